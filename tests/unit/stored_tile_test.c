/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What is between a tile and its samples in a file. Depths are in depth_file_test.c, the words themselves in tile_words_test.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "made_map.h"

/* Each bit of a tile counts, and so does its place: the first of 64 words or the last. */
static void every_bit_counts(void **state) {
  (void)state;
  tile_plan plan = {.count = {[TILE_PIXELS - 1] = 4}};
  tile *t = tile_create(&plan);
  deep_tile deep = {.words = NULL};
  assert_int_equal(store_tile(t, STORED_GREY, &deep), DSM_OK);
  tile_record record = tile_record_of(t, &deep, 5);
  const tile *back;
  assert_int_equal(restore_tile(&deep, STORED_GREY, &record, 4, &back), DSM_REFUSED);   /* of another place */
  for (uint32_t i = 0; i < 32 * deep.count[0]; ++i) {
    deep.words[i / 32] ^= 1u << i % 32;
    assert_true(tile_record_of(t, &deep, 5).checksum != record.checksum);
    assert_int_equal(restore_tile(&deep, STORED_GREY, &record, 5, &back), DSM_REFUSED);
    deep.words[i / 32] ^= 1u << i % 32;
  }
  assert_int_equal(restore_tile(&deep, STORED_GREY, &record, 5, &back), DSM_OK);
  assert_true(same_tiles(t, back));
  tile_destroy(back);
  free(deep.words);
  tile_destroy(t);
}

/* The first pixel has the words, and no other one has any. */
static void words_are_in_the_first_pixel(void **state) {
  (void)state;
  tile_plan plan = {.count = {4}};
  tile *t = tile_create(&plan);
  deep_tile deep = {.words = NULL};
  assert_int_equal(store_tile(t, STORED_GREY, &deep), DSM_OK);
  tile_record record = tile_record_of(t, &deep, 5);
  const tile *back;
  for (uint32_t i = 1; i < TILE_PIXELS; ++i) {
    --deep.count[0];
    ++deep.count[i];
    assert_int_equal(restore_tile(&deep, STORED_GREY, &record, 5, &back), DSM_REFUSED);
    ++deep.count[0];
    assert_int_equal(restore_tile(&deep, STORED_GREY, &record, 5, &back), DSM_REFUSED);
    --deep.count[i];
  }
  deep.count[0] = 0;
  assert_int_equal(restore_tile(&deep, STORED_GREY, &record, 5, &back), DSM_REFUSED);
  free(deep.words);
  tile_destroy(t);
}

/* No tile is written that could not be read again. */
static void what_cannot_be_is_not_written(void **state) {
  (void)state;
  tile_plan plan = {.count = {[7] = 2}};
  deep_tile deep = {.words = NULL};
  for (int wrong = 0; wrong < 4; ++wrong) {
    plan.marked[7] = wrong == 3;
    tile *t = tile_create(&plan);
    tile_put(t, 7, 0, 0, wrong == 1 ? 3 : 1, 5);
    tile_put(t, 7, 1, 0, 2, wrong == 2 ? 6 : 5);
    assert_int_equal(store_tile(t, STORED_GREY, &deep), wrong ? DSM_INVALID : DSM_OK);
    tile_destroy(t);
  }
  free(deep.words);
}

/* A tile with colour belongs into a map of colour alone, whoever writes it or reads it. */
static void colour_is_announced(void **state) {
  (void)state;
  tile_plan plan = {.count = {[7] = 1}, .coloured = {[7] = 1}};
  deep_tile deep = {.words = NULL};
  tile *t = tile_create(&plan);
  const tile *back;
  for (uint32_t c = 0; c < 3; ++c) tile_put(t, 7, 0, c, 1, (uint16_t)(9 - c));
  assert_int_equal(store_tile(t, STORED_GREY, &deep), DSM_INVALID);
  assert_int_equal(store_tile(t, STORED_COLOURED, &deep), DSM_OK);
  tile_record record = tile_record_of(t, &deep, 2);
  assert_int_equal(restore_tile(&deep, STORED_GREY, &record, 2, &back), DSM_REFUSED);
  assert_null(back);
  assert_int_equal(restore_tile(&deep, STORED_COLOURED, &record, 2, &back), DSM_OK);
  assert_true(same_tiles(t, back));
  tile_destroy(back);
  free(deep.words);
  tile_destroy(t);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_bit_counts),
    cmocka_unit_test(words_are_in_the_first_pixel),
    cmocka_unit_test(what_cannot_be_is_not_written),
    cmocka_unit_test(colour_is_announced),
  };
  return cmocka_run_group_tests_name("stored tile", tests, NULL, NULL);
}
