# SPDX-License-Identifier: AGPL-3.0-or-later
# One scene's table of all rungs (-v scene=...), after common.awk.
function setting(name,  w, s) {
  split(part(name, 4), w, ",")
  s = w[1] == 1 ? "1 ray" : w[1] * w[1] " rays"
  s = s " an image pixel"
  if (w[2] > 0) s = s ", MS " w[2]
  if (part(name, 3) == "accuracy") s = s ", accuracy " w[3]
  else if (w[3] != "") s = s ", " w[3] "&#178; map pixels, " w[4] " samples"
  if (w[5] != "") s = s ", region " w[5] " image pixels wide"
  return s
}
END {
  print "<table><thead>" cells("method|setting|RMSE|max|total s|shadows s|user + system s|of none|map MB|file MB|runs", "th") "</thead><tbody>"
  split("none raytraced deep accuracy baked map", methods, " ")
  for (m = 1; m <= 6; m++)
    for (i = 1; i <= count; i++) {
      n = names[i]
      if (index(n, "speed/" scene "/" methods[m] "/") != 1) continue
      if (!ok(n)) { print "<tr><td>" called(methods[m]) "</td><td>" setting(n) "</td><td colspan='9'>" missing(n) "</td></tr>"; continue }
      none = none_of(n)
      file = get(n, "map"); gsub(/;/, ",", file)
      print cells(called(methods[m]) "|" setting(n) "|" error(get(n, "rmse")) "|" error(get(n, "max")) "|" seconds(get(n, "seconds")) "|" \
        (methods[m] == "none" ? "" : seconds(shadow_seconds(n))) "|" seconds(get(n, "cpu")) "|" \
        (methods[m] == "none" || get(none, "seconds") < 0.05 ? "" : times(get(n, "seconds") / get(none, "seconds"))) "|" \
        mega(get(n, "bytes")) "|" mega(get(file, "file_bytes")) "|" get(n, "runs"))
    }
  print "</tbody></table>"
  r = "reference/" scene
  if (ok(r)) {
    split(get(r, "picture"), p, ":"); split(get(r, "options"), o, " ")
    printf "<p>Error is counted in %d &#215; %d image pixels of the %d &#215; %d picture, against a reference ray-traced with %d rays an image pixel%s. Scene options of all pictures: <code>%s</code>.</p>\n", \
      p[6], p[7], p[1], p[2], (p[3] > 1 ? p[3] * p[3] : 1) * o[1] * o[1], \
      (o[2] > 0 ? ", with MS doubled up to " get(r, "ms") ": the last doubling moved it by " sprintf("%.5f", get(r, "moved")) " (RMSE)" : ""), \
      substr(get(r, "options"), length(o[1] o[2] o[3]) + 4)
  } else print "<p>Reference: " missing(r) "</p>"
}
