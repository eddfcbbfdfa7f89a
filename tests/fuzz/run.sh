#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Fuzzes the reader of map files with libFuzzer (Debian package clang) under AddressSanitizer and UndefinedBehaviorSanitizer.
#
#   tests/fuzz/run.sh [map|words|layout] [SECONDS]     map 60; what it finds stays in build/fuzz/
#   JOBS=2 tests/fuzz/run.sh ...                       in so many processes
#
# map: the whole reader, through OpenImageIO and OpenEXR, the system's own, without sanitizers. words: all that is behind them, told any
# attributes and words; many times faster. layout: the guard before them alone, many times faster again.
# Seeds are small maps of every kind: grey, coloured, marked, of depths, of one face and of six, plain and with levels.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
top=$(dirname "$(dirname "$here")")
: "${POVRAY:=$top/build/bin/povray}"
export LC_ALL=C
target=${1:-map} seconds=${2:-60}
out=$top/build/fuzz
mkdir -p "$out/seeds" "$out/seeds-words" "$out/found" "$out/objects" "$out/corpus-$target"

# What parses is watched comparison by comparison. What computes from words that were checked is not: that takes most of the time there,
# and teaches the fuzzer nothing. Calls within plugin/store go by their names, so that fuzzed_map.h can stand before one of them.
plain=(-g -O2 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined
  -ffp-contract=off -I"$top/plugin" -D_POSIX_C_SOURCE=200809L)
computes=("${plain[@]}" -fsanitize-coverage=inline-8bit-counters,pc-table)
parses=("${plain[@]}" -fsanitize=fuzzer-no-link -fPIC -fsemantic-interposition)

# Objects that were compiled already are kept, until a header or this file changes.
[ -z "$(find "$top/plugin" "$here" \( -name '*.h' -o -name run.sh \) -newer "$out/objects/stamp" 2>&1)" ] || rm -f "$out"/objects/*
touch "$out/objects/stamp"
compile() {
  local file object
  objects=()
  for file in "$@"; do
    object=$out/objects/$(basename "$file").o
    objects+=("$object")
    [ "$object" -nt "$file" ] && continue
    case $file in
      *.cpp) clang++ -std=c++17 "${parses[@]}" $(pkg-config --cflags OpenImageIO) -c "$file" -o "$object" ;;
      "$here"/*) clang -std=c11 "${plain[@]}" -c "$file" -o "$object" ;;
      */store/*) clang -std=c11 "${parses[@]}" -c "$file" -o "$object" ;;
      *) clang -std=c11 "${computes[@]}" -c "$file" -o "$object" ;;
    esac
  done
}

# $1: the program, $2: what else the linker shall wrap, $3: for the fuzzer's own `main`, then the sources of the store.
link_reader() {
  local program=$1 wrap=$2 fuzzer=$3
  shift 3
  compile "$here/$program.c" "$top"/plugin/core/*.c "$top"/plugin/map/*.c "$@"
  clang++ "${plain[@]}" $fuzzer "${objects[@]}" -Wl,-z,muldefs,--wrap=tile_table_read"$wrap" \
    $(pkg-config --libs OpenImageIO) -lm -lpthread -o "$out/$program"
}

build() {
  local store=() files=() file
  for file in "$top"/plugin/store/*.c; do [[ $file == */deep_exr_load.c ]] || store+=("$file"); done
  files=("${store[@]}" "$top"/plugin/store/*.cpp)
  case $target in
    map) link_reader read_map ,--wrap=pread64 -fsanitize=fuzzer "${files[@]}" ;;
    words)
      link_reader record_words '' '' "${files[@]}"
      link_reader read_words '' -fsanitize=fuzzer "${store[@]}" ;;
    layout)
      compile "$here/check_layout.c" "$top/plugin/store/exr_layout.c"
      clang++ "${plain[@]}" -fsanitize=fuzzer "${objects[@]}" -Wl,--wrap=pread64,--wrap=open64,--wrap=fstat64,--wrap=close -o "$out/check_layout" ;;
    *) echo "run.sh: there is no target $target" >&2; exit 2 ;;
  esac
}

seed() {  # $1: name, $2: the rest of the scene
  cat >"$out/seed.pov" <<SCENE
#version 3.7;
global_settings { assumed_gamma 1 }
camera { location <0, 3, -6> look_at 0 }
plane { y, -1 pigment { rgb 1 } }
$2
SCENE
  (cd "$out/seeds" && "$POVRAY" -D -V +I"$out/seed.pov" +O"$out/seed.png" +W8 +H6 -A >"$out/seed.log" 2>&1) ||
    { cat "$out/seed.log" >&2; exit 1; }
}

make_seeds() {
  local light='light_source { <4, 6, -4>, 1' ball='sphere { 0, 1 pigment { rgb 1 } }'
  seed grey "$light spotlight point_at 0 radius 30 falloff 40 deep_shadow { resolution 1 samples 4 save_file \"grey.exr\" } } $ball"
  seed levels "$light deep_shadow { resolution 20 samples 4 save_file \"levels.exr\" } } $ball"
  seed deltas "$light deep_shadow { resolution 16 samples 64 tolerance 0.03 save_file \"deltas.exr\" } } $ball
    sphere { <.3, 1.2, 0>, .3 pigment { rgb 1 } } sphere { <-.4, 1.5, .2>, .4 pigment { rgb 1 } }"
  seed glass "$light parallel point_at 0 deep_shadow { resolution 2 samples 4 save_file \"glass.exr\" } }
    sphere { 0, 1 pigment { rgbf <1, .5, .2, .9> } } box { -.5, <.5, 1.5, .5> pigment { rgb 1 } }"
  seed cube "light_source { <.1, .2, .1>, 1 deep_shadow { resolution 1 samples 1 save_file \"cube.exr\" } }
    difference { sphere { 0, 2 } sphere { 0, 1.9 } box { <-3, -1, -3>, <3, 1, 3> } pigment { rgb 1 } }"
  seed marked "$light deep_shadow { resolution 4 samples 4 save_file \"marked.exr\" } }
    sphere { 0, 1 pigment { rgbf 1.4 } } sphere { 1.5, .4 pigment { rgb 1 } }"
  seed depths "$light shadow_map { resolution 20 save_file \"depths.exr\" } } $ball"
}

build
[ -s "$out/seeds/depths.exr" ] || make_seeds
cd "$out"
seeds=seeds
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1:max_malloc_fill_size=0:quarantine_size_mb=1
ASAN_OPTIONS+=:thread_local_quarantine_size_kb=64:malloc_context_size=1
export UBSAN_OPTIONS=print_stacktrace=1
case $target in
  map) program=read_map limits=(-max_len=20000) ;;
  words)
    program=read_words limits=(-max_len=4000) seeds=seeds-words
    for file in seeds/*.exr; do ./record_words "$file" >"seeds-words/$(basename "$file" .exr)"; done ;;
  layout) program=check_layout limits=(-max_len=20000) ;;
esac
limits+=(-entropic_scale_per_exec_time=1)   # what runs in no time tells as much
[ -z "${JOBS:-}" ] || limits+=("-fork=$JOBS")
exec "./$program" "${limits[@]}" -max_total_time="$seconds" -rss_limit_mb=1500 -malloc_limit_mb=600 -timeout=10 \
  -artifact_prefix=found/ -print_final_stats=1 "corpus-$target" "$seeds"
