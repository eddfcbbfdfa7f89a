/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "plain_tile.h"
#include "random.h"

typedef struct { tile_plan plan; uint64_t records; int coloured, marked; } planned;

/* A record for each vertex, two for a coloured one, of 6 bytes as long as the tile is not compact. */
static void plan_pixel(planned *p, int place, uint32_t count, int coloured, int marked) {
  p->plan.count[place] = count;
  p->plan.coloured[place] = coloured != 0;
  p->plan.marked[place] = marked != 0;
  p->records += (uint64_t)count * (coloured ? 2 : 1);
  p->coloured |= coloured;
  p->marked |= marked;
}

/* Whether 16 bits do not count the records in front of eight pixels, or a byte those of one. */
static int is_wide(const planned *p) {
  uint64_t before = 0;
  for (int group = 0; group < 32; ++group) {
    uint64_t in_group = 0, most = 0;
    for (int i = 8 * group; i < 8 * group + 8; ++i) {
      uint64_t n = (uint64_t)p->plan.count[i] * (p->plan.coloured[i] ? 2 : 1);
      in_group += n;
      most = n > most ? n : most;
    }
    if (most > 255 || before > 65535) return 1;
    before += in_group;
  }
  return 0;
}

static size_t size_of(const planned *p) {
  size_t table = is_wide(p) ? 257 * 4 : 32 * 2 + 256;
  return sizeof(tile) + table + (p->coloured ? 32 : 0) + (p->marked ? 32 : 0) + 6 * p->records;
}

static float depth_of(int place, uint32_t k) { return (float)k + 0.001f * (float)place; }
static uint16_t value_of(int place, uint32_t k, uint32_t c) { return (uint16_t)(place * 7919u + k * 31u + c * 13u); }

static void fill(tile *t, const planned *p) {
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    uint32_t channels = p->plan.coloured[i] ? 3 : 1;
    for (uint32_t k = 0; k < p->plan.count[i]; ++k) {
      for (uint32_t c = 0; c < channels; ++c) tile_put(t, i, k, c, depth_of((int)i, k), value_of((int)i, k, c));
    }
  }
}

/* The address sanitizer watches both ends. */
static int holds(const tile *t, const planned *p) {
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    visibility v = tile_visibility(t, i);
    uint32_t channels = p->plan.coloured[i] ? 3 : 1;
    if (v.count != p->plan.count[i] || v.channels != channels) return 0;
    if (!tile_is_coloured(t, i) != !p->plan.coloured[i] || !tile_is_marked(t, i) != !p->plan.marked[i]) return 0;
    for (uint32_t k = 0; k < v.count; ++k) {
      if (visibility_depth(&v, k) != depth_of((int)i, k)) return 0;
      for (uint32_t c = 0; c < channels; ++c)
        if (visibility_stored(&v, k, c) != value_of((int)i, k, c)) return 0;
    }
  }
  return 1;
}

static void check_round_trip(const planned *p) {
  tile *t = tile_create(&p->plan);
  assert_non_null(t);
  assert_true(t->kind == TILE_STORED && t->near_depth == 0 && t->tolerance == 0);
  assert_int_equal(t->size, size_of(p));
  assert_int_equal(t->layout, (is_wide(p) ? TILE_WIDE : 0) | (p->coloured ? TILE_COLOURED : 0)
                                  | (p->marked ? TILE_MARKED : 0));
  for (const char *zero = (const char *)t + t->codes.records; zero < (const char *)t + t->size; ++zero) assert_true(!*zero);
  fill(t, p);
  assert_true(holds(t, p));
  tile_destroy(t);
}

static void optional_parts_are_there_when_needed(void **state) {
  (void)state;
  for (int parts = 0; parts < 4; ++parts)
    for (int place = 0; place < TILE_PIXELS; place += 51) {   /* the first, the last, and across the bytes of a bitmap */
      planned p = {0};
      if (parts & 1) plan_pixel(&p, place, 3, 1, 0);
      if (parts & 2) plan_pixel(&p, TILE_PIXELS - 1 - place, 0, 0, 1);
      check_round_trip(&p);
    }
}

/* An odd number of values leaves half a word over; no count may be taken for its neighbour. */
static void any_count_comes_back(void **state) {
  (void)state;
  for (uint32_t count = 0; count < 600; ++count)
    for (int coloured = 0; coloured < 2; ++coloured) {
      planned p = {0};
      plan_pixel(&p, 7, count, coloured, 0);
      plan_pixel(&p, 8, 1, !coloured, 0);
      plan_pixel(&p, 255, count + 1, coloured, 0);
      check_round_trip(&p);
    }
}

/* 255 records in a pixel are the most that a byte counts; 16 bits count those in front of the last of eight pixels. */
static void wide_from_where_a_byte_ends(void **state) {
  (void)state;
  for (uint32_t more = 0; more < 2; ++more)
    for (int place = 0; place < TILE_PIXELS; place += 51) {
      planned one = {0}, group = {0}, coloured = {0};
      plan_pixel(&one, place, 255 + more, 0, 0);
      check_round_trip(&one);
      assert_true(is_wide(&one) == (int)more);
      for (int i = 0; i < 7; ++i) plan_pixel(&group, place / 8 * 8 + i, i ? 255 : 254 + more, 0, 0);
      plan_pixel(&group, place / 8 * 8 + 7, 255, 0, 0);
      check_round_trip(&group);
      assert_true(!is_wide(&group));
      plan_pixel(&coloured, place, 127 + more, 1, 0);
      check_round_trip(&coloured);
      assert_true(is_wide(&coloured) == (int)more);
    }
}

/* Grey, coloured, lit and marked in turns as chance has it; some with more than 16 bits count. */
static void any_mixture(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(400); ++seed) {
    rng r = rng_seeded(seed);
    planned p = {0};
    uint32_t most = seed % 4 ? 9 : 1500;
    for (int i = 0; i < TILE_PIXELS; ++i) {
      uint32_t what = rng_below(&r, 8);
      plan_pixel(&p, i, what < 2 ? 0 : rng_below(&r, most), what > 4, what == 0);
    }
    tile *t = tile_create(&p.plan);
    assert_non_null(t);
    assert_seeded(&r, t->size == size_of(&p));
    fill(t, &p);
    assert_seeded(&r, holds(t, &p));
    assert_seeded(&r, !(t->layout & TILE_WIDE) == !is_wide(&p));
    tile_destroy(t);
  }
}

/* The address sanitizer would clear its record of all those gigabytes, and end the program for want of them. */
const char *__asan_default_options(void);
const char *__asan_default_options(void) { return "allocator_may_return_null=1:max_allocation_size_mb=1024"; }

/* More than 32 bits count in bytes, in one pixel or in all together. */
static void a_size_out_of_range(void **state) {
  (void)state;
  planned one = {0}, all = {0};
  plan_pixel(&one, 3, UINT32_MAX, 1, 0);
  assert_null(tile_create(&one.plan));
  for (int i = 0; i < TILE_PIXELS; ++i) plan_pixel(&all, i, 1u << 22, 0, 0);
  assert_null(tile_create(&all.plan));
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
    cmocka_unit_test(optional_parts_are_there_when_needed),
    cmocka_unit_test(any_count_comes_back),
    cmocka_unit_test(wide_from_where_a_byte_ends),
    cmocka_unit_test(any_mixture),
    cmocka_unit_test(a_size_out_of_range),
    cmocka_unit_test(shared_ones_may_be_destroyed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
