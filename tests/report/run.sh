#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Measures what the plan asks for and what is not measured yet; says how far it is. Interrupted, it goes on from there
# when called again.
#
#   tests/report/run.sh full|short|smoke [SECTION...]     only lines whose names start with one of these, and what they need
#
# A row of measured.csv belongs to a key: a hash of the line of the plan, the scene, the programs, and the keys of its
# reference and its map. Folder: REPORT (build/report).
. "$(dirname "$0")/measure.sh"
form=${1:?full, short or smoke}
shift
: "${REPORT:=$top/build/report}"
store=$REPORT/measured.csv work=$REPORT/work.$$
mkdir -p "$work" "$REPORT/maps" "$REPORT/pictures" "$REFERENCES"
columns=key,name,status,runs,seconds,cpu,wall,parse,rmse,max,share,rays,pixels,lookups,bytes,file_bytes,vertices,uncompressed,finest_bytes,moved,ms,spent,threads,commit,idle,all_seconds
[ -s "$store" ] || echo $columns >"$store"
# A row that was cut off is no row. (Others may be writing if we are one of several.)
if [ -z "${PARTS:-}" ]; then
  awk -F, -v n="$(awk -F, '{ print NF }' <<<$columns)" 'NF == n' "$store" >"$store.new" && mv "$store.new" "$store"
fi
trap 'rm -rf "$work"' EXIT
trap 'echo; echo "Stopped; the same command goes on from here." >&2; exit 130' INT TERM

programs=$(cat "$POVRAY" "$(dirname "$POVRAY")"/../lib/povray-3.7/*.so | sha256sum)
commit=$(git -C "$top" describe --always --dirty 2>/dev/null || echo unknown)
hash_of() { sha256sum <<<"$*" | cut -c1-16; }

# ---- The plan: names in order, and a key for each; what a line needs stands before it -----------------------------------
declare -A expect runs_of kind scene picture reference map options key got
names=()
while IFS=$'\t' read -r name seconds runs k file p r m o; do
  names+=("$name")
  expect[$name]=$seconds runs_of[$name]=$runs kind[$name]=$k scene[$name]=$file picture[$name]=$p reference[$name]=$r map[$name]=$m options[$name]=$o
  made=$programs
  [ "$k" != reference ] || made=   # the ray tracer is POV-Ray's own; its pictures outlive our programs
  key[$name]=$(hash_of "$name $runs $k $p $o $THREADS $(cat "$top/$file" 2>/dev/null) $made ${key[$r]:-} ${key[$m]:-}")
done < <(bash "$top/tests/report/plan.sh" "$form")
[ ${#names[@]} -gt 0 ] || exit 1
while IFS=, read -r k _; do got[$k]=1; done <"$store"

todo=()
declare -A wanted
for ((i = ${#names[@]} - 1; i >= 0; i--)); do
  name=${names[i]}
  [ -n "${*:-}" ] || wanted[$name]=1
  for section; do case $name in "$section"*) wanted[$name]=1 ;; esac; done
  [ -n "${wanted[$name]:-}" ] || continue
  for need in "${reference[$name]}" "${map[$name]}"; do [ "$need" = - ] || wanted[$need]=1; done
done
for name in "${names[@]}"; do
  [ -z "${wanted[$name]:-}" ] || [ -n "${got[${key[$name]}]:-}" ] || todo+=("$name")
done


# In the smoke form times count for nothing: parts that share no map run at once.
if [ "$form" = smoke ] && [ $# = 0 ] && [ ${#todo[@]} -gt 20 ]; then
  for sections in speed/hair speed/floor 'speed/cloud speed/glass' 'speed/pipes speed/sphere' lv rsc; do
    # shellcheck disable=SC2086
    PARTS=1 bash "$0" smoke $sections &
  done
  wait
  exec bash "$0" smoke ''
fi

# ---- The kinds; each sets what it knows of the row -----------------------------------------------------------------------
declare -A row
reference_file() { echo "$REFERENCES/$(basename "$1")-${key[$1]}.exr"; }
map_folder() { echo "$REPORT/maps/${key[$1]}"; }
stay() { [ "${map[$1]}" = - ] && echo "$work" || map_folder "${map[$1]}"; }

compare() {  # $1: name, $2: picture; which is kept
  local truth x y
  cp "$2" "$REPORT/pictures/${key[$1]}.exr"
  [ "${reference[$1]}" != - ] || return 0
  truth=$(reference_file "${reference[$1]}")
  [ -s "$truth" ] || return 1
  IFS=: read -r _ _ _ x y _ <<<"${picture[$1]}"
  read -r row[rmse] row[max] row[share] < <("$SHADOW_ERROR" "$truth" "$2" "$x" "$y")
}

log_to_row() {  # $1: log
  read -r row[parse] row[parse_cpu] row[pixels] row[rays] row[lookups] row[bytes] row[vertices] row[uncompressed] row[trace] < <(from_log "$1")
}

timed() {  # $1: name, then options: renders it as often as the plan says
  local name=$1 i seconds=() cpu=() wall=() s c
  shift
  for ((i = 0; i < runs_of[$name]; i++)); do
    # shellcheck disable=SC2086
    render "$(stay "$name")" "$work/timed" "${scene[$name]}" "$@" ${options[$name]} || return 1
    log_to_row "$work/timed.log"
    read -r s c < <(from_time "$work/timed" "${row[parse]}" "${row[parse_cpu]}")
    # of a look-up the tracing alone: reading the map is no part of it
    [ "${kind[$name]}" != lookup ] || s=${row[trace]}
    seconds+=("$s") cpu+=("$c")
    wall+=("$(awk 'NF == 3 { print $1 }' "$work/timed.time")")
  done
  row[seconds]=$(printf '%s\n' "${seconds[@]}" | median)
  row[cpu]=$(printf '%s\n' "${cpu[@]}" | median)
  row[wall]=$(printf '%s\n' "${wall[@]}" | median)
  row[all_seconds]=${seconds[*]}
}

measure_reference() {
  local file
  file=$(reference_file "$1")
  if [ ! -s "$file" ]; then
    local over move ms rest
    read -r over move ms rest <<<"${options[$1]}"
    # shellcheck disable=SC2086
    read -r row[moved] row[ms] < <(truth "$file" "${scene[$1]}" "${picture[$1]}" "$over" "$move" "$ms" $rest)
    printf '%s %s\n' "${row[moved]}" "${row[ms]}" >"$file.moved"
  fi
  [ -s "$file" ] && read -r row[moved] row[ms] <"$file.moved"
}

measure_bake() {
  local folder W H
  folder=$(map_folder "$1")
  mkdir -p "$folder"
  IFS=: read -r W H _ <<<"${picture[$1]}"
  # shellcheck disable=SC2086
  render "$folder" "$work/timed" "${scene[$1]}" +W"$W" +H"$H" -A ${options[$1]} || return 1
  log_to_row "$work/timed.log"
  read -r row[seconds] row[cpu] < <(from_time "$work/timed" "${row[parse]}" "${row[parse_cpu]}")
  row[file_bytes]=$(cat "$folder"/*.exr | wc -c)
  [ "${row[file_bytes]}" -gt 0 ] || return 1
  row[finest_bytes]=$(for file in "$folder"/*.exr; do "$DSMTOOL" info "$file" 2>/dev/null; done |
    awk '$1 == "level" { on = 1; next } on && $1 == "0" { bytes += $7; on = 0 } END { print bytes + 0 }')
}

measure_picture() {
  local W H depth
  IFS=: read -r W H depth _ <<<"${picture[$1]}"
  # shellcheck disable=SC2046
  timed "$1" +W"$W" +H"$H" $(antialiasing "$depth") || return 1
  compare "$1" "$work/timed.exr"
}

measure_lookup() {
  local W H times
  IFS=: read -r W H times _ <<<"${picture[$1]}"
  # shellcheck disable=SC2046
  timed "$1" +W$((W * times)) +H$((H * times)) $(antialiasing 3) || return 1
  [ "${reference[$1]}" != - ] || return 0
  # shellcheck disable=SC2086
  render "$(stay "$1")" "$work/look" "${scene[$1]}" +W"$W" +H"$H" -A ${options[$1]} || return 1
  compare "$1" "$work/look.exr"
}

measure_vertices() {
  local file
  file=$(ls "$(map_folder "${map[$1]}")"/*.exr 2>/dev/null | head -n 1)
  [ -n "$file" ] || return 1
  # as sampled, greedy, fewest, their ratio
  row[all_seconds]=$("$VERTICES" "$file" "${options[$1]}") || return 1
}

# A Declare that the scene does not know would be measured for nothing: prints the first.
unknown_declare() {
  local word
  for word in ${options[$1]}; do
    case $word in Declare=*) word=${word#Declare=} word=${word%%=*} ;; *) continue ;; esac
    grep -qw -- "$word" "$top/${scene[$1]}" || { echo "Declare=$word"; return 0; }
  done
  return 1
}

# ---- Progress ------------------------------------------------------------------------------------------------------------
left=$(for name in "${todo[@]}"; do echo "${expect[$name]}"; done | awk '{ s += $1 } END { print s + 0 }')
done_expected=0 done_spent=0
progress() {  # $1: number, $2: name
  local text
  # The guess of the plan counts like a minute already measured, so that the first rows do not swing it.
  text=$(awk -v l="$left" -v e="$done_expected" -v s="$done_spent" \
    'BEGIN { t = l * (s + 60) / (e + 60); if (t < 90) printf "%d s", t + 0.5; else printf "%d min", t / 60 + 0.5 }')
  printf '%d of %d, about %s left: %s\n' "$1" ${#todo[@]} "$text" "$2"
}

IDLE=0
[ ${#todo[@]} = 0 ] || IDLE=$(idle_seconds "$work" "$([ "$form" = smoke ] && echo 1 || echo 5)")
number=0
for name in "${todo[@]}"; do
  number=$((number + 1))
  progress $number "$name"
  row=()
  began=$(date +%s.%N)
  status=ok
  if [ ! -f "$top/${scene[$name]}" ]; then status='no such scene'
  elif unknown=$(unknown_declare "$name"); then status="the scene has no $unknown"
  elif ! "measure_${kind[$name]}" "$name"; then
    status=$(tr '\r' '\n' <"$work/timed.log" 2>/dev/null | grep -hm 1 -E 'Error|error|Cannot|Failed' | sed 's/^.*Error: //' | tr ',\t' '; ' | cut -c1-80)
    status="failed: ${status:-no picture}"
  fi
  spent=$(awk -v a="$began" -v b="$(date +%s.%N)" 'BEGIN { printf "%.2f", b - a }')
  line=${key[$name]},${name//,/;},$status,${runs_of[$name]}
  for column in seconds cpu wall parse rmse max share rays pixels lookups bytes file_bytes vertices uncompressed finest_bytes moved ms; do
    line=$line,${row[$column]:-}
  done
  printf '%s\n' "$line,$spent,$THREADS,$commit,$IDLE,${row[all_seconds]:-}" >>"$store"
  done_expected=$(awk -v a="$done_expected" -v b="${expect[$name]}" 'BEGIN { print a + b }')
  done_spent=$(awk -v a="$done_spent" -v b="$spent" 'BEGIN { print a + b }')
  left=$(awk -v a="$left" -v b="${expect[$name]}" 'BEGIN { print a - b }')
done

[ -z "${PARTS:-}" ] || exit 0

# What belongs to this form, in the plan's order, with the plan's columns: what the page is made of.
{
  echo "form,scene,kind,picture,reference,map,options,$columns"
  for name in "${names[@]}"; do
    printf '%s,%s,%s,%s,%s,%s,%s,%s\n' "$form" "${scene[$name]}" "${kind[$name]}" "${picture[$name]}" "${reference[$name]//,/;}" \
      "${map[$name]//,/;}" "${options[$name]}" "$(grep "^${key[$name]}," "$store" | tail -n 1)"
  done | awk -F, -v n="$(awk -F, '{ print NF + 7 }' <<<"$columns")" 'NF == n'
} >"$REPORT/report.csv.new" && mv "$REPORT/report.csv.new" "$REPORT/report.csv"
