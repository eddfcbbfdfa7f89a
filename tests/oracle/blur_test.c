/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Wide look-ups: `blur` and footprints spread a shadow's edge by what was asked for, and move no light. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "oracle.h"

/* An opaque half plane x > edge in a map of 4 x 4 scene units, under a parallel light. */
static shape half_plane(double edge) {
  shape s = sheet_at(5, 2, 0, 0, 0);
  s.box.low[0] = edge;
  return s;
}

static dsm_receiver spread_out(double x, double y, double across, double up) {
  dsm_receiver r = in_air(x, y, 9);
  r.has_footprint = across > 0 || up > 0;
  r.footprint[0][0] = across;
  r.footprint[1][1] = up;
  return r;
}

typedef struct { double place, deviation; } edge;

/* Where an edge at `angle` is and how wide, from the light across it: mean and deviation of its derivative. */
static edge measure(stage *s, double reach, double across, double up) {
  double sum = 0, first = 0, second = 0, last = 0, step = reach / 400;
  for (double x = -reach; x <= reach; x += step) {
    double light = 1 - light_of(s, spread_out(x, 0.137, across, up), 0), slope = light - last;
    assert_true(light >= last - 0.004);   /* levels are compressed */
    sum += slope;
    first += slope * (x - step / 2);
    second += slope * (x - step / 2) * (x - step / 2);
    last = light;
  }
  assert_true(fabs(sum - 1) < 0.004);
  return (edge){first, sqrt(second - first * first)};
}

/* Over many positions of the edge, as a coarse pixel does not know where in it an edge lies. */
static void check_edge(const char *blur, double across, double up, double width) {
  double place = 0, variance = 0, pixel = 4.0 / 254;
  const int edges = UNLESS_SLOW(24, 12);
  for (int k = 0; k < edges; ++k) {
    shape all[] = {sheet_at(4, 2, 1, 1, 1), half_plane(0.3 * (k + 0.5) / edges - 0.15)};
    stage s;
    stage_open(&s, all, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 256", "samples 16", blur));
    edge e = measure(&s, 0.9, across, up);
    place += (e.place - all[1].box.low[0]) / edges;
    variance += e.deviation * e.deviation / edges;
    stage_close(&s);
  }
  /* the bilinear look-up alone has a variance of a quarter of a pixel's square */
  double want = sqrt(0.25 * pixel * pixel + fmax(0, width * width - pixel * pixel) / 12);
  if (!(fabs(place) < 0.05 * want && fabs(sqrt(variance) - want) < 0.06 * want))
    fail_msg("%s, footprint %g %g: off by %g, deviation %g for %g", blur, across, up, place, sqrt(variance), want);
}

static void edges_are_as_wide_as_asked(void **state) {
  (void)state;
  check_edge("blur 0", 0, 0, 0);
  check_edge("blur 0.015", 0, 0, 0.015 * 256 * 4 / 254);
  check_edge("blur 0.05", 0, 0, 0.05 * 256 * 4 / 254);
  check_edge("blur 0.1", 0, 0, 0.1 * 256 * 4 / 254);
  check_edge("blur 0", 0.1, 0.1, 0.1);
  check_edge("blur 0", 0.3, 0.3, 0.3);
  check_edge("blur 0", 0.25, 0.06, 0.25);     /* long across the edge */
  check_edge("blur 0", 0.06, 0.25, 0.06);     /* and along it: sharp */
  check_edge("blur 0.025", 0.1, 0.1, sqrt(0.01 + 0.025 * 256 * 4 / 254 * 0.025 * 256 * 4 / 254));
}

/* Whatever the width, a shadow takes as much light. */
static void light_is_kept(void **state) {
  (void)state;
  const double area = acos(-1) * 0.25 * 0.25;
  const char *const blurs[] = {"blur 0", "blur 0.02", "blur 0.07", "blur 0.15"};
  for (int k = 0; k < 4; ++k) {
    shape ball = sphere_at(0.21, -0.13, 5, 0.25, 0), wide[] = {sheet_at(4, 1, 1, 1, 1), ball};
    stage s;
    stage_open(&s, wide, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 128", "samples 16", blurs[k]));
    double lost = 0, step = 0.011;
    for (double x = -1.5; x < 1.5; x += step)
      for (double y = -1.5; y < 1.5; y += step) lost += (1 - light_of(&s, in_air(x, y, 9), 0)) * step * step;
    assert_true(fabs(lost - area) < 0.01 * area);
    stage_close(&s);
  }
}

/* A shadow at the frame's edge spreads beyond it. */
static void beyond_the_frame(void **state) {
  (void)state;
  shape all[] = {sheet_at(5, 1, 0, 0, 0)};
  stage s;
  stage_open(&s, all, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 128", "blur 0.1"));
  edge e = {0, 0};
  double last = 1, sum = 0;
  for (double x = 0; x <= 1.6; x += 1e-3) {
    double dark = 1 - light_of(&s, in_air(x, 0.1, 9), 0);
    assert_true(dark <= last + 0.004 && last - dark < 0.03);   /* no jump */
    sum += last - dark;
    e.place += (last - dark) * (x - 5e-4);
    last = dark;
  }
  assert_true(last == 0 && fabs(sum - 1) < 0.004 && fabs(e.place - 1) < 0.01);
  stage_close(&s);
}

/* Six faces: a uniform shell stays uniform across their edges, a ball's shadow continuous. */
static void no_seam_in_a_cube(void **state) {
  (void)state;
  shape shell = sphere_at(0, 0, 0, 5, 0.5);
  stage s;
  stage_open(&s, &shell, 1, point_at(0.5, -0.25, 1), WORDS("resolution 64", "tolerance 0", "blur 0.06"));
  rng r = rng_seeded(1);
  for (int i = 0; i < (int)most_cases(20000); ++i) {
    double d[3];
    for (int k = 0; k < 3; ++k) d[k] = rng_below(&r, 4) ? rng_between(&r, -1, 1) : rng_below(&r, 2) ? 1 : -1;
    if (fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2]))) < 0.75) continue;
    assert_seeded(&r, fabs(light_of(&s, in_air(0.5 + 9 * d[0], 9 * d[1] - 0.25, 1 + 9 * d[2]), 1) - 0.5) < 1e-4);
  }
  stage_close(&s);
}

/* The lit side of a ball and of slanted ground is lit under any blur; what lies deep in shadow is dark. */
static void no_acne(void **state) {
  (void)state;
  const char *const blurs[] = {"blur 0.02", "blur 0.1"};
  for (int k = 0; k < 2; ++k) {
    shape ball = sphere_at(0, 0, 5, 1, 0);
    stage s;
    stage_open(&s, &ball, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 128", blurs[k]));
    for (double degrees = 0; degrees < 60; degrees += 1)
      for (int turn = 0; turn < 12; ++turn) {
        double a = degrees * acos(-1) / 180, b = turn * 0.5236 + 0.1;
        double n[3] = {sin(a) * cos(b), sin(a) * sin(b), -cos(a)}, rgb[3] = {-1, -1, -1};
        dsm_receiver at = on_plane(n[0], n[1], 5 + n[2], n[0], n[1], n[2]);
        dsm_result result = dsm_api.lookup(s.worker, &at, rgb);
        if (result != DSM_OK || rgb[0] < 0.999) fail_msg("%s: result %d, light %g at %g degrees", blurs[k], (int)result, rgb[0], degrees);
      }
    assert_true(light_of(&s, on_plane(0.2, 0.1, 6.5, 0, 0, -1), 0) == 0);
    stage_close(&s);
  }
}

/* Towards the foot of a wall that stands on the ground the shadow sharpens, and never leaks at the contact. */
static void contact(void **state) {
  (void)state;
  shape wall[] = {half_plane(0), sheet_at(5.02, 1, 1, 1, 1)};
  stage s;
  stage_open(&s, wall, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 128", "blur 0.1"));
  double rgb[3];
  for (double x = -0.3; x <= 0.3; x += 0.01) {
    double slant = 0.3, size = sqrt(1 + slant * slant);
    dsm_receiver at = on_plane(x, 0.1, 5.02 + slant * x, slant / size, 0, -1 / size);
    dsm_result result = dsm_api.lookup(s.worker, &at, rgb);
    assert_true(result == DSM_TRACE || result == DSM_OK || result == DSM_OUTSIDE);
    if (result == DSM_OK && x > 0.2) assert_true(rgb[0] < 0.05);
    if (result == DSM_OK && x < -0.2) assert_true(rgb[0] > 0.95);
  }
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(edges_are_as_wide_as_asked),
    cmocka_unit_test(light_is_kept),
    cmocka_unit_test(beyond_the_frame),
    cmocka_unit_test(no_seam_in_a_cube),
    cmocka_unit_test(no_acne),
    cmocka_unit_test(contact),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
