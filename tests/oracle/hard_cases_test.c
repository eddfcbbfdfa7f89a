/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Numbers at their limits, each against a closed form: depths of thirteen orders of magnitude in one map, thousands of layers, light at
 * no distance, lights and receivers where formulas divide by nothing. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "oracle.h"

static const double NEAR_ZERO = 1e-5;   /* what is allowed beside the tolerance: stored values and depths are rounded */

static void assert_light(stage *s, dsm_receiver r, double expected, double error) {
  double light = light_of(s, r, 0);
  if (!(fabs(light - expected) <= error + NEAR_ZERO))
    fail_msg("at %g %g %g: %.9g instead of %.9g", r.point[0], r.point[1], r.point[2], light, expected);
}

/* Sheets from a millionth to ten million units from the light, in one pixel. */
static void all_depths_in_one_map(void **state) {
  (void)state;
  enum { DECADES = 14 };
  shape sheets[DECADES];
  for (int i = 0; i < DECADES; ++i) sheets[i] = sheet_at(pow(10, i - 6), 0.2 * pow(10, i - 6), 0.8, 0.8, 0.8);
  for (int spot = 0; spot < 2; ++spot) {
    stage s;
    dsm_light light = spot ? spot_at(0, 0, 0, 0, 0, 1, 5) : parallel_at(0, 0, 0, 0, 0, 1);
    light.radius = spot ? 0 : 1e-7;   /* a beam that the nearest sheet is wider than */
    stage_open(&s, sheets, DECADES, light, WORDS("resolution 8", "tolerance 0.001", "samples 4"));
    for (int i = 0; i < DECADES; ++i) {
      double z = pow(10, i - 6), x = spot ? 0.01 * z : 1e-8;
      assert_light(&s, in_air(x, -x, 0.9 * z), pow(0.8, i), 0.001);
      assert_light(&s, in_air(x, -x, 1.1 * z), pow(0.8, i + 1), 0.001);
      assert_light(&s, on_plane(x, x, z, 0, 0, -1), pow(0.8, i), 0.001);
    }
    stage_close(&s);
  }
}

/* The same scene at any size, and far from the origin. */
static void any_scale_and_place(void **state) {
  (void)state;
  static const double scales[] = {1e-6, 1e-3, 1, 1e3, 1e7}, places[] = {0, 1e6};
  for (int k = 0; k < 5; ++k)
    for (int p = 0; p < 2; ++p) {
      double u = scales[k], away = places[p] * (u < 1 ? u : 1);   /* a double at 1e6 is no finer than 1e-10 */
      shape shapes[2] = {sheet_at(away + 2 * u, u, 0.5, 0.5, 0.5), sphere_at(away, away, away + 4 * u, 0.5 * u, 0.25)};
      for (int i = 0; i < 2; ++i) shapes[0].box.low[i] += away, shapes[0].box.high[i] += away;
      stage s;
      stage_open(&s, shapes, 2, spot_at(away, away, away, 0, 0, 1, 20), WORDS("resolution 64", "tolerance 0.001", "samples 4"));
      assert_light(&s, in_air(away, away, away + u), 1, 0);
      assert_light(&s, in_air(away + 0.1 * u, away, away + 3 * u), 0.5, 0.001);
      assert_light(&s, in_air(away, away + 0.01 * u, away + 4 * u), 0.5 * 0.25, 0.001);
      assert_light(&s, in_air(away, away, away + 9 * u), 0.5 * 0.25 * 0.25, 0.001);
      stage_close(&s);
    }
}

/* Ten thousand sheets, evenly spaced, one float apart, or at one depth. */
static void ten_thousand_layers(void **state) {
  (void)state;
  enum { LAYERS = 10000 };
  static shape sheets[LAYERS];
  static const double gaps[] = {1e-4, 0x1p-23, 0};
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < LAYERS; ++i) sheets[i] = sheet_at(1 + gaps[k] * i, 1, 0.9999, 0.9999, 0.9999);
    stage s;
    stage_open(&s, sheets, LAYERS, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 4", "tolerance 0.0005", "samples 2"));
    assert_light(&s, in_air(0.1, 0.2, 0.999), 1, 0);
    assert_light(&s, in_air(0.1, 0.2, 3), pow(0.9999, LAYERS), 0.0005);
    if (k == 0)
      for (int i = 500; i < LAYERS; i += 977) assert_light(&s, in_air(0.1, 0.2, 1 + gaps[k] * (i - 0.5)), pow(0.9999, i), 0.0005);
    stage_close(&s);
  }
  /* A float apart they are still told apart, where depths may not be rounded for a tolerance. */
  for (int i = 0; i < LAYERS; ++i) sheets[i] = sheet_at(1 + gaps[1] * i, 1, 0.9999, 0.9999, 0.9999);
  stage s;
  stage_open(&s, sheets, LAYERS, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 4", "tolerance 0", "samples 1"));
  for (int i = 0; i <= LAYERS; i += 500) assert_light(&s, in_air(0.1, 0.2, 1 + gaps[1] * (i - 0.5)), pow(0.9999, i), 0);
  stage_close(&s);
}

/* What is nearly opaque hides nothing of what is, and what is opaque leaves exactly nothing. */
static void opaque_behind_nearly_opaque(void **state) {
  (void)state;
  shape sheets[3] = {sheet_at(1, 1, 0.001, 0.001, 0.001), sheet_at(1.0000001, 1, 0, 0, 0), sheet_at(2, 1, 0.5, 0.5, 0.5)};
  stage s;
  stage_open(&s, sheets, 3, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 4", "tolerance 0.0001"));
  assert_light(&s, in_air(0, 0, 1.00000005), 0.001, 0.0001);
  assert_true(light_of(&s, in_air(0, 0, 1.5), 0) == 0);
  assert_true(light_of(&s, in_air(0, 0, 2.5), 0) == 0);
  stage_close(&s);
}

/* A surface in the light's own plane, and one that the spot stands behind by a hair. */
static void a_surface_at_the_light(void **state) {
  (void)state;
  for (int k = 0; k < 2; ++k) {
    shape sheets[2] = {sheet_at(k ? 1e-9 : 0, 1, 0.5, 0.5, 0.5), sheet_at(1, 1, 0.5, 0.5, 0.5)};
    stage s;
    stage_open(&s, sheets, 2, k ? spot_at(0, 0, 0, 0, 0, 1, 30) : parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 16", "tolerance 0.001"));
    double behind_first = light_of(&s, in_air(0.01, 0.01, 0.5), 0), behind_both = light_of(&s, in_air(0.01, 0.01, 2), 0);
    /* at depth 0 itself it is the host that says whether it is there; either way the rest is right */
    assert_true(fabs(behind_first - 0.5) < 0.0011 || (!k && behind_first == 1));
    assert_true(fabs(behind_both - 0.5 * behind_first) < 0.0011);
    stage_close(&s);
  }
}

/* Fog so thin that it is nothing, so thick that it is a wall, and both in one pixel. */
static void thin_and_thick_fog(void **state) {
  (void)state;
  static const double thickness[] = {1e-9, 1e-4, 1, 50, 1e4};
  dsm_box box = {{-1, -1, 1}, {1, 1, 2}}, next = {{-1, -1, 3}, {1, 1, 3.001}};
  for (int k = 0; k < 5; ++k) {
    shape fogs[2] = {fog_in(box, thickness[k], thickness[k], thickness[k], 0), fog_in(next, 1e7, 1e7, 1e7, 0)};
    stage s;
    stage_open(&s, fogs, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 4", "tolerance 0.001"));
    for (int i = 1; i <= 10; ++i)
      assert_light(&s, in_air(0.1, 0.1, 1 + 0.1 * i), exp(-0.1 * i * thickness[k]), 0.001);
    assert_light(&s, in_air(0.1, 0.1, 2.9), exp(-thickness[k]), 0.001);
    assert_light(&s, in_air(0.1, 0.1, 3.002), 0, 0.001);
    stage_close(&s);
  }
}

/* The limits of the settings: no tolerance and nearly half, one sample and thousands. */
static void limits_of_the_settings(void **state) {
  (void)state;
  static const char *const tolerances[] = {"tolerance 0", "tolerance 0.499"}, *const samples[] = {"samples 1", "samples 4096"};
  shape sheets[4];
  for (int i = 0; i < 4; ++i) sheets[i] = sheet_at(1 + i, 1, 0.6, 0.6, 0.6);
  for (int t = 0; t < 2; ++t)
    for (int k = 0; k < 2; ++k) {
      stage s;
      stage_open(&s, sheets, 4, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 8", tolerances[t], samples[k]));
      for (int i = 0; i < 5; ++i) assert_light(&s, in_air(0.1, 0.1, i + 0.5), pow(0.6, i), t ? 0.499 : 0);
      stage_close(&s);
    }
}

/* A spotlight as narrow as a needle and one as wide as half of space, and points where light does not go. */
static void odd_spotlights(void **state) {
  (void)state;
  static const double degrees[] = {0.0005, 89.5};
  shape sheet = sheet_at(5, 1, 0.3, 0.3, 0.3);
  for (int k = 0; k < 2; ++k) {
    stage s;
    stage_open(&s, &sheet, 1, spot_at(0, 0, 0, 0, 0, 1, degrees[k]), WORDS("resolution 32", "tolerance 0.001"));
    assert_light(&s, in_air(0, 0, 4), 1, 0);
    assert_light(&s, in_air(0, 0, 6), 0.3, 0.001);
    double rgb[3] = {-1, -1, -1};
    static const double beside[][3] = {{0, 0, -5}, {0, 0, 0}, {5, 0, 0}, {5, 0, -1e-12}, {1e-300, 0, 0}, {1e7, 1e7, 1}};
    for (size_t i = 0; i < sizeof beside / sizeof *beside; ++i) {
      dsm_receiver r = in_air(beside[i][0], beside[i][1], beside[i][2]);
      dsm_result result = dsm_api.lookup(s.worker, &r, rgb);
      assert_true(result == DSM_OK || result == DSM_OUTSIDE || result == DSM_TRACE);
      if (result != DSM_TRACE) assert_true(rgb[0] == 1 && rgb[1] == 1 && rgb[2] == 1);
    }
    stage_close(&s);
  }
}

/* A spotlight so far from what it lights that the cosine of its cone is 1: no shadow may be lost beside a face of no width. */
static void a_cone_whose_cosine_is_one(void **state) {
  (void)state;
  shape sheet = sheet_at(0, 1, 0.3, 0.3, 0.3);
  stage s;
  dsm_light light = spot_at(0, 0, -1e9, 0, 0, 1, 2e-7);
  assert_true(light.cos_angle == 1);
  stage_open(&s, &sheet, 1, light, WORDS("resolution 128", "tolerance 0.001"));
  for (double x = -0.9; x < 1; x += 0.3) {
    assert_light(&s, in_air(x, -x, -1), 1, 0);
    assert_light(&s, in_air(x, -x, 1), 0.3, 0.001);
  }
  stage_close(&s);
}

/* Exactly on the borders of pixels, tiles and faces, and a step of a double to each side. */
static void borders(void **state) {
  (void)state;
  shape wall = sheet_at(2, 1.5, 0.5, 0.5, 0.5);
  stage s;
  stage_open(&s, &wall, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 48", "tolerance 0"));
  for (int i = -12; i <= 12; ++i) {
    double x = i / 12.0;
    const double xs[] = {nextafter(x, -9), x, nextafter(x, 9)};
    for (int k = 0; k < 3; ++k) assert_light(&s, in_air(xs[k], xs[k], 3), 0.5, 0);
  }
  stage_close(&s);

  shape shell = sphere_at(0, 0, 0, 2, 0.5);
  stage_open(&s, &shell, 1, point_at(0, 0, 0), WORDS("resolution 20", "tolerance 0.001"));
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x || y || z) {
          assert_light(&s, in_air(x, y, z), 1, 0);               /* faces, edges and corners of the cube */
          assert_light(&s, in_air(3 * x, 3 * y, 3 * z), 0.5, 0.001);
        }
  stage_close(&s);
}

/* A floor almost along the light, and one that the light's plane cuts: no acne, whatever the angle. */
static void grazing_light(void **state) {
  (void)state;
  static const double degrees[] = {60, 85, 89, 89.9, 89.99, 90};
  for (int k = 0; k < 6; ++k) {
    double a = degrees[k] * acos(-1) / 180, slope = tan(a);
    shape floor = sheet_at(0, 1, 0, 0, 0);
    dsm_light sun = parallel_at(-slope * 5 > -1e6 ? -slope * 5 : -1e6, 0, 5, sin(a), 0, -cos(a));
    stage s;
    stage_open(&s, &floor, 1, sun, WORDS("resolution 64"));
    rng r = rng_seeded(5);
    for (int i = 0; i < 200; ++i) {
      dsm_receiver p = on_plane(rng_between(&r, -0.9, 0.9), rng_between(&r, -0.9, 0.9), 0, 0, 0, 1);
      double rgb[3];
      dsm_result result = dsm_api.lookup(s.worker, &p, rgb);
      if (result == DSM_OK || result == DSM_OUTSIDE) {
        if (!(rgb[0] > 0.999)) fail_msg("%g degrees: %g", degrees[k], rgb[0]);
      }
      else
        assert_int_equal(result, DSM_TRACE);
    }
    stage_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(all_depths_in_one_map),   cmocka_unit_test(any_scale_and_place), cmocka_unit_test(ten_thousand_layers),
    cmocka_unit_test(opaque_behind_nearly_opaque), cmocka_unit_test(a_surface_at_the_light), cmocka_unit_test(thin_and_thick_fog),
    cmocka_unit_test(limits_of_the_settings),  cmocka_unit_test(odd_spotlights),      cmocka_unit_test(borders),
    cmocka_unit_test(grazing_light),           cmocka_unit_test(a_cone_whose_cosine_is_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
