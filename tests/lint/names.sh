#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# File names are unique in plugin/, sources open with their licence, have at most 600 lines and stand in Makefile.am,
# and no file knows the folder it was written in.
set -euo pipefail
cd "$(dirname "$0")/../.."
top=$(pwd)
failed=0
bad() { echo "$*"; failed=1; }

twins=$(find plugin -type f \( -name '*.[ch]' -o -name '*.cpp' \) -printf '%f\n' | sort | uniq -d)
[ -z "$twins" ] || bad "more than one file in plugin/ is called: $twins"

while read -r file; do
  case $file in tests/*_test.c) file=${file%.c} ;; esac
  grep -qxE "  $file( \\\\)?" Makefile.am || bad "$file: not in Makefile.am"
done < <(find plugin tests -name '*.c' -o -name '*.tap' -o -name '*.test' -o -name '*.sh' -path '*/lint/*')

mapfile -t ours < <(find plugin patches scenes tests doc .ci ./*.* -maxdepth 5 -type f \( -name '*.[ch]' -o -name '*.cpp' \
  -o -name '*.sh' -o -name '*.test' -o -name '*.tap' -o -name '*.pov' -o -name '*.inc' -o -name '*.patch' -o -name '*.md' -o -name run \
  -o -name 'configure.ac' -o -name 'Makefile.am' \) | grep -v '^\./build' | sort -u)

# Folders that many machines have say nothing about this one.
places=("$top/")
case $(dirname "$top") in
  / | /tmp | /var/tmp | /home | /usr/src | /opt | /srv | /mnt) ;;
  *) places+=("$(dirname "$top")/") ;;
esac

for file in "${ours[@]}"; do
  case $file in
    *.md | *.patch) ;;
    *)
      grep -q 'SPDX-License-Identifier: AGPL-3.0-or-later' <<<"$(head -n 3 "$file")" || bad "$file: no SPDX line at the top"
      lines=$(wc -l <"$file")
      [ "$lines" -le 600 ] || bad "$file: $lines lines, more than 600" ;;
  esac
  for place in "${places[@]}"; do
    if grep -nHF -- "$place" "$file"; then bad "$file: names a folder of this machine"; fi
  done
  if grep -nHE '(^|[^[:alnum:]_./%-])/(home|root|Users)/[[:alnum:]]' "$file"; then bad "$file: names somebody's home"; fi
done
exit $failed
