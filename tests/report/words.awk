# SPDX-License-Identifier: AGPL-3.0-or-later
# When to use which method, and what it costs: sentences from the numbers, after common.awk and envelope.awk.

# The best rung of ray tracing, by error: its seconds over those without shadows are the most that anything can save.
# "" where the latter are too few to be measured.
function ceiling(scene,  i, best, least) {
  least = 1e9
  for (i = 1; i <= count; i++)
    if (index(names[i], "speed/" scene "/raytraced/") == 1 && has(names[i], "rmse") && get(names[i], "rmse") + 0 < least) {
      least = get(names[i], "rmse") + 0
      best = names[i]
    }
  return best == "" || get(none_of(best), "seconds") < 0.05 ? "" : get(best, "seconds") / get(none_of(best), "seconds")
}

function against(scene, other,  a, b, c, e, s, t, u, DE, DT, OE, OT, BE, BT, text) {
  a = envelope(scene, "deep", "total", DE, DT)
  b = envelope(scene, other, "total", OE, OT)
  c = envelope(scene, "baked", "total", BE, BT)
  if (!a || !b) return (other == "map" ? "PCF" : "Ray tracing") " was not available for this comparison."
  common(DE, a, OE, b)
  e = lo
  s = time_at(e, DE, DT, a); t = time_at(e, OE, OT, b); u = time_at(e, BE, BT, c)
  text = "At an error of " error(e) " " (other == "map" ? "PCF" : "ray tracing") " takes " seconds(t) " s and a deep map " seconds(s) " s" \
    (u == "" ? "" : " (" seconds(u) " s if it comes from a file, as in an animation's second frame)") ": "
  if (t >= s * 1.1) { wins[scene, other] = "deep"; text = text "<strong>the deep map is " times(t / s) " times as fast</strong>." }
  else if (s >= t * 1.1) {
    wins[scene, other] = other
    text = text "<strong>" (other == "map" ? "PCF" : "ray tracing") " wins, by " times(s / t) " times</strong>" \
      (u != "" && u * 1.1 <= t ? ", unless the map comes from a file: then the deep map is " times(t / u) " times as fast." : ".")
  } else { wins[scene, other] = "none"; text = text "they are about even." }
  if (DE[a] > OE[b] * 1.2) text = text " With finer settings " (other == "map" ? "PCF" : "ray tracing") " got down to " error(OE[b]) ", where no deep map of this ladder came (" error(DE[a]) ")."
  if (OE[b] > DE[a] * 1.2) text = text " Deep maps went on to " error(DE[a]) "; " (other == "map" ? "PCF" : "ray tracing") " did not get below " error(OE[b]) " on its ladder."
  return text
}

function list_of(winner, other,  i, s) {
  for (i = 1; i <= 6; i++) if (wins[scenes[i], other] == winner) s = s (s == "" ? "" : ", ") tolower(title(scenes[i]))
  return s
}

END {
  split("hair floor cloud pipes glass sphere", scenes, " ")
  for (i = 1; i <= 6; i++) {
    c = ceiling(scenes[i])
    body = body "<li><strong>" title(scenes[i]) ".</strong> " against(scenes[i], "raytraced") " " against(scenes[i], "map") \
      (c == "" || c < 1.05 ? "" : " Without any shadows the picture would take 1/" times(c) " of ray tracing's best, so nothing can gain more than that.") "</li>\n"
  }
  d = list_of("deep", "raytraced"); r = list_of("raytraced", "raytraced"); n = list_of("none", "raytraced"); p = list_of("map", "map"); q = list_of("deep", "map")
  print "<ul>"
  if (d != "") print "<li>Use a <strong>deep shadow map</strong> for what these stand for: " d ". There it gave the same error in less time than ray tracing, its baking included.</li>"
  if (n != "") print "<li>Either will do for: " n ".</li>"
  if (r != "") print "<li>Keep <strong>ray tracing</strong> for what these stand for: " r ". There it gave the same error in less time, and its shadows are as sharp as the scene.</li>"
  if (q != "" || p != "") print "<li><strong>PCF</strong> on an ordinary shadow map" (p == "" ? " was never the fastest against a deep map at equal error" : " is faster than a deep map at equal error for: " p) (q == "" ? "" : "; it is slower, or never as close, for: " q) ". It knows only opaque surfaces: glass and clouds cast full shadows or none.</li>"
  else print "<li><strong>PCF</strong>: not measured here.</li>"
  print "</ul>\n<p>Scene by scene, at the smallest error that both reached, total seconds (map and picture):</p>\n<ul>\n" body "</ul>"
}
