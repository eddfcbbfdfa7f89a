#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Runs unit and oracle tests, and then the real program, under a sanitizer or valgrind. What is compiled for it, and all logs, are in
# build/sanitize-*/. `address,undefined` is both of them at once, in little more time than one takes.
#
#   tests/sanitize/run.sh address|undefined|address,undefined|thread|valgrind [tests|program|whole [WORD]]
#
# tests: those of tests/unit and tests/oracle; with `thread` those that start threads or load the library for files, which does.
# program: small scenes of every kind, whose tiles 8 threads bake on demand, or save, load and evict. The plugin, the bridge and the
#   upstream files that the patches touch are compiled anew. The rest of POV-Ray is the ordinary build, and gives no reports of its own. It
#   causes none either: its locks and threads are those of the C library, where the sanitizer sees them. valgrind takes the ordinary
#   program and sees all of it.
# whole: the same with all of POV-Ray compiled anew (as long as building it takes). This sees also races between two calls of
#   the bridge that meet within POV-Ray's own code.
#
# WORD: only tests and scenes that have it in their name or options.
#
# What upstream code and libraries do is left out by the *.supp beside this file, each entry with its reason; every other report
# is a failure. DSM_MOST_CASES: how many random cases a test tries, at most. The last line counts what passed and failed; the exit status is 0 if
# nothing failed.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(dirname "$(dirname "$here")")
which=${1:-}
part=${2:-both}
word=${3:-}
tree=$top/build/sanitize-${which/,/-}
povray=$tree/build/bin/povray
export LC_ALL=C

common='-g -O1 -fno-omit-frame-pointer'
wrap=()
case $which in
  address | undefined | address,undefined) flags="$common -fsanitize=$which" ;;
  # Some kernels place memory where this sanitizer does not expect it.
  thread) flags="$common -fsanitize=thread" wrap=(setarch -R) ;;
  valgrind) flags=
    wrap=(valgrind -q --error-exitcode=99 --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite
      "--suppressions=$here/valgrind.supp") ;;
  *) which= ;;
esac
case $which-$part in
  -* | *-) false ;;
  *-both | *-tests | *-program | *-whole) ;;
  *) false ;;
esac || { echo "usage: run.sh address|undefined|address,undefined|thread|valgrind [tests|program|whole [WORD]]" >&2; exit 2; }
# new_delete_type_mismatch: POV-Ray deletes its UnixShelloutProcessing by a base class whose destructor is not virtual.
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1:exitcode=99:new_delete_type_mismatch=0
export LSAN_OPTIONS=suppressions=$here/address.supp:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1:suppressions=$here/undefined.supp
export TSAN_OPTIONS=suppressions=$here/thread.supp:halt_on_error=0:exitcode=99:history_size=4
report='(WARNING|ERROR): [A-Z][a-z]+Sanitizer|runtime error:'   # valgrind tells by the exit status alone

# Where a sanitizer stands between, the loader does not know which library's search path it is to take.
[ "$which" = valgrind ] || export LD_LIBRARY_PATH=$tree/plugin/.libs
export DEEP_SHADOW_CHOICE=map   # maps also where rays would cost less
export DSM_CASES=${DSM_CASES-100} DSM_MOST_CASES=${DSM_MOST_CASES-100}

mkdir -p "$tree/build"
cd "$tree"
passed=0 failed=0

# $1: what, $2: its log, then the command.
judge() {
  local what=$1 log=$2 start=$SECONDS
  shift 2
  case $what in *"$word"*) ;; *) return 0 ;; esac
  local try status
  for try in {1..20}; do
    status=0
    timeout 1800 "${wrap[@]}" "$@" >"$log" 2>&1 </dev/null || status=$?
    # POV-Ray gives its own first thread three seconds to start, which are few where the machine is busy; and then takes its locks away.
    grep -qE 'Timed out waiting for worker thread startup|invalid mutex .*pthread_helpers.hpp' "$log" || break
  done
  if [ "$status" = 0 ] && ! grep -qE "$report" "$log"; then
    echo "passed $what ($((SECONDS - start)) s)"
    passed=$((passed + 1))
  else
    echo "FAILED $what: see $log"
    failed=$((failed + 1))
  fi
}

run_tests() {
  local test folder=$tree
  if [ "$which" = valgrind ]; then
    make -s -C "$top" check TESTS= >build/tests.log 2>&1 || { tail build/tests.log >&2; exit 1; }
    folder=$top
  fi
  cd "$folder"
  for test in $(cd "$top" && find tests/unit tests/oracle -name '*_test.c' | sed 's/\.c$//' | sort); do
    if [ "$which" = thread ] && ! grep -qE 'pthread_create|made_map\.h|map_file\.h|saved_map\.h' "$test.c"; then continue; fi
    judge "$test" "$tree/build/$(basename "$test").log" "$test"
  done
  cd "$tree"
}

# What is compiled anew of POV-Ray's objects, as a pattern for their paths.
own_objects() {
  if [ "$part" = whole ]; then echo '\.o$'; return; fi
  echo "source/backend/shadow/.*\.o$"
  [ "$which" != thread ] || echo "source/backend/support/task\(queue\)\?\.o$"
  sed -n 's|^+++ b/\(.*\)\.cpp.*|\1\\.o$|p' "$top"/patches/*.patch | sort -u
}

build_program() {
  [ -e "$top/build/povray/unix/povray" ] || { echo "run.sh: build the program first (make)" >&2; exit 1; }
  local built own
  own=$(own_objects)
  if [ "$own $flags" != "$(cat build/.compiled 2>/dev/null)" ]; then
    find build/povray -name '*.o' -delete 2>/dev/null || true
    echo "$own $flags" >build/.compiled
  fi
  ( cd "$top/build"
    find povray share etc ! -type d ! -name '*.a' ! -path povray/unix/povray -print0 | grep -zv "$own" |
      xargs -0 cp -a -u --parents --target-directory="$tree/build" )
  cd build/povray
  [ "$which" != thread ] || make_flag_known source/backend/support/task.h
  find . -name '*.a' -delete
  rm -f unix/povray
  built=$(sed -n 's/^CXXFLAGS = //p' Makefile)
  make -s "-j$(nproc)" all "CXXFLAGS=$built $flags" >../povray.log 2>&1 || { tail ../povray.log >&2; exit 1; }
  mkdir -p ../bin
  install -C -m 755 unix/povray ../bin/povray
  cd ../..
}

# A thread of POV-Ray learns by a plain flag that a task has finished, and then frees what it has used. The sanitizer takes that for a race,
# and would for all that shadow tasks leave behind. In this copy the flag is atomic; it has the same size and place.
make_flag_known() {
  ! grep -q 'volatile bool done;' "$1" || {
    sed 's/volatile bool done;/std::atomic<bool> done;/; 0,/^#include/s//#include <atomic>\n&/' "$1" >"$1.new"
    touch -r "$1" "$1.new"   # what is not compiled anew may stay
    mv "$1.new" "$1"
  }
}

scenes=0
render() {  # a scene, and its options
  local scene=$1
  shift
  scenes=$((scenes + 1))
  judge "$scene $*" "$tree/build/picture-$scenes.log" \
    "$povray" -D -V +L"$top/tests/image/scenes" +I"$top/$scene" +O"$tree/build/picture.png" +WT8 +BS8 "$@"
}

# Of every kind: surfaces, media, colours, mirrors and photons; maps and depth maps, of fixed size and by accuracy; baked on demand,
# saved, loaded, and evicted while others read.
run_program() {
  local size=(+W64 +H48 +A0.3) little=(+W32 +H24 -A)
  ASAN_OPTIONS+=:fast_unwind_on_malloc=0   # POV-Ray has no frame pointers, and suppressions need names
  if [ "$which" = valgrind ]; then
    size=(+W32 +H24 -A) little=(+W16 +H12 -A) povray=$top/build/bin/povray
  else
    build_program
  fi
  local deep=Shadow_Method=deep pcf=Shadow_Method=map hairs=(scenes/hairball.pov Declare=Hairs=500 Declare=Resolution=128)
  rm -f hairball?.exr glass?.exr
  render "${hairs[@]}" "${size[@]}"
  render "${hairs[@]}" "${size[@]}" Declare=Cache=0.1
  render "${hairs[@]}" "${little[@]}" Declare=File=1 Declare=Cache=0.1
  render "${hairs[@]}" "${size[@]}" Declare=File=2 Declare=Cache=0.1
  render scenes/hairball.pov "${little[@]}" Declare=Hairs=500 Declare=Accuracy=0.05 Declare=Bound=512
  render scenes/glass.pov "${size[@]}" Declare=Resolution=256
  render scenes/glass.pov "${little[@]}" Declare=Accuracy=0.05 Declare=Bound=512
  render scenes/glass.pov "${little[@]}" Declare=Pcf=1 Declare=Resolution=128 Declare=File=1
  render scenes/glass.pov "${size[@]}" Declare=Pcf=1 Declare=Resolution=128 Declare=File=2
  render scenes/point_light.pov "${little[@]}"
  render scenes/point_light.pov "${little[@]}" $pcf
  render scenes/lamps.pov "${little[@]}" $pcf
  render scenes/cloud.pov "${little[@]}" Declare=MS=5
  DEEP_SHADOW_CHOICE='' render scenes/cloud.pov "${little[@]}" Declare=MS=5
  DEEP_SHADOW_CHOICE='' render scenes/sphere_plane.pov "${size[@]}" $deep
  render tests/image/scenes/media_pipe.pov "${little[@]}"
  render tests/image/scenes/light_group.pov "${little[@]}" $deep
  render tests/image/scenes/photons.pov "${little[@]}" $deep
  render tests/image/scenes/radiosity.pov "${little[@]}" $deep
  render tests/image/scenes/degenerate.pov "${little[@]}" $deep
}

[ "$which" = valgrind ] || "$here/build.sh" "$(basename "$tree")" "$flags"
case $part in both | tests) run_tests ;; esac
[ "$part" = tests ] || run_program
echo "$passed passed, $failed failed"
[ "$failed" = 0 ] && [ "$passed" -gt 0 ]
