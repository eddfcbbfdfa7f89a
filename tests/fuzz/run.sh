#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Fuzzes the reader of map files with libFuzzer (Debian package clang) under AddressSanitizer and UndefinedBehaviorSanitizer.
#
#   tests/fuzz/run.sh [map|layout] [SECONDS]     map 60; what it finds stays in build/fuzz/
#
# map: the whole reader. layout: the guard before OpenEXR alone, many times faster.
# Seeds are small maps of every kind: grey, coloured, marked, of depths, of one face and of six, plain and with levels. OpenImageIO and
# OpenEXR are the system's own, without sanitizers.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
: "${POVRAY:=$top/build/bin/povray}"
export LC_ALL=C
target=${1:-map} seconds=${2:-60}
out=$top/build/fuzz
mkdir -p "$out/seeds" "$out/found" "$out/objects" "$out/corpus-$target"

flags=(-g -O1 -fno-omit-frame-pointer -fsanitize=address,undefined,fuzzer-no-link -fno-sanitize-recover=undefined
  -ffp-contract=off -I"$top/plugin" -D_POSIX_C_SOURCE=200809L)

# Objects that were compiled already are kept, until a header changes.
[ -z "$(find "$top/plugin" "$top/tests/fuzz" -name '*.h' -newer "$out/objects/stamp" 2>&1)" ] || rm -f "$out"/objects/*
touch "$out/objects/stamp"
compile() {
  local file
  objects=()
  for file in "$@"; do
    objects+=("$out/objects/$(basename "$file").o")
    [ "${objects[-1]}" -nt "$file" ] && continue
    case $file in
      *.cpp) clang++ -std=c++17 "${flags[@]}" $(pkg-config --cflags OpenImageIO) -c "$file" -o "${objects[-1]}" ;;
      *) clang -std=c11 "${flags[@]}" -c "$file" -o "${objects[-1]}" ;;
    esac
  done
}

build() {
  local store=() file
  case $target in
    map)
      for file in "$top"/plugin/store/*.c "$top"/plugin/store/*.cpp; do [[ $file == */deep_exr_load.c ]] || store+=("$file"); done
      compile "$top"/plugin/core/*.c "$top"/plugin/map/*.c "${store[@]}" "$top/tests/fuzz/read_map.c"
      clang++ "${flags[@]}" -fsanitize=fuzzer "${objects[@]}" -Wl,--wrap=pread64,--wrap=tile_table_read,--wrap=map_seal \
        $(pkg-config --libs OpenImageIO) -lm -lpthread -o "$out/map" ;;
    layout)
      compile "$top/plugin/store/exr_layout.c" "$top/tests/fuzz/check_layout.c"
      clang++ "${flags[@]}" -fsanitize=fuzzer "${objects[@]}" -Wl,--wrap=pread64,--wrap=open64,--wrap=fstat64,--wrap=close -o "$out/layout" ;;
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
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1:quarantine_size_mb=16:malloc_context_size=3:max_malloc_fill_size=0 UBSAN_OPTIONS=print_stacktrace=1
exec "./$target" -max_total_time="$seconds" -rss_limit_mb=1500 -malloc_limit_mb=600 -timeout=10 -max_len=20000 \
  -artifact_prefix=found/ -print_final_stats=1 "corpus-$target" seeds
