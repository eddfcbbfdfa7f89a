/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Fog, glass and solid things in one map: the product of each thing's own answer. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "oracle.h"

/* Fog from 2 to 6 with two overlapping boxes, a sheet inside at 3, one behind at 7, half of it in the shade of a solid. */
static void things_multiply(void **state) {
  (void)state;
  shape all[] = {
    fog_in((dsm_box){{-1, -1, 2}, {1, 1, 6}}, 0.3, 0.2, 0.1, 0),
    fog_in((dsm_box){{-1, -1, 4}, {1, 1, 5}}, 0.5, 0.5, 0.5, 2),
    sheet_at(3, 1, 0.9, 0.5, 0.25),
    sheet_at(7, 1, 0.5, 0.5, 0.5),
    sheet_at(6.5, 0.5, 0, 0, 0),
  };
  all[4].box.low[0] = all[4].box.low[1] = 0;   /* covers a quarter */
  stage s;
  stage_open(&s, all, 5, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 102", "tolerance 0.002"));
  rng r = rng_seeded(5);
  for (int i = 0; i < (int)most_cases(4000); ++i) {
    double x = rng_between(&r, -0.9, 0.9), y = rng_between(&r, -0.9, 0.9), z = rng_between(&r, 1, 9);
    if (fabs(z - 3) < 1e-4 || fabs(z - 6.5) < 1e-4 || fabs(z - 7) < 1e-4) continue;
    if (fabs(x) < 0.03 || fabs(y) < 0.03 || fabs(x - 0.5) < 0.03 || fabs(y - 0.5) < 0.03) continue;
    int shaded = z > 6.5 && x > 0 && x < 0.5 && y > 0 && y < 0.5;
    for (int c = 0; c < 3; ++c) {
      double q = fmax(0, fmin(1, z - 4));
      double want = exp(-all[0].density[c] * fmax(0, fmin(4, z - 2)) - all[1].density[c] * (q + q * q));
      if (z > 3) want *= all[2].pass[c];
      if (z > 7) want *= 0.5;
      if (shaded) want = 0;
      assert_seeded(&r, fabs(light_of(&s, in_air(x, y, z), c) - want) <= 0.002 + 1e-5);
    }
  }
  stage_close(&s);
}

/* A surface in fog is neither shadowed by itself nor lit by the fog behind it. */
static void surface_in_fog(void **state) {
  (void)state;
  shape all[] = {fog_in((dsm_box){{-1, -1, 0.5}, {1, 1, 3}}, 0.4, 0.4, 0.4, 0), sphere_at(0, 0, 2, 0.5, 0)};
  stage s;
  stage_open(&s, all, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 258", "tolerance 0.001"));
  for (double a = 0; a < 80; a += 1) {
    double t = a * acos(-1) / 180, x = 0.5 * sin(t), z = 2 - 0.5 * cos(t);
    double lit = light_of(&s, on_plane(x, 0.001, z, sin(t), 0, -cos(t)), 1), want = exp(-0.4 * (z - 0.5));
    assert_true(lit >= want - 0.0011 && lit <= want + 0.05);   /* the bias reads the fog a little in front */
    assert_true(a > 70 || light_of(&s, in_air(x, 0.001, 2.6), 1) <= 0.0011);
  }
  stage_close(&s);
}

/* Only in the marked pixels does the map refuse. */
static void growing_light_is_left_to_the_host(void **state) {
  (void)state;
  shape all[] = {sheet_at(2, 1, 0.5, 0.5, 0.5), sheet_at(3, 0.4, 1.5, 1.5, 1.5)};
  all[1].box.low[2] = all[1].box.high[2] = 3;
  stage s;
  stage_open(&s, all, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 102"));
  double rgb[3] = {-1, -1, -1};
  dsm_receiver inside = in_air(0, 0, 5), beside = in_air(0.7, 0.7, 5);
  assert_int_equal(dsm_api.lookup(s.worker, &inside, rgb), DSM_TRACE);
  assert_true(rgb[0] == -1);
  assert_int_equal(dsm_api.lookup(s.worker, &beside, rgb), DSM_OK);
  assert_true(fabs(rgb[0] - 0.5) < 1e-5);
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(s.map, &got);
  assert_true(got.pixels_marked > 0 && got.pixels_marked < got.pixels_baked);
  stage_close(&s);
}

/* What compression leaves is the average of the rays within the tolerance, whatever the scene and filter. */
static void hair_converges(void **state) {
  (void)state;
  enum { HAIRS = 300 };
  static shape hair[HAIRS];
  rng r = rng_seeded(77);
  for (int i = 0; i < HAIRS; ++i)
    hair[i] = sphere_at(rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 2, 4), 0.02, 0);
  const char *size = UNLESS_SLOW("resolution 32", "resolution 12");
  double error[2];
  stage best;
  stage_open(&best, hair, HAIRS, parallel_at(0, 0, 0, 0, 0, 1), WORDS(size, "samples 4096", "tolerance 0"));
  for (int k = 0; k < 2; ++k) {
    stage s;
    stage_open(&s, hair, HAIRS, parallel_at(0, 0, 0, 0, 0, 1), WORDS(size, k ? "samples 256" : "samples 4"));
    rng q = rng_seeded(3);
    double sum = 0;
    for (int i = 0; i < 2000; ++i) {
      dsm_receiver at = in_air(rng_between(&q, -1, 1), rng_between(&q, -1, 1), rng_between(&q, 2, 5));
      double d = light_of(&s, at, 0) - light_of(&best, at, 0);
      sum += d * d;
    }
    error[k] = sqrt(sum / 2000);
    stage_close(&s);
  }
  stage_close(&best);
  assert_true(error[0] < 0.25 && error[1] < error[0] / 6);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(things_multiply),
    cmocka_unit_test(surface_in_fog),
    cmocka_unit_test(growing_light_is_left_to_the_host),
    cmocka_unit_test(hair_converges),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
