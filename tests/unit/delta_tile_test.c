/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include <math.h>

#include "map/delta_tile.h"
#include "random.h"

enum { MOST = 501 };

/* Pixels as codes, and the tile that tells them in deltas; NULL: there is none. */
typedef struct {
  uint32_t count[TILE_PIXELS], depth[TILE_PIXELS][MOST], value[TILE_PIXELS][MOST];
  unsigned char marked[TILE_PIXELS], coloured[TILE_PIXELS], need[TILE_PIXELS];
  double quantum;
  uint32_t value_bits;
  tile *deltas;
} pixels;

static void make(pixels *p) {
  coded_tile t = {.per_quantum = 1 / p->quantum, .depth_bits = MOST_CODE_BITS, .value_bits = p->value_bits,
                  .near_depth = 7.5, .tolerance = 0.25f, .volume = 1};
  memcpy(t.plan.count, p->count, sizeof t.plan.count);
  memcpy(t.plan.coloured, p->coloured, sizeof t.plan.coloured);
  memcpy(t.plan.marked, p->marked, sizeof t.plan.marked);
  memcpy(t.plan.need, p->need, sizeof t.plan.need);
  t.vertices = malloc(TILE_PIXELS * MOST * sizeof *t.vertices);
  for (uint32_t i = 0; i < TILE_PIXELS; ++i)
    for (uint32_t k = 0; k < p->count[i]; ++k) {
      uint16_t value = (uint16_t)p->value[i][k];
      t.vertices[t.count++] = (coded_vertex){p->depth[i][k], {value, value, value}};
    }
  delta_plan plan;
  p->deltas = delta_tile_plan(&t, UINT64_MAX, &plan) ? delta_tile(&t, &plan) : NULL;
  free(t.vertices);
}

/* A number of so many bits or fewer, every length alike. */
static uint32_t any_number(rng *r, uint32_t bits) {
  uint32_t length = rng_below(r, bits + 1);
  return length ? rng_below(r, 1u << length) : 0;
}

/* Small deltas mostly, so that large ones do not fit; depths up to 24 bits. */
static void any_pixels(rng *r, pixels *p) {
  memset(p, 0, sizeof *p);
  p->quantum = ldexp(1, (int)rng_below(r, 40) - 30);
  p->value_bits = 1 + rng_below(r, VALUE_BITS);
  uint32_t most = (1u << p->value_bits) - 1, small = rng_below(r, 9), rare = 2 + rng_below(r, 40), long_start = rng_below(r, 24);
  uint32_t longest = rng_below(r, 8) ? 12 : 60;
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    p->need[i] = (unsigned char)(rng_below(r, 3) == 0 && most % 2 ? i : 0);
    p->marked[i] = rng_below(r, 40) == 0;
    p->count[i] = p->marked[i] ? 0 : rng_below(r, longest);
    uint32_t depth = any_number(r, long_start), value = rng_below(r, 2) ? most : most - any_number(r, p->value_bits);
    for (uint32_t k = 0; k < p->count[i]; ++k) {
      uint32_t room = ((1u << MOST_CODE_BITS) - 2) - depth, fall = any_number(r, rng_below(r, rare) ? p->value_bits / 3 : p->value_bits);
      uint32_t deeper = any_number(r, rng_below(r, rare) ? small : 23);
      if (k == 1 && p->value[i][0] == most && deeper == 0) deeper = 1;
      depth += k == 0 ? 0 : deeper < room ? deeper : room;
      value -= k == 0 ? 0 : fall < value ? fall : value;
      p->depth[i][k] = depth;
      p->value[i][k] = value;
    }
  }
}

static void check_numbers(rng *r, const pixels *p) {
  const tile *t = p->deltas;
  assert_seeded(r, t->near_depth == 7.5 && t->tolerance == 0.25f && t->volume == 1 && t->kind == TILE_STORED);
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    visibility v = tile_visibility(t, i);
    assert_seeded(r, v.count == p->count[i] && v.channels == 1 && !tile_is_marked(t, i) == !p->marked[i]);
    assert_seeded(r, tile_need_at(t, i) == p->need[i]);
    for (uint32_t k = 0; k < v.count; ++k) {
      assert_seeded(r, visibility_depth(&v, k) == p->depth[i][k] * p->quantum);
      assert_seeded(r, visibility_code(&v, k, 0) == p->value[i][k]);
    }
  }
}

/* What absolute records give, to the last bit: the same codes in the same formula. */
static double value_at(const pixels *p, uint32_t place, double z) {
  uint32_t most = (1u << p->value_bits) - 1, behind = 0, count = p->count[place];
  double unit = 1.0 / most, at = z / p->quantum;
  while (behind < count && p->depth[place][behind] < at) ++behind;
  if (behind == 0) return 1;
  double a = p->value[place][behind - 1], near_end = p->depth[place][behind - 1];
  if (behind == count) return unit * a;
  return unit * (a + (at - near_end) / (p->depth[place][behind] - near_end) * (p->value[place][behind] - a));
}

static double any_depth(rng *r, const pixels *p, uint32_t place) {
  double z = p->depth[place][rng_below(r, p->count[place])] * p->quantum;
  switch (rng_below(r, 6)) {
    case 0: return nextafter(z, HUGE_VAL);
    case 1: return nextafter(z, -HUGE_VAL);
    case 2: return z * rng_between(r, 0.5, 1.5);
    case 3: return z + rng_between(r, -3, 3) * p->quantum;
    case 4: return rng_below(r, 9) ? rng_unit(r) * p->depth[place][p->count[place] - 1] * p->quantum : 1e300;
    default: return z;
  }
}

static void check_look_ups(rng *r, const pixels *p, int times) {
  const visibility_codes *codes = &p->deltas->codes;
  delta_word_shape shape = delta_shape_of(codes);
  delta_mark marks[TILE_PIXELS];   /* of the last search in each pixel */
  int marked[TILE_PIXELS] = {0};
  for (int n = 0; n < times; ++n) {
    uint32_t place = rng_below(r, TILE_PIXELS), hint = 0;
    visibility v = tile_visibility(p->deltas, place);
    if (!v.count) continue;
    double z = any_depth(r, p, place);
    assert_seeded(r, visibility_at(&v, z, &hint).c[0] == value_at(p, place, z));
    visibility_key key = visibility_key_of(codes, z);
    visibility_place from_mark;
    delta_walk again = marked[place] ? delta_resume(&shape, v.first, v.records, &marks[place], key.word >> DELTA_SHIFT)
                                     : delta_begin(&shape, v.first, v.records);
    marks[place] = (delta_mark){again.at, again.depth, again.fall};
    marked[place] = 1;
    int behind = delta_find(codes, &shape, &again, key, &from_mark, &marks[place]);
    assert_seeded(r, (behind ? visibility_value(&v, &from_mark, 0) : 1) == value_at(p, place, z));
    /* One walk for depths in order. */
    delta_walk walk = delta_begin(&shape, v.first, v.records);
    delta_mark mark;
    for (int k = 0; k < 4; ++k, z = fmax(z, any_depth(r, p, place))) {
      visibility_place at;
      int found = delta_find(codes, &shape, &walk, visibility_key_of(codes, z), &at, &mark);
      assert_seeded(r, (found ? visibility_value(&v, &at, 0) : 1) == value_at(p, place, z));
    }
  }
}

/* A record each, the start's second one, and those that only add. */
static uint32_t more_records(const pixels *p) {
  uint32_t least = 0;
  for (uint32_t i = 0; i < TILE_PIXELS; ++i)
    least += p->count[i] ? p->count[i] + (p->value[i][0] < (1u << p->value_bits) - 1) : 0;
  return tile_first(p->deltas, TILE_PIXELS - 1) + tile_records(p->deltas, TILE_PIXELS - 1) - least;
}

static void any_tile_comes_back(void **state) {
  (void)state;
  pixels *p = malloc(sizeof *p);
  uint32_t made = 0, adding = 0;
  for (uint64_t seed = 0; seed < most_cases(800); ++seed) {
    rng r = rng_seeded(seed);
    any_pixels(&r, p);
    make(p);
    if (!p->deltas) continue;
    ++made;
    adding += more_records(p) > 0;
    check_numbers(&r, p);
    check_look_ups(&r, p, 1000);
    tile_destroy(p->deltas);
  }
  assert_true(made > most_cases(800) / 2 && adding > made / 2);
  free(p);
}

/* One pixel alone of these vertices. */
static void put(pixels *p, uint32_t place, uint32_t count, const uint32_t depth[], const uint32_t value[]) {
  p->count[place] = count;
  memcpy(p->depth[place], depth, count * sizeof *depth);
  memcpy(p->value[place], value, count * sizeof *value);
}

static void whatever_a_pixel_begins_or_ends_with(void **state) {
  (void)state;
  rng r = rng_seeded(1);
  static const uint32_t depths[][4] = {{0, 0, 0, 0}, {0, 1, 1, 2}, {9000000, 9000001, 9000001, 9000002}, {0, 0, 9000000, 9000000},
                                       {1, 16777213, 16777213, 16777213}};
  static const uint32_t values[][4] = {{511, 511, 511, 511}, {0, 0, 0, 0}, {511, 511, 0, 0}, {511, 510, 509, 0}, {300, 299, 1, 0}};
  pixels *p = malloc(sizeof *p);
  for (uint32_t count = 1; count <= 4; ++count)
    for (int d = 0; d < 5; ++d)
      for (int v = 0; v < 5; ++v)
        for (uint32_t place = 0; place < TILE_PIXELS; place += 51) {
          memset(p, 0, sizeof *p);
          p->quantum = 0.5;
          p->value_bits = 9;
          put(p, place, count, depths[d], values[v]);
          make(p);
          int twice = count > 1 && values[v][0] == 511 && depths[d][0] == depths[d][1];   /* begins with 1 at one depth */
          assert_true((p->deltas == NULL) == twice);
          if (!p->deltas) continue;
          check_numbers(&r, p);
          check_look_ups(&r, p, 500);
          tile_destroy(p->deltas);
        }
  free(p);
}

/* Of 500 records; there is no such tile of one more, nor of colours, nor of values that grow. */
static void limits(void **state) {
  (void)state;
  rng r = rng_seeded(2);
  pixels *p = malloc(sizeof *p);
  for (uint32_t kind = 0; kind < 4; ++kind) {
    memset(p, 0, sizeof *p);
    p->quantum = 1;
    p->value_bits = 9;
    p->count[255] = 500 + (kind == 1);
    for (uint32_t k = 0; k < MOST; ++k) {
      p->depth[255][k] = 3 * k;
      p->value[255][k] = 511 - k + (kind == 3 && k == 40 ? 2 : 0);
    }
    p->coloured[255] = kind == 2;
    make(p);
    assert_true((p->deltas == NULL) == (kind > 0));
    if (!p->deltas) continue;
    assert_true(tile_records(p->deltas, 255) == 500);
    check_numbers(&r, p);
    check_look_ups(&r, p, 20000);
    tile_destroy(p->deltas);
  }
  free(p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(any_tile_comes_back),
    cmocka_unit_test(whatever_a_pixel_begins_or_ends_with),
    cmocka_unit_test(limits),
  };
  return cmocka_run_group_tests_name("tile of deltas", tests, NULL, NULL);
}
