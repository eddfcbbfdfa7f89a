#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Lokovic & Veach's figures 7, 8 and 9 on the hair ball's shadow seen from nearby, 256 x 256 map pixels.
#
#   tests/bench/figures.sh [7] [8] [9]        all; "7" with its row of 64 x 64 rays a pixel takes half an hour
#
# SIDES="2 4 8 16 32 64": square roots of the rays a pixel. RUNS=5: each time is the median of so many renders. Times
# are those of an image with the map loaded, minus those of the image without shadows; maps stay in build/figures/.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
: "${POVRAY:=$top/build/bin/povray}" "${DSMTOOL:=$top/build/bin/dsmtool}" "${SHADOW_ERROR:=$top/tests/image/shadow_error}"
: "${SIDES:=2 4 8 16 32 64}" "${RUNS:=5}" "${VERTICES:=$top/tests/bench/vertices}"
export LC_ALL=C
out=$top/build/figures
mkdir -p "$out"

# A quarter of the worst noise, and what storing rounds: the step of one ray in 16 is then still no taller.
tolerance_of() { awk -v n="$1" 'BEGIN { printf "%.6f", 0.25 / n + 1e-5 }'; }

render() {  # $1: folder of the map, $2: picture, then options
  local folder=$1 picture=$2
  shift 2
  (cd "$folder" && "$POVRAY" -D -V +I"$top/scenes/hairball.pov" +O"$out/$picture.exr" +FE +W640 +H480 -A \
    Declare=White=1 Declare=Close=1 Declare=Resolution=256 "$@" >"$out/$picture.log" 2>&1)
}

# Seconds of tracing as POV-Ray prints them: the median of RUNS.
seconds() {
  for _ in $(seq "$RUNS"); do
    render "$@" +WT1 +A0.0 +AM1 +R3 -J
    sed -n 's/.*Trace Time:.*(\([0-9.]*\) seconds).*/\1/p' "$out/$2.log" | tail -n 1
  done | sort -n | awk '{ t[NR] = $1 } END { print t[int((NR + 1) / 2)] }'
}

bake() {  # $1: side, $2: tolerance; prints the map's folder
  local folder=$out/map-$1-$2
  if [ ! -s "$folder/hairball1.exr" ]; then
    mkdir -p "$folder"
    render "$folder" bake +W16 +H12 +WT"$(nproc)" Declare=Samples=$(($1 * $1)) Declare=Tolerance="$2" Declare=File=1
  fi
  echo "$folder"
}

level() { awk -v column="$2" '$1 == "level" { on = 1; next } on && $1 == 0 { print $column; exit }' <<<"$1"; }

# Truth for the error: the picture's own camera rays, 81 a pixel and averaged 4 x 4, ray-traced.
truth() {
  [ -s "$out/truth.exr" ] || {
    render "$out" truth-full +W640 +H480 +A0.0 +AM1 +R9 -J +WT"$(nproc)" Shadow_Method=raytraced
    oiiotool "$out/truth-full.exr" --ch R,G,B --resize:filter=box 25% -o "$out/truth.exr"
  }
}
error() {  # $1: map's folder, then options
  local folder=$1
  shift
  render "$folder" error-full +W640 +H480 +A0.0 +AM1 +R9 -J +WT"$(nproc)" Declare=File=2 "$@"
  oiiotool "$out/error-full.exr" --ch R,G,B --resize:filter=box 25% -o "$out/error.exr"
  "$SHADOW_ERROR" "$out/truth.exr" "$out/error.exr" | cut -d' ' -f1
}

figure7() {
  truth
  local none
  none=$(seconds "$out" none Shadow_Method=none)
  printf '\nFigure 7. Image without shadows: %s s. Memory is that of level 0; the file holds all levels.\n' "$none"
  printf '%8s %9s %9s %9s %9s %10s %9s %9s %9s\n' samples tolerance RMSE "time s" MB "all, MB" "file MB" vertices bytes
  for side in $SIDES; do
    local t folder time info options
    t=$(tolerance_of "$side")
    folder=$(bake "$side" "$t")
    options=(Declare=Samples=$((side * side)) Declare=Tolerance="$t")
    time=$(seconds "$folder" deep "${options[@]}" Declare=File=2)
    info=$("$DSMTOOL" info "$folder/hairball1.exr")
    printf '%8s %9s %9s %9s %9s %10s %9s %9s %9s\n' "${side}x$side" "$t" "$(error "$folder" "${options[@]}")" \
      "$(awk -v a="$time" -v b="$none" 'BEGIN { printf "%.3f", a - b }')" "$(level "$info" 7 | awk '{ printf "%.3f", $1 / 1e6 }')" \
      "$(awk '/^All levels together/ { printf "%.3f", $5 / 1e6 }' <<<"$info")" \
      "$(stat -c %s "$folder/hairball1.exr" | awk '{ printf "%.3f", $1 / 1e6 }')" "$(level "$info" 6)" "$(level "$info" 8)"
  done
}

figure8() {
  printf '\nFigure 8. Vertices a pixel that has any: as sampled, greedy, minimal, minimal/greedy; N^(1/4).\n'
  for side in $SIDES; do
    [ "$side" -le "${MOST_EXACT:-16}" ] || continue
    printf '%8s %s %10.2f\n' "${side}x$side" "$("$VERTICES" "$(bake "$side" 0)/hairball1.exr" "$(tolerance_of "$side")")" \
      "$(awk -v n="$side" 'BEGIN { print sqrt(n) }')"
  done
}

figure9() {
  local none folder t
  t=$(tolerance_of 16)
  folder=$(bake 16 "$t")
  none=$(seconds "$out" none Shadow_Method=none)
  printf '\nFigure 9. Time of shadows against the width of the filter, as a share of the map.\n%8s %9s\n' width "time s"
  for blur in 0.004 0.0075 0.015 0.03 0.045 0.06; do
    printf '%8s %9s\n' "$blur" "$(seconds "$folder" deep Declare=Samples=256 Declare=Tolerance="$t" Declare=File=2 \
      Declare=Blur=$blur | awk -v b="$none" '{ printf "%.3f", $1 - b }')"
  done
}

for figure in "${@:-7 8 9}"; do for figure in $figure; do "figure$figure"; done; done
