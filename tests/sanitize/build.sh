#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# tests/sanitize/build.sh FOLDER FLAGS: a copy of the plugin and its tests in build/FOLDER/, compiled with FLAGS by the same rules as ever.
# Unit and oracle tests are built; nothing is run. Only what has changed is copied and compiled again.
set -euo pipefail
top=$(cd "$(dirname "$0")/../.." && pwd)
tree=$top/build/$1
flags=$2
case $flags in   # libtool links C++ libraries without what the compiler would add by itself
  *-fsanitize=address,undefined*) libs='-lasan -lubsan' ;;
  *-fsanitize=address*) libs=-lasan ;;
  *-fsanitize=undefined*) libs=-lubsan ;;
  *-fsanitize=thread*) libs=-ltsan ;;
  *) libs= ;;
esac

mkdir -p "$tree"
cd "$top"
find plugin tests build-aux \( -name '*.[ch]' -o -name '*.cpp' -o -name '*.map' -o -path 'build-aux/*' \) -type f -print0 |
  xargs -0 cp -u --parents --target-directory="$tree"   # as new as the copy is: what was edited during the last build is compiled again
cp -u -p --parents --target-directory="$tree" doc/dsmtool.1 aclocal.m4 configure configure.ac Makefile.am Makefile.in

cd "$tree"
if [ "$flags" != "$(cat .flags 2>/dev/null)" ]; then
  ./configure -q "CFLAGS=$flags" "CXXFLAGS=$flags" "LIBS=$libs" >configure.log 2>&1 || { tail configure.log >&2; exit 1; }
  find plugin tests -name '*.o' -delete -o -name '*.lo' -delete -o -name '*.la' -delete
  echo "$flags" >.flags
fi
jobs=()
case ${MAKEFLAGS-} in *-j*) ;; *) jobs=("-j$(nproc)") ;; esac
make -s "${jobs[@]}" plugin tool $(find tests/unit tests/oracle -name '*_test.c' | sed 's/\.c$//') >build.log 2>&1 ||
  { tail build.log >&2; exit 1; }
