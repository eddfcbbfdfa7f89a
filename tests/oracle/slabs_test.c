/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Stacks of coloured glass sheets across the light: the products of their transmittances, exact between them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "map/tile.h"
#include "oracle.h"

enum { SHEETS = 7 };
static const double DEPTHS[] = {1e-3, 1e-2, 1, 300, 1e5};

static void fill(shape *sheets, double first, double gap, double half, double product[SHEETS + 1][3]) {
  for (int c = 0; c < 3; ++c) product[0][c] = 1;
  for (int i = 0; i < SHEETS; ++i) {
    sheets[i] = sheet_at(first + gap * i, half, 0.95 - 0.1 * (i % 3), 0.8, 0.7 + 0.05 * i);
    for (int c = 0; c < 3; ++c) product[i + 1][c] = product[i][c] * sheets[i].pass[c];
  }
}

static void check(stage *s, double first, double gap, double reach, double product[SHEETS + 1][3], double error) {
  rng r = rng_seeded(11);
  for (int k = 0; k < 400; ++k) {
    int i = (int)rng_below(&r, SHEETS + 1);
    /* strictly between sheets i-1 and i; seen obliquely the sheets do not lie at one depth over a pixel */
    double z = first + gap * (i - 0.5), x = reach * rng_between(&r, -1, 1), y = reach * rng_between(&r, -1, 1);
    for (int c = 0; c < 3; ++c) assert_true(fabs(light_of(s, in_air(x, y, z), c) - product[i][c]) <= error);
    /* the surface of a sheet itself, from its lit side and from behind */
    if (i < SHEETS) {
      double on = light_of(s, on_plane(x, y, first + gap * i, 0, 0, -1), 1);
      assert_true(fabs(on - product[i][1]) <= error);
    }
  }
}

static void parallel_light(void **state) {
  (void)state;
  for (size_t d = 0; d < sizeof DEPTHS / sizeof *DEPTHS; ++d) {
    double first = DEPTHS[d], gap = first / 8, product[SHEETS + 1][3];
    shape sheets[SHEETS];
    fill(sheets, first, gap, first, product);
    for (int exact = 0; exact < 2; ++exact) {
      stage s;
      stage_open(&s, sheets, SHEETS, parallel_at(0, 0, 0, 0, 0, 1),
                 WORDS("resolution 40", exact ? "tolerance 0" : "tolerance 0.01"));
      check(&s, first, gap, 0.9 * first, product, exact ? 1e-5 : 0.01 + 1e-5);
      stage_close(&s);
    }
  }
}

static void spotlight(void **state) {
  (void)state;
  for (size_t d = 0; d < sizeof DEPTHS / sizeof *DEPTHS; ++d) {
    double first = DEPTHS[d], gap = first / 8, product[SHEETS + 1][3];
    shape sheets[SHEETS];
    fill(sheets, first, gap, first, product);
    stage s;
    stage_open(&s, sheets, SHEETS, spot_at(0, 0, 0, 0, 0, 1, 30), WORDS("resolution 200", "tolerance 0.005", "samples 4"));
    check(&s, first, gap, 0.4 * first, product, 0.005 + 1e-5);
    stage_close(&s);
  }
}

/* Grey glass stores one channel, coloured three. */
static void grey_pixels_store_one_channel(void **state) {
  (void)state;
  shape sheet[1] = {sheet_at(1, 1, 0.5, 0.5, 0.5)};
  dsm_statistics grey = {.size = sizeof grey}, coloured = {.size = sizeof coloured};
  for (int k = 0; k < 2; ++k) {
    stage s;
    stage_open(&s, sheet, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 16"));
    light_of(&s, in_air(0, 0, 2), 0);
    dsm_api.statistics(s.map, k ? &coloured : &grey);
    stage_close(&s);
    sheet[0].pass[0] = 0.25;
  }
  assert_int_equal(grey.pixels_coloured, 0);
  assert_int_equal(grey.pixels, coloured.pixels_baked);
  assert_true(coloured.pixels_coloured >= 14 * 14);
  assert_int_equal(grey.vertices, coloured.vertices);
  /* a second record a vertex, both of at most 6 bytes, and a tile's list of its coloured pixels */
  assert_true(coloured.bytes > grey.bytes && coloured.bytes - grey.bytes <= 6 * coloured.vertices + TILE_PIXELS / 8);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(parallel_light),
    cmocka_unit_test(spotlight),
    cmocka_unit_test(grey_pixels_store_one_channel),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
