/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "map/tile.h"
#include "random.h"

static tile_pixel *pixels_of(tile *t) { return (tile_pixel *)(void *)(t + 1); }
static float *floats_of(tile *t) { return (float *)(void *)(pixels_of(t) + TILE_PIXELS); }

static void starts_zeroed_and_holds_what_it_says(void **state) {
  (void)state;
  static const uint32_t counts[] = {0, 1, 2, 1000, 1u << 18};
  for (int k = 0; k < 5; ++k) {
    tile *t = tile_create(counts[k]);
    assert_non_null(t);
    assert_true(t->kind == TILE_STORED && t->floats == counts[k]);
    assert_true(t->near_depth == 0 && t->depth_rounding == 0);
    assert_int_equal(t->size, sizeof(tile) + TILE_PIXELS * sizeof(tile_pixel) + counts[k] * sizeof(float));
    assert_ptr_equal((const char *)tile_floats(t) + counts[k] * sizeof(float), (const char *)t + t->size);
    for (int i = 0; i < TILE_PIXELS; ++i) {
      assert_true(tile_pixels(t)[i].start == 0 && tile_pixels(t)[i].word == 0);
      assert_int_equal(tile_visibility(t, &tile_pixels(t)[i]).count, 0);
    }
    for (uint32_t i = 0; i < counts[k]; ++i) assert_true(tile_floats(t)[i] == 0);
    if (counts[k]) floats_of(t)[counts[k] - 1] = 1;   /* the address sanitizer sees whether it is there */
    tile_destroy(t);
  }
}

/* The address sanitizer would clear its record of all those gigabytes, and end the program for want of them. */
const char *__asan_default_options(void);
const char *__asan_default_options(void) { return "allocator_may_return_null=1:max_allocation_size_mb=1024"; }

/* More than the machine has, and more than 32 bits count in bytes: none at all, or as large as it says. */
static void a_size_out_of_range(void **state) {
  (void)state;
  static const uint32_t counts[] = {1u << 30, UINT32_MAX};
  for (int k = 0; k < 2; ++k) {
    tile *t = tile_create(counts[k]);
    if (!t) continue;
    assert_true((t->size - sizeof(tile) - TILE_PIXELS * sizeof(tile_pixel)) / sizeof(float) == counts[k]);
    assert_true(t->floats == counts[k]);
    floats_of(t)[counts[k] - 1] = 1;
    assert_true(tile_floats(t)[counts[k] - 1] == 1 && tile_floats(t)[0] == 0);
    tile_destroy(t);
  }
}

/* All 256 pixels in one block, grey and coloured in turns as chance has it, come back as they were put in. */
static void visibility_round_trip(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < 50; ++seed) {
    rng r = rng_seeded(seed);
    uint32_t count[TILE_PIXELS], channels[TILE_PIXELS], floats = 0;
    for (int i = 0; i < TILE_PIXELS; ++i) {
      count[i] = rng_below(&r, 9);
      channels[i] = rng_below(&r, 2) ? 3 : 1;
      floats += count[i] * (1 + channels[i]);
    }
    tile *t = tile_create(floats);
    assert_non_null(t);
    uint32_t at = 0;
    for (int i = 0; i < TILE_PIXELS; ++i) {
      pixels_of(t)[i] = (tile_pixel){at, count[i] | (channels[i] == 3 ? PIXEL_COLOURED : 0)};
      for (uint32_t k = 0; k < count[i]; ++k) {
        floats_of(t)[at + k] = (float)(k + 1);
        for (uint32_t c = 0; c < channels[i]; ++c)
          floats_of(t)[at + count[i] + k * channels[i] + c] = (float)i + 0.125f * (float)k + 0.01f * (float)c;
      }
      at += count[i] * (1 + channels[i]);
    }
    for (int i = 0; i < TILE_PIXELS; ++i) {
      visibility v = tile_visibility(t, &tile_pixels(t)[i]);
      assert_seeded(&r, v.count == count[i] && v.channels == channels[i]);
      assert_seeded(&r, v.value + v.count * v.channels <= tile_floats(t) + floats);
      for (uint32_t k = 0; k < count[i]; ++k) {
        uint32_t hint = rng_below(&r, 20);
        rgb seen = visibility_at(&v, k + 1 + 1e-6, &hint);
        for (uint32_t c = 0; c < 3; ++c)
          assert_seeded(&r, fabs(seen.c[c] - (i + 0.125 * k + (channels[i] == 3 ? 0.01 * c : 0))) < 1e-4);
      }
    }
    tile_destroy(t);
  }
}

static void flags_and_count_share_a_word(void **state) {
  (void)state;
  assert_int_equal(PIXEL_COLOURED ^ PIXEL_MARKED ^ PIXEL_COUNT, UINT32_MAX);
  assert_true((PIXEL_COLOURED & PIXEL_MARKED) == 0 && (PIXEL_COUNT & (PIXEL_COLOURED | PIXEL_MARKED)) == 0);
  tile *t = tile_create(0);
  assert_non_null(t);
  pixels_of(t)[0].word = PIXEL_MARKED;   /* nothing stored */
  pixels_of(t)[1].word = PIXEL_COLOURED | PIXEL_COUNT;
  assert_int_equal(tile_visibility(t, &tile_pixels(t)[0]).count, 0);
  assert_int_equal(tile_visibility(t, &tile_pixels(t)[1]).count, PIXEL_COUNT);
  tile_destroy(t);
}

static void shared_ones_may_be_destroyed(void **state) {
  (void)state;
  for (int k = 0; k < 2; ++k) {
    tile_destroy(&tile_lit);
    tile_destroy(&tile_failed);
    tile_destroy(NULL);
  }
  assert_true(tile_lit.kind == TILE_LIT && tile_failed.kind == TILE_FAILED);
  assert_true(tile_lit.size == sizeof(tile) && tile_failed.size == sizeof(tile));
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(starts_zeroed_and_holds_what_it_says),
    cmocka_unit_test(a_size_out_of_range),
    cmocka_unit_test(visibility_round_trip),
    cmocka_unit_test(flags_and_count_share_a_word),
    cmocka_unit_test(shared_ones_may_be_destroyed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
