/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Opaque spheres: where the shadow's edge lies, how much of a pixel it covers, and no sphere on itself. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "oracle.h"

static const double PI = 3.14159265358979323846;

/* Across the edge of a parallel shadow the light passes 1/2 at the sphere's radius, within a fraction of a pixel. */
static void edge_position(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  stage s;
  stage_open(&s, &ball, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 258", "samples 64"));
  double pixel = 2.0 / 256;
  for (int k = 0; k < 60; k += UNLESS_SLOW(1, 12)) {
    double angle = 2 * PI * k / 60, sum = 0;
    for (int i = 0; i < 200; ++i) {   /* the integral of light over radii 0.9 … 1.1 */
      double r = 0.9 + 0.2 * (i + 0.5) / 200;
      sum += light_of(&s, in_air(r * cos(angle), r * sin(angle), 8), 0) / 200;
    }
    double edge = 1.1 - 0.2 * sum;
    assert_true(fabs(edge - 1) < 0.15 * pixel);
  }
  stage_close(&s);
}

/* The light that a whole shadow takes is the disc's area. */
static void coverage(void **state) {
  (void)state;
  shape ball = sphere_at(0.3, -0.2, 5, 1, 0);
  stage s;
  stage_open(&s, &ball, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 66", "samples 16"));
  double step = 2.0 / 64 / 3, lost = 0;
  for (double x = -1 + step / 2; x < 1.6; x += step)
    for (double y = -1.5 + step / 2; y < 1.1; y += step) lost += (1 - light_of(&s, in_air(x, y, 9), 0)) * step * step;
  assert_true(fabs(lost - PI) < 0.003 * PI);
  stage_close(&s);
}

/* A spotlight: the edge lies where the tangent cone meets the receiving plane. */
static void edge_of_a_cone(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  stage s;
  stage_open(&s, &ball, 1, spot_at(0, 0, 0, 0, 0, 1, 25), WORDS("resolution 256", "samples 64"));
  double sine = 1.0 / 5, radius = 10 * sine / sqrt(1 - sine * sine), pixel = 2 * radius / 250, sum = 0;
  for (int i = 0; i < 400; ++i) sum += light_of(&s, in_air(radius * (0.9 + 0.2 * (i + 0.5) / 400), 0.01, 10), 0) / 400;
  assert_true(fabs(radius * (1.1 - 0.2 * sum) - radius) < 0.3 * pixel);
  stage_close(&s);
}

/* The lit side up to 89 degrees from the light's direction is exactly lit; the far side is dark from 20 degrees
 * past the rim on, out of the filter's reach. */
static void self_shadow(const dsm_light *light, const double centre[3], double radius, const char *resolution,
                        const char *filter) {
  shape ball = sphere_at(centre[0], centre[1], centre[2], radius, 0);
  stage s;
  stage_open(&s, &ball, 1, *light, WORDS(resolution, "samples 16", filter));
  double to_light[3], length = 0, across[3], third[3];
  for (int i = 0; i < 3; ++i) {
    to_light[i] = light->kind == DSM_LIGHT_PARALLEL ? -light->direction[i] : light->origin[i] - centre[i];
    length += to_light[i] * to_light[i];
  }
  for (int i = 0; i < 3; ++i) to_light[i] /= sqrt(length);
  double helper[3] = {to_light[1], to_light[2], -to_light[0]}, along = 0, size = 0;
  for (int i = 0; i < 3; ++i) along += helper[i] * to_light[i];
  for (int i = 0; i < 3; ++i) {
    across[i] = helper[i] - along * to_light[i];
    size += across[i] * across[i];
  }
  for (int i = 0; i < 3; ++i) across[i] /= sqrt(size);
  for (int i = 0; i < 3; ++i)
    third[i] = to_light[(i + 1) % 3] * across[(i + 2) % 3] - to_light[(i + 2) % 3] * across[(i + 1) % 3];
  /* from nearby the lit cap ends where the view from the light touches the sphere */
  double rim = light->kind == DSM_LIGHT_PARALLEL ? 90 : acos(radius / sqrt(length)) * 180 / PI;
  for (double degrees = 0; degrees <= 180; degrees += degrees > rim - 3 && degrees < rim + 3 ? 0.25 : 1)
    for (int k = 0; k < 16; ++k) {
      double a = degrees * PI / 180, b = 2 * PI * (k + 0.3) / 16, n[3];
      dsm_receiver r = {.plane_count = 1};
      for (int i = 0; i < 3; ++i) {
        n[i] = cos(a) * to_light[i] + sin(a) * (cos(b) * across[i] + sin(b) * third[i]);
        r.point[i] = centre[i] + radius * n[i];
        r.planes[0].normal[i] = degrees < 90 ? n[i] : -n[i];
      }
      double rgb[3] = {-1, -1, -1}, light_here;
      dsm_result result = dsm_api.lookup(s.worker, &r, rgb);
      if (result == DSM_TRACE && degrees > rim - 0.01) continue;   /* at the terminator a map may decline */
      if (result != DSM_OK && result != DSM_OUTSIDE) fail_msg("result %d at %g degrees", (int)result, degrees);
      light_here = rgb[0];
      if (degrees <= rim - 1 && light_here != 1)
        fail_msg("acne at %g degrees, turn %d: %g", degrees, k, light_here);
      if (degrees >= rim + 20 && light_here > 0.01)
        fail_msg("leak at %g degrees, turn %d: %g", degrees, k, light_here);
    }
  stage_close(&s);
}

static void no_acne_and_no_leak(void **state) {
  (void)state;
  static const double at[3] = {0.1, 0.2, 5}, low[3] = {3, 2.5, 2.9}, far[3] = {700, -300, 900};
  static const char *const filters[] = {"filter box", "filter triangle", "filter gaussian 3"};
  for (int f = 0; f < UNLESS_SLOW(3, 1); ++f) {
    dsm_light parallel = parallel_at(1, 2, -3, -0.1, 0.2, 1), spot = spot_at(0, 0, 0, 0, 0, 1, 25), point = point_at(0, 0, 0);
    self_shadow(&parallel, at, 1, "resolution 128", filters[f]);
    self_shadow(&spot, at, 1, "resolution 128", filters[f]);
    self_shadow(&point, at, 1, "resolution 200", filters[f]);
    self_shadow(&point, low, 1, "resolution 128", filters[f]);
    self_shadow(&point, far, 20, "resolution 512", filters[f]);
  }
}

/* The room's light: a sphere at any angle from it, over all six faces. */
static void no_acne_in_a_cube(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < UNLESS_SLOW(6u, 1u); ++seed) {
    rng r = rng_seeded(seed);
    shape balls[14];
    for (int i = 0; i < 14; ++i) {
      double d[3], size = 0;
      for (int k = 0; k < 3; ++k) {
        d[k] = rng_between(&r, -1, 1);
        size += d[k] * d[k];
      }
      for (int k = 0; k < 3; ++k) d[k] *= rng_between(&r, 4, 8) / sqrt(size);
      balls[i] = sphere_at(d[0], d[1], d[2], 0.2, 0);
    }
    stage s;
    stage_open(&s, balls, 14, point_at(0, 0, 0), WORDS("resolution 256"));
    for (int k = 0; k < (int)most_cases(3000); ++k) {
      const shape *ball = &balls[rng_below(&r, 14)];
      double n[3], size = 0, cosine = 0, distance = 0;
      dsm_receiver on = {.plane_count = 1};
      for (int i = 0; i < 3; ++i) {
        n[i] = rng_between(&r, -1, 1);
        size += n[i] * n[i];
      }
      for (int i = 0; i < 3; ++i) {
        on.planes[0].normal[i] = n[i] /= sqrt(size);
        on.point[i] = 0.5 * (ball->box.low[i] + ball->box.high[i]) + 0.2 * n[i];
        cosine -= n[i] * on.point[i];
        distance += on.point[i] * on.point[i];
      }
      if (cosine / sqrt(distance) < 0.03) continue;
      /* other balls may be in the way; they are far enough apart to be told by a ray */
      double clear = 1;
      for (int b = 0; b < 14; ++b) {
        double along = 0, away = 0;
        for (int i = 0; i < 3; ++i) along += 0.5 * (balls[b].box.low[i] + balls[b].box.high[i]) * on.point[i] / sqrt(distance);
        for (int i = 0; i < 3; ++i) {
          double d = 0.5 * (balls[b].box.low[i] + balls[b].box.high[i]) - along * on.point[i] / sqrt(distance);
          away += d * d;
        }
        if (&balls[b] != ball && along > 0 && along < sqrt(distance) + 0.5 && sqrt(away) < 0.35) clear = 0;
      }
      if (clear == 1) assert_seeded(&r, light_of(&s, on, 0) == 1);
    }
    stage_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(edge_position),
    cmocka_unit_test(coverage),
    cmocka_unit_test(edge_of_a_cone),
    cmocka_unit_test(no_acne_and_no_leak),
    cmocka_unit_test(no_acne_in_a_cube),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
