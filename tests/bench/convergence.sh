#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Error of the deep shadow against resolution and samples, on a part of the hair ball and of the glass scene.
#
#   tests/bench/convergence.sh [SCENE...]      hairball glass
#
# Truth is ray tracing with 1296 samples an image pixel: 81 a pixel of a picture that is then averaged 4 x 4. The deep
# pictures have the same camera rays, so that the difference is the shadow's alone; the report's have fewer, as its are timed.
# LADDER="512,16 2048,64" are map resolutions and samples; PART_hairball and PART_glass are X:Y:w:h in a picture of 160 x 120.
set -eu
export DEEP_SHADOW_CHOICE=map  # what is measured are maps, also where rays would cost less
. "$(dirname "$0")/../report/measure.sh"
: "${LADDER:=256,4 256,16 512,16 512,64 1024,16 1024,64 2048,16 2048,64}"
: "${PART_hairball:=68:49:14:13}" "${PART_glass:=41:55:62:46}"
out=$top/build/convergence
mkdir -p "$out"

averaged() {  # $1: name, $2: scene, then options
  local name=$1 scene=$2 part=PART_$2
  shift 2
  truth "$out/$name.exr" "scenes/$scene.pov" "160:120:9:${!part}" 4 0 0 Declare=White=1 "$@" >/dev/null
}

for scene in "${@:-hairball glass}"; do for scene in $scene; do
  [ -s "$out/$scene-truth.exr" ] || averaged "$scene-truth" "$scene"
  printf '\n%s\n%10s %8s %9s %9s %12s %10s\n' "$scene" resolution samples RMSE max "map bytes" "vertices"
  for step in $LADDER; do
    name=$scene-${step/,/-}
    averaged "$name" "$scene" Shadow_Method=deep Declare=Resolution="${step%,*}" Declare=Samples="${step#*,}"
    read -r rmse max _ < <("$SHADOW_ERROR" "$out/$scene-truth.exr" "$out/$name.exr")
    read -r _ _ _ _ _ bytes vertices _ < <(from_log "$out/$name-full.log")
    printf '%10s %8s %9.5f %9.5f %12s %10s\n' "${step%,*}" "${step#*,}" "$rmse" "$max" "$bytes" "$vertices"
  done
done; done
