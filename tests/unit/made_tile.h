/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Random tiles of every kind, and what holds of every tile that may be looked at. Include after cmocka.h. */
#ifndef TESTS_MADE_TILE_H
#define TESTS_MADE_TILE_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/vertices.h"
#include "map/read_tile.h"
#include "map/tile_words.h"
#include "plain_tile.h"
#include "random.h"

static inline int same_tiles(const tile *a, const tile *b) {
  if (a->kind != TILE_STORED || b->kind != TILE_STORED) return a == b;
  return a->near_depth == b->near_depth && a->tolerance == b->tolerance
      && a->size == b->size && a->layout == b->layout && memcmp(&a->codes, &b->codes, sizeof a->codes) == 0
      && memcmp(a + 1, b + 1, a->size - sizeof(tile)) == 0;
}

/* Grey or coloured, marked, wide, refined, of deltas, of whole depths and of floats: as compact as it gets, or not at all. */
static inline tile *any_tile(rng *r) {
  tile_plan plan = {.count = {0}};
  uint32_t most = rng_below(r, 10) ? 12 : 350, colours = rng_below(r, 3) == 0, marks = rng_below(r, 2), needs = rng_below(r, 2);
  for (int i = 0; i < TILE_PIXELS; ++i) {
    plan.marked[i] = marks && rng_below(r, 20) == 0;
    plan.count[i] = plan.marked[i] || rng_below(r, 4) == 0 ? 0 : rng_below(r, most);
    plan.coloured[i] = colours && plan.count[i] && rng_below(r, 9) == 0;
    plan.need[i] = (unsigned char)(needs && rng_below(r, 3) == 0 ? rng_below(r, 256) : 0);
  }
  tile *t = tile_create(&plan);
  assert_non_null(t);
  t->near_depth = rng_scale(r, 1e-9, 1e9);
  t->tolerance = (float)rng_unit(r);
  uint32_t value_bits = 2 + rng_below(r, VALUE_BITS - 1), top = (1u << value_bits) - 1, farthest = 1u << (4 + rng_below(r, 20));
  double quantum = rng_below(r, 4) ? ldexp(1, (int)rng_below(r, 100) - 60) : 0;
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    uint32_t step = 0, code[3] = {top, top, top};
    float z = 0;
    for (uint32_t n = 0; n < plan.count[i]; ++n) {
      uint32_t more = n == 1 ? 1 : rng_below(r, 3) * rng_below(r, 2 + farthest / 64);   /* no deltas tell 1 and less at one depth */
      step = step + more < farthest - 1 ? step + more : step;
      z = quantum > 0 ? (float)(step * quantum) : z + (float)(rng_below(r, 3) * rng_unit(r));
      for (uint32_t c = 0; c < (plan.coloured[i] ? 3u : 1u); ++c) {
        if (n > 0 || rng_below(r, 2)) code[c] -= rng_below(r, 2) * rng_below(r, 1 + code[c] / 4);
        uint32_t lower = plan.coloured[i] && n == 0 && c == 2 && code[0] == code[1] && code[1] == code[2] && code[2];
        tile_put(t, i, n, c, z, (uint16_t)value_of_code(code[c] -= lower, top));
      }
    }
  }
  return rng_below(r, 8) ? tile_compact(t) : t;
}

static inline double value_there(const tile *t, const visibility *v, double z, rng *r) {
  uint32_t hint = rng_below(r, 20);
  rgb value = visibility_at(v, z, &hint);
  for (int c = 0; c < 3; ++c) assert_seeded(r, value.c[c] >= 0 && value.c[c] <= 1);
  if (v->count && (t->layout & ~TILE_REFINED) == 0 && !codes_are_deltas(&t->codes)) {   /* as look-ups take it that know the length of records */
    uint32_t bytes = t->codes.record_bits / 8u;
    visibility_place a = {0}, b = {0};
    if (bytes == 3 || bytes == 4 || bytes == 6 || (bytes == 5 && codes_are_whole(&t->codes))) {
      int whole = bytes != 6, found = visibility_find(v, visibility_key_of(v->codes, z), &hint, &a);
      assert_seeded(r, found == visibility_find_as(v, visibility_key_as(v->codes, z, whole), &hint, &b, bytes, whole));
      assert_seeded(r, !found || (a.t == b.t && a.front == b.front && a.behind == b.behind));
    }
  }
  return value.c[0];
}

/* Depths are finite and never fall, values are in [0,1] and never grow, at the vertices, between them, and in front of and behind all. */
static inline void walk_pixel(rng *r, const tile *t, uint32_t place) {
  visibility v = tile_visibility(t, place);
  vertices read = {0};
  assert_int_equal(read_pixel(t, place, &read), DSM_OK);
  assert_seeded(r, read.count == v.count && (v.channels == 1 || v.channels == 3));
  double before = 1, last = 0;
  for (uint32_t i = 0; i < v.count; ++i) {
    const vertex *now = &read.data[i], *old = i ? &read.data[i - 1] : now;
    double z = now->z - t->near_depth;
    assert_seeded(r, now->z < HUGE_VAL && z >= 0 && now->z >= old->z);
    for (int c = 0; c < 3; ++c) assert_seeded(r, now->v.c[c] >= 0 && now->v.c[c] <= old->v.c[c] && old->v.c[c] <= 1);
    double at = visibility_depth(&v, i);
    assert_seeded(r, at >= last);
    double between = last + rng_unit(r) * (at - last), first = value_there(t, &v, between, r), second = value_there(t, &v, at, r);
    assert_seeded(r, first <= before + 1e-12 && second <= first + 1e-12);
    before = second;
    last = at;
  }
  assert_seeded(r, value_there(t, &v, -1, r) == 1 && value_there(t, &v, NAN, r) == 1);
  assert_seeded(r, value_there(t, &v, HUGE_VAL, r) <= before && value_there(t, &v, 1e300, r) <= before);
  assert_seeded(r, !tile_is_marked(t, place) || v.count == 0);
  assert_seeded(r, tile_need_at(t, place) <= 255);
  vertices_free(&read);
}

static inline void walk_tile(rng *r, const tile *t) {
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) walk_pixel(r, t, i);
}

/* Bit for bit, at any depth. */
static inline void same_answers(rng *r, const tile *a, const tile *b) {
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    visibility v = tile_visibility(a, i), w = tile_visibility(b, i);
    assert_seeded(r, v.count == w.count && v.channels == w.channels && tile_is_marked(a, i) == tile_is_marked(b, i));
    assert_seeded(r, tile_need_at(a, i) == tile_need_at(b, i));
    for (int k = 0; k < 8 && v.count; ++k) {
      double z = visibility_depth(&v, rng_below(r, v.count)) * (rng_below(r, 2) ? 1 : rng_between(r, 0.5, 1.5));
      uint32_t hint = rng_below(r, 20), other = rng_below(r, 20);
      rgb x = visibility_at(&v, z, &hint), y = visibility_at(&w, z, &other);
      assert_memory_equal(&x, &y, sizeof x);
    }
  }
}

#endif
