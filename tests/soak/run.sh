#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Renders random scenes (random.pov) ray-traced and with deep maps: no crash, no number that is none, and an error within the bound
# that each scene prints. A line of the Test Anything Protocol for each scene, in the order in which they finish.
#
#   tests/soak/run.sh [FIRST [COUNT]]     seeds, 1 200; pictures stay in build/soak/
#   RESUME=1 tests/soak/run.sh ...        goes on: what this program, library and generator have rendered is not rendered again
set -u
here=$(cd "$(dirname "$0")" && pwd)
top=$(dirname "$(dirname "$here")")
: "${POVRAY:=$top/build/bin/povray}" "${SHADOW_ERROR:=$top/tests/image/shadow_error}"
export DEEP_SHADOW_CHOICE=map   # maps also where rays would cost less
export POVRAY SHADOW_ERROR here
export out=$top/build/soak
first=${1:-1} count=${2:-200}
[ -n "${RESUME:-}" ] || rm -rf "$out"
mkdir -p "$out"

rendered() {  # $1: picture without its ending
  local file maker
  file=$out/$1.exr
  [ -s "$file" ] && grep -qa 'POV-Ray finished' "$out/$1.log" || return 1
  for maker in "$POVRAY" "$(dirname "$POVRAY")"/../lib/povray-*/deepshadow.so "$here/random.pov"; do
    [ "$file" -nt "$maker" ] || return 1
  done
}

render() {  # $1: picture without its ending, $2: seed, then options
  local picture=$1 seed=$2
  shift 2
  ! rendered "$picture" || return 0
  (cd "$out" && timeout 600 "$POVRAY" -D -V +I"$here/random.pov" +O"$picture.exr" +FE +W96 +H72 +A0.0 +AM1 +R2 -J \
    Declare=Seed="$seed" "$@" >"$picture.log" 2>&1 </dev/null) && [ -s "$out/$picture.exr" ]
}

one() {  # $1: seed
  local bound words name="seed $1"
  if ! render "$1-traced" "$1" +WT1 Shadow_Method=raytraced; then
    echo "not ok - $name: no ray-traced picture"
    tail -n 5 "$out/$1-traced.log" | sed 's/^/# /'
    return
  fi
  if ! render "$1-deep" "$1" +WT$(($1 % 4 + 1)) Shadow_Method=deep; then
    echo "not ok - $name: no picture with deep maps"
    tail -n 5 "$out/$1-deep.log" | sed 's/^/# /'
    return
  fi
  bound=$(sed -n 's/^Bound \([0-9.]*\)$/\1/p' "$out/$1-deep.log")
  read -ra words < <("$SHADOW_ERROR" "$out/$1-traced.exr" "$out/$1-deep.exr" 2>&1)
  if awk -v r="${words[0]:-x}" -v b="${bound:-x}" 'BEGIN { exit !(r ~ /^[0-9.e+-]+$/ && b ~ /^[0-9.]+$/ && r + 0 <= b + 0) }'; then
    echo "ok - $name: rmse ${words[0]} of $bound"
  else
    echo "not ok - $name: ${words[*]} (rmse, max, share); allowed ${bound:-what the scene did not say}"
  fi
}
export -f one render rendered

echo "1..$count"
seq "$first" $((first + count - 1)) | xargs -r -n 1 -P "$(nproc)" bash -c 'one "$1"' _
