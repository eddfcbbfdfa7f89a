# SPDX-License-Identifier: AGPL-3.0-or-later
# The papers' tables, theirs and ours in the same rows (-v table=lv6|lv7|lv8|lv9|rsc1|rsc2), after common.awk.
function look(name,  s) {  # seconds of look-ups: the picture less the one without shadows
  if (!ok(name)) return ""
  s = get(name, "seconds") - get("lv/close/none/-", "seconds")
  return seconds(s > 0.001 ? s : 0.001)
}
function map_of(name,  m) { m = get(name, "map"); gsub(/;/, ",", m); return m }
function ratio(a, b) { return a == "" || b == "" || b + 0 == 0 ? "" : times(a / b) }
function head(s) { print "<table><thead>" cells(s, "th") "</thead><tbody>" }

function lv6(  i, n, w, theirs) {
  theirs["b"] = "512&#178; PCF, 16 samples|19|"; theirs["c"] = "4096&#178; PCF, 400 samples|559|6"; theirs["d"] = "512&#178; deep, 256 samples a pixel|37|1"
  head("figure|LV|LV s|LV storage, of d|ours|look-ups s|RMSE|memory MB|file MB|baking s")
  for (i = 1; i <= count; i++) {
    n = names[i]
    if (part(n, 1) != "lv6") continue
    split(part(n, 4), w, ",")
    m = map_of(n)
    if (part(n, 3) == "raytraced") { print cells("-|||| ray-traced|" look(n) "|" error(get(n, "rmse")) "|||"); continue }
    print cells("6" w[1] "|" theirs[w[1]] "|" w[2] "&#178; " (part(n, 3) == "map" ? "PCF, " : "deep, ") w[3] " samples|" (ok(n) ? look(n) "|" error(get(n, "rmse")) "|" \
      mega(get(m, "bytes")) "|" mega(get(m, "file_bytes")) "|" seconds(get(m, "seconds")) : missing(n) "||||"))
  }
}

function lv7(  i, n, w, side, theirs, d, p) {
  theirs[2] = "25.00|34|45|0.34|0.49"; theirs[4] = "12.50|39|46|1.34|0.79"; theirs[8] = "6.25|60|45|5.34|1.18"
  theirs[16] = "3.12|145|46|21.34|1.53"; theirs[32] = "1.56|554|46|85.34|1.84"; theirs[64] = "0.78|2414|45|341.34|2.20"
  head("samples|LV error %|LV PCF s|LV deep s|LV PCF MB|LV deep MB|LV PCF / deep|PCF RMSE|deep RMSE|PCF s|deep s|PCF / deep|PCF MB|deep MB, finest level|deep file MB|PCF baking s|deep baking s")
  for (i = 1; i <= count; i++) {
    n = names[i]
    if (index(n, "lv7/close/deep/") != 1) continue
    side = part(n, 4); d = n; p = "lv7/close/map/" side
    split(theirs[side], w, "|")
    print cells(side "&#215;" side "|" theirs[side] "|" ratio(w[2], w[3]) "|" (ok(p) ? error(get(p, "rmse")) : missing(p)) "|" (ok(d) ? error(get(d, "rmse")) : missing(d)) "|" \
      look(p) "|" look(d) "|" ratio(look(p), look(d)) "|" mega(get(map_of(p), "bytes")) "|" mega(get(map_of(d), "finest_bytes")) "|" mega(get(map_of(d), "file_bytes")) "|" \
      seconds(get(map_of(p), "seconds")) "|" seconds(get(map_of(d), "seconds")))
  }
}

function lv8(  i, n, v) {
  head("samples|as sampled|LV 3.3, greedy|fewest possible|fewest / greedy|N<sup>1/4</sup>, LV")
  for (i = 1; i <= count; i++) {
    n = names[i]
    if (part(n, 1) != "lv8") continue
    split(get(n, "all_seconds"), v, " ")
    print cells(part(n, 4) "&#215;" part(n, 4) "|" (ok(n) ? v[1] "|" v[2] "|" v[3] "|" v[4] : missing(n) "|||") "|" sprintf("%.2f", sqrt(part(n, 4))))
  }
}

function lv9(  i, n, p) {
  head("filter width, of the map|PCF s|deep s|PCF / deep")
  for (i = 1; i <= count; i++) {
    n = names[i]
    if (index(n, "lv9/close/deep/") != 1) continue
    p = "lv9/close/map/" part(n, 4)
    print cells(part(n, 4) "|" (ok(p) ? look(p) : missing(p)) "|" (ok(n) ? look(n) : missing(n)) "|" ratio(look(p), look(n)))
  }
}

function resolution_of(scene, method,  i) {
  for (i = 1; i <= count; i++) if (index(names[i], "rsc/" scene "/" method "/") == 1) return part(names[i], 4)
}
function rsc1(  i, k, s, n, first, second, none, m, pictures, theirs) {
  split("sphere colours lamps", pictures, " ")
  theirs[1] = "Sphere and plane|42.0|1|9.7|48.0|57.7|37.3"; theirs[2] = "Colored lights|64.4|3|14.2|80.8|95.0|47.6"; theirs[3] = "Luxo Jr.|58.8|3|14.6|74.2|88.8|50.9"
  head("image|RSC without min|lights|first pass min|second pass min|total min|increase %|method|ours: without s|first pass s|second pass s|total s|increase %")
  for (i = 1; i <= 3; i++)
    for (k = 1; k <= 3; k++) {
      m = k == 1 ? "map" : k == 2 ? "deep" : "raytraced"
      s = m == "raytraced" ? "-" : resolution_of(pictures[i], m)
      n = "rsc/" pictures[i] "/" m "/" s
      none = get("rsc/" pictures[i] "/none/-", "seconds")
      first = get("bake/" pictures[i] "/" m "/" s, "seconds"); second = get(n, "seconds")
      print cells((k == 1 ? theirs[i] : "||||||") "|" (m == "deep" ? "deep map" : called(m)) "|" (ok(n) ? seconds(none) "|" seconds(first) "|" seconds(second) "|" seconds(first + second) "|" \
        (none > 0 ? sprintf("%.0f", 100 * ((first + second) / none - 1)) : "") : missing(n) "||||"))
    }
  print cells("Red's Dream|261.3|2|55.3|332.1|387.4|48.4|<em>their scene is not public</em>|||||")
}
function rsc2(  i, s, n, m, lights, pictures, theirs) {
  split("sphere colours lamps", pictures, " ")
  theirs[1] = "Sphere and plane|1 at 1024&#178;|4.0|.4|.4"; theirs[2] = "Colored lights|3 at 1024&#178;|12.0|2.6|2.9"; theirs[3] = "Luxo Jr.|1 at 2048&#178;, 2 at 1024&#178;|24.0|13.0|3.7"
  lights[1] = 1; lights[2] = 3; lights[3] = 3
  head("image|RSC resolutions|raw MB|bounding box MB|tiles MB|ours: resolution|raw MB|in memory, 16&#178; tiles MB|file MB|deep: in memory MB|deep: file MB")
  for (i = 1; i <= 3; i++) {
    s = resolution_of(pictures[i], "map")
    n = "bake/" pictures[i] "/map/" s; m = "bake/" pictures[i] "/deep/" s
    print cells(theirs[i] "|" lights[i] " at " s "&#178;|" mega(4 * s * s * lights[i]) "|" (ok(n) ? mega(get(n, "bytes")) "|" mega(get(n, "file_bytes")) : missing(n) "|") "|" \
      (ok(m) ? mega(get(m, "bytes")) "|" mega(get(m, "file_bytes")) : missing(m) "|"))
  }
  print cells("Bike Store|2 at 1024&#178;|8.0|5.6|4.2|<em>their scene is not public</em>|||||")
}
END {
  if (table == "lv6") lv6(); else if (table == "lv7") lv7(); else if (table == "lv8") lv8(); else if (table == "lv9") lv9()
  else if (table == "rsc1") rsc1(); else if (table == "rsc2") rsc2()
  print "</tbody></table>"
}
