#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Includes point downwards only, in the order of the rooms below. The bridge sees the library through dsm.h alone,
# and core is pure: no input or output, no threads (of stdio.h, it may format into memory).
set -euo pipefail
cd "$(dirname "$0")/../../plugin"
rooms=(core map store bake tool povray)   # from the bottom up
impure='pthread|threads|semaphore|signal|unistd|fcntl|dirent|dlfcn|time|sys/.*'
stdio='\b((FILE|std(in|out|err))\b|(v?f?printf|f?put(s|c)|putchar|perror|f(open|close|read|write|flush|seek|gets)|f?scanf|rename) *\()'
failed=0

level() {  # of a file: 0 for dsm.h, then the rooms, and entry.c above all
  local i
  case $1 in
    dsm.h) echo 0; return ;;
    entry.c) echo 99; return ;;
  esac
  for i in "${!rooms[@]}"; do
    if [ "${1%%/*}" = "${rooms[i]}" ]; then echo $((i + 1)); return; fi
  done
  echo "no such room: plugin/$1" >&2
  return 1
}
bad() { echo "plugin/$1 includes $2: $3"; failed=1; }

for file in $(find . -name '*.[ch]' -o -name '*.cpp' | sed 's,^\./,,' | sort); do
  own=$(level "$file")
  while read -r name; do
    target=$(find . -path "*/${name#./}" | sed 's,^\./,,')
    if [ -z "$target" ]; then
      [[ $file == povray/* ]] || bad "$file" "\"$name\"" "no such file in plugin/"
    elif [[ $file == povray/* && $target != povray/* && $target != dsm.h ]]; then
      bad "$file" "\"$name\"" "the bridge may include dsm.h and its own files"
    elif [ "$(level "$target")" -gt "$own" ]; then
      bad "$file" "\"$name\"" "that points up"
    fi
  done < <(sed -n -E 's/^[[:space:]]*#[[:space:]]*include[[:space:]]*"([^"]+)".*/\1/p' "$file")
  [[ $file == core/* ]] || continue
  if sed 's,//.*,,; s,/\*.*,,' "$file" | grep -nE "$stdio"; then bad "$file" "<stdio.h>" "core does no input or output"; fi
  while read -r name; do
    bad "$file" "<$name>" "core does no input, output or threads"
  done < <(sed -n -E "s,^[[:space:]]*#[[:space:]]*include[[:space:]]*<(($impure)\.h)>.*,\1,p" "$file")
done
exit $failed
