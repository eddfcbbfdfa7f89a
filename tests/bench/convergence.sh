#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Error of the deep shadow against resolution and samples, on a part of the hair ball and of the glass scene.
#
#   tests/bench/convergence.sh [SCENE...]      hairball glass
#
# Truth is ray tracing with 1296 samples an image pixel: 81 a pixel of a picture that is then averaged 4 x 4. The deep
# pictures have the same camera rays, so that the difference is the shadow's alone. LADDER="512,16 2048,64" are map
# resolutions and samples; CROP_hairball and CROP_glass are columns and rows of the picture, as shares.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
: "${POVRAY:=$top/build/bin/povray}" "${SHADOW_ERROR:=$top/tests/image/shadow_error}"
: "${LADDER:=256,4 256,16 512,16 512,64 1024,16 1024,64 2048,16 2048,64}"
: "${CROP_hairball:=0.42 0.52 0.40 0.52}" "${CROP_glass:=0.25 0.65 0.45 0.85}"
width=640 height=480   # averaged to a quarter of this
out=$top/build/convergence
mkdir -p "$out"

picture() {  # $1: name, $2: scene, then options: writes the averaged crop $out/$1.exr
  local name=$1 scene=$2 crop=CROP_$2 c0 c1 r0 r1
  shift 2
  read -r c0 c1 r0 r1 <<<"${!crop}"
  "$POVRAY" -D -V +I"$top/scenes/$scene.pov" +O"$out/full.exr" +FE +W$width +H$height +A0.0 +AM1 +R9 -J +WT"$(nproc)" \
    +SC"$c0" +EC"$c1" +SR"$r0" +ER"$r1" Declare=White=1 "$@" >"$out/$name.log" 2>&1
  local box
  box=$(awk -v w=$width -v h=$height -v a="$c0" -v b="$c1" -v c="$r0" -v d="$r1" \
    'BEGIN { x = 4 * int(w * a / 4) + 4; y = 4 * int(h * c / 4) + 4; printf "%dx%d+%d+%d", 4 * int((w * b - x) / 4) - 4, 4 * int((h * d - y) / 4) - 4, x, y }')
  oiiotool "$out/full.exr" --ch R,G,B --cut "$box" --resize:filter=box 25% -o "$out/$name.exr"
}

for scene in "${@:-hairball glass}"; do for scene in $scene; do
  [ -s "$out/$scene-truth.exr" ] || picture "$scene-truth" "$scene" Shadow_Method=raytraced
  printf '\n%s\n%10s %8s %9s %9s %12s %10s\n' "$scene" resolution samples RMSE max "map bytes" "vertices"
  for step in $LADDER; do
    name=$scene-${step/,/-}
    picture "$name" "$scene" Declare=Resolution="${step%,*}" Declare=Samples="${step#*,}"
    read -r rmse max _ < <("$SHADOW_ERROR" "$out/$scene-truth.exr" "$out/$name.exr")
    printf '%10s %8s %9.5f %9.5f %12s %10s\n' "${step%,*}" "${step#*,}" "$rmse" "$max" \
      "$(sed -n 's/^Bytes: *//p' "$out/$name.log" | tail -n 1)" "$(sed -n 's/^Vertices per pixel: *\([0-9.]*\).*/\1/p' "$out/$name.log" | tail -n 1)"
  done
done; done
