#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Runs unit and oracle tests, and then the real program, under a sanitizer or valgrind. Everything happens in build/sanitize-WHICH/.
#
#   tests/sanitize/run.sh address|undefined|thread|valgrind [tests|program]
#
# In the program the plugin, the bridge and the upstream files that the patches touch are compiled anew; the rest of POV-Ray is the
# ordinary build, and gives no reports of its own; valgrind takes the ordinary program as it is. It renders small scenes of
# every kind, whose tiles 8 threads bake on demand. What upstream code and libraries do is left out by the *.supp beside this file,
# each entry with its reason.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(dirname "$(dirname "$here")")
which=${1:-}
part=${2:-both}
tree=$top/build/sanitize-$which
povray=$tree/build/bin/povray
export LC_ALL=C

common='-g -O1 -fno-omit-frame-pointer'
wrap=()
case $which in
  address) flags="$common -fsanitize=address" ;;
  undefined) flags="$common -fsanitize=undefined -fno-sanitize-recover=undefined" ;;
  # Some kernels place memory where this sanitizer does not expect it.
  thread) flags="$common -fsanitize=thread" wrap=(setarch -R) ;;
  valgrind) flags="$common"
    wrap=(valgrind -q --error-exitcode=99 --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite
      "--suppressions=$here/valgrind.supp") ;;
  *) echo "usage: run.sh address|undefined|thread|valgrind [tests|program]" >&2; exit 2 ;;
esac
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1:exitcode=99
export LSAN_OPTIONS=suppressions=$here/address.supp:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$here/thread.supp:halt_on_error=0:exitcode=99

# Where a sanitizer stands between, the loader does not know which library's search path it is to take.
export LD_LIBRARY_PATH=$tree/plugin/.libs

mkdir -p "$tree/build"
[ "$which-$part" = valgrind-program ] || "$here/build.sh" "sanitize-$which" "$flags"
cd "$tree"
status=0

run_tests() {
  local test
  export DSM_CASES=${DSM_CASES-200}   # of tests/unit/random_cases_test.c
  for test in $(find tests/unit tests/oracle -name '*_test.c' | sed 's/\.c$//' | sort); do
    # A hundred thousand cases take hours here, and the other sanitizers run them.
    if [ "$which" = valgrind ] && grep -qE '[0-9]00000' "$test.c"; then continue; fi
    if timeout 1800 "${wrap[@]}" "$test" >"$test.log" 2>&1; then
      echo "passed $test"
    else
      echo "FAILED $test: see $tree/$test.log"
      status=1
    fi
  done
}

# The files that a patch changes, as objects.
patched_objects() {
  sed -n 's|^+++ b/\(.*\)\.cpp.*|\1.o|p' "$top"/patches/*.patch | sort -u
}

build_program() {
  [ -e "$top/build/povray/unix/povray" ] || { echo "run.sh: build the program first (make)" >&2; exit 1; }
  local built
  mkdir -p build
  cp -a -u "$top/build/povray" "$top/build/share" "$top/build/etc" build/
  cd build/povray
  if [ "$flags" != "$(cat .flags 2>/dev/null)" ]; then
    rm -f source/backend/shadow/*.o $(patched_objects)
    echo "$flags" >.flags
  fi
  rm -f source/libpovray.a unix/povray
  built=$(sed -n 's/^CXXFLAGS = //p' Makefile)
  make -s "-j$(nproc)" all "CXXFLAGS=$built ${flags/ -O1/}" >../povray.log 2>&1 || { tail ../povray.log >&2; exit 1; }
  install -C -D -m 755 unix/povray ../bin/povray
  cd ../..
}

render() {  # a scene, and its options
  local scene=$1 name=build/picture
  shift
  if timeout 1800 "${wrap[@]}" "$povray" -D -V +L"$top/tests/image/scenes" +I"$top/$scene" +O"$tree/$name.png" +WT8 +BS8 \
       Shadow_Method=deep "$@" >"$name.log" 2>&1 </dev/null && ! grep -qE '(WARNING|ERROR): [A-Z][a-z]+Sanitizer|runtime error' "$name.log"; then
    echo "passed $scene $*"
  else
    cp "$name.log" "build/$(basename "$scene" .pov).log"
    echo "FAILED $scene $*: see $tree/build/$(basename "$scene" .pov).log"
    status=1
  fi
}

run_program() {
  local size=(+W64 +H48 +A0.3)
  if [ "$which" = valgrind ]; then
    size=(+W32 +H24 -A) povray=$top/build/bin/povray
  else
    build_program
  fi
  render scenes/hairball.pov "${size[@]}" Declare=Hairs=500 Declare=Resolution=256
  render scenes/glass.pov "${size[@]}" Declare=Resolution=256
  render scenes/point_light.pov "${size[@]}"
  render tests/image/scenes/media_pipe.pov "${size[@]}"
  render tests/image/scenes/photons.pov "${size[@]}"
  render tests/image/scenes/radiosity.pov "${size[@]}"
  render tests/image/scenes/degenerate.pov "${size[@]}"
}

[ "$part" = program ] || run_tests
[ "$part" = tests ] || run_program
exit "$status"
