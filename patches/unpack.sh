#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# patches/unpack.sh DIR [--series]: unpacks the pinned POV-Ray source with Debian's patches into the new folder
# DIR, and with --series applies ours on top. Sources come from build/download, where autogen.sh puts them.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
download=${POVRAY_DOWNLOAD:-$here/../build/download}
dir=$1
mode=${2:-}

(cd "$download" && sha256sum --quiet --check "$here/base.sha256") ||
  { echo "unpack.sh: POV-Ray's source is missing or not the pinned one; run ./autogen.sh" >&2; exit 1; }

# No fuzz and no offset: the base is pinned, so a hunk that has to be searched for is a hunk out of date.
apply() {
  local out
  grep -q '^--- ' "$1" || return 0   # a new patch, still only a header
  out=$(patch --directory="$dir" --strip=1 --fuzz=0 --forward --force --unified --no-backup-if-mismatch <"$1") &&
    ! grep -q -e offset -e fuzz <<<"$out" && return
  echo "unpack.sh: $(basename "$1") does not apply cleanly:" >&2
  echo "$out" >&2
  return 1
}

series() { sed -e 's/[[:space:]]*#.*//' -e '/^$/d' "$1"; }

mkdir "$dir"
tar -xzf "$download"/povray_*.orig.tar.gz -C "$dir" --strip-components=1
tar -xJf "$download"/povray_*.debian.tar.xz -C "$dir"
# Debian's own patches were made for other upstream versions too: they may move, as they do for dpkg-source.
# One is left out: it tells povray.conf where Debian's packages put the scenes, and we keep them at upstream's place.
series "$dir/debian/patches/series" | grep -vx 10_includes-location | while read -r name; do
  patch --directory="$dir" --strip=1 --fuzz=0 --forward --force --silent --unified \
    --no-backup-if-mismatch <"$dir/debian/patches/$name"
done
# The bundled libraries stay unused, as in Debian: POV-Ray's configure would prefer them to the system's.
rm -rf "$dir/libraries" "$dir/windows" "$dir/distribution/platform-specific"
if [ "$mode" = --series ]; then
  series "$here/series" | while read -r name; do apply "$here/$name"; done
fi
