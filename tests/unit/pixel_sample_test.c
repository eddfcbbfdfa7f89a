/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/pixel_sample.h"
#include "random.h"

static const pixel_filter BOX = {FILTER_BOX, 1}, TRIANGLE = {FILTER_TRIANGLE, 2}, GAUSSIAN = {FILTER_GAUSSIAN, 3};

/* Every dyadic box of area 1/N holds one of N = 2^m points: rows, columns and cells. */
static void powers_of_two_fill_all_strata(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(200); ++seed) {
    rng r = rng_seeded(seed);
    pixel_seed pixel = pixel_sample_seed(rng_below(&r, 6), rng_below(&r, 16384), rng_below(&r, 16384));
    uint32_t m = rng_below(&r, 9), n = 1u << m;
    pixel_point path[256];
    pixel_sample_path(n, path);
    for (uint32_t across = 0; across <= m; ++across) {
      unsigned char seen[256] = {0};
      for (uint32_t i = 0; i < n; ++i) {
        double o[2];
        pixel_sample_offsets(&BOX, pixel, &path[i], 1, &o);
        assert_seeded(&r, o[0] > -0.5 && o[0] < 0.5 && o[1] > -0.5 && o[1] < 0.5);
        uint32_t cell = ((uint32_t)((o[0] + 0.5) * (1u << across)) << (m - across)) + (uint32_t)((o[1] + 0.5) * (1u << (m - across)));
        assert_seeded(&r, !seen[cell]);
        seen[cell] = 1;
      }
    }
  }
}

static void same_pixel_same_samples_other_pixel_others(void **state) {
  (void)state;
  double a[2], b[2];
  int differ = 0;
  const pixel_point point = {7, 0x12345678};
  for (uint32_t k = 0; k < 3; ++k) {
    pixel_seed one = pixel_sample_seed(1, 2, 3), other = pixel_sample_seed(k == 0 ? 0 : 1, k == 1 ? 5 : 2, k == 2 ? 5 : 3);
    pixel_sample_offsets(&BOX, one, &point, 1, &a);
    pixel_sample_offsets(&BOX, one, &point, 1, &b);
    assert_memory_equal(a, b, sizeof a);
    pixel_sample_offsets(&BOX, other, &point, 1, &b);
    differ += memcmp(a, b, sizeof a) != 0;
  }
  assert_int_equal(differ, 3);
}

static void many_are_as_one_by_one(void **state) {
  (void)state;
  enum { MOST = 9 };
  pixel_point path[MOST];
  pixel_sample_path(MOST, path);
  const pixel_filter *filters[] = {&BOX, &TRIANGLE, &GAUSSIAN};
  for (uint32_t n = 1; n <= MOST; ++n)
    for (int k = 0; k < 3; ++k) {
      double all[MOST + 1][2], one[2];
      pixel_seed seed = pixel_sample_seed(1, n, 4);
      all[n][0] = all[n][1] = 7;
      pixel_sample_offsets(filters[k], seed, path, n, all);
      assert_true(all[n][0] == 7 && all[n][1] == 7);
      for (uint32_t i = 0; i < n; ++i) {
        pixel_sample_offsets(filters[k], seed, &path[i], 1, &one);
        assert_memory_equal(all[i], one, sizeof one);
      }
    }
}

/* Mean 0, and the variance of the density that the filter is. */
static void filters_have_their_moments(void **state) {
  (void)state;
  double phi = exp(-2) / sqrt(2 * acos(-1)), inside = erf(sqrt(2));
  const struct { pixel_filter filter; double variance; } cases[] = {
    {BOX, 1.0 / 12}, {TRIANGLE, 1.0 / 6}, {GAUSSIAN, 0.75 * 0.75 * (1 - 4 * phi / inside)},
    {{FILTER_GAUSSIAN, 16}, 16 * (1 - 4 * phi / inside)}, {{FILTER_BOX, 5}, 25.0 / 12},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    double sum[2] = {0}, square[2] = {0}, half = cases[k].filter.width / 2;
    enum { PIXELS = 100, RAYS = 1024 };
    static pixel_point path[RAYS];
    pixel_sample_path(RAYS, path);
    for (uint32_t p = 0; p < PIXELS; ++p)
      for (uint32_t i = 0; i < RAYS; ++i) {
        double o[2];
        pixel_sample_offsets(&cases[k].filter, pixel_sample_seed(0, p, 77), &path[i], 1, &o);
        for (int a = 0; a < 2; ++a) {
          assert_true(fabs(o[a]) <= half);
          sum[a] += o[a] / (PIXELS * RAYS);
          square[a] += o[a] * o[a] / (PIXELS * RAYS);
        }
      }
    for (int a = 0; a < 2; ++a) {
      assert_true(fabs(sum[a]) < 1e-3 * half);
      assert_true(fabs(square[a] / cases[k].variance - 1) < 1e-3);
    }
  }
}

/* Root mean square error of the share of samples on one side of a random edge, over many pixels. */
static double edge_error(uint32_t n) {
  rng r = rng_seeded(n);
  double sum = 0;
  enum { PIXELS = 2000 };
  pixel_point path[256];
  pixel_sample_path(n, path);
  for (uint32_t p = 0; p < PIXELS; ++p) {
    double angle = rng_between(&r, 0, 6.3), nx = cos(angle), ny = sin(angle), d = rng_between(&r, -0.3, 0.3), got = 0, want = 0;
    for (uint32_t i = 0; i < n; ++i) {
      double o[2];
      pixel_sample_offsets(&BOX, pixel_sample_seed(0, p, 1), &path[i], 1, &o);
      got += nx * o[0] + ny * o[1] < d;
    }
    for (int i = 0; i < 64; ++i)   /* exact along y, 64 columns */
    {
      double x = (i + 0.5) / 64 - 0.5, y = (d - nx * x) / ny;
      want += ny > 0 ? fmax(0, fmin(1, y + 0.5)) : 1 - fmax(0, fmin(1, y + 0.5));
    }
    sum += (got / n - want / 64) * (got / n - want / 64);
  }
  return sqrt(sum / PIXELS);
}

/* LV 2: O(N^-3/4) at an edge, and not only for squares of whole numbers. */
static void edges_converge_as_stratified_samples_do(void **state) {
  (void)state;
  assert_true(edge_error(16) < 0.075 && edge_error(64) < 0.03 && edge_error(256) < 0.012);
  assert_true(edge_error(48) < 0.05 && edge_error(100) < 0.03);
}

/* The path visits the first n points of the sequence, and neighbours on it are near each other in every pixel. */
static void path_visits_all_by_short_steps(void **state) {
  (void)state;
  for (uint32_t n = 1; n <= 4096; n = n < 40 ? n + 1 : n * 3) {
    pixel_point *path = malloc(n * sizeof *path);
    unsigned char *seen = calloc(n, 1);
    pixel_sample_path(n, path);
    double length = 0;
    for (uint32_t i = 0; i < n; ++i) {
      assert_true(path[i].x < n && !seen[path[i].x]);   /* the first dimension, bits reversed, is the index */
      seen[path[i].x] = 1;
      if (i == 0) continue;
      double a[2], b[2];
      pixel_sample_offsets(&BOX, pixel_sample_seed(3, n, 9), &path[i - 1], 1, &a);
      pixel_sample_offsets(&BOX, pixel_sample_seed(3, n, 9), &path[i], 1, &b);
      length += hypot(a[0] - b[0], a[1] - b[1]);
    }
    assert_true(length < 2.2 * sqrt(n));   /* at random it would be 0.52 n */
    free(path);
    free(seen);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(powers_of_two_fill_all_strata),
    cmocka_unit_test(same_pixel_same_samples_other_pixel_others),
    cmocka_unit_test(many_are_as_one_by_one),
    cmocka_unit_test(filters_have_their_moments),
    cmocka_unit_test(edges_converge_as_stratified_samples_do),
    cmocka_unit_test(path_visits_all_by_short_steps),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
