/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The tiles that a look-up is said to want are those that it makes: all of them, and no others. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"

enum { SIDE = 64, SEED = 5 };

typedef struct {
  unsigned char finest[6][SIDE][SIDE];
  int told;
} wishes;

static void note(void *data, const dsm_tiles *tiles) {
  wishes *w = data;
  w->told++;
  assert_true(tiles->face < 6 && tiles->past_x <= SIDE && tiles->past_y <= SIDE);
  assert_true(tiles->x < tiles->past_x && tiles->past_x <= tiles->x + (1u << tiles->level));
  assert_true(tiles->y < tiles->past_y && tiles->past_y <= tiles->y + (1u << tiles->level));
  for (uint32_t y = tiles->y; y < tiles->past_y; ++y)
    for (uint32_t x = tiles->x; x < tiles->past_x; ++x) w->finest[tiles->face][y][x] = 1;
}

static uint64_t rays_of(const stage *s) {
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(s->map, &got);
  return got.rays;
}

static void try_receiver(dsm_light light, const dsm_receiver *at) {
  shape all[] = {sphere_at(0, 0, 5, 1, 0.5), sphere_at(1, 2, 7, 0.5, 0), sheet_at(-3, 1, 0.2, 0.4, 0.6)};
  stage asked, baked;
  double rgb[3], same[3];
  static wishes w;
  memset(&w, 0, sizeof w);
  stage_open(&asked, all, 3, light, WORDS("resolution 200", "samples 4"));
  stage_open(&baked, all, 3, light, WORDS("resolution 200", "samples 4"));

  assert_int_equal(dsm_api.tiles_wanted(asked.worker, at, note, &w), DSM_OK);
  assert_int_equal(rays_of(&asked), 0);
  for (uint32_t f = 0; f < 6; ++f)
    for (uint32_t y = 0; y < SIDE; ++y)
      for (uint32_t x = 0; x < SIDE; ++x)
        if (w.finest[f][y][x]) assert_int_equal(dsm_api.bake_tile(baked.worker, f, x, y), DSM_OK);
  uint64_t rays = rays_of(&baked);
  dsm_result result = dsm_api.lookup(asked.worker, at, rgb);
  assert_int_equal(dsm_api.lookup(baked.worker, at, same), result);
  assert_true(rays_of(&baked) == rays && rays_of(&asked) == rays);   /* none was missing, none too many */
  if (result == DSM_OK) assert_memory_equal(rgb, same, sizeof rgb);

  w.told = 0;
  assert_int_equal(dsm_api.tiles_wanted(asked.worker, at, note, &w), DSM_OK);
  assert_int_equal(w.told, 0);   /* all are there */
  stage_close(&asked);
  stage_close(&baked);
}

static void wanted_tiles_are_those_made(void **state) {
  (void)state;
  rng r = rng_seeded(SEED);
  print_message("seed %d\n", SEED);
  for (int k = 0; k < 60; ++k) {
    dsm_light light = k % 3 == 0 ? spot_at(0, 0, 0, 0, 0, 1, 30) : k % 3 == 1 ? point_at(0.2, 0.1, 0) : parallel_at(0, 0, -9, 0, 0, 1);
    dsm_receiver at = in_air(rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 5, 9));
    if (k % 2) {
      double size = pow(10, rng_between(&r, -3, 0.5));
      at.has_footprint = 1;
      at.footprint[0][0] = size;
      at.footprint[1][1] = size * rng_between(&r, 0.1, 1);
    }
    try_receiver(light, &at);
  }
}

static void tiles_outside_are_refused(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  stage s;
  stage_open(&s, &ball, 1, spot_at(0, 0, 0, 0, 0, 1, 30), WORDS("resolution 32"));
  assert_int_equal(dsm_api.bake_tile(s.worker, 1, 0, 0), DSM_INVALID);
  assert_int_equal(dsm_api.bake_tile(s.worker, 0, 2, 0), DSM_INVALID);
  assert_int_equal(dsm_api.bake_tile(s.worker, 0, 0, 2), DSM_INVALID);
  assert_int_equal(dsm_api.bake_tile(s.worker, 0, 1, 1), DSM_OK);
  stage_close(&s);
}

typedef struct {
  dsm_worker *worker;
  const dsm_receiver *at;
  int told;
} asking;

static void ask_again(void *data, const dsm_tiles *tiles) {
  asking *a = data;
  (void)tiles;
  ++a->told;
  assert_int_equal(dsm_api.tiles_wanted(a->worker, a->at, ask_again, a), DSM_INVALID);
}

/* From within `wanted` nothing can be asked; and what no look-up takes, this does not. */
static void what_cannot_be_asked(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  stage s;
  stage_open(&s, &ball, 1, spot_at(0, 0, 0, 0, 0, 1, 30), WORDS("resolution 32"));
  dsm_receiver at = in_air(0, 0, 9), nowhere = in_air(0, NAN, 9);
  asking a = {s.worker, &at, 0};
  assert_int_equal(dsm_api.tiles_wanted(s.worker, &at, ask_again, &a), DSM_OK);
  assert_true(a.told > 0);
  a.told = 0;
  assert_int_equal(dsm_api.tiles_wanted(s.worker, &nowhere, ask_again, &a), DSM_INVALID);
  assert_int_equal(a.told, 0);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(wanted_tiles_are_those_made),
    cmocka_unit_test(tiles_outside_are_refused),
    cmocka_unit_test(what_cannot_be_asked),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
