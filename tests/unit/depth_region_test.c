/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>

#include "core/depth_region.h"
#include "random.h"

static dsm_settings with(uint32_t samples, uint32_t min_samples, double size_factor, double min_size, sample_pattern pattern) {
  dsm_settings s;
  settings_shadow_map_defaults(&s);
  s.samples = samples;
  s.min_samples = min_samples;
  s.size_factor = size_factor;
  s.min_size = min_size;
  s.pattern = pattern;
  return s;
}

static depth_region box_of(double across, double up, const dsm_settings *s) {
  const double sides[2][2] = {{across, 0}, {0, up}};
  return depth_region_of(sides, s);
}

static void counts_are(double across, double up, uint32_t samples, uint32_t least, uint32_t s, uint32_t t) {
  dsm_settings settings = with(samples, least, 1, 0, PATTERN_JITTERED);
  depth_region r = box_of(across, up, &settings);
  if (r.counts[0] != s || r.counts[1] != t)
    fail_msg("%g x %g, %u, %u: %u x %u, not %u x %u", across, up, (unsigned)samples, (unsigned)least, (unsigned)r.counts[0],
             (unsigned)r.counts[1], (unsigned)s, (unsigned)t);
}

/* Figure 4, followed with pen and paper. Half sizes are the footprint's sizes here. */
static void samples_are_split_as_in_the_figure(void **state) {
  (void)state;
  counts_are(3, 3, 16, 1, 4, 4);       /* 36 pixels, 16 samples */
  counts_are(2, 2, 16, 1, 4, 4);       /* as many pixels as samples */
  counts_are(1, 1, 16, 1, 2, 2);       /* 4 pixels: one sample each */
  counts_are(1, 1, 16, 3, 3, 3);       /* but three along each side */
  counts_are(0.1, 0.1, 16, 1, 1, 1);   /* none would be too few */
  counts_are(4, 1, 16, 1, 8, 2);       /* 16 pixels: sqrt(16/4) = 2 rows of 8 */
  counts_are(1, 4, 16, 1, 2, 8);
  counts_are(100, 1, 16, 1, 16, 1);    /* a sliver: one row */
  counts_are(100, 1, 16, 3, 5, 3);     /* three rows, and 16/3 + 1/2 */
  counts_are(1, 100, 16, 3, 3, 16);    /* all 16 rows, and three along the other side all the same */
}

static void size_and_its_least(void **state) {
  (void)state;
  dsm_settings s = with(16, 1, 3, 2, PATTERN_JITTERED);
  depth_region r = box_of(1, 5, &s);
  assert_true(r.sides[0][0] == 6 && r.sides[0][1] == 0 && r.sides[1][0] == 0 && r.sides[1][1] == 30);
  r = box_of(0.5, 0, &s);   /* 1.5 and 0 are below 2 */
  assert_true(r.sides[0][0] == 4 && r.sides[1][1] == 4);
  s = with(1, 3, 0, 0, PATTERN_JITTERED);   /* RSC figure 6a: an ordinary z-buffer */
  r = box_of(7, 7, &s);
  assert_true(r.sides[0][0] == 0 && r.sides[1][1] == 0 && depth_region_samples(&r) == 1);
  depth_sample only = depth_region_sample(&r, 5, 0);
  assert_true(only.x == 0 && only.y == 0);
}

/* The box holds the parallelogram, as much enlarged; the other pattern is the parallelogram. */
static void slanted_footprints(void **state) {
  (void)state;
  const double sides[2][2] = {{2, 1}, {-1, 3}};
  dsm_settings s = with(64, 1, 2, 0, PATTERN_JITTERED);
  depth_region r = depth_region_of(sides, &s);
  assert_true(r.sides[0][0] == 2 * 2 * 3 && r.sides[1][1] == 2 * 2 * 4 && r.sides[0][1] == 0 && r.sides[1][0] == 0);
  s.pattern = PATTERN_INSIDE;
  r = depth_region_of(sides, &s);
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 2; ++i) assert_true(fabs(r.sides[k][i] - 4 * sides[k][i]) < 1e-12);
  for (uint32_t i = 0; i < depth_region_samples(&r); ++i) {   /* both coordinates along its sides within a half */
    depth_sample at = depth_region_sample(&r, 77, i);
    double a = (at.x * 12 - at.y * -4) / (8 * 12 + 4 * 4), b = (8 * at.y - 4 * at.x) / (8 * 12 + 4 * 4);
    assert_true(fabs(a) <= 0.5 && fabs(b) <= 0.5);
  }
  /* a line is given a width across itself; a point becomes a square */
  const double line[2][2] = {{3, 4}, {0, 0}}, point[2][2] = {{0, 0}, {0, 0}};
  s = with(64, 1, 1, 2, PATTERN_INSIDE);
  r = depth_region_of(line, &s);
  assert_true(r.sides[0][0] == 6 && r.sides[0][1] == 8 && fabs(r.sides[1][0] + 3.2) < 1e-12 && fabs(r.sides[1][1] - 2.4) < 1e-12);
  r = depth_region_of(point, &s);
  assert_true(r.sides[0][0] == 4 && r.sides[1][1] == 4 && r.sides[0][1] == 0 && r.sides[1][0] == 0);
}

/* Each part of the region has its sample, and over many seeds samples lie everywhere in it. */
static void jitter_fills_every_part(void **state) {
  (void)state;
  dsm_settings s = with(12, 1, 1, 0, PATTERN_JITTERED);
  depth_region r = box_of(4, 3, &s);
  assert_true(depth_region_samples(&r) == 12);
  double low[2] = {1, 1}, high[2] = {0, 0}, sum[2] = {0, 0};
  enum { SEEDS = 20000 };
  for (uint64_t seed = 0; seed < SEEDS; ++seed)
    for (uint32_t i = 0; i < 12; ++i) {
      depth_sample at = depth_region_sample(&r, seed * 0x9e3779b97f4a7c15u, i);
      double part[2] = {(at.x / 8 + 0.5) * r.counts[0] - i / r.counts[1], (at.y / 6 + 0.5) * r.counts[1] - i % r.counts[1]};
      for (int k = 0; k < 2; ++k) {
        assert_true(part[k] > -1e-12 && part[k] < 1 + 1e-12);
        low[k] = fmin(low[k], part[k]);
        high[k] = fmax(high[k], part[k]);
        sum[k] += part[k] / (12.0 * SEEDS);
      }
    }
  for (int k = 0; k < 2; ++k)   /* the standard error of the mean is 0.0006 */
    assert_true(low[k] < 0.001 && high[k] > 0.999 && fabs(sum[k] - 0.5) < 0.003);
}

/* Mean and variance of the patterns: 1/12 of the side's square where the density is even, less for the gaussian. */
static void moments_of_the_patterns(void **state) {
  (void)state;
  enum { SEEDS = 20000 };
  for (int pattern = PATTERN_JITTERED; pattern <= PATTERN_INSIDE; ++pattern) {
    dsm_settings s = with(16, 1, 1, 0, (sample_pattern)pattern);
    depth_region r = box_of(2, 2, &s);
    double n = 16.0 * SEEDS, mean = 0, square = 0, cross = 0, bias = 0, least = 1, most = 0;
    for (uint64_t seed = 1; seed <= SEEDS; ++seed)
      for (uint32_t i = 0; i < 16; ++i) {
        depth_sample at = depth_region_sample(&r, seed << 20, i);
        assert_true(fabs(at.x) <= 2 && fabs(at.y) <= 2 && at.bias >= 0 && at.bias < 1);
        mean += at.x / n;
        square += at.y * at.y / n;
        cross += at.x * at.y / n;
        bias += at.bias / n;
        least = fmin(least, at.bias);
        most = fmax(most, at.bias);
      }
    /* of exp(-2 t^2) on [-1,1] the variance is 1/4 - exp(-2) / (2 sqrt(pi/2) erf(sqrt 2)) = 0.19343, times 2^2 */
    double variance = pattern == PATTERN_GAUSSIAN ? 4 * 0.19343 : 16.0 / 12;
    if (fabs(mean) > 0.01 || fabs(square - variance) > 0.012 || fabs(cross) > 0.012)
      fail_msg("pattern %d: mean %g, square %g of %g, cross %g", pattern, mean, square, variance, cross);
    assert_true(fabs(bias - 0.5) < 0.003 && least < 0.001 && most > 0.999);
  }
}

/* Every split is within its bounds, and asks for no more than it may. */
static void any_footprint(void **state) {
  (void)state;
  rng r = rng_seeded(3);
  for (int k = 0; k < 200000; ++k) {
    dsm_settings s = with(1 + rng_below(&r, 4096), 1 + rng_below(&r, 64), rng_below(&r, 3) ? rng_scale(&r, 1e-3, 1e3) : 0,
                          rng_below(&r, 3) ? rng_scale(&r, 1e-3, 1e3) : 0, (sample_pattern)rng_below(&r, 4));
    double sides[2][2];
    for (int i = 0; i < 4; ++i) sides[i / 2][i % 2] = rng_below(&r, 4) ? rng_between(&r, -1, 1) * rng_scale(&r, 1e-9, 1e9) : 0;
    depth_region region = depth_region_of((const double (*)[2])sides, &s);
    uint32_t least = s.min_samples < s.samples ? s.min_samples : s.samples;
    for (int i = 0; i < 2; ++i) {
      assert_seeded(&r, region.counts[i] >= least && region.counts[i] <= s.samples);
      for (int j = 0; j < 2; ++j) assert_seeded(&r, fabs(region.sides[i][j]) <= 2e9);
    }
    assert_seeded(&r, depth_region_samples(&region) <= (s.samples + 0.5 * region.counts[0]) * 1.5 + least * (s.samples + 1.0));
    depth_sample at = depth_region_sample(&region, rng_bits(&r), rng_below(&r, depth_region_samples(&region)));
    assert_seeded(&r, isfinite(at.x) && isfinite(at.y));
  }
}

static void seeds(void **state) {
  (void)state;
  const double a[3] = {1, 0.0, 3}, b[3] = {1, -0.0, 3}, c[3] = {1, 3, 0}, d[3] = {1, 0, nextafter(3, 4)}, none[3] = {0, 0, 0};
  assert_true(depth_region_seed(a) == depth_region_seed(b));
  assert_true(depth_region_seed(a) != depth_region_seed(c) && depth_region_seed(a) != depth_region_seed(d));
  assert_true(depth_region_seed(none) != 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(samples_are_split_as_in_the_figure),
    cmocka_unit_test(size_and_its_least),
    cmocka_unit_test(slanted_footprints),
    cmocka_unit_test(jitter_fills_every_part),
    cmocka_unit_test(moments_of_the_patterns),
    cmocka_unit_test(any_footprint),
    cmocka_unit_test(seeds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
