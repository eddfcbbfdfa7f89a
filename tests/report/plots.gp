# SPDX-License-Identifier: AGPL-3.0-or-later
# Plots of the report: gnuplot -e "data='FOLDER'; scene='hair'; what='total'; output='x.svg'" plots.gp
# what: total, shadow, memory, file (against error, for a scene), lv7, lv7error, lv8, lv9.
set terminal svg size 520,400 fixed font "sans-serif,12" background "#ffffff" name what.scene
set output output
set logscale xy
set format xy "%g"
set grid lc rgb "#dddddd"
set key below samplen 2
set border lc rgb "#555555"
methods = "none raytraced deep accuracy baked map"
title_of(m) = m eq "raytraced" ? "ray tracing" : m eq "deep" ? "deep, baked in this render" : m eq "baked" ? "deep, from a file" : m eq "accuracy" ? "deep, accuracy" : "PCF"
colour(m) = m eq "raytraced" ? "#444444" : m eq "deep" ? "#0060c0" : m eq "baked" ? "#30a0e0" : m eq "accuracy" ? "#20a040" : "#d06000"
file(m) = data."/".scene."-".m.".dat"
# Methods of whom there is a point.
there(list) = system("for m in ".list."; do test -s '".data."/".scene."-'$m.dat && echo $m; done")

if (what eq "total" || what eq "shadow") {
  set xlabel "RMSE"
  set ylabel what eq "total" ? "seconds, map and picture" : "seconds of the shadows alone"
  shown = there("raytraced deep accuracy baked map")
  plot for [m in shown] file(m) using 1:(what eq "total" ? $2 : $3) with linespoints lw 2 pt 7 ps 0.6 lc rgb colour(m) title title_of(m)
}
if (what eq "memory" || what eq "file") {
  set xlabel "RMSE"
  set ylabel what eq "memory" ? "megabytes in memory" : "megabytes of the map's file"
  shown = what eq "memory" ? there("deep accuracy map") : there("baked map")
  plot for [m in shown] file(m) using 1:((what eq "memory" ? $4 : $5) > 0 ? (what eq "memory" ? $4 : $5) / 1e6 : NaN) with linespoints lw 2 pt 7 ps 0.6 lc rgb colour(m) title (m eq "map" ? "PCF" : m eq "accuracy" ? "deep, accuracy" : "deep")
}
if (what eq "lv7" || what eq "lv7error") {
  scene = "lv7"
  shown = there("map deep")
  if (what eq "lv7") {
    set xlabel "rays a pixel of a 256 x 256 map, along one side"
    set ylabel "seconds of look-ups"
    plot for [m in shown] file(m) using 1:2 with linespoints lw 2 pt 7 ps 0.6 lc rgb colour(m) title (m eq "map" ? "PCF" : "deep")
  } else {
    set xlabel "RMSE"
    set ylabel "seconds of look-ups"
    plot for [m in shown] file(m) using 3:2 with linespoints lw 2 pt 7 ps 0.6 lc rgb colour(m) title (m eq "map" ? "PCF" : "deep")
  }
}
if (what eq "lv8") {
  set xlabel "rays a pixel, along one side"
  set ylabel "vertices a pixel"
  plot data."/lv8.dat" using 1:2 with linespoints lw 2 pt 7 ps 0.6 lc rgb "#444444" title "as sampled", \
    "" using 1:3 with linespoints lw 2 pt 7 ps 0.6 lc rgb "#0060c0" title "greedy (LV 3.3)", \
    "" using 1:4 with linespoints lw 2 pt 7 ps 0.6 lc rgb "#30a0e0" title "fewest possible", \
    "" using 1:(sqrt($1)) with lines dt 2 lc rgb "#888888" title "N^{1/4}, LV 4"
}
if (what eq "lv9") {
  scene = "lv9"
  set xlabel "filter width, as a share of the map"
  set ylabel "seconds of look-ups"
  shown = there("map deep")
  plot for [m in shown] file(m) using 1:2 with linespoints lw 2 pt 7 ps 0.6 lc rgb colour(m) title (m eq "map" ? "PCF" : "deep")
}
