#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Writes report.html from report.csv (and the pictures beside it), as run.sh left them. Folder: REPORT (build/report).
here=$(cd "$(dirname "$0")" && pwd)
. "$here/measure.sh"
set -e
: "${REPORT:=$top/build/report}"
csv=$REPORT/report.csv
[ -s "$csv" ] || { echo "page.sh: no $csv: run tests/report/run.sh first" >&2; exit 1; }
command -v gnuplot >/dev/null || { echo "page.sh: gnuplot draws the plots (Debian: gnuplot-nox)" >&2; exit 1; }
data=$REPORT/plots
rm -rf "$data"
mkdir -p "$data"
table() { awk -f "$here/common.awk" "$@" "$csv"; }
# A column of the row whose name is $1.
of() { table -v name="$1" -v what="$2" -f <(echo 'END { if (ok(name)) print get(name, what) }'); }

plot() {  # $1: what, $2: scene or none, then the data files of which one must be there
  local what=$1 scene=$2 file found=
  shift 2
  for file; do [ ! -s "$data/$file.dat" ] || found=1; done
  if [ -z "$found" ]; then echo "<p><em>not available: no measurement to draw ($what${scene:+, $scene})</em></p>"; return; fi
  gnuplot -e "data='$data'; scene='$scene'; what='$what'; output='$data/$what-$scene.svg'" "$here/plots.gp" 2>"$data/gnuplot.log" || { cat "$data/gnuplot.log" >&2; return 1; }
  sed '1,/^<svg/ { /^<svg/!d }' "$data/$what-$scene.svg"
}

figure() {  # $1: PNG, $2: caption
  printf '<figure><img alt="%s" src="data:image/png;base64,%s" /><figcaption>%s</figcaption></figure>\n' "$2" "$(base64 -w0 "$1")" "$2"
}
pair() {  # $1: name of a row, $2: its reference's name, $3: caption: the part that counts as sRGB, and how far it is from the truth
  local key picture truth x y w h
  key=$(of "$1" key) truth=$REFERENCES/$(basename "$2")-$(of "$2" key).exr picture=$REPORT/pictures/$key.exr
  if [ -z "$key" ] || [ ! -s "$picture" ] || [ ! -s "$truth" ]; then echo "<p><em>not available: $3</em></p>"; return; fi
  IFS=: read -r _ _ _ x y w h <<<"$(of "$1" picture)"
  "$OIIOTOOL" "$picture" --ch R,G,B --cut "${w}x$h+$x+$y" --dup --clamp:min=0:max=1 --colorconvert linear sRGB -d uint8 -o "$data/picture.png" \
    --pop "$truth" --absdiff --mulc 4 --clamp:min=0:max=1 --colorconvert linear sRGB -d uint8 -o "$data/difference.png"
  figure "$data/picture.png" "$3"
  figure "$data/difference.png" "difference from the reference, 4 times"
}
# The finest rung of a method, by its place in the plan.
last() { table -v start="speed/$1/$2/" -f <(echo 'END { for (i = 1; i <= count; i++) if (index(names[i], start) == 1 && ok(names[i])) n = names[i]; print n }'); }

table -v folder="$data" -f "$here/curves.awk"
scenes='hair floor cloud pipes glass sphere'
form=$(awk -F, 'NR == 2 { print $1 }' "$csv")

# Deep against ray-traced at the same MS.
for name in $(table -f <(echo 'END { for (i = 1; i <= count; i++) if (part(names[i], 1) == "speed" && part(names[i], 3) == "deep" && part(names[i], 4) !~ /^[0-9]+,0,/ && ok(names[i])) print names[i] }')); do
  IFS=/ read -r _ scene _ setting <<<"$name"
  traced=$(of "speed/$scene/raytraced/$(cut -d, -f1,2 <<<"$setting")" key)
  own=$REPORT/pictures/$(of "$name" key).exr
  [ -z "$traced" ] || [ ! -s "$own" ] || [ ! -s "$REPORT/pictures/$traced.exr" ] ||
    echo "$name $("$SHADOW_ERROR" "$REPORT/pictures/$traced.exr" "$own" | cut -d' ' -f1)"
done >"$data/between"

{
  cat "$here/page.html"
  [ "$form" = full ] || echo "<p><em>This is the $form form of the report: smaller pictures, fewer settings, single runs. Take numbers from the full one$([ "$form" != smoke ] || echo '; these only show that everything works').</em></p>"
  cat <<'TEXT'
<h2>When to use which method, and what it costs</h2>
<p><strong>Ray tracing</strong> sends a shadow ray from every point that is shaded to every light: exact for that point, dear where the way is
full of hair, glass or cloud, and noisy where shadows are finer than the rays. <strong>PCF</strong> (percentage closer filtering on an ordinary
shadow map) looks from the light once and keeps one depth for each map pixel; a point compares its own depth with some of those around it, and the
share that lies before it is its shadow. <strong>A deep shadow map</strong> also looks from the light once, but keeps for each map pixel how much light is left
at <em>every</em> depth: the mean of many light rays, compressed. One look-up then gives a shadow already filtered, through hair, glass and cloud alike.
With the word <code>accuracy</code> a deep map chooses resolution and rays place by place, for an error to aim at.
A map costs its baking and its memory; it blurs what is smaller than its pixels; and it can be kept in a file for the next frame.</p>
TEXT
  table -f "$here/envelope.awk" -f "$here/words.awk"
  cat <<TEXT
<h2>How it was measured</h2>
<table><tbody>
<tr><td>machine</td><td>$(awk -F': *' '/^model name/ { print $2; exit }' /proc/cpuinfo), $(nproc) processors, $THREADS threads, $(uname -sr)</td></tr>
<tr><td>version</td><td>$(table -f <(echo 'END { for (i = 1; i <= count; i++) if (get(names[i], "commit") != "") s[get(names[i], "commit")] = 1; for (c in s) printf "%s ", c }'))</td></tr>
<tr><td>date</td><td>$(date -u '+%Y-%m-%d %H:%M UTC'), form "$form"</td></tr>
<tr><td>programs</td><td>$("$POVRAY" --version 2>&1 | grep -m 1 -o "POV-Ray 3[^ ]*" || true), $("$OIIOTOOL" --version 2>/dev/null | head -n 1) (OpenImageIO), gnuplot $(gnuplot --version | cut -d' ' -f2)</td></tr>
</tbody></table>
<p><strong>Error</strong> is the root mean square error (RMSE) and the largest difference over red, green and blue of linear values, of the shadow
alone: all receivers are matte white (<code>Declare=White=1</code>; hair and floor are white, glass casts shadows but is not seen, clouds glow no more
and their surroundings are black), so that full light is about 1. One program counts it: <code>tests/image/shadow_error.cpp</code>. The
reference is ray-traced with at least 1024 rays an image pixel (full form); with media, its media samples are doubled until that moves it
less than about a tenth of the errors that count (how far stands below each table). <strong>Time</strong> is wall time less what reading the scene takes and what POV-Ray waits for nothing
($(table -f <(echo 'END { for (i = count; i >= 1; i--) if (get(names[i], "idle") > 0) { print get(names[i], "idle"); exit } }')) s), both the same for all methods: the median of the runs in the last column (long renders run once); user + system stands beside it. Shadow time is that less the
time of the same picture with <code>Shadow_Method=none</code>. All numbers are in <code>report.csv</code> beside this page.</p>
<h2>Speed against error</h2>
TEXT
  for scene in $scenes; do
    echo "<h3>$(table -v s="$scene" -f <(echo 'END { print title(s) }'))</h3><div class='plots'>"
    files=("$scene-raytraced" "$scene-deep" "$scene-accuracy" "$scene-baked" "$scene-map")
    plot total "$scene" "${files[@]}"
    plot shadow "$scene" "${files[@]}"
    echo '</div>'
    table -v scene="$scene" -f "$here/speed.awk"
    for method in raytraced deep accuracy map; do
      name=$(last "$scene" "$method")
      [ -z "$name" ] || pair "$name" "reference/$scene" "$(table -v m=$method -f <(echo 'END { print called(m) }')), its last setting"
    done
  done
  cat <<'TEXT'
<h2>Times at equal error</h2>
<p>Each method's best settings make a curve; between its points time is interpolated as a straight line of log time against log error. The errors are the
smallest that both methods reached, the largest, and their geometric mean. Where the last column is above 1, the deep map is faster; in bold where it is slower.</p>
TEXT
  table -f "$here/envelope.awk" -f "$here/equal.awk"
  echo '<h2>Media: against the reference, and against each other</h2><p>At the same number of media samples: RMSE.</p>'
  table -v between="$data/between" -f "$here/media.awk"
  echo '<h2>Memory and file size against error</h2>'
  for scene in $scenes; do
    echo "<h3>$(table -v s="$scene" -f <(echo 'END { print title(s) }'))</h3><div class='plots'>"
    plot memory "$scene" "$scene-deep" "$scene-accuracy" "$scene-map"
    plot file "$scene" "$scene-baked"
    echo '</div>'
  done
  cat <<'TEXT'
<h2>Lokovic &amp; Veach 2000</h2>
<p>The shadow of the hair ball on the floor, from nearby. Times are those of looking up: POV-Ray's own seconds of tracing the picture (9 rays an image pixel) with the map from a file, less those of the
picture without shadows, as in the paper. Errors are those of one look-up an image pixel. The region of PCF is as wide as a pixel of the deep map's (figure 6: of the smallest map). Theirs is a 1999 scan-line renderer: compare ratios.</p>
<h3>Figure 6</h3>
TEXT
  table -v table=lv6 -f "$here/papers.awk"
  for name in $(table -f <(echo 'END { for (i = 1; i <= count; i++) if (part(names[i], 1) == "lv6") print names[i] }')); do
    IFS=/ read -r _ _ method setting <<<"$name"
    pair "$name" reference/close "$([ "$setting" = - ] && echo "ray-traced, one ray an image pixel" || echo "6${setting%%,*}: $method")"
  done
  echo '<h3>Figure 7: the same number of depth samples</h3><div class="plots">'
  plot lv7 '' lv7-deep lv7-map
  plot lv7error '' lv7-deep lv7-map
  echo '</div>'
  table -v table=lv7 -f "$here/papers.awk"
  echo '<h3>Figure 8: vertices of a pixel that has any</h3><div class="plots">'
  plot lv8 '' lv8
  echo '</div>'
  table -v table=lv8 -f "$here/papers.awk"
  echo '<h3>Figure 9: wider filters</h3><div class="plots">'
  plot lv9 '' lv9-deep lv9-map
  echo '</div><p>Theirs, read off the plot: PCF grows with the width, deep shadows do not.</p>'
  table -v table=lv9 -f "$here/papers.awk"
  echo '<h2>Reeves, Salesin &amp; Cook 1987</h2><h3>Table 1: computation time</h3><p>First pass: all of the maps. 16 rays an image pixel, here and there; their pictures are 1024 image pixels wide.</p>'
  table -v table=rsc1 -f "$here/papers.awk"
  echo '<h3>Table 2: storage of the maps</h3>'
  table -v table=rsc2 -f "$here/papers.awk"
  echo '</body></html>'
} >"$REPORT/report.html.new"
mv "$REPORT/report.html.new" "$REPORT/report.html"
rm -f "$data"/*.png
echo "$REPORT/report.html"
