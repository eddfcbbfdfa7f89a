#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# patches/refresh.sh [PATCH]: carries edits made in build/povray into the patches.
#
# An edited file goes to PATCH, or else to the last patch in the series that touches the file. All patches are
# written anew with one line of context; their headers stay. Nothing is written if the result would not be
# exactly the edited tree. New files are no matter of patches: they belong in plugin/povray/.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
tree=$here/../build/povray
into=${1:-}
into=${into##*/}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$here/unpack.sh" "$work/now"
"$here/unpack.sh" "$work/old" --series
mkdir "$work/new"

mapfile -t series < <(sed -e 's/[[:space:]]*#.*//' -e '/^$/d' "$here/series")
touched() { sed -n -E 's,^(---|\+\+\+) [ab]/([^[:space:]]+).*,\2,p' "$@" | sort -u; }
# No `| grep -q` below: grep leaves at its first match, and pipefail then takes the writer's broken pipe for a failure.
in_series() { [[ " ${series[*]} " == *" $1 "* ]]; }
[ -z "$into" ] || in_series "$into" || { echo "refresh.sh: no $into in patches/series" >&2; exit 1; }

declare -A owner
edited=$(cd "$work/old" && find source vfe unix -type f ! -path 'unix/config/*' | while read -r file; do
  cmp -s "$file" "$tree/$file" || echo "$file"; done)
for file in $edited; do
  owner[$file]=$into
  for name in "${series[@]}"; do
    if [ -z "$into" ] && grep -qxF "$file" <<<"$(touched "$here/$name")"; then owner[$file]=$name; fi
  done
  if [ -z "${owner[$file]}" ]; then
    echo "refresh.sh: no patch touches $file; name the one it shall go to" >&2
    exit 1
  fi
done
files=$( (echo "$edited"; cd "$here" && for name in "${series[@]}"; do touched "$name"; done) | sort -u)

change() { patch --quiet --no-backup-if-mismatch --force --directory="$work/now" --strip=1; }

for name in "${series[@]}"; do
  rm -rf "$work/before"
  cp -r "$work/now" "$work/before"
  if grep -q '^--- ' "$here/$name"; then change <"$here/$name"; fi
  for file in $edited; do
    [ "${owner[$file]}" = "$name" ] || continue
    { diff -u --label "a/$file" --label "b/$file" "$work/old/$file" "$tree/$file" || true; } | change
  done
  sed '/^--- /,$d' "$here/$name" >"$work/new/$name"
  for file in $files; do
    diff -U1 --label "a/$file" --label "b/$file" "$work/before/$file" "$work/now/$file" >>"$work/new/$name" || true
  done
done
for file in $files; do
  cmp "$work/now/$file" "$tree/$file" || { echo "refresh.sh: the edits do not fit; nothing written" >&2; exit 1; }
done
for name in "${series[@]}"; do
  cmp -s "$work/new/$name" "$here/$name" && continue
  sed -i "s/^Last-Update:.*/Last-Update: $(date +%F)/" "$work/new/$name"
  cp "$work/new/$name" "$here/$name"
  echo "refreshed $name"
done
