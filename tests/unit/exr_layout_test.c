/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Files with one wrong length or place each; what is wrong is put there by hand, byte by byte, from the format's description. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "made_map.h"
#include "store/exr_layout.h"

/* A file of one part, 32 x 16 pixels in two tiles, with the fewest attributes; and its places that tests change. */
typedef struct {
  unsigned char bytes[1000];
  size_t size, int_size, list_size, chunk_count, right_edge, tile_width, type, table, tile;
} image;

static void add(image *m, const void *bytes, size_t size) {
  memcpy(m->bytes + m->size, bytes, size);
  m->size += size;
}

static void put_number(unsigned char *where, uint64_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) where[i] = (unsigned char)(number >> 8 * i);
}

static void add_number(image *m, uint64_t number, int bytes) {
  put_number(m->bytes + m->size, number, bytes);
  m->size += (size_t)bytes;
}

/* Returns the place of its size; the value follows. */
static size_t add_attribute(image *m, const char *name, const char *type, uint32_t size) {
  add(m, name, strlen(name) + 1);
  add(m, type, strlen(type) + 1);
  add_number(m, size, 4);
  return m->size - 4;
}

static void add_tile(image *m, int many, uint32_t x) {
  if (many) add_number(m, 0, 4);
  const uint32_t numbers[4] = {x, 0, 0, 0};
  for (int i = 0; i < 4; ++i) add_number(m, numbers[i], 4);
  add_number(m, 10, 8);     /* packed counts */
  add_number(m, 20, 8);     /* packed samples */
  add_number(m, 2000, 8);   /* samples */
  m->size += 30;
}

static image make(int many) {
  image m = {.size = 0};
  add_number(&m, 20000630, 4);
  add_number(&m, many ? 0x1802 : 0xa02, 4);
  m.list_size = add_attribute(&m, "channels", "chlist", 19);
  add(&m, "Z\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0\0", 19);
  m.int_size = add_attribute(&m, "version", "int", 4);
  add_number(&m, 1, 4);
  m.chunk_count = add_attribute(&m, "chunkCount", "int", 4) + 4;
  add_number(&m, 2, 4);
  m.right_edge = add_attribute(&m, "dataWindow", "box2i", 16) + 12;
  add_number(&m, 0, 8);
  add_number(&m, 31, 4);
  add_number(&m, 15, 4);
  m.tile_width = add_attribute(&m, "tiles", "tiledesc", 9) + 4;
  add_number(&m, 16, 4);
  add_number(&m, 16, 4);
  add_number(&m, 0, 1);
  m.type = add_attribute(&m, "type", "string", 8) + 4;
  add(&m, "deeptile", 8);
  m.size += many ? 2 : 1;
  m.table = m.size;
  m.size += 16;
  for (uint32_t x = 0; x < 2; ++x) {
    put_number(m.bytes + m.table + 8 * x, m.size, 8);
    if (x == 1) m.tile = m.size + (many ? 4 : 0);
    add_tile(&m, many, x);
  }
  return m;
}

static exr_layout *open_image(const image *m) {
  exr_layout *layout;
  const char *path = made_path("layout.exr");
  FILE *f = fopen(path, "wb");
  assert_non_null(f);
  assert_int_equal(fwrite(m->bytes, 1, m->size, f), m->size);
  assert_int_equal(fclose(f), 0);
  dsm_result result = exr_layout_open(path, &layout);
  assert_true(result == (layout ? DSM_OK : DSM_REFUSED));
  return layout;
}

static void sound_files_are_taken(void **state) {
  (void)state;
  for (int many = 0; many < 2; ++many) {
    image m = make(many);
    exr_layout *layout = open_image(&m);
    assert_non_null(layout);
    assert_true(exr_layout_tile(layout, 0, 0, 0) && exr_layout_tile(layout, 0, 1, 0));
    assert_int_equal(exr_layout_bytes(layout, 0), 2 * (8 + (many ? 20 : 16) + 24 + 30));   /* place, numbers, sizes, counts and samples */
    assert_int_equal(exr_layout_bytes(layout, 1), 0);
    assert_false(exr_layout_tile(layout, 0, 2, 0) || exr_layout_tile(layout, 0, 0, 1) || exr_layout_tile(layout, 1, 0, 0));
    exr_layout_close(layout);
  }
}

static void assert_refused(const image *m) { assert_null(open_image(m)); }

static void wrong_headers_are_refused(void **state) {
  (void)state;
  for (int many = 0; many < 2; ++many) {
    const image good = make(many);
    const struct { size_t place; uint64_t number; int bytes; } wrong[] = {
      {good.int_size, 5, 4}, {good.int_size, 0x7fffffff, 4}, {good.int_size, 0xffffffff, 4}, {good.list_size, 18, 4},
      {good.list_size, 20, 4}, {good.list_size, 0, 4}, {good.chunk_count, 3, 4}, {good.chunk_count, 0, 4},
      {good.chunk_count, 0x40000000, 4}, {good.right_edge, 0x7fffffff, 4}, {good.right_edge, 63, 4},
      {good.tile_width, 0x10000000, 4}, {good.tile_width + 8, 1, 1}, {good.type, 'D', 1}, {good.type - 4, 0x70000000, 4},
      {good.table, 0, 8}, {good.table + 8, good.size + 1, 8}, {good.table, UINT64_MAX, 8}, {good.table, 8, 8},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
      image m = good;
      put_number(m.bytes + wrong[i].place, wrong[i].number, wrong[i].bytes);
      exr_layout *layout = open_image(&m);
      if (layout) fail_msg("number %d was taken", (int)i);
    }
    for (size_t size = 0; size < good.table + 16; ++size) {
      image m = good;
      m.size = size;
      assert_refused(&m);
    }
  }
}

static void wrong_tiles_are_refused(void **state) {
  (void)state;
  for (int many = 0; many < 2; ++many) {
    const image good = make(many);
    const struct { int place; uint64_t number; int bytes; } wrong[] = {
      {0, 0, 4}, {4, 1, 4}, {8, 1, 4}, {12, 1, 4}, {16, 11, 8}, {16, 2000, 8}, {16, UINT64_MAX, 8}, {24, 21, 8},
      {24, UINT64_MAX - 5, 8}, {32, 20 * 1032 + 1, 8}, {32, UINT64_MAX, 8},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
      image m = good;
      put_number(m.bytes + m.tile + wrong[i].place, wrong[i].number, wrong[i].bytes);
      exr_layout *layout = open_image(&m);
      assert_non_null(layout);
      assert_true(exr_layout_tile(layout, 0, 0, 0));
      if (exr_layout_tile(layout, 0, 1, 0)) fail_msg("number %d was taken", (int)i);
      exr_layout_close(layout);
    }
    image cut = good;
    cut.size -= 1;
    exr_layout *layout = open_image(&cut);
    assert_false(exr_layout_tile(layout, 0, 1, 0));
    exr_layout_close(layout);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(sound_files_are_taken),
    cmocka_unit_test(wrong_headers_are_refused),
    cmocka_unit_test(wrong_tiles_are_refused),
  };
  return cmocka_run_group_tests(tests, made_folder_open, made_folder_close);
}
