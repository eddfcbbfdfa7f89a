#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# POV-Ray's own distribution scenes, unedited.
#
#   tests/bench/distribution.sh identical [FOLDER...]   stock POV-Ray (make stock) and ours must give the same pixels
#   tests/bench/distribution.sh deep [FOLDER...]        Shadow_Method=deep against raytraced: error and seconds, a line a scene
#   tests/bench/distribution.sh cost [FOLDER...]        the same, each light with its map or ray-traced as the program itself
#                                                       chooses: user and system seconds of the whole program, medians of RUNS
#                                                       (default 3) taken in turns, their ratio, and what was chosen;
#                                                       MOST=5 SIZE="+W160 +H120" takes ten minutes
#
# Folders, or single scenes, are those below scenes/ of the distribution; none: all. A scene that gives no picture in LIMIT seconds (default 60)
# in either program fails, but for those that stock itself cannot render alone. Pictures stay in build/distribution/.
# MOST=6 takes six scenes of each folder, evenly spread. SIZE="+W120 +H90" and OPTIONS="+A0.1 -J" go to every render.
set -u
top=$(cd "$(dirname "$0")/../.." && pwd)
what=${1:?identical, deep or cost}
shift
: "${LIMIT:=60}" "${MOST:=1000}" "${SIZE:=+W120 +H90}" "${OPTIONS:=}" "${RUNS:=3}"
unset DEEP_SHADOW_CHOICE
if [ "$what" = deep ]; then export DEEP_SHADOW_CHOICE=map; fi
: "${SHADOW_ERROR:=$top/tests/image/shadow_error}"
: "${POVRAY:=$top/build/bin/povray}" "${STOCK:=$top/build/stock/bin/povray}"
: "${SCENES:=$(dirname "$(dirname "$POVRAY")")/share/povray-3.7/scenes}"
export LIMIT SIZE OPTIONS RUNS SHADOW_ERROR POVRAY STOCK SCENES what
export out=$top/build/distribution/$what
mkdir -p "$out"

render() {  # $1: program, $2: picture, $3: scene, then options
  local program=$1 picture=$2 scene=$3
  shift 3
  rm -f "$picture"
  # shellcheck disable=SC2086
  (cd "$(dirname "$scene")" && timeout "$LIMIT" "$program" -D -V +I"$(basename "$scene")" +O"$picture" $SIZE +WT1 \
    +L"$SCENES/../include" +SF1 +EF1 $OPTIONS "$@" >"${picture%.*}.log" 2>&1 </dev/null) && [ -s "$picture" ]
}

seconds() { sed -n 's/.*Trace Time: .*(\([0-9.]*\) seconds).*/\1/p' "$1" | tail -n 1; }

# User and system seconds of the whole program. $1: picture, $2: scene, then options
cpu_seconds() {
  local TIMEFORMAT='%U %S' picture=$1
  { time render "$POVRAY" "$@" 2>/dev/null || return 1; } 2>"${picture%.*}.time" || return 1
  awk '{ print $1 + $2 }' "${picture%.*}.time"
}

median() { sort -g | awk '{ s[NR] = $1 } END { print NR ? (s[int((NR + 1) / 2)] + s[int(NR / 2) + 1]) / 2 : "nan" }'; }

# "map 0.3, rays 25": each light's choice, and the map's cost in that of the rays
choices() { sed -nE "s/.*light source.*: (map|rays)(, a map costs [a-z ]*([^ ]*) times the rays)?$/\\1 \\3/p" "$1" | paste -sd, | sed 's/,/, /g'; }

cost() {  # $1: name, $2: scene, $3, $4: pictures
  local run
  : >"$3.runs" >"$4.runs"
  for ((run = 0; run < RUNS; run++)); do
    cpu_seconds "$3.exr" "$2" +FE Shadow_Method=raytraced >>"$3.runs" || { echo "none $1"; return; }
    cpu_seconds "$4.exr" "$2" +FE Shadow_Method=deep >>"$4.runs" || { echo "MISSING $1"; return; }
  done
  awk -v a="$(median <"$3.runs")" -v b="$(median <"$4.runs")" -v name="$1" -v chosen="$(choices "$4.log")" \
    'BEGIN { printf "cost %.3f %s: ray-traced %.2f s, deep %.2f s; %s\n", b / a, name, a, b, chosen == "" ? "no choice" : chosen }'
}

one() {
  local scene=$1 name a b
  name=${scene#"$SCENES"/}
  name=${name%.pov}
  a=$out/${name//\//-}-1 b=$out/${name//\//-}-2
  case $what in
    identical)
      if ! render "$STOCK" "$a.ppm" "$scene" +FP16; then echo "none       $name"; return; fi
      if ! render "$POVRAY" "$b.ppm" "$scene" +FP16; then echo "MISSING    $name"; return; fi
      # pixels, not files: those carry a date
      if idiff -q -fail 0 -failpercent 0 -hardfail 0 -warn 0 "$a.ppm" "$b.ppm" >/dev/null 2>&1
      then echo "identical  $name"; else echo "DIFFERENT  $name"; fi ;;
    deep)
      if ! render "$POVRAY" "$a.exr" "$scene" +FE Shadow_Method=raytraced; then echo "none $name"; return; fi
      if ! render "$POVRAY" "$b.exr" "$scene" +FE Shadow_Method=deep; then echo "MISSING $name"; return; fi
      echo "rmse $("$SHADOW_ERROR" "$a.exr" "$b.exr" 2>&1 | cut -d' ' -f1,2) $name $(seconds "$a.log") $(seconds "$b.log")" ;;
    cost) cost "$name" "$scene" "$a" "$b" ;;
  esac
}
export -f choices cost cpu_seconds median one render seconds

[ $# -gt 0 ] || set -- $(cd "$SCENES" && ls -d */)
for folder; do
  find "$SCENES/${folder%/}" -name '*.pov' | sort |
    awk -v most="$MOST" '{ s[NR] = $0 } END { n = NR < most ? NR : most; for (i = 0; i < n; i++) printf "%s%c", s[1 + int(i * NR / n)], 0 }'
done |
  xargs -0 -n 1 -P "$(nproc)" bash -c 'one "$1"' _ | tee "$out.txt"
echo
case $what in
  identical) cut -d' ' -f1 "$out.txt" | sort | uniq -c ;;
  deep) echo "scenes: $(grep -c '^rmse' "$out.txt"), above 0.02: $(awk '/^rmse/ && $2 > 0.02' "$out.txt" | wc -l), no picture: $(grep -c '^MISSING' "$out.txt")" ;;
  cost) awk '/^cost/ { n++; if ($2 > worst) worst = $2; above += $2 > 1.1; sum += log($2) }
    END { printf "scenes: %d, above 1.1: %d, worst: %.3f, geometric mean: %.3f\n", n, above, worst, n ? exp(sum / n) : 0 }' "$out.txt" ;;
esac
! grep -qE '^(MISSING|DIFFERENT)' "$out.txt"
