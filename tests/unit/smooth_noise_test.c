/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Noisy stretches are simplified, and nothing else moves. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "bake/smooth_noise.h"
#include "core/compress.h"
#include "random.h"

enum { STEPS = 16, MOST = 4 * STEPS };

/* A plateau of `level` after a calm step, then a staircase of rays' steps to `end` between depths 3 and 4, all noise; then
 * calm, and a calm step at 6. */
static void staircase(rng *r, double level, double end, vertices *mean, double allowed[MOST], double noise) {
  mean->count = 0;
  double v = level, z = 3, height[STEPS], sum = 0;   /* some tall, some not: the first step may survive or not */
  for (int i = 0; i < STEPS; ++i) sum += height[i] = rng_scale(r, 0.01, 1);
  if (level < 1) {
    vertices_push(mean, 2, rgb_grey(1));
    vertices_push(mean, 2, rgb_grey(level));
  }
  for (int i = 0; i < STEPS; ++i) {
    vertices_push(mean, z, rgb_grey(v));
    v += (end - level) * height[i] / sum;
    vertices_push(mean, z, rgb_grey(i + 1 < STEPS ? v : end));
    z += rng_between(r, 0.3, 1.7) / STEPS;
  }
  vertices_push(mean, 6, rgb_grey(end));
  vertices_push(mean, 6, rgb_grey(0.5 * end));
  for (size_t i = 0; i < mean->count; ++i)
    allowed[i] = mean->data[i].z >= 3 && mean->data[i].v.c[0] > end && mean->data[i].v.c[0] < level ? noise : 0;
}

static void check(rng *r, double level, double end, double noise) {
  vertices mean = {0}, scratch = {0}, out = {0};
  double allowed[MOST];
  staircase(r, level, end, &mean, allowed, noise);
  noise_profile profile = {.allowed = allowed};
  noise_limits limits = {0.002, 0.0625, 0, 0};
  int compressed;
  assert_int_equal(smooth_noise(&mean, &profile, 1, &limits, &scratch, &out, &compressed), DSM_OK);
  assert_seeded(r, out.count <= mean.count + 2 && !compressed);
  for (double z = 1; z < 8; z += 1.0 / 1024) {   /* far enough from the calm steps */
    double want = vertices_at(mean.data, mean.count, z).c[0], got = vertices_at(out.data, out.count, z).c[0];
    int noisy = z >= 3 && want < level && want > end;
    if (!(fabs(got - want) <= (noisy ? noise + 1e-12 : z >= 3 && z < 6 ? noise : 1e-12)))
      fail_msg("at %g: %g for %g (level %g, end %g)", z, got, want, level, end);
  }
  /* what lies behind and in front is as it was, to the last bit but rounding */
  assert_seeded(r, fabs(vertices_at(out.data, out.count, 5.5).c[0] - end) < 1e-12);
  assert_seeded(r, fabs(vertices_at(out.data, out.count, 2.9).c[0] - level) < 1e-12);
  for (size_t i = 1; i < out.count; ++i)
    assert_seeded(r, out.data[i].z >= out.data[i - 1].z && out.data[i].v.c[0] <= out.data[i - 1].v.c[0]);
  vertices_free(&mean);
  vertices_free(&scratch);
  vertices_free(&out);
}

static void calm_parts_stay(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(2000); ++seed) {
    rng r = rng_seeded(seed);
    double level = seed % 3 ? rng_between(&r, 0.3, 1) : 1;
    check(&r, level, level * rng_between(&r, 0, 0.9), rng_between(&r, 0.01, 0.06));
  }
}

/* A surface that all rays end at, each at its own depth: nothing is left to compress. */
static void one_stretch_is_compressed_already(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(500); ++seed) {
    rng r = rng_seeded(seed);
    vertices mean = {0}, scratch = {0}, out = {0}, again = {0};
    double allowed[MOST], z = 3, noise = rng_between(&r, 0.01, 0.06);
    int compressed;
    for (int i = 0; i < STEPS; ++i, z += rng_between(&r, 0.3, 1.7) / STEPS) {
      allowed[mean.count] = i ? noise : 0;
      vertices_push(&mean, z, rgb_grey(1 - (double)i / STEPS));
      allowed[mean.count] = i + 1 < STEPS ? noise : 0;
      vertices_push(&mean, z, rgb_grey(1 - (i + 1.0) / STEPS));
    }
    noise_profile profile = {.allowed = allowed};
    noise_limits limits = {0.002, 0.0625, 0, 0};
    assert_int_equal(smooth_noise(&mean, &profile, 1, &limits, &scratch, &out, &compressed), DSM_OK);
    assert_int_equal(compress_minimal(mean.data, mean.count, 1, noise, &again), DSM_OK);
    assert_seeded(&r, compressed && out.count == again.count && out.data[out.count - 1].v.c[0] == 0);
    vertices_free(&mean);
    vertices_free(&scratch);
    vertices_free(&out);
    vertices_free(&again);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(calm_parts_stay),
    cmocka_unit_test(one_stretch_is_compressed_already),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
