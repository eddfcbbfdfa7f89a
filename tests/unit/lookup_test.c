/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "map/map.h"

/* Half the map under a sheet: light is bilinear across its edge, over one pixel. */
static void bilinear_across_an_edge(void **state) {
  (void)state;
  shape all[] = {sheet_at(5, 1, 0, 0, 0), sheet_at(6, 1, 1, 1, 1)};
  all[0].box.low[0] = 0;   /* only x > 0 */
  stage s;
  stage_open(&s, all, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 66", "samples 16"));
  double pixel = 2.0 / 64;
  for (double t = -3; t <= 3; t += 0.01) {
    double lit = light_of(&s, in_air(t * pixel, 0.37, 9), 0);   /* the edge lies on a border of pixels */
    assert_true(fabs(lit - fmax(0, fmin(1, 0.5 - t))) < 1e-6);
  }
  stage_close(&s);
}

/* Points exactly on borders of pixels, tiles and the frame are like their neighbours. */
static void borders(void **state) {
  (void)state;
  shape all[] = {sheet_at(5, 1, 0.25, 0.25, 0.25)};
  stage s;
  stage_open(&s, all, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 66", "tolerance 0"));
  double pixel = 2.0 / 64;
  for (int i = -31; i <= 31; ++i)
    for (int j = -31; j <= 31; ++j)
      for (int half = 0; half < 2; ++half)
        assert_true(fabs(light_of(&s, in_air((i + 0.5 * half) * pixel, (j + 0.5 * half) * pixel, 6), 0) - 0.25) < 1e-5);
  /* out over the edge light only grows, to exactly 1 */
  double last = 0;
  for (double x = 1 - 2 * pixel; x < 1 + 3 * pixel; x += pixel / 64) {
    double now = light_of(&s, in_air(x, 0.1, 6), 0);
    assert_true(now >= last - 1e-12);
    last = now;
  }
  assert_true(last == 1);
  dsm_receiver far_out = in_air(1e6, 0, 6);
  double rgb[3];
  assert_int_equal(dsm_api.lookup(s.worker, &far_out, rgb), DSM_OUTSIDE);
  stage_close(&s);
}

/* In grey fog, with short records and long ones, points in the air are as dark as a surface that faces the light. */
static void in_the_air_and_on_a_surface(void **state) {
  (void)state;
  shape fog = fog_in((dsm_box){{-1, -1, 5}, {1, 1, 7}}, 1, 1, 1, 0.2);
  const char *const *words[] = {WORDS("resolution 66", "bias 0"), WORDS("resolution 66", "bias 0", "tolerance 0"),
                                WORDS("resolution 66", "bias 0", "tolerance 0.00005"), WORDS("resolution 66", "bias 0", "tolerance 0.02")};
  int seen[7] = {0};
  rng r = rng_seeded(12);
  for (int k = 0; k < 4; ++k) {
    stage s;
    stage_open(&s, &fog, 1, parallel_at(0, 0, 0, 0, 0, 1), words[k]);
    for (int i = 0; i < 1000; ++i) {
      double x = rng_between(&r, -0.9, 0.9), y = rng_between(&r, -0.9, 0.9), z = rng_between(&r, 5, 7.1), far = fmin(z, 7) - 5;
      double air = light_of(&s, in_air(x, y, z), 0);
      assert_seeded(&r, fabs(air - exp(-far * (1 + 0.1 * far))) < 0.02 + 1e-5);
      assert_seeded(&r, fabs(air - light_of(&s, on_plane(x, y, z, 0, 0, -1), 0)) < 2e-5);
    }
    for (uint64_t n = 0; n < s.map->store.tile_count; ++n) {
      tile_key key = tile_store_key(&s.map->store, n);
      const tile *t = tile_store_peek(&s.map->store, &key);
      if (t && t->kind == TILE_STORED && (t->layout & ~TILE_REFINED) == 0) ++seen[t->codes.record_bits / 8];
    }
    stage_close(&s);
  }
  assert_true(seen[4] > 0 && seen[5] > 0);
}

static void behind_the_last_caster_its_value_stays(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0.5);
  stage s;
  stage_open(&s, &ball, 1, spot_at(0, 0, 0, 0, 0, 1, 20), WORDS("resolution 64", "tolerance 0"));
  for (double z = 7; z < 1e12; z *= 10) assert_true(fabs(light_of(&s, in_air(0, 0, z), 0) - 0.25) < 1e-5);
  stage_close(&s);
}

static void numbers_that_are_none(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0.5);
  stage s;
  stage_open(&s, &ball, 1, spot_at(0, 0, 0, 0, 0, 1, 20), WORDS("resolution 64"));
  const double odd[] = {NAN, INFINITY, -INFINITY};
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 7; ++i) {
      dsm_receiver at = on_plane(0, 0, 7, 0, 0, -1);
      *(i < 3 ? &at.point[i] : i < 6 ? &at.planes[0].normal[i - 3] : &at.planes[0].rise) = odd[k];
      double rgb[3] = {7, 7, 7};
      assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_INVALID);
      assert_true(rgb[0] == 7);
    }
  dsm_receiver at = in_air(0, 0, 7);
  double rgb[3];
  at.plane_count = 3;
  assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_INVALID);
  at.point[0] = 1e300;   /* finite, but its square is not */
  at.plane_count = 0;
  dsm_result result = dsm_api.lookup(s.worker, &at, rgb);
  assert_true(result == DSM_OUTSIDE || result == DSM_OK);
  /* a normal of length 0 says nothing, and one through the light asks for all */
  assert_true(light_of(&s, on_plane(0, 0, 7, 0, 0, 0), 0) <= 1);
  dsm_receiver grazing = on_plane(0, 0, 7, 1, 0, 0);
  result = dsm_api.lookup(s.worker, &grazing, rgb);
  assert_true(result == DSM_TRACE || (result == DSM_OK && rgb[0] == 1));
  stage_close(&s);
}

/* The map steps over what the receiver's own surface may be, or says that it cannot tell. */
static int open_or_declined(stage *s, dsm_receiver at) {
  double rgb[3];
  dsm_result result = dsm_api.lookup(s->worker, &at, rgb);
  return result == DSM_TRACE || (result == DSM_OK && rgb[0] == 1);
}

static void rise_and_constant_bias(void **state) {
  (void)state;
  shape sheet = sheet_at(5, 1, 0, 0, 0);
  stage s;
  stage_open(&s, &sheet, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 32"));
  dsm_receiver at = on_plane(0, 0, 5.5, 0, 0, -1);
  assert_true(light_of(&s, at, 0) == 0);
  at.planes[0].rise = 0.6;
  assert_true(open_or_declined(&s, at));
  /* two planes: the one that asks for less */
  at.plane_count = 2;
  at.planes[1] = (dsm_plane){{0, 0, -1}, 0.1};
  assert_true(light_of(&s, at, 0) == 0);
  at.planes[1] = (dsm_plane){{1, 0, 0}, 0};
  assert_true(open_or_declined(&s, at));
  stage_close(&s);
  stage_open(&s, &sheet, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 32", "bias 0.25"));
  assert_true(light_of(&s, on_plane(0, 0, 5.2, 1, 0, -0.01), 0) == 1);
  assert_true(light_of(&s, on_plane(0, 0, 5.3, 1, 0, -0.01), 0) == 0);
  assert_true(light_of(&s, in_air(0, 0, 5.2), 0) == 0);   /* no surface, no bias */
  stage_close(&s);
}

/* A thin wall does not leak: the floor behind it is dark right up to a pixel from its foot. */
static void thin_wall(void **state) {
  (void)state;
  shape wall[] = {sheet_at(1, 1, 0, 0, 0), sheet_at(1.01, 1, 0, 0, 0)};
  stage s;
  stage_open(&s, wall, 2, spot_at(0, 0, 0, 0, 0, 1, 30), WORDS("resolution 256"));
  for (double x = -0.4; x <= 0.4; x += 0.013) {
    assert_true(light_of(&s, on_plane(x, 0.1, 1, 0, 0, -1), 0) == 1);      /* its lit side */
    assert_true(light_of(&s, on_plane(x, 0.1, 1.01, 0, 0, 1), 0) == 0);    /* its other side */
    assert_true(light_of(&s, on_plane(x, 0.1, 1.02, 0, 0, -1), 0) == 0);   /* a floor close behind */
  }
  stage_close(&s);
}

/* The hints a worker keeps never change an answer: not in absolute records, not in deltas, not when a tile is another block of memory. */
static void asks_as_if_for_the_first_time(const char *const *words, int times) {
  enum { HAIRS = 200 };
  static shape hair[HAIRS];
  rng r = rng_seeded(1);
  for (int i = 0; i < HAIRS; ++i)
    hair[i] = sphere_at(rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 2, 4), 0.1, 0.3);
  stage s, evicting;
  stage_open(&s, hair, HAIRS, parallel_at(0, 0, 0, 0, 0, 1), words + 1);
  stage_open(&evicting, hair, HAIRS, parallel_at(0, 0, 0, 0, 0, 1), words);
  for (int k = 0; k < times; ++k) {
    double x = rng_between(&r, -1, 1), y = rng_between(&r, -1, 1), z = rng_between(&r, 2, 5);
    for (int near = 0; near < 8; ++near) {
      double depth = z + 0.1 * near * rng_between(&r, -1, 1);
      dsm_receiver at = near & 1 ? in_air(x, y, depth) : on_plane(x, y, depth, 0.3, 0, -1);
      dsm_worker *fresh;
      double a[3], b[3], c[3];
      assert_int_equal(dsm_api.worker_create(s.map, &s.w, &fresh), DSM_OK);
      dsm_result first = dsm_api.lookup(s.worker, &at, a), second = dsm_api.lookup(fresh, &at, b);
      assert_seeded(&r, first == second && memcmp(a, b, sizeof a) == 0);
      assert_seeded(&r, dsm_api.lookup(evicting.worker, &at, c) == second && memcmp(c, b, sizeof c) == 0);
      dsm_api.worker_destroy(fresh);
    }
  }
  dsm_statistics all = {.size = sizeof all}, few = all;
  dsm_api.statistics(s.map, &all);
  dsm_api.statistics(evicting.map, &few);
  assert_true(all.tiles_evicted == 0 && few.tiles_evicted > 0);
  stage_close(&evicting);
  stage_close(&s);
}

static void answers_do_not_depend_on_the_past(void **state) {
  (void)state;
  asks_as_if_for_the_first_time(WORDS("cache 0.02", "resolution 96"), 600);
  asks_as_if_for_the_first_time(WORDS("cache 0.02", "resolution 96", "samples 64", "tolerance 0.03"), 600);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(bilinear_across_an_edge),
    cmocka_unit_test(borders),
    cmocka_unit_test(in_the_air_and_on_a_surface),
    cmocka_unit_test(behind_the_last_caster_its_value_stays),
    cmocka_unit_test(numbers_that_are_none),
    cmocka_unit_test(rise_and_constant_bias),
    cmocka_unit_test(thin_wall),
    cmocka_unit_test(answers_do_not_depend_on_the_past),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
