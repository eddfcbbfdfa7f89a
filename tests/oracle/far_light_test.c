/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A light at 1e5 or 1e9 units gives the picture of a light nearby: depths keep the casters' scale. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "oracle.h"

static void same_as_parallel(double distance, dsm_light light, double depth_slack) {
  shape all[] = {sheet_at(1, 1, 0.5, 0.6, 0.7), sphere_at(0.2, 0.1, 0, 0.4, 0), sheet_at(-1, 1, 0.9, 0.8, 0.7)};
  stage far, near;
  stage_open(&far, all, 3, light, WORDS("resolution 128", "samples 16"));
  stage_open(&near, all, 3, parallel_at(0, 0, 10, 0, 0, -1), WORDS("resolution 128", "samples 16"));
  rng r = rng_seeded((uint64_t)distance);
  double sum = 0, product = 0.5;
  for (int i = 0; i < 4000; ++i) {
    double x = rng_between(&r, -0.8, 0.8), y = rng_between(&r, -0.8, 0.8), z = rng_between(&r, -2, 2);
    double rim = hypot(x - 0.2, y - 0.1) - 0.4, a = light_of(&far, in_air(x, y, z), 0), b = light_of(&near, in_air(x, y, z), 0);
    sum += (a - b) * (a - b);
    if (fabs(rim) < 0.04 || fabs(z - 1) < depth_slack || fabs(z + 1) < depth_slack) continue;
    if (rim < 0 && fabs(fabs(z) - sqrt(0.16 - (rim + 0.4) * (rim + 0.4))) < 0.1) continue;   /* at the ball's surface */
    product = (z < 1 ? 0.5 : 1) * (z < -1 ? 0.9 : 1) * (rim < 0 && z < 0 ? 0 : 1);
    if (rim < 0 && fabs(z) < 0.4) continue;
    assert_seeded(&r, fabs(a - product) < 0.01);
  }
  assert_true(sqrt(sum / 4000) < 0.03);
  /* the ball's own lit side, and the sheets' */
  for (double a = 0; a <= 89; a += 0.5) {
    double t = a * acos(-1) / 180, n[3] = {sin(t) * 0.6, sin(t) * 0.8, cos(t)};
    dsm_receiver ball = on_plane(0.2 + 0.4 * n[0], 0.1 + 0.4 * n[1], 0.4 * n[2], n[0], n[1], n[2]);
    double rgb[3];
    if (a > 87.5 && dsm_api.lookup(far.worker, &ball, rgb) == DSM_TRACE) continue;   /* under light that grazes a map may decline */
    double lit = light_of(&far, ball, 0);
    /* near the rim the plane's bias reads in front of the glass above, which then takes less */
    if (a <= 60) assert_true(fabs(lit - 0.5) < 0.0021);
    else assert_true(lit > 0.43);
  }
  assert_true(light_of(&far, on_plane(0.7, 0.7, 1, 0, 0, 1), 0) == 1);
  assert_true(fabs(light_of(&far, on_plane(0.7, 0.7, -1, 0, 0, 1), 0) - 0.5) < 0.0021);
  stage_close(&far);
  stage_close(&near);
}

static void point_light(void **state) {
  (void)state;
  same_as_parallel(1e5, point_at(0, 0, 1e5), 1e-4);
  same_as_parallel(1e9, point_at(0, 0, 1e9), 1e-4);
}

static void spotlight(void **state) {
  (void)state;
  same_as_parallel(1e5, spot_at(0, 0, 1e5, 0, 0, -1, 1), 1e-4);
  same_as_parallel(1e9, spot_at(0, 0, 1e9, 0.1, 0.2, -1, 30), 1e-4);
}

static void parallel_light(void **state) {
  (void)state;
  same_as_parallel(1e5, parallel_at(1e5, 0, 1e5, 0, 0, -1), 1e-4);
  same_as_parallel(1e9, parallel_at(0, 0, 1e9, 0, 0, -1), 1e-4);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(point_light),
    cmocka_unit_test(spotlight),
    cmocka_unit_test(parallel_light),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
