#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# What the report measures, a line each, in the order of measuring:
#
#   tests/report/plan.sh full|short|smoke
#
# name  seconds  runs  kind  scene  picture  reference  map  options
#
# separated by tabs. Seconds are those of all runs on two quiet cores, as a guess: they only feed "time left". Names are
# SECTION/SCENE/METHOD/SETTING. Kinds: reference (the truth, kept in build/references/), bake (a whole map, to files),
# picture (a timed render, compared with its reference), lookup (a timed render of a larger picture, 9 rays an image pixel, and
# one with one ray, compared), vertices (of a map that was saved uncompressed). Reference and map are names of other
# lines, or -. RUNS=N: so many runs of every line, instead of three of the short ones (full) or one. A reference's options start with OVER, MOVE and the first MS (tests/report/measure.sh: truth).
set -eu
. "$(dirname "$0")/measure.sh"
form=${1:?full, short or smoke}

line() { printf '%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\t%s\n' "$@"; }

# Several runs only of what is short, as a long one is its own mean: seconds of all runs, and how many. $2: what is long
several() { awk -v s="$1" -v long="$2" -v r="$runs" -v all="${RUNS:-0}" 'BEGIN { if (s > long && !all) r = 1; printf "%.1f %d\n", s * r, r }'; }
picture() {  # $1: name, $2: seconds of a run, $3: kind, $4: scene, $5: picture, $6: reference, $7: map, $8: options
  local s n
  read -r s n < <(several "$2" "$([ "$3" = lookup ] && echo 9 || echo 6)")
  line "$1" "$s" "$n" "$3" "$4" "$5" "$6" "$7" "$8"
}

# One scene's speed against error. Words of a ladder's rung: DEPTH,MS for ray tracing, DEPTH,MS,RESOLUTION,SAMPLES for deep,
# DEPTH,MS,ACCURACY for a deep map with that word, DEPTH,MS,RESOLUTION,SAMPLES,SIZE_FACTOR for PCF; MS is 0 where there are no media.
speed() {  # $1: scene's short name, $2: file, $3: W:H, $4: X:Y:w:h, $5: OVER:DEPTH:MOVE:MS of the truth, $6: its seconds, $7: options
  local name=$1 file=$2 size=$3 part=$4 over depth move ms options=$7 d m r s f o seen=' '
  local look
  IFS=: read -r over depth move ms <<<"$5"
  line "reference/$name" "$6" 1 reference "$file" "$size:$depth:$part" - - "$over $move $ms $options"
  own() { o=$options; [ "$m" = 0 ] || o="$o Declare=MS=$m"; look=$size:$d:$part; }
  for rung in $traced $deep $accuracy $map; do
    IFS=, read -r d m _ <<<"$rung"
    case $seen in *" $d,$m "*) continue ;; esac
    seen="$seen$d,$m "
    own
    picture "speed/$name/none/$d,$m" "$(cost "$none_cost" "$d" "$m")" picture "$file" "$look" - - "$o Shadow_Method=none"
  done
  for rung in $traced; do
    IFS=, read -r d m <<<"$rung"
    own
    picture "speed/$name/raytraced/$rung" "$(cost "$traced_cost" "$d" "$((m * m / 20))")" picture "$file" "$look" "reference/$name" - "$o Shadow_Method=raytraced"
  done
  for rung in $deep; do
    IFS=, read -r d m r s <<<"$rung"
    own
    o="$o Declare=Pcf=0 Declare=Resolution=$r Declare=Samples=$s"
    local bake
    bake=$(awk -v c="$bake_cost" -v r="$r" -v s="$s" 'BEGIN { printf "%.2f", c * r * r * s / 1e6 }')
    picture "speed/$name/deep/$rung" "$(awk -v a="$bake" -v b="$(cost "$none_cost" "$d" "$m")" 'BEGIN { print a + 1.5 * b }')" \
      picture "$file" "$look" "reference/$name" - "$o"
    line "bake/$name/deep/$r,$s" "$(awk -v a="$bake" -v s="$start" 'BEGIN { print a + s }')" 1 bake "$file" 16:12:1:0:0:16:12 - - "$o Declare=File=1"
    picture "speed/$name/baked/$rung" "$(cost "$none_cost" "$d" "$m" | awk '{ print 1.5 * $1 }')" \
      picture "$file" "$look" "reference/$name" "bake/$name/deep/$r,$s" "$o Declare=File=2"
  done
  for rung in $accuracy; do
    IFS=, read -r d m r <<<"$rung"
    own
    # some 10,000 light rays for 1 / ACCURACY
    picture "speed/$name/accuracy/$rung" "$(awk -v c="$bake_cost" -v a="$r" -v b="$(cost "$none_cost" "$d" "$m")" 'BEGIN { print c * 0.01 / a + 2 * b }')" \
      picture "$file" "$look" "reference/$name" - "$o Declare=Accuracy=$r"
  done
  for rung in $map; do
    IFS=, read -r d m r s f <<<"$rung"
    own
    o="$o Declare=Pcf=1 Shadow_Method=map Declare=Resolution=$r Declare=NumSamples=$s Declare=ResFactor=$f"
    picture "speed/$name/map/$rung" "$(awk -v c="$bake_cost" -v r="$r" -v b="$(cost "$none_cost" "$d" "$m")" 'BEGIN { print c * r * r / 1e6 + 2 * b }')" \
      picture "$file" "$look" "reference/$name" - "$o"
  done
}

# Seconds of a picture: $1 a ray, in millionths, at MS 20; $2: depth, $3: MS or 0. Scene reading is in $start.
cost() {
  awk -v c="$1" -v d="$2" -v m="$3" -v n="$(awk -F: '{ print $1 * $2 }' <<<"$size")" -v s="$start" \
    'BEGIN { printf "%.2f", s + c * 1e-6 * n * (d * d + (d > 1)) * (m > 0 ? m / 20 : 1) }'
}

case $form in
  full)
    runs=${RUNS:-3} over=4 sides='2 4 8 16 32 64' exact='2 4 8 16' blurs='0.004 0.015 0.06'
    figure6='b,map,512,4 c,map,4096,20 d,deep,512,16' hair= ;;
  short)
    runs=${RUNS:-1} over=2 sides='2 4 8' exact='4' blurs='0.004 0.06'
    figure6='b,map,512,4 c,map,2048,10 d,deep,256,8' hair='Declare=Hairs=5000' ;;
  smoke)
    runs=${RUNS:-1} over=2 sides='2 4' exact='2' blurs='0.06'
    figure6='b,map,64,4 c,map,128,8 d,deep,64,4' hair='Declare=Hairs=400' ;;
  *) echo "plan.sh: no form $form; there are full, short and smoke" >&2; exit 2 ;;
esac

# A map that several figures use stands here once.
{ . "$(dirname "$0")/plan_speed.sh"; . "$(dirname "$0")/plan_papers.sh"; } | awk -F '\t' '!seen[$1]++'
