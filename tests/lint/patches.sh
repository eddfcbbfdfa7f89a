#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Every patch is in the series, has its DEP-3 header and at most one line of context, and the series applies to
# the pinned base without fuzz or offset.
set -euo pipefail
cd "$(dirname "$0")/../../patches"
failed=0
bad() { echo "$*"; failed=1; }

mapfile -t series < <(sed -e 's/[[:space:]]*#.*//' -e '/^$/d' series)
# No `| grep -q` here: grep leaves at its first match, and pipefail then takes the writer's broken pipe for a failure.
for file in *.patch; do
  [ -e "$file" ] || continue
  [[ " ${series[*]} " == *" $file "* ]] || bad "$file is not in the series"
done

for name in "${series[@]}"; do
  [ -f "$name" ] || { bad "$name is in the series, but not here"; continue; }
  header=$(sed '/^--- /,$d' "$name")
  for field in Description Author Last-Update; do
    grep -q "^$field: *[^ ]" <<<"$header" || bad "$name: no $field:"
  done
  awk '
    function done() { if (first > 1 || last > 1) { print at ": more than one line of context"; wrong = 1 } first = last = seen = 0 }
    /^@@ /   { done(); at = FILENAME ":" FNR; hunk = 1; next }
    /^--- /  { done(); hunk = 0 }
    !hunk    { next }
    /^[-+]/  { seen = 1; last = 0; next }
    /^ |^$/  { if (seen) last++; else first++ }
    END      { done(); exit wrong }' "$name" || failed=1
done

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
./unpack.sh "$work/povray" --series || failed=1
exit $failed
