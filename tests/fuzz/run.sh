#!/bin/bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# Fuzzes the reader of map files with libFuzzer (Debian package clang) under AddressSanitizer and UndefinedBehaviorSanitizer.
#
#   tests/fuzz/run.sh [SECONDS [JOBS]]     60 1; what it finds stays in build/fuzz/
#
# Seeds are small maps of every kind: grey, coloured, marked, of one face and of six, plain and with levels. OpenImageIO and OpenEXR are the
# system's own, without sanitizers.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
: "${POVRAY:=$top/build/bin/povray}"
export LC_ALL=C
out=$top/build/fuzz
mkdir -p "$out/seeds" "$out/found" "$out/objects" "$out/corpus"

flags=(-g -O1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize-recover=undefined -ffp-contract=off -I"$top/plugin"
  -D_POSIX_C_SOURCE=200809L)

build() {
  local file objects=()
  for file in "$top"/plugin/core/*.c "$top"/plugin/map/*.c "$top"/plugin/store/*.c "$top"/tests/fuzz/read_map.c; do
    objects+=("$out/objects/$(basename "$file" .c).o")
    [ "${objects[-1]}" -nt "$file" ] || clang -std=c11 "${flags[@]}" -fsanitize=fuzzer-no-link -c "$file" -o "${objects[-1]}"
  done
  # The library of files loads by itself, as ever; here it has sanitizers, too.
  clang++ -std=c++17 "${flags[@]}" -fsanitize=fuzzer-no-link -shared -fPIC "$top"/plugin/store/*.cpp \
    $(pkg-config --cflags --libs OpenImageIO) -Wl,--version-script="$top/plugin/store/deep_exr.map" \
    -o "$out/deepshadow_files.so"
  clang++ "${flags[@]}" -fsanitize=fuzzer "${objects[@]}" -Wl,-rpath,"$out" -rdynamic -ldl -lm -lpthread -o "$out/read_map"
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
  local light='light_source { <4, 6, -4>, 1' size='resolution 20 samples 4'
  seed grey "$light spotlight point_at 0 radius 30 falloff 40 deep_shadow { $size save_file \"grey.exr\" } }
    sphere { 0, 1 pigment { rgb 1 } }"
  seed glass "$light parallel point_at 0 deep_shadow { $size save_file \"glass.exr\" } }
    sphere { 0, 1 pigment { rgbf <1, .5, .2, .9> } } box { -.5, <.5, 1.5, .5> pigment { rgb 1 } }"
  seed cube "light_source { <.1, .2, .1>, 1 deep_shadow { resolution 9 samples 1 save_file \"cube.exr\" } }
    difference { sphere { 0, 2 } sphere { 0, 1.9 } box { <-3, -1, -3>, <3, 1, 3> } pigment { rgb 1 } }"
  seed marked "$light deep_shadow { $size save_file \"marked.exr\" } }
    sphere { 0, 1 pigment { rgbf 1.4 } } sphere { 1.5, .4 pigment { rgb 1 } }"
}

build
[ -s "$out/seeds/marked.exr" ] || make_seeds
cd "$out"
export LD_LIBRARY_PATH=$out ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1
exec ./read_map -max_total_time="${1:-60}" -fork="${2:-1}" -rss_limit_mb=1500 -malloc_limit_mb=600 -timeout=10 -max_len=60000 \
  -artifact_prefix="$out/found/" corpus seeds
