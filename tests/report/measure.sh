#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# How one thing is measured: functions that run.sh and the scripts in tests/bench/ share. To be sourced.
#
# A picture is "W:H:DEPTH:X:Y:w:h": its size, the antialiasing depth (DEPTH x DEPTH rays an image pixel; 1: one ray), and
# the part of it, in image pixels from the upper left corner, in which errors are counted.
set -u
export DEEP_SHADOW_CHOICE=map  # what is measured are maps, also where rays would cost less
top=${top:-$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)}
: "${POVRAY:=$top/build/bin/povray}" "${DSMTOOL:=$top/build/bin/dsmtool}" "${SHADOW_ERROR:=$top/tests/image/shadow_error}"
: "${VERTICES:=$top/tests/bench/vertices}" "${OIIOTOOL:=oiiotool}" "${THREADS:=2}"
: "${REFERENCES:=$top/build/references}"
export LC_ALL=C TIMEFORMAT='%R %U %S'

antialiasing() { if [ "$1" = 1 ]; then echo -A; else echo "+A0.0 +AM1 +R$1 -J"; fi; }

render() {  # $1: folder to be in, $2: where picture and log go, without ending, $3: scene, then options
  local folder=$1 to=$2 scene=$3
  shift 3
  rm -f "$to.exr"
  { time (cd "$folder" && "$POVRAY" -D -V +I"$top/$scene" +O"$to.exr" +FE -J +WT"$THREADS" "$@" >"$to.log" 2>&1 </dev/null); } 2>"$to.time" &&
    [ -s "$to.exr" ]
}

# The part of a picture that counts, its pixels averaged $4 x $4.
cut_out() {  # $1: picture, $2: result, $3: X:Y:w:h in averaged pixels, $4: how many are averaged
  local x y w h
  IFS=: read -r x y w h <<<"$3"
  "$OIIOTOOL" "$1" --ch R,G,B --cut "$((w * $4))x$((h * $4))+$((x * $4))+$((y * $4))" --resize:filter=box "${w}x$h" -o "$2"
}

# What the log says, as "parse parse-cpu pixels rays lookups bytes vertices uncompressed trace"; numbers that it does not hold are 0.
from_log() {
  tr '\r' '\n' <"$1" | awk '
    /Time:/ { reading = /Parse Time:|Bounding Time:/; s = $0; sub(/.*\(/, "", s); if (reading) parse += s; if (/Trace Time:/) trace = s }
    /CPU-seconds total/ && reading { s = $0; sub(/.* with /, "", s); cpu += s }
    /^Pixels baked:/ { pixels = $3 } /^Light rays:/ { rays = $3 } /^Look-ups:/ { lookups = $2 + 0 } /^Bytes:/ { bytes = $2 }
    /^Vertices per pixel:/ { vertices = $4; before = $7 + 0 }
    END { printf "%.3f %.3f %d %d %d %d %s %s %.3f\n", parse, cpu, pixels, rays, lookups, bytes, vertices + 0, before + 0, trace }'
}

# Seconds that POV-Ray takes for nothing: it waits for its own threads. $1: folder, $2: how often; prints their median.
idle_seconds() {
  local i
  echo "camera { }" >"$1/empty.pov"
  for ((i = 0; i < $2; i++)); do
    (top=$1 && render "$1" "$1/empty" empty.pov +W4 +H3 -A) || return 1
    awk 'NF == 3 { print $1 }' "$1/empty.time"
  done | median
}

# Wall and CPU seconds of a picture, without $IDLE and those of reading the scene, which are the same for every method.
from_time() {  # $1: picture without ending, $2, $3: seconds of reading the scene, wall and CPU; prints "wall cpu"
  awk -v parse="$2" -v used="$3" -v idle="${IDLE:-0}" 'NF == 3 { w = $1 - parse - idle; c = $2 + $3 - used; printf "%.3f %.3f\n", (w > 0.001 ? w : 0.001), (c > 0 ? c : 0) }' "$1.time"
}

median() { sort -g | awk '{ t[NR] = $1 } END { print t[int((NR + 1) / 2)] }'; }

# Largest compression error for N x N rays a pixel: a quarter of the worst noise 1 / N, and what storing rounds.
tolerance_of() { awk -v n="$1" 'BEGIN { printf "%.6f", 0.25 / n + 1e-5 }'; }

# The truth: ray-traced at OVER times the size with DEPTH x DEPTH rays, averaged; with media, MS doubled until the
# picture moves less than MOVE (RMSE). Prints the last movement and MS, or "0 0".
truth() {  # $1: result, $2: scene, $3: picture, $4: over, $5: MOVE or 0, $6: first MS, then options
  local result=$1 scene=$2 picture=$3 over=$4 move=$5 ms=$6 W H depth x y w h moved=0 work
  shift 6
  IFS=: read -r W H depth x y w h <<<"$picture"
  work=${result%.exr}
  one() {  # $1: more options
    # shellcheck disable=SC2046,SC2086
    render "$(dirname "$result")" "$work-full" "$scene" +W$((W * over)) +H$((H * over)) $(antialiasing "$depth") \
      +SC$((x * over + 1)) +EC$(((x + w) * over)) +SR$((y * over + 1)) +ER$(((y + h) * over)) \
      Shadow_Method=raytraced "${@:2}" $1 && cut_out "$work-full.exr" "$work-new.exr" "$x:$y:$w:$h" "$over"
  }
  if [ "$move" = 0 ]; then
    one '' "$@" || return 1
  else
    one "Declare=MS=$ms" "$@" || return 1
    while :; do
      mv "$work-new.exr" "$work-old.exr"
      ms=$((2 * ms))
      one "Declare=MS=$ms" "$@" || return 1
      moved=$("$SHADOW_ERROR" "$work-old.exr" "$work-new.exr" | cut -d' ' -f1)
      ! awk -v m="$moved" -v t="$move" 'BEGIN { exit !(m + 0 < t + 0) }' || break
      [ "$ms" -lt 320 ] || break   # four times dearer each time
    done
  fi
  mv "$work-new.exr" "$result"
  rm -f "$work-full.exr" "$work-old.exr"
  echo "$moved $ms"
}
