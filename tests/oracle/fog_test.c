/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Fog by Beer and Lambert: homogeneous and of linear density, at all scales. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "oracle.h"

static const double DEPTHS[] = {1e-3, 0.1, 1, 1e3, 1e5};

/* Fog in a box from depth d to 2 d, so thick that exp(-thick) is left of the reddest light where it is homogeneous. */
static shape fog_at(double d, double thick, double growth) {
  return fog_in((dsm_box){{-d, -d, d}, {d, d, 2 * d}}, thick / d, 0.5 * thick / d, 0.1 * thick / d, growth / d);
}

static double truth(const shape *fog, const double from[3], const double to[3], int channel) {
  dsm_ray ray = {.near_depth = 0};
  for (int i = 0; i < 3; ++i) {
    ray.origin[i] = from[i];
    ray.direction[i] = to[i] - from[i];
    ray.far_depth += ray.direction[i] * ray.direction[i];
  }
  ray.far_depth = sqrt(ray.far_depth);
  for (int i = 0; i < 3; ++i) ray.direction[i] /= ray.far_depth;
  double span[2];
  return cross_box(&fog->box, &ray, span) ? exp(-fog->density[channel] * fog_integral(fog, &ray, span[0], span[1])) : 1;
}

static void check_parallel(double thick, double growth, const char *tolerance_word, double tolerance) {
  for (size_t k = 0; k < sizeof DEPTHS / sizeof *DEPTHS; ++k) {
    double d = DEPTHS[k];
    shape fog = fog_at(d, thick, growth);
    stage s;
    stage_open(&s, &fog, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 24", UNLESS_SLOW("samples 16", "samples 1"), tolerance_word));
    rng r = rng_seeded(k);
    for (uint64_t i = 0; i < most_cases(500); ++i) {
      double to[3] = {d * rng_between(&r, -0.9, 0.9), d * rng_between(&r, -0.9, 0.9), d * rng_between(&r, 0.9, 2.2)};
      double from[3] = {to[0], to[1], 0};
      for (int c = 0; c < 3; ++c) {
        double error = light_of(&s, in_air(to[0], to[1], to[2]), c) - truth(&fog, from, to, c);
        assert_seeded(&r, fabs(error) <= tolerance + 1e-5);
      }
    }
    stage_close(&s);
  }
}

static void homogeneous(void **state) {
  (void)state;
  check_parallel(2, 0, "tolerance 0.01", 0.01);
  check_parallel(2, 0, "tolerance 0.0001", 0.0001);
  check_parallel(0.05, 0, "tolerance 0", 0);
  check_parallel(30, 0, "tolerance 0.002", 0.002);
}

static void linear_density(void **state) {
  (void)state;
  check_parallel(1, 3, "tolerance 0.01", 0.01);
  check_parallel(1, 3, "tolerance 0.0005", 0.0005);
  check_parallel(1, -1, "tolerance 0.001", 0.001);
}

/* With perspective the rays of a pixel differ, and so the answer is an average over the footprint: the error left
 * over falls with the pixel's size. */
static void perspective(void **state) {
  (void)state;
  for (size_t k = 0; k < sizeof DEPTHS / sizeof *DEPTHS; ++k) {
    double d = DEPTHS[k], origin[3] = {0, 0, 0};
    shape fog = fog_at(d, 2, 1);
    stage s;
    stage_open(&s, &fog, 1, spot_at(0, 0, 0, 0, 0, 1, 20), WORDS("resolution 256", UNLESS_SLOW("samples 16", "samples 4"), "tolerance 0.001"));
    rng r = rng_seeded(k);
    for (uint64_t i = 0; i < most_cases(300); ++i) {
      double z = d * rng_between(&r, 0.9, 2.2), to[3] = {0.3 * z * rng_between(&r, -1, 1), 0.3 * z * rng_between(&r, -1, 1), z};
      for (int c = 0; c < 3; ++c) {
        double error = light_of(&s, in_air(to[0], to[1], to[2]), c) - truth(&fog, origin, to, c);
        assert_seeded(&r, fabs(error) <= 0.001 + 1e-3);
      }
    }
    stage_close(&s);
  }
}

/* The automatic tolerance is at its floor where the rays of a pixel agree. */
static void automatic_tolerance_in_smooth_fog(void **state) {
  (void)state;
  shape fog = fog_at(1, 2, 0);
  stage s;
  stage_open(&s, &fog, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 24"));
  for (double z = 0.9; z < 2.1; z += 0.001)
    assert_true(fabs(light_of(&s, in_air(0.1, 0.2, z), 0) - exp(-2 * fmax(0, fmin(1, z - 1)))) <= 0.002 + 1e-5);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(homogeneous),
    cmocka_unit_test(linear_density),
    cmocka_unit_test(perspective),
    cmocka_unit_test(automatic_tolerance_in_smooth_fog),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
