#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# patches/build.sh patched|stock configure|all|install [VARIABLE=VALUE...]: builds POV-Ray from the pinned source.
#
# `patched` has our patches and the bridge, in build/; `stock` has neither, in build/stock/. Everything else is one
# set of rules for both, so that their images can be compared bit by bit. Each step does only what is left to do.
set -euo pipefail
export LC_ALL=C
here=$(cd "$(dirname "$0")" && pwd)
top=$(dirname "$here")
which=$1
step=$2
shift 2

case $which in
  patched) prefix=$top/build ;;
  stock) prefix=$top/build/stock ;;
  *) echo "build.sh: patched or stock?" >&2; exit 2 ;;
esac
tree=$prefix/povray
make=${MAKE:-make}

bridge_files() {
  [ "$which" = patched ] || return 0
  (cd "$top/plugin" && find dsm.h povray -name '*.h' -o -name '*.cpp') | sort
}

# What the tree is made from. The bridge counts by its names only: its contents are linked, not copied.
tree_sum() {
  {
    cat "$here/base.sha256" "$here/unpack.sh" "$here/build.sh"
    bridge_files
    if [ "$which" = patched ]; then cat "$here/series" "$here"/*.patch 2>/dev/null || true; fi
  } | sha256sum
}

make_new_tree() {  # $1: a folder that does not exist yet
  local series='' file
  if [ "$which" = patched ]; then series=--series; fi
  "$here/unpack.sh" "$1" $series

  # As Debian does: newer autoconf-archive macros than the bundled ones, which do not know today's library folders.
  for file in "$1"/unix/config/*.m4; do
    if [ -f "/usr/share/aclocal/${file##*/}" ]; then ln -sf "/usr/share/aclocal/${file##*/}" "$file"; fi
  done
  # POV-Ray's prebuild.sh lists its sources with `find`, so linked files need no Makefile patch.
  for file in $(bridge_files); do
    mkdir -p "$1/source/backend/shadow"
    ln -s "../../../../../plugin/$file" "$1/source/backend/shadow/"
  done
  (cd "$1/unix" && ./prebuild.sh) >"$prefix/prebuild.log" 2>&1 ||
    { tail "$prefix/prebuild.log" >&2; return 1; }
  rm -rf "$1/autom4te.cache"
  (cd "$1" && find . -type f -print0 | sort -z | xargs -0 sha256sum) >"$1.manifest"
  mv "$1.manifest" "$1/.manifest"
}

file_sum() { sha256sum <"$1" 2>/dev/null | cut -c1-64; }
sum_in() { sed -n "s|^\([0-9a-f]\{64\}\)  $2\$|\1|p" "$1"; }
paths() { cut -c67- | sort; }

# Carries what differs into the old tree, and only that, so that make sees what really changed.
merge_tree() {  # $1: the new tree
  local file now changed gone edited='' sum
  changed=$(comm -23 <(sort "$1/.manifest") <(sort "$tree/.manifest") | paths)
  gone=$(comm -13 <(paths <"$1/.manifest") <(paths <"$tree/.manifest"))
  for file in $changed $gone; do
    case $file in
      *.cpp | *.h)
        sum=$(file_sum "$tree/$file")
        [ -z "$sum" ] || [ "$sum" = "$(sum_in "$tree/.manifest" "$file")" ] ||
          [ "$sum" = "$(sum_in "$1/.manifest" "$file")" ] || edited+=" $file" ;;
    esac
  done
  if [ -n "$edited" ]; then
    echo "build.sh: edited in $tree, and the patches would change it too:$edited" >&2
    echo "Keep the edits with patches/refresh.sh, or drop them by removing $tree." >&2
    return 1
  fi
  now=$(date +@%s)  # one time for all: what was generated must not look older than its source
  for file in $changed; do
    cmp -s "$1/$file" "$tree/$file" && continue
    mkdir -p "$(dirname "$tree/$file")"
    cp "$1/$file" "$tree/$file"
    touch -d "$now" "$tree/$file"
  done
  for file in $gone; do rm -f "${tree:?}/$file"; done
  rm -rf "$tree/source/backend/shadow"
  (cd "$1" && find . -type l -print0 | xargs -0 --no-run-if-empty cp -P --parents --force --target-directory="$tree")
  cp "$1/.manifest" "$tree/.manifest"
}

refresh_tree() {
  local sum new
  sum=$(tree_sum)
  [ "$sum" != "$(cat "$tree/.sum" 2>/dev/null)" ] || return 0
  mkdir -p "$prefix"
  new=$(mktemp -d "$prefix/new.XXXXXX")
  # shellcheck disable=SC2064
  trap "rm -rf '$new'" EXIT
  echo "Preparing POV-Ray's source ($which)"
  make_new_tree "$new/povray"
  if [ -e "$tree/.manifest" ]; then
    merge_tree "$new/povray"
  else
    rm -rf "$tree"
    mv "$new/povray" "$tree"
  fi
  echo "$sum" >"$tree/.sum"
}

# The objects that hold the installation's paths; make does not notice when those change.
forget_paths() { rm -f "$tree"/vfe/unix/unixoptions.o "$tree"/vfe/unix/unixconsole.o "$tree"/povray.ini; }

configure_tree() {
  # What today's libraries say about yesterday's source would hide what is worth reading.
  local quiet='-DBOOST_BIND_GLOBAL_PLACEHOLDERS -DBOOST_ALLOW_DEPRECATED_HEADERS -Wno-deprecated-declarations'
  local arguments=(
    "COMPILED_BY=Deep shadows for POV-Ray" --prefix="$prefix"
    --without-x --without-libsdl --with-boost-thread=boost_thread
    # No -march=native and no contraction: images must not depend on the machine that compiled. What code is aligned to does not depend on
    # what stands before it: the interpreter of functions is a tenth to a quarter slower where it lies badly (measured: AMD EPYC, Intel Xeon).
    --disable-optimiz --disable-strip "CXXFLAGS=-O3 -falign-functions=64 -falign-loops=32 -falign-jumps=32 -ffp-contract=off $quiet"
  )
  [ "${arguments[*]}" != "$(cat "$tree/.arguments" 2>/dev/null)" ] || return 0
  echo "Configuring POV-Ray ($which)"
  (cd "$tree" && ./configure "${arguments[@]}") >"$prefix/configure.log" 2>&1 ||
    { tail -n 20 "$prefix/configure.log" >&2; echo "build.sh: see $prefix/configure.log" >&2; return 1; }
  forget_paths
  echo "${arguments[*]}" >"$tree/.arguments"
}

# Said to every make in place: `make install prefix=... DESTDIR=...` above us must not reach it.
in_place=(
  DESTDIR= prefix="$prefix" exec_prefix="$prefix" bindir="$prefix/bin" sysconfdir="$prefix/etc"
  datarootdir="$prefix/share" datadir="$prefix/share" mandir="$prefix/share/man"
)

compile() {  # with the variables of an installation, or those for running in place
  local jobs=()
  case ${MAKEFLAGS-} in
    *-j*) ;;  # the caller's make shares its jobs
    *) jobs=("-j$(nproc)") ;;
  esac
  V=${V-0} "$make" -s --no-print-directory -C "$tree" "${jobs[@]}" all "$@"
}

# Runs from the folder it was built in, with scenes and include files beside it.
install_in_place() {
  install -C -D -m 755 "$tree/unix/povray" "$prefix/bin/povray"
  cmp -s "$tree/.sum" "$prefix/share/povray-3.7/.sum" && return
  "$make" -s --no-print-directory -C "$tree" install-data "${in_place[@]}" >/dev/null
  # Maps are read and written only where povray.conf permits; in place that is the current folder with all below it, and the project's own.
  sed -i 's|^read+write  = \.$|read+write* = .\nread+write* = %INSTALLDIR%/'"$(realpath --relative-to="$prefix/share/povray-3.7" "$top")|" \
    "$prefix/etc/povray/3.7/povray.conf"
  cp "$tree/.sum" "$prefix/share/povray-3.7/.sum"
}

refresh_tree
configure_tree
case $step in
  configure) ;;
  all)
    compile "${in_place[@]}"
    install_in_place
    ;;
  install)
    forget_paths
    compile "$@"
    "$make" -s --no-print-directory -C "$tree" install "$@"
    forget_paths
    ;;
  *) echo "build.sh: configure, all or install?" >&2; exit 2 ;;
esac
