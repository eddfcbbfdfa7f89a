/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A light among its casters: six faces, and no seam between them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/projection.h"
#include "map/map.h"
#include "oracle.h"

/* A shell of tinted bubbles all around. */
enum { BUBBLES = 400 };
static shape bubbles[BUBBLES];

static void make_bubbles(void) {
  rng r = rng_seeded(9);
  for (int i = 0; i < BUBBLES; ++i) {
    double d[3], size = 0;
    for (int k = 0; k < 3; ++k) {
      d[k] = rng_between(&r, -1, 1);
      size += d[k] * d[k];
    }
    for (int k = 0; k < 3; ++k) d[k] *= rng_between(&r, 2, 4) / sqrt(size);
    bubbles[i] = sphere_at(1 + d[0], 2 + d[1], 3 + d[2], 0.25, 0.7);
  }
}

/* A point 8 units from the light in a direction within `off` of a cube's edge or corner. */
static dsm_receiver near_edge(rng *r, int corner, double off[3]) {
  double d[3];
  int axis = (int)rng_below(r, 3);
  for (int k = 0; k < 3; ++k) d[k] = rng_below(r, 2) ? 1 : -1;
  if (!corner) d[axis] = rng_between(r, -1, 1);
  double size = 0;
  for (int k = 0; k < 3; ++k) {
    d[k] += off[k];
    size += d[k] * d[k];
  }
  return in_air(1 + 8 * d[0] / sqrt(size), 2 + 8 * d[1] / sqrt(size), 3 + 8 * d[2] / sqrt(size));
}

/* Crossing an edge in steps of a thousandth of a pixel never changes light by more than the steepest bilinear slope. */
static void continuous(const char *resolution, const char *filter, double pixel) {
  stage s;
  stage_open(&s, bubbles, BUBBLES, point_at(1, 2, 3), WORDS(resolution, filter, "samples 8"));
  rng r = rng_seeded(21);
  int dimmed = 0;
  for (int k = 0; k < 300; ++k) {
    double direction[3], last = -1;
    for (int i = 0; i < 3; ++i) direction[i] = rng_between(&r, -1, 1);
    rng same = r;
    for (int t = -1500; t <= 1500; ++t) {
      double off[3];
      for (int i = 0; i < 3; ++i) off[i] = direction[i] * pixel * 1e-3 * t;
      same = r;
      double light = light_of(&s, near_edge(&same, k % 4 == 0, off), 0);
      dimmed += light < 0.9;
      if (last >= 0) assert_seeded(&r, fabs(light - last) < 0.004);
      last = light;
    }
    r = same;
  }
  assert_true(dimmed > 100000);
  stage_close(&s);
}

static void no_seam(void **state) {
  (void)state;
  continuous("resolution 64", "filter box", 2.0 / 62);
  continuous("resolution 64 48", "filter gaussian 3", 2.0 / 60);
  continuous("resolution 7", "filter triangle 2", 2.0 / 3);
}

/* A uniform shell of glass has no seam at all. */
static void uniform_shell(void **state) {
  (void)state;
  shape shell = sphere_at(0, 0, 0, 5, 0.5);
  stage s;
  stage_open(&s, &shell, 1, point_at(0.5, -0.25, 1), WORDS("resolution 40", "tolerance 0"));
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(s.map, &got);
  assert_int_equal(got.faces, 6);
  assert_int_equal(got.pixels, 6 * 40 * 40);
  rng r = rng_seeded(1);
  for (int i = 0; i < 20000; ++i) {
    double d[3];
    for (int k = 0; k < 3; ++k) d[k] = rng_below(&r, 4) ? rng_between(&r, -1, 1) : rng_below(&r, 2) ? 1 : -1;
    assert_seeded(&r, fabs(light_of(&s, in_air(0.5 + 9 * d[0], 9 * d[1] - 0.25, 1 + 9 * d[2]), 1) - 0.5) < 1e-5
                      || fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2]))) < 0.75);
  }
  stage_close(&s);
}

/* Faces are cropped to what they see; a lone caster on an edge is in both, and casts its shadow through both. */
static void cropped_faces(void **state) {
  (void)state;
  shape all[] = {sphere_at(4, 0.1, 0, 0.3, 0), sphere_at(-3, 0, 3.01, 0.2, 0), sphere_at(0, -3, 0, 0.01, 0)};
  stage s;
  stage_open(&s, all, 3, point_at(0, 0, 0), WORDS("resolution 128"));
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(s.map, &got);
  assert_int_equal(got.faces, 4);
  assert_true(got.pixels < 3 * 128 * 128);
  assert_true(light_of(&s, in_air(8, 0.2, 0), 0) == 0 && light_of(&s, in_air(-6, 0, 6.02), 0) == 0);
  assert_true(light_of(&s, in_air(-6, 0, 6.02 + 1e-9), 0) == 0 && light_of(&s, in_air(-6.02, 0, 6), 0) == 0);
  assert_true(light_of(&s, in_air(8, 3, 0), 0) == 1 && light_of(&s, in_air(0, 5, 0), 0) == 1);
  assert_true(light_of(&s, in_air(0, 0, 0), 0) == 1);
  /* around the caster on the edge, the shadow's area is the ball's on both sides */
  double side[2] = {0, 0}, step = 0.002;
  for (double u = -0.1; u <= 0.1; u += step)
    for (double v = -0.1; v <= 0.1; v += step) {
      double a = -3 * acos(-1) / 4 + u, d[3] = {sin(a) * cos(v), sin(v), -cos(a) * cos(v)};
      side[u > 0] += (1 - light_of(&s, in_air(-fabs(9 * d[0]), 9 * d[1], fabs(9 * d[2])), 0)) * step * step;
    }
  double sine = 0.2 / hypot(3, 3.01);
  assert_true(fabs(side[0] + side[1] - acos(-1) * sine * sine) < 0.03 * acos(-1) * sine * sine);
  stage_close(&s);
}

/* Above 60 degrees a spotlight has a cube too; behind it is no light to shadow. */
static void wide_spotlight(void **state) {
  (void)state;
  for (int degrees = 61; degrees <= 179; degrees += 59) {
    shape all[] = {sphere_at(0, 0, 4, 1, 0), sphere_at(4, 0, 0.2, 1, 0), sphere_at(0, 0, -4, 1, 0)};
    stage s;
    stage_open(&s, all, 3, spot_at(0, 0, 0, 0, 0, 1, degrees), WORDS("resolution 64"));
    assert_true(light_of(&s, in_air(0.1, 0, 8), 0) == 0 && light_of(&s, in_air(3, 3, 8), 0) == 1);
    if (degrees > 90) assert_true(light_of(&s, in_air(8, 0, 0.3), 0) == 0 && light_of(&s, in_air(0, 0, -8), 0) == 0);
    stage_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_seam),
    cmocka_unit_test(uniform_shell),
    cmocka_unit_test(cropped_faces),
    cmocka_unit_test(wide_spotlight),
  };
  make_bubbles();
  return cmocka_run_group_tests(tests, NULL, NULL);
}
