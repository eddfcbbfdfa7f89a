#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Makes a fresh Debian 12 machine ready for `make`: packages, POV-Ray's pinned source, our patches, configure.
set -euo pipefail
cd "$(dirname "$0")"

usage() {
  cat <<'END'
usage: ./autogen.sh [--no-install] [--povray-source FILE] [arguments of ./configure]

  --no-install          install no Debian package: print the command that would, and stop
  --povray-source FILE  take POV-Ray's source from here instead of apt: the .dsc, one of the two
                        tarballs beside it, or the folder that holds them

Running it again is cheap: it does only what is missing.
END
}

install=yes
source=
configure=()
while [ $# -gt 0 ]; do
  case $1 in
    --help | -h) usage; exit 0 ;;
    --no-install) install=no ;;
    --povray-source) source=${2:?--povray-source needs a file}; shift ;;
    --povray-source=*) source=${1#*=} ;;
    *) configure+=("$1") ;;
  esac
  shift
done

say() { echo "autogen.sh: $*"; }
fail() { echo "autogen.sh: $*" >&2; exit 1; }

packages=(
  gcc g++ libc6-dev make patch pkgconf xz-utils           # compilers and tools
  autoconf automake autoconf-archive libtool              # the build system, ours and POV-Ray's
  libboost-dev libboost-thread-dev libopenexr-dev         # POV-Ray's libraries
  libjpeg-dev libpng-dev libtiff-dev zlib1g-dev
  libopenimageio-dev openimageio-tools libcmocka-dev      # map files, image comparison, unit tests
  gnuplot-nox                                             # dsmtool plot
)

# As root, or through sudo.
as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    fail "neither root nor sudo here; as root, run: $*"
  fi
}

install_packages() {
  local missing=() name
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get --quiet --yes --no-install-recommends install)
  if ! command -v dpkg-query >/dev/null; then
    say "not a Debian machine; it needs what these packages hold: ${packages[*]}"
    return
  fi
  for name in "${packages[@]}"; do
    [ "$(dpkg-query --show --showformat='${db:Status-Status}' "$name" 2>/dev/null)" = installed ] || missing+=("$name")
  done
  if [ ${#missing[@]} = 0 ]; then return; fi
  if [ $install = no ]; then
    fail "missing packages; install them with: apt-get install --no-install-recommends ${missing[*]}"
  fi
  say "installing ${missing[*]}"
  # A fresh machine has no package lists, or lists that have aged.
  as_root "${apt[@]}" "${missing[@]}" ||
    { as_root apt-get --quiet update && as_root "${apt[@]}" "${missing[@]}"; }
}

sources_ready() { (cd build/download && sha256sum --status --check ../../patches/base.sha256 2>/dev/null); }

get_sources() {
  local file from=$source
  mkdir -p build/download
  if [ -n "$source" ]; then
    [ -e "$source" ] || fail "$source does not exist"
    [ -d "$source" ] || from=$(dirname "$source")
    while read -r _ file; do
      [ -e "$from/$file" ] || fail "no $file in $from"
      [ "$from/$file" -ef "build/download/$file" ] || cp "$from/$file" build/download/
    done <patches/base.sha256
    sources_ready || fail "the files in $from are not the pinned ones (patches/base.sha256)"
  elif ! sources_ready; then
    command -v apt-get >/dev/null || fail "no apt here; give POV-Ray's source with --povray-source"
    say "fetching POV-Ray's source with apt"
    patches/fetch.sh build/download ||
      fail "apt found no source package of POV-Ray 3.7.0.10-2 (Debian 12); give it with --povray-source"
    sources_ready || fail "what apt fetched is not the pinned source (patches/base.sha256)"
  fi
}

install_packages
get_sources
if [ configure.ac -nt configure ] || [ Makefile.am -nt Makefile.in ]; then autoreconf --install; fi
if [ ${#configure[@]} -gt 0 ] || [ configure -nt config.status ]; then ./configure "${configure[@]}"; fi
patches/build.sh patched configure
say "ready: now run make"
