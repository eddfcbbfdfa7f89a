# SPDX-License-Identifier: AGPL-3.0-or-later
# The table of times at equal error, after common.awk and envelope.awk.
function lines(scene, other, what,  a, b, c, k, steps, e, s, t, u, DE, DT, OE, OT, BE, BT, first) {
  a = envelope(scene, "deep", what, DE, DT)
  b = envelope(scene, other, what, OE, OT)
  c = envelope(scene, "baked", what, BE, BT)
  if (!b && other == "accuracy") return   # not of this scene
  first = title(scene) "|deep against " called(other) "|" (what == "total" ? "all" : "shadows")
  if (!a || !b) { print cells(first "|<em>not available</em>||||"); return }
  common(DE, a, OE, b)
  steps = lo < hi ? 3 : 1
  for (k = 0; k < steps; k++) {
    e = steps == 1 ? lo : exp(log(hi) + k / (steps - 1) * log(lo / hi))
    s = time_at(e, DE, DT, a); t = time_at(e, OE, OT, b); u = time_at(e, BE, BT, c)
    print cells(first "|" error(e) "|" (s == "" ? "not reached" : seconds(s)) "|" (u == "" ? "" : seconds(u)) "|" \
      (t == "" ? "not reached" : seconds(t)) "|" (s == "" || t == "" ? "" : (t >= s ? times(t / s) : "<strong>1/" times(s / t) "</strong>")))
  }
}
END {
  print "<table><thead>" cells("scene|compared|time|at RMSE|deep s|deep from a file s|other s|other / deep", "th") "</thead><tbody>"
  split("hair floor cloud pipes glass sphere", scenes, " ")
  split("raytraced map accuracy", others, " ")
  for (i = 1; i <= 6; i++) {
    for (k = 1; k <= 3; k++) { lines(scenes[i], others[k], "total"); lines(scenes[i], others[k], "shadow") }
  }
  print "</tbody></table>"
}
