# SPDX-License-Identifier: AGPL-3.0-or-later
# Media at the same MS: deep and ray-traced against the reference, and against each other; after common.awk. The last
# comes from a file of lines "DEEP RMSE" (-v between=FILE).
END {
  while ((getline text < between) > 0) { split(text, w, " "); apart[w[1]] = w[2] }
  print "<table><thead>" cells("scene|MS|deep map|deep &#8722; reference|ray-traced &#8722; reference|deep &#8722; ray-traced", "th") "</thead><tbody>"
  for (i = 1; i <= count; i++) {
    n = names[i]
    if (part(n, 1) != "speed" || part(n, 3) != "deep" || !has(n, "rmse")) continue
    split(part(n, 4), w, ",")
    if (w[2] == 0) continue
    t = "speed/" part(n, 2) "/raytraced/" w[1] "," w[2]
    print cells(title(part(n, 2)) "|" w[2] "|" w[3] "&#178;, " w[4] "|" error(get(n, "rmse")) "|" error(get(t, "rmse")) "|" error(apart[n]))
  }
  print "</tbody></table>"
}
