#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# What the hair ball's map costs to bake object by object, against ray by ray: 512 x 512, 16 samples, all tiles.
#
#   tests/bench/order.sh [HAIRS]      50000; takes some minutes
#
# Cost: user instructions where the machine counts them, and user seconds. What the scene costs without its map
# (parsing, trees) is measured too and taken off; what is left is tracing, averaging, compression and the file. "Trace"
# is the share of the wall clock that went into finding hits and reporting them. RUNS=3: medians.
set -eu
export DEEP_SHADOW_CHOICE=map  # what is measured are maps, also where rays would cost less
top=$(cd "$(dirname "$0")/../.." && pwd)
: "${POVRAY:=$top/build/bin/povray}" "${RUNS:=3}" "${RESOLUTION:=512}"
export LC_ALL=C
hairs=${1:-50000}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

counted=
if perf stat -x, -e instructions:u -o "$out/perf" true 2>/dev/null && grep -q '^[0-9]' "$out/perf"; then counted=1; fi

render() {  # $1: order, then options; prints user seconds, instructions (0: not counted) and the share of tracing
  local order=$1 seconds instructions=0
  shift
  local -a count=()
  [ -z "$counted" ] || count=(perf stat '-x,' -e instructions:u -o "$out/perf")
  mkdir -p "$out/$order"
  TIMEFORMAT=%U
  seconds=$( { time (cd "$out/$order" && DEEP_SHADOW_ORDER=${order%-*} "${count[@]}" "$POVRAY" -D -V +I"$top/scenes/hairball.pov" \
    +O"$out/picture.exr" +FE +W16 +H12 -A +WT1 Declare=Close=1 Declare=Hairs="$hairs" "$@" >"$out/$order/log" 2>&1); } 2>&1)
  [ -z "$counted" ] || instructions=$(sed -n 's/^\([0-9]*\),.*instructions.*/\1/p' "$out/perf")
  echo "$seconds $instructions $(sed -n 's/^Bake time: *\([0-9.]*\) thread seconds (\([0-9.]*\) .*/\1 \2/p' "$out/$order/log" |
    awk '{ print ($1 > 0) ? $2 / $1 : 0 }')"
}
median() { sort -n | awk '{ v[NR] = $1 } END { print v[int((NR + 1) / 2)] }'; }

for curl in 0 1; do
  for name in objects rays idle; do : >"$out/$name-$curl.txt"; done
  for _ in $(seq "$RUNS"); do
    for name in objects rays; do
      render "$name-$curl" Declare=Curl="$curl" Declare=Resolution="$RESOLUTION" Declare=Samples=16 Declare=File=1 >>"$out/$name-$curl.txt"
    done
    render "idle-$curl" Declare=Curl="$curl" Declare=Resolution=16 Declare=Samples=1 >>"$out/idle-$curl.txt"
  done
  if cmp -s "$out/objects-$curl/hairball1.exr" "$out/rays-$curl/hairball1.exr"; then same="equal maps"; else same="DIFFERENT MAPS"; fi
  column() { awk -v c="$2" '{ print $c }' "$out/$1-$curl.txt" | median; }
  awk -v curl="$curl" -v same="$same" -v hairs="$hairs" -v counted="${counted:-0}" \
      -v o="$(column objects 1)" -v r="$(column rays 1)" -v i="$(column idle 1)" \
      -v oc="$(column objects 2)" -v rc="$(column rays 2)" -v ic="$(column idle 2)" \
      -v os="$(column objects 3)" -v rs="$(column rays 3)" 'BEGIN {
    printf "%d %s hairs: %s\n", hairs, curl ? "curled" : "straight", same
    printf "  bake, user seconds:       by object %8.2f  by ray %8.2f  ratio %5.2f\n", o - i, r - i, (r - i) / (o - i)
    printf "  of that tracing:          by object %8.2f  by ray %8.2f  ratio %5.2f\n", (o - i) * os, (r - i) * rs, (r - i) * rs / ((o - i) * os)
    if (counted) printf "  bake, 1e9 instructions:   by object %8.2f  by ray %8.2f  ratio %5.2f\n", (oc - ic) / 1e9, (rc - ic) / 1e9, (rc - ic) / (oc - ic)
  }'
done
