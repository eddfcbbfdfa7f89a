# SPDX-License-Identifier: AGPL-3.0-or-later
# What gnuplot draws: files FOLDER/SCENE-METHOD.dat with lines "RMSE seconds shadow-seconds bytes file-bytes", and
# FOLDER/lv7-METHOD.dat, lv8.dat, lv9-METHOD.dat. After common.awk.
function bytes_of(name, what,  m) { m = get(name, "map"); gsub(/;/, ",", m); return get(m, what) }
END {
  for (i = 1; i <= count; i++) {
    n = names[i]
    if (!ok(n)) continue
    if (part(n, 1) == "speed" && has(n, "rmse") && get(n, "rmse") > 0)
      print get(n, "rmse"), get(n, "seconds"), shadow_seconds(n), get(n, "bytes") + 0, bytes_of(n, "file_bytes") + 0 \
        >(folder "/" part(n, 2) "-" part(n, 3) ".dat")
    s = get(n, "seconds") - get("lv/close/none/-", "seconds")
    if (s < 0.001) s = 0.001
    if (part(n, 1) == "lv7") print part(n, 4), s, get(n, "rmse"), bytes_of(n, "file_bytes") / 1e6 >(folder "/lv7-" part(n, 3) ".dat")
    if (part(n, 1) == "lv8") { split(get(n, "all_seconds"), v, " "); print part(n, 4), v[1], v[2], v[3] >(folder "/lv8.dat") }
    if (part(n, 1) == "lv9") print part(n, 4), s >(folder "/lv9-" part(n, 3) ".dat")
  }
}
