# SPDX-License-Identifier: AGPL-3.0-or-later
# Reads report.csv and answers for rows by their names; the other .awk files here build on it. POSIX awk.
BEGIN { FS = ","; OFS = "\t" }
FNR == 1 { for (i = 1; i <= NF; i++) column[$i] = i; next }
{
  row = $column["name"]
  gsub(/;/, ",", row)
  names[++count] = row
  for (c in column) value[row, c] = $column[c]
}

function get(name, what) { return value[name, what] }
function ok(name) { return value[name, "status"] == "ok" }
function has(name, what) { return ok(name) && value[name, what] != "" }

# "speed/hair/deep/1,0,512,4": section, scene, method, setting
function part(name, n,  words) { split(name, words, "/"); return words[n] }

# The picture without shadows that belongs to a row of speed: same depth and MS.
function none_of(name,  words) { split(part(name, 4), words, ","); return "speed/" part(name, 2) "/none/" words[1] "," words[2] }
# Seconds of the shadows alone; what is below the clock's step counts as a millisecond.
function shadow_seconds(name,  s) {
  s = get(name, "seconds") - get(none_of(name), "seconds")
  return s > 0.001 ? s : 0.001
}

function seconds(s) { return s == "" ? "" : s < 10 ? sprintf("%.2f", s) : sprintf("%.0f", s) }
function error(e) { return e == "" ? "" : sprintf("%.4f", e) }
function mega(bytes) { return bytes == "" || bytes == 0 ? "" : sprintf(bytes < 1e7 ? "%.2f" : "%.1f", bytes / 1e6) }
function times(r) { return r >= 10 ? sprintf("%.0f", r) : sprintf("%.1f", r) }
function html(s) { gsub(/&/, "\\&amp;", s); gsub(/</, "\\&lt;", s); gsub(/>/, "\\&gt;", s); return s }

function row_of(cells, n, tag,  i, s) { s = "<tr>"; for (i = 1; i <= n; i++) s = s "<" tag ">" cells[i] "</" tag ">"; return s "</tr>" }
# A table's line from words with | between them.
function cells(line, tag,  list, n) { n = split(line, list, "|"); return row_of(list, n, tag == "" ? "td" : tag) }
function missing(name) { return "<em>not available: " html(value[name, "status"] == "" ? "not measured" : value[name, "status"]) "</em>" }

function title(scene) {
  return scene == "hair" ? "Hair ball" : scene == "floor" ? "Hair shadow" : scene == "cloud" ? "Cloud" : \
    scene == "pipes" ? "Cloud with pipes" : scene == "glass" ? "Glass" : scene == "sphere" ? "Sphere and plane" : scene
}
function called(method) {
  return method == "raytraced" ? "ray tracing" : method == "deep" ? "deep map, baked in this render" : \
    method == "baked" ? "deep map from a file" : method == "map" ? "PCF" : \
    method == "accuracy" ? "deep map with accuracy" : method
}
