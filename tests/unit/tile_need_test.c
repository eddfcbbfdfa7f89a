/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Which pixels of a tile want a finer level: those around edges, whatever lies where; not what runs straight, nor a slanted surface. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#include "bake/tile_need.h"

static baked_pixel pixels[TILE_PIXELS];
static vertices stored;
static const need_limits LIMITS = {0, 0.1, 0.01, 1};   /* pixels 0.1 wide */

/* A surface at depth z behind which `left` is left. */
static void put(uint32_t i, double z, double before, double left) {
  if (pixels[i].count == 0) pixels[i].first = stored.count;
  assert_int_equal(vertices_push(&stored, z, rgb_grey(before)), DSM_OK);
  assert_int_equal(vertices_push(&stored, z, rgb_grey(left)), DSM_OK);
  pixels[i].count += 2;
}

static void begin(void) {
  stored.count = 0;
  for (int i = 0; i < TILE_PIXELS; ++i) pixels[i] = (baked_pixel){0};
}

static int largest(void) {
  int most = 0;
  for (int i = 0; i < TILE_PIXELS; ++i)
    if (pixels[i].need > most) most = pixels[i].need;
  return most;
}

static void nothing_wants_nothing(void **state) {
  (void)state;
  begin();
  tile_need(pixels, &stored, &LIMITS);
  assert_int_equal(largest(), 0);
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) put(i, 3, 1, 0);
  tile_need(pixels, &stored, &LIMITS);
  assert_int_equal(largest(), 0);
}

static void straight_is_enough(void **state) {
  (void)state;
  begin();
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) put(i, 3, 1, 0.2 + 0.03 * (i % TILE_SIDE) + 0.02 * (i / TILE_SIDE));
  tile_need(pixels, &stored, &LIMITS);
  assert_int_equal(largest(), 0);
}

/* Up to 45 degrees from facing the light, in both directions; alone, and behind a glass that is even. */
static void slanted_ground_is_no_edge(void **state) {
  (void)state;
  for (int glass = 0; glass < 2; ++glass) {
    begin();
    for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
      if (glass) put(i, 1, 1, 0.6);
      put(i, 5 + 0.1 * (i % TILE_SIDE) + 0.05 * (i / TILE_SIDE), glass ? 0.6 : 1, 0);
    }
    tile_need(pixels, &stored, &LIMITS);
    assert_int_equal(largest(), 0);
  }
}

/* Grooves as narrow as pixels and nearly as deep shadow themselves, which no depth by itself tells. */
static void grooves_want_more(void **state) {
  (void)state;
  for (int deep = 0; deep < 2; ++deep) {
    begin();
    for (uint32_t i = 0; i < TILE_PIXELS; ++i) put(i, 5 + (i % 2 ? 0.06 : 0.02) * (1 + deep), 1, 0);
    tile_need(pixels, &stored, &LIMITS);
    for (uint32_t i = 0; i < TILE_PIXELS; ++i) assert_int_equal(pixels[i].need > NEED_OCTAVE, deep);
  }
}

/* All of what is read is the finer level's: more than an octave above what is let pass. */
static int is_wanted(int need) { return need > NEED_OCTAVE && need <= NEED_MOST; }

/* An occluder over half of a slanted ground: its edge is seen between the two, and nowhere else. */
static void an_edge_wants_more(void **state) {
  (void)state;
  for (int vertical = 0; vertical < 2; ++vertical) {
    begin();
    for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
      uint32_t x = i % TILE_SIDE, y = i / TILE_SIDE, at = vertical ? y : x;
      double half = at < 8 ? 1 : at == 8 ? 0.5 : 0;
      if (half < 1) put(i, 2, 1, half);
      if (half > 0) put(i, 5 + 0.08 * x, half, 0);
    }
    tile_need(pixels, &stored, &LIMITS);
    for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
      uint32_t at = vertical ? i / TILE_SIDE : i % TILE_SIDE;
      if (at >= 7 && at <= 9) assert_true(is_wanted(pixels[i].need));
      if (at < 6 || at > 10) assert_int_equal(pixels[i].need, 0);
    }
  }
}

/* At the tile's border too, where only one side of it is seen. */
static void an_edge_at_the_border_wants_more(void **state) {
  (void)state;
  begin();
  for (uint32_t i = 0; i < TILE_PIXELS; ++i)
    if (i % TILE_SIDE > 0) put(i, 2, 1, 0);
  tile_need(pixels, &stored, &LIMITS);
  for (uint32_t i = 0; i < TILE_PIXELS; ++i)
    if (i % TILE_SIDE < 2) assert_true(is_wanted(pixels[i].need));
    else if (i / TILE_SIDE > 0 && i / TILE_SIDE < TILE_SIDE - 1 && i % TILE_SIDE < TILE_SIDE - 1) assert_int_equal(pixels[i].need, 0);
}

/* What is not known is asked for where light can grow, but not amid such pixels, nor where nobody looks, and bends nothing next to it. */
static void unknown_pixels(void **state) {
  (void)state;
  begin();
  for (uint32_t i = 0; i < TILE_PIXELS; ++i)
    if (i % TILE_SIDE < 8) put(i, 3, 1, 0.3);
    else if (i / TILE_SIDE < 8) pixels[i].absent = 1;
    else pixels[i].marked = 1;
  tile_need(pixels, &stored, &LIMITS);
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    int rim = i % TILE_SIDE == 8 || i / TILE_SIDE == 8;
    assert_int_equal(pixels[i].need, pixels[i].marked && rim ? NEED_ALWAYS : 0);
  }
}

/* Noise is known to be there: bends of that size are expected. */
static void noise_is_forgiven(void **state) {
  (void)state;
  for (int known = 0; known < 2; ++known) {
    begin();
    for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
      put(i, 3, 1, 0.5 + ((i * 7 + i / TILE_SIDE * 3) % 5 < 2 ? 0.05 : -0.05));
      pixels[i].variance = known ? 0.05 : 0;
    }
    tile_need(pixels, &stored, &LIMITS);
    if (known) assert_int_equal(largest(), 0);
    else assert_true(is_wanted(largest()));
  }
}

/* Few pixels are enough for what runs straight, and for what curves a little; not for a step, wherever it lies, in any colour. */
static void few_pixels_are_enough_without_steps(void **state) {
  (void)state;
  const sparse_grid grid = {4, {0, 5, 10, 15}, {0, 5, 10, 15}};
  for (int kind = 0; kind < 4; ++kind)
    for (uint32_t edge = 1; edge < TILE_SIDE; ++edge)
      for (int vertical = 0; vertical < 2; ++vertical) {
        begin();
        for (uint32_t k = 0; k < 16; ++k) {
          uint32_t x = grid.x[k % 4], y = grid.y[k / 4], at = vertical ? y : x, i = sparse_place(&grid, k % 4, k / 4);
          double straight = 0.9 - 0.02 * x - 0.03 * y, curve = 0.5 + 0.0005 * (x - 7.0) * (x - 7.0) - 0.0005 * (y - 7.0) * (y - 7.0), step = at < edge ? 0.8 : 0.55;
          put(i, 3, 1, kind == 0 ? straight : kind == 1 ? curve : step);
          if (kind == 3) stored.data[pixels[i].first + 1].v = (rgb){{0.8, 0.8, step}};
          pixels[i].coloured = kind == 3;
        }
        assert_int_equal(sparse_is_enough(pixels, &stored, &LIMITS, &grid, 0), kind < 2);
        assert_int_equal(sparse_is_enough(pixels, &stored, &LIMITS, &grid, 1), kind < 2);
      }
  vertices_free(&stored);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(nothing_wants_nothing),
    cmocka_unit_test(straight_is_enough),
    cmocka_unit_test(slanted_ground_is_no_edge),
    cmocka_unit_test(grooves_want_more),
    cmocka_unit_test(an_edge_wants_more),
    cmocka_unit_test(an_edge_at_the_border_wants_more),
    cmocka_unit_test(unknown_pixels),
    cmocka_unit_test(noise_is_forgiven),
    cmocka_unit_test(few_pixels_are_enough_without_steps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
