#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Lokovic & Veach's figures 6 to 9 and Reeves, Salesin & Cook's tables; plan.sh sources it. The hair ball's shadow on the
# floor, seen from nearby: "close". Maps are baked whole and kept, so that times are those of looking up.
file=scenes/hairball.pov start=$(ladder 5.6 0.9 0.3)
close="Declare=White=1 Declare=Close=1 $hair"
# For what is looked up DEPTH is how many times larger the timed picture is: 640 x 480.
view=$(ladder 160:120:4:0:72:160:48 160:120:2:0:72:160:48 32:24:2:0:12:32:12)
line reference/close "$(ladder 75 10 0.5)" 1 reference "$file" "$(ladder 160:120:9 160:120:6 32:24:2):$(cut -d: -f4- <<<"$view")" - - "$over 0 0 $close"

bake_seconds() { awk -v r="$1" -v n="$2" -v s="$start" 'BEGIN { printf "%.1f", s + 1.3e-6 * r * r * n }'; }
bake_deep() {  # $1: resolution, $2: side, $3: tolerance; sets map and words
  map=bake/close/deep/$1,$2,$3
  words="$close Declare=Resolution=$1 Declare=Samples=$(($2 * $2)) Declare=Tolerance=$3"
  line "$map" "$(bake_seconds "$1" $(($2 * $2)))" 1 bake "$file" 16:12:1:0:0:16:12 - - "$words Declare=File=1"
}
bake_map() {  # $1: resolution, $2: side of the samples of a look-up, $3: width of the filter in map pixels
  map=bake/close/map/$1
  words="$close Declare=Pcf=1 Shadow_Method=map Declare=Resolution=$1"
  line "$map" "$(bake_seconds "$1" 1)" 1 bake "$file" 16:12:1:0:0:16:12 - - "$words Declare=File=1"
  words="$words Declare=NumSamples=$(($2 * $2)) Declare=MinSamples=1 Declare=ResFactor=0.001 Declare=MinSize=$3"
}
look() {  # $1: name, $2: more seconds a run, $3: reference or -
  picture "$1" "$(awk -v s="$start" -v m="$2" -v t="$(ladder 3 1 0.1)" 'BEGIN { print s + t + m }')" lookup "$file" "$view" "$3" "$map" \
    "$words Declare=File=2"
}
# Map pixels that cover a pixel of a map of $2 pixels, in one of $1.
across() { awk -v a="$1" -v b="$2" 'BEGIN { printf "%g", a / b }'; }

map=- words="$close Shadow_Method=none"
picture lv/close/none/- "$(ladder 7 2 0.4)" lookup "$file" "$view" - - "$words"

# ---- Figure 6 --------------------------------------------------------------------------------------------------------
words="$close Shadow_Method=raytraced"
picture lv6/close/raytraced/- "$(ladder 14 4 0.4)" lookup "$file" "$view" reference/close - "$words"
for row in $figure6; do
  IFS=, read -r letter method r side <<<"$row"
  case $method in
    deep) bake_deep "$r" "$side" "$(tolerance_of "$side")" ;;
    map) bake_map "$r" "$side" "$(across "$r" "$(cut -d' ' -f1 <<<"$figure6" | cut -d, -f3)")" ;;
  esac
  look "lv6/close/$method/$letter,$r,$((side * side))" 1 reference/close
done

# ---- Figure 7: the same number of depth samples, and one filter width: a pixel of the deep map ------------------------
base=$(ladder 256 256 32)
for side in $sides; do
  bake_deep "$base" "$side" "$(tolerance_of "$side")"
  look "lv7/close/deep/$side" 1 reference/close
  bake_map $((base * side)) "$side" "$side"
  look "lv7/close/map/$side" "$(awk -v n="$side" 'BEGIN { print 1 + 0.007 * n * n }')" reference/close
done

# ---- Figure 8: vertices, of maps that merge exact ones only -----------------------------------------------------------
for side in $exact; do
  bake_deep "$base" "$side" 0
  line "lv8/close/vertices/$side" "$(ladder 3 2 0.2)" 1 vertices "$file" - - "$map" "$(tolerance_of "$side")"
done

# ---- Figure 9: wider filters on one map; 8 x 8 samples ---------------------------------------------------------------
side=$(ladder 8 8 2)
for blur in $blurs; do
  bake_deep "$base" "$side" "$(tolerance_of "$side")"
  words="$words Declare=Blur=$blur"
  look "lv9/close/deep/$blur" 1 -
  bake_map $((base * side)) "$side" "$(awk -v b="$blur" -v r=$((base * side)) 'BEGIN { print b * r }')"
  look "lv9/close/map/$blur" 1 -
done

# ---- Reeves, Salesin & Cook: first pass, second pass ------------------------------------------------------------------
rsc() {  # $1: name, $2: file, $3: resolution of its maps, $4: options
  local part
  size=$(ladder 384:288 192:144 32:24) none_cost=1.5 start=0.3
  part=${size}:4:0:0:$size
  picture "rsc/$1/none/-" "$(cost 1 4 0)" picture "$2" "$part" - - "$4 Shadow_Method=none"
  picture "rsc/$1/raytraced/-" "$(cost 1.5 4 0)" picture "$2" "$part" - - "$4 Shadow_Method=raytraced"
  line "bake/$1/map/$3" 1 1 bake "$2" 16:12:1:0:0:16:12 - - "$4 Declare=Pcf=1 Shadow_Method=map Declare=Resolution=$3 Declare=File=1"
  picture "rsc/$1/map/$3" "$(cost 2.5 4 0)" picture "$2" "$part" - "bake/$1/map/$3" "$4 Declare=Pcf=1 Shadow_Method=map Declare=Resolution=$3 Declare=File=2"
  line "bake/$1/deep/$3" 3 1 bake "$2" 16:12:1:0:0:16:12 - - "$4 Declare=Pcf=0 Declare=Resolution=$3 Declare=Samples=4 Declare=File=1"
  picture "rsc/$1/deep/$3" "$(cost 2 4 0)" picture "$2" "$part" - "bake/$1/deep/$3" "$4 Declare=Pcf=0 Declare=Resolution=$3 Declare=Samples=4 Declare=File=2"
}
rsc sphere scenes/sphere_plane.pov "$(ladder 1024 512 64)" ''
rsc colours scenes/sphere_plane.pov "$(ladder 1024 512 64)" Declare=Colored=1
rsc lamps scenes/lamps.pov "$(ladder 1024 512 64)" ''
