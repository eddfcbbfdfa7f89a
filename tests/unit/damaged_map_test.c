/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Good maps that are damaged by chance in all the ways that files are: each is refused or read, and nothing else happens; and it
 * takes no more memory than a good one of its size. tests/fuzz does the same for hours.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "made_map.h"

enum { MAPS = 8, RUNS_A_MAP = 400, MOST_DAMAGES = 4, MOST_MEGABYTES = 100 };

static char text[MAP_REASON_SIZE];
static map_reason why = {text, sizeof text};

/* The most memory that this process has asked for, in megabytes; zeros where the system does not tell. */
static long most_memory(void) {
  char line[200];
  long kilobytes = 0;
  FILE *status = fopen("/proc/self/status", "r");
  while (status && fgets(line, sizeof line, status)) sscanf(line, "VmPeak: %ld kB", &kilobytes);
  if (status) fclose(status);
  return kilobytes / 1024;
}

static dsm_result read_whole(const char *path) {
  map_header header;
  map_file *file;
  map_parts parts;
  dsm_result result = map_file_open(path, &header, &file, &why), worst = result;
  if (result != DSM_OK) return result;
  map_parts_lay(&parts, &header.projection, map_header_kind(&header));
  for (uint32_t part = 0; part + 1 < parts.count; ++part) {
    tile_key key = parts.keys[part];
    for (key.y = 0; key.y < parts.parts[part].up; ++key.y)
      for (key.x = 0; key.x < parts.parts[part].across; ++key.x) {
        const tile *t;
        result = map_file_tile(file, &key, &t, &why);
        tile_destroy(t);
        if (result != DSM_OK) worst = result;
      }
  }
  map_file_close(file);
  map_header_free(&header);
  return worst;
}

/* Numbers at which readers stumble. */
static uint64_t edge_number(rng *r) {
  static const uint64_t edges[] = {0, 1, 0x7f, 0x80, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0x80000000, 0xffffffff, INT64_MAX, UINT64_MAX};
  return edges[rng_below(r, sizeof edges / sizeof *edges)] + rng_below(r, 3) - 1;
}

/* The headers come first, so the first bytes are damaged more often. */
static size_t some_place(rng *r, size_t size) {
  size_t most = rng_below(r, 2) && size > 4000 ? 4000 : size;
  return rng_below(r, (uint32_t)most);
}

static size_t damage(rng *r, unsigned char *bytes, size_t size) {
  size_t at = some_place(r, size), other = some_place(r, size), left = size - (at > other ? at : other);
  size_t run = 1 + rng_below(r, left < 64 ? (uint32_t)left : 64);
  uint64_t number = edge_number(r);
  if (run > left) run = left;
  switch (rng_below(r, 7)) {
    case 0: bytes[at] ^= (unsigned char)(1u << rng_below(r, 8)); break;
    case 1: bytes[at] = (unsigned char)rng_bits(r); break;
    case 2: memcpy(bytes + at, &number, size - at < 4 ? size - at : 4); break;
    case 3: memcpy(bytes + at, &number, size - at < 8 ? size - at : 8); break;
    case 4: memset(bytes + at, (int)number, run); break;
    case 5: memmove(bytes + at, bytes + other, run); break;
    case 6: return rng_below(r, 4) || size < 400 ? size : 200 + at % (size - 200);
  }
  return size;
}

static void put_bytes(const char *path, const unsigned char *bytes, size_t size) {
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(bytes, 1, size, f), size);
  assert_int_equal(fclose(f), 0);
}

static unsigned char *bytes_of(const char *path, size_t *size) {
  FILE *f = fopen(path, "rb");
  assert_non_null(f);
  fseek(f, 0, SEEK_END);
  *size = (size_t)ftell(f);
  rewind(f);
  unsigned char *bytes = malloc(*size);
  assert_int_equal(fread(bytes, 1, *size, f), *size);
  fclose(f);
  return bytes;
}

static void damaged_maps_are_refused_or_read(void **state) {
  (void)state;
  const char *seed = getenv("SEED");
  rng r = rng_seeded(seed ? strtoull(seed, NULL, 10) : 1);
  print_message("seed %llu\n", (unsigned long long)r.seed);   /* a crash says nothing */
  int refused = 0, read = 0, tools_own_memory = getenv("DSM_MOST_CASES") != NULL;   /* what asks for fewer needs a lot itself */
  for (int i = 0; i < MAPS; ++i) {
    made_map m = made_map_random(&r, rng_below(&r, 3) ? 1 : 6, 40, i % 3, 4);
    const char *path = made_path("damaged.exr");
    assert_int_equal(map_file_write(path, &m.header, give_made, &m, NULL, &why), DSM_OK);
    assert_int_equal(read_whole(path), DSM_OK);
    long before = most_memory();
    size_t size;
    unsigned char *good = bytes_of(path, &size), *bad = malloc(size);
    for (int run = 0; run < (int)most_cases(RUNS_A_MAP); ++run) {
      size_t less = size;
      memcpy(bad, good, size);
      for (uint32_t n = 1 + rng_below(&r, MOST_DAMAGES); n > 0; --n) less = damage(&r, bad, less);
      put_bytes(path, bad, less);
      dsm_result result = read_whole(path);
      assert_seeded(&r, result == DSM_OK || result == DSM_REFUSED);
      refused += result == DSM_REFUSED;
      read += result == DSM_OK;
      assert_seeded(&r, tools_own_memory || most_memory() - before <= MOST_MEGABYTES);
    }
    free(good);
    free(bad);
    made_map_free(&m);
  }
  assert_seeded(&r, refused > 10 * read && read > 0);
}

/* Whoever goes through the words of a tile may point at them, even where there are none. */
static void a_tile_without_samples_has_words_to_point_at(void **state) {
  (void)state;
  const deep_part part = {.name = "empty", .across = 1, .up = 1, .channel_count = 2, .channels = {"Z", "V"}};
  deep_error error;
  const deep_exr *exr = deep_exr_load(&error);
  assert_non_null(exr);
  deep_tile tile = {.words = NULL};
  deep_writer *writer = exr->create(made_path("empty.exr"), &part, 1, NULL, 0, &error);
  assert_non_null(writer);
  assert_true(exr->write(writer, 0, 0, 0, &tile, &error));
  exr->finish(writer);
  deep_reader *reader = exr->open(made_path("empty.exr"), &error);
  assert_non_null(reader);
  assert_true(exr->has_parts(reader, &part, 1, &error));
  assert_true(exr->read(reader, 0, 0, 0, &tile, &error));
  assert_non_null(tile.words);
  for (int i = 0; i < DEEP_PIXELS; ++i) assert_int_equal(tile.count[i], 0);
  exr->close(reader);
  free(tile.words);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(damaged_maps_are_refused_or_read),
    cmocka_unit_test(a_tile_without_samples_has_words_to_point_at),
  };
  return cmocka_run_group_tests(tests, made_folder_open, made_folder_close);
}
