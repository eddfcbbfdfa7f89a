#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Motion blur: bakes the map of motion.pov at many instants, merges the maps, and renders the flight of the ball with the
# blurred shadow, and with the shadow of the middle of the flight only. Run it in the build's top folder.
#
# Environment: POVRAY (build/bin/povray), DSMTOOL (build/bin/dsmtool), MOTION_DIR (build/motion), MOTION_WIDTH (640),
# MOTION_HEIGHT (480), MOTION_INSTANTS (32), MOTION_THREADS (all processors).
set -eu
export DEEP_SHADOW_CHOICE=map  # what is shown are maps

here=$(cd "$(dirname "$0")" && pwd)
povray=$(realpath "${POVRAY:-build/bin/povray}")
dsmtool=$(realpath "${DSMTOOL:-build/bin/dsmtool}")
width=${MOTION_WIDTH:-640}
height=${MOTION_HEIGHT:-480}
instants=${MOTION_INSTANTS:-32}
threads=${MOTION_THREADS:-$(nproc)}

mkdir -p "${MOTION_DIR:-build/motion}"
cd "${MOTION_DIR:-build/motion}"
rm -f motion*.exr frame*.exr

# A frame for each instant: the middles of as many parts of the shutter's time.
flight() { # what to say, then options
    echo "$1 ..."
    shift
    if ! "$povray" "$@" +I"$here/motion.pov" -D -V -J +WT"$threads" +KFI1 +KFF"$instants" \
        +KI"$(awk "BEGIN { print 0.5 / $instants }")" +KF"$(awk "BEGIN { print 1 - 0.5 / $instants }")" > flight.log 2>&1; then
        tail -n 20 flight.log >&2
        exit 1
    fi
}

mean() { # picture: of the frames, which it removes
    local frames=(frame*.exr) sum=() i
    for i in "${!frames[@]}"; do
        sum+=("${frames[i]}")
        [ "$i" = 0 ] || sum+=(--add)
    done
    oiiotool "${sum[@]}" --ch R,G,B --divc "${#frames[@]}" -o "$1"
    rm -f "${frames[@]}"
}

flight "Baking $instants maps" Declare=Bake=1 -F +W8 +H6
"$dsmtool" merge -o motion.exr motion_*.exr
flight "Rendering the flight with a blurred shadow" Declare=Merged=1 +Oframe.exr +FE +W"$width" +H"$height" +A0.1
mean with.exr
flight "Rendering the flight with the shadow of its middle" Declare=Frozen=1 +Oframe.exr +FE +W"$width" +H"$height" +A0.1
mean without.exr
oiiotool without.exr with.exr --mosaic:pad=8 2x1 --clamp:min=0:max=1 --colorconvert linear sRGB -d uint8 -o motion.png
echo "The maps and pictures are in $(pwd): motion.png has the shadow of one instant on the left, the blurred one on the right."
