#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Renders the hair ball without shadows, ray-traced and with deep shadows, and prints what each cost and how far it is
# from ray tracing. `make demo` calls this from the build's top folder.
#
# Environment: POVRAY (build/bin/povray), SHADOW_ERROR (tests/image/shadow_error), DEMO_WIDTH (640), DEMO_HEIGHT (480),
# DEMO_HAIRS (50000), DEMO_THREADS (all processors), DEMO_DIR (build/demo), DEMO_OPTIONS (more options for POV-Ray).
set -eu
export DEEP_SHADOW_CHOICE=map  # what is shown are maps

here=$(cd "$(dirname "$0")" && pwd)
povray=${POVRAY:-build/bin/povray}
shadow_error=${SHADOW_ERROR:-tests/image/shadow_error}
width=${DEMO_WIDTH:-640}
height=${DEMO_HEIGHT:-480}
hairs=${DEMO_HAIRS:-50000}
threads=${DEMO_THREADS:-$(nproc)}
out=${DEMO_DIR:-build/demo}

mkdir -p "$out"
[ -x "$(command -v "$povray")" ] || { echo "demo.sh: no program $povray: run make first" >&2; exit 1; }

# Seconds as bash's time prints them; user and system are added.
TIMEFORMAT='%R %U %S'

render() { # method
    local method=$1
    rm -f "$out/hairball_$method.exr" "$out/hairball_$method.png"
    echo "Rendering the hair ball, $width x $height, Shadow_Method=$method ..."
    # shellcheck disable=SC2086
    if ! { time "$povray" "+I$here/hairball.pov" "+O$out/hairball_$method.exr" +FE "+W$width" "+H$height" \
            "+WT$threads" -D -V +A0.0 +AM1 +R3 -J "Declare=Hairs=$hairs" "Shadow_Method=$method" \
            ${DEMO_OPTIONS:-} > "$out/hairball_$method.log" 2>&1; } 2> "$out/hairball_$method.time" ||
        [ ! -s "$out/hairball_$method.exr" ]; then
        tail -n 20 "$out/hairball_$method.log" >&2
        echo "demo.sh: the render failed; its whole output is in $out/hairball_$method.log" >&2
        exit 1
    fi
    # A picture for eyes: the same values, with the sRGB curve.
    if command -v oiiotool > /dev/null; then
        oiiotool "$out/hairball_$method.exr" --ch R,G,B --clamp:min=0:max=1 --colorconvert linear sRGB -d uint8 \
            -o "$out/hairball_$method.png"
    fi
}

row() { # method
    local wall cpu error
    read -r wall cpu < <(awk 'NF == 3 { w = $1; c = $2 + $3 } END { printf "%.1f %.1f\n", w, c }' "$out/hairball_$1.time")
    error=$("$shadow_error" "$out/hairball_raytraced.exr" "$out/hairball_$1.exr" |
        awk '{ printf "%10.4f %8.3f", $1, $2 }') || error='         ?        ?'
    printf '%-10s %8s %8s %s\n' "$1" "$wall" "$cpu" "$error"
}

# Lines "name: value" of the statistics' section "Deep Shadow Maps".
statistics() {
    awk '
        { line = $0; gsub(/\r/, "", line) }
        tolower(line) ~ /deep shadow maps/ { inside = 1; next }
        inside && line ~ /^[ \t]*(-+|=+)?[ \t]*$/ { if (seen && line !~ /[-=]/) inside = 0; next }
        inside && line ~ /^[ \t]*[A-Za-z][^:]*:?[ \t]+[^ \t]/ {
            key = tolower(line); sub(/[:].*/, "", key)
            if (key ~ /bytes|memory|size|vert|look|ray|bake|pixel|map|light/) { sub(/^[ \t]*/, "", line); print "  " line; seen = 1 }
            else if (seen) inside = 0
        }' "$out/hairball_deep.log"
}

for method in none raytraced deep; do render "$method"; done

echo
echo "Hair ball, $hairs hairs, three lights, $width x $height, 9 samples an image pixel, $threads threads"
echo "(wall and CPU seconds with scene reading; RMSE and largest difference against ray tracing, linear values)"
echo
printf '%-10s %8s %8s %10s %8s\n' method wall CPU RMSE max
for method in none raytraced deep; do row "$method"; done
echo
lines=$(statistics)
if [ -n "$lines" ]; then
    echo "Deep shadow maps:"
    echo "$lines"
else
    echo "(No statistics of deep shadow maps in $out/hairball_deep.log.)"
fi
echo
echo "Pictures: $out/hairball_none.png, $out/hairball_raytraced.png, $out/hairball_deep.png"
