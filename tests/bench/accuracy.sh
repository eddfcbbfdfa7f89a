#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# What the word `accuracy` reaches and costs, beside fixed maps: error of the shadow, light rays traced for it, and CPU seconds of
# all threads for map and picture, without reading the scene.
#
#   tests/bench/accuracy.sh [SCENE...]      glass hairball cloud cloud_pipes volume parallel_light point_light; a quarter of an hour
#
# The reference is a fixed map, fine and with many rays, under the same camera rays: so the difference is what coarser pixels
# and fewer rays make, and nothing else. (It flatters fixed maps as fine as the reference itself, whose pixels blur alike.)
# AIMS="0.02 0.01" are values of accuracy, FIXED="128,16 512,4" resolutions and samples; CHOSEN=0.01 is the aim that is compared with
# the cheapest fixed map that is as close. PICTURE_glass is its picture (tests/report/measure.sh). References stay in build/accuracy/.
set -eu
. "$(dirname "$0")/../report/measure.sh"
: "${AIMS:=0.02 0.01 0.005}" "${FIXED:=64,4 128,4 128,16 256,1 256,4 256,16 512,1 512,4 512,16 1024,1 1024,4}" "${CHOSEN:=0.01}"
: "${PICTURE_glass:=160:120:3:0:0:160:120}" "${PICTURE_hairball:=160:120:3:49:65:61:40}"
: "${PICTURE_cloud:=120:90:2:0:0:120:90}" "${PICTURE_cloud_pipes:=120:90:2:0:0:120:90}" "${PICTURE_volume:=120:90:2:0:0:120:90}"
: "${PICTURE_parallel_light:=160:120:3:0:0:160:120}" "${PICTURE_point_light:=160:120:3:0:0:160:120}"
: "${REFERENCE_parallel_light:=2048,16}" "${REFERENCE_point_light:=2048,16}"
: "${REFERENCE_glass:=1024,64}" "${REFERENCE_hairball:=1024,64}" "${REFERENCE_cloud:=512,16}" "${REFERENCE_cloud_pipes:=2048,16}" "${REFERENCE_volume:=1024,16}"
out=$top/build/accuracy
mkdir -p "$out"

fixed() { echo "Declare=Resolution=${1%,*} Declare=Samples=${1#*,}"; }

shadow() {  # $1: name of the picture, $2: scene, then options
  local name=$1 scene=$2 part=PICTURE_$2 media='' W H depth x y w h
  shift 2
  case $scene in cloud*) media=Declare=MS=20 ;; esac
  IFS=: read -r W H depth x y w h <<<"${!part}"
  # shellcheck disable=SC2046
  render "$out" "$out/$name" "scenes/$scene.pov" +W"$W" +H"$H" $(antialiasing "$depth") \
    +SC$((x + 1)) +EC$((x + w)) +SR$((y + 1)) +ER$((y + h)) Declare=White=1 $media "$@"
}

reference() {  # $1: scene, $2: resolution and samples
  local part=PICTURE_$1
  # shellcheck disable=SC2046
  shadow "$1-whole" "$1" $(fixed "$2") || return 1
  cut_out "$out/$1-whole.exr" "$out/$1-reference.exr" "$(cut -d: -f4- <<<"${!part}")" 1
  rm -f "$out/$1-whole.exr"
}

line() {  # $1: scene, $2: what to call it, then options: prints and notes "name RMSE rays"
  local scene=$1 name=$2 part=PICTURE_$1 x y rmse max parse used rays bytes cpu
  shift 2
  shadow "$scene-one" "$scene" "$@" || { echo "accuracy.sh: $scene, $name: no picture; see $out/$scene-one.log" >&2; return 1; }
  IFS=: read -r _ _ _ x y _ <<<"${!part}"
  read -r rmse max _ < <("$SHADOW_ERROR" "$out/$scene-reference.exr" "$out/$scene-one.exr" "$x" "$y")
  read -r parse used _ rays _ bytes _ < <(from_log "$out/$scene-one.log")
  read -r _ cpu < <(from_time "$out/$scene-one" "$parse" "$used")
  printf '%-20s %9.5f %9.5f %12d %9.2f %12d\n' "$name" "$rmse" "$max" "$rays" "$cpu" "$bytes" | tee -a "$out/$scene.txt"
}

verdict() {  # $1: scene
  awk -v chosen="accuracy $CHOSEN" '
    { name = $1 " " $2; error = $3 + 0; rays = $5 + 0; seconds = $6 }
    name == chosen { aim = error; cost = rays; time = seconds }
    $1 == "fixed" { n++; names[n] = $2; errors[n] = error; costs[n] = rays; times[n] = seconds }
    END {
      if (!cost) exit
      for (i = 1; i <= n; i++) if (errors[i] <= aim && (!best || costs[i] < costs[best])) best = i
      printf "%s: %.5f, %d rays, %.2f s; ", chosen, aim, cost, time
      if (best) printf "cheapest fixed that is as accurate: %s, %.5f, %d rays, %.2f s; ratio of rays %.2f\n", names[best], errors[best], costs[best], times[best], costs[best] / cost
      else print "no fixed map of these is as accurate"
    }' "$out/$1.txt"
}

for scene in "${@:-glass hairball cloud cloud_pipes volume parallel_light point_light}"; do for scene in $scene; do
  reference=REFERENCE_$scene part=PICTURE_$scene
  about="${!reference} ${!part} $(cat "$POVRAY" "$(dirname "$POVRAY")"/../lib/povray-3.7/*.so "$top/scenes/$scene.pov" | sha256sum)"
  if [ ! -s "$out/$scene-reference.exr" ] || [ "$about" != "$(cat "$out/$scene-reference.of" 2>/dev/null)" ]; then
    reference "$scene" "${!reference}"
    echo "$about" >"$out/$scene-reference.of"
  fi
  printf '\n%s, against a fixed map of %s\n%-20s %9s %9s %12s %9s %12s\n' "$scene" "${!reference}" map RMSE max 'light rays' 'CPU s' 'map bytes'
  : >"$out/$scene.txt"
  for aim in $AIMS; do line "$scene" "accuracy $aim" Declare=Accuracy="$aim"; done
  # shellcheck disable=SC2046
  for step in $FIXED; do [ "$step" = "${!reference}" ] || line "$scene" "fixed $step" $(fixed "$step"); done
  verdict "$scene"
done; done
