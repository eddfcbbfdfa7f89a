/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/receiver_depth.h"
#include "core/settings.h"
#include "random.h"

/* A point on a plane, somewhere in a face. */
typedef struct { projection p; projected at; dsm_plane bound; double point[3], half, cosine; } scene;

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void random_direction(rng *r, double out[3]) {
  for (int i = 0; i < 3; ++i) out[i] = rng_between(r, -1, 1);
  double length = sqrt(dot(out, out));
  for (int i = 0; i < 3; ++i) out[i] /= length;
}

static scene random_scene(rng *r, int perspective, double smallest, double largest) {
  scene s = {.p = {.perspective = perspective, .count = 1}, .half = rng_between(r, 0.1, 2)};
  face *f = &s.p.faces[0];
  double forward[3];
  random_direction(r, forward);
  s.p.axes = f->axes = frame_along(forward);
  f->pixel_u = rng_scale(r, smallest, largest);
  f->pixel_v = f->pixel_u * rng_between(r, 0.5, 2);
  f->u0 = rng_between(r, -1, 0.5);
  f->v0 = rng_between(r, -1, 0.5);
  s.at.x = rng_between(r, 0, 0.5) / f->pixel_u;
  s.at.y = rng_between(r, 0, 0.5) / f->pixel_v;
  s.at.u = f->u0 + s.at.x * f->pixel_u;
  s.at.v = f->v0 + s.at.y * f->pixel_v;
  s.at.depth = rng_scale(r, 0.1, 1e4);
  s.at.nearness = s.p.perspective ? sqrt(s.at.u * s.at.u + s.at.v * s.at.v + 1) / s.at.depth : 1;
  random_direction(r, s.bound.normal);
  for (int i = 0; i < 3; ++i) s.p.origin[i] = rng_between(r, -5, 5);
  dsm_ray ray;
  projection_ray(&s.p, 0, s.at.x, s.at.y, &ray);
  for (int i = 0; i < 3; ++i) s.point[i] = ray.origin[i] + s.at.depth * ray.direction[i];
  s.cosine = fabs(dot(s.bound.normal, ray.direction));
  return s;
}

static receiver_plane seen(const scene *s, double bias) {
  receiver_plane plane;
  receiver_plane_seen(&s->p, &s->at, &s->bound, &(receiver_region){s->half, 1}, bias, &plane);
  return plane;
}

/* How deep the plane is along the ray du, dv pixels off; perspective: negative where it is behind the light. */
static double plane_depth(const scene *s, double du, double dv) {
  dsm_ray ray;
  projection_ray(&s->p, 0, s->at.x + du, s->at.y + dv, &ray);
  double to_plane[3];
  for (int i = 0; i < 3; ++i) to_plane[i] = s->point[i] - ray.origin[i];
  return dot(s->bound.normal, to_plane) / dot(s->bound.normal, ray.direction);
}

/* The plane at its nearest within a pixel's footprint, by trying: covered, and by little more than it takes. */
static void bias_covers_the_footprint(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(3000); ++seed) {
    rng r = rng_seeded(seed);
    scene s = random_scene(&r, seed % 3 > 0, 1e-4, 0.02);
    if (s.cosine < 0.03) continue;
    receiver_plane plane = seen(&s, SETTING_AUTOMATIC);
    double du = rng_between(&r, -1, 1), dv = rng_between(&r, -1, 1), need = 0;
    for (int i = -4; i <= 4; ++i)
      for (int j = -4; j <= 4; ++j) {
        double z = plane_depth(&s, du + s.half * i / 4, dv + s.half * j / 4);
        if (z > 0 || !s.p.perspective) need = fmax(need, s.at.depth - z);
      }
    double bias = receiver_bias(&plane, du, dv), middle = receiver_middle(&plane, du, dv);
    double rounding = 1e-11 * s.at.depth;
    assert_seeded(&r, bias >= need - rounding);
    /* what the plane's image on the sphere of directions bends within reach, and no slope */
    double across = (1 + s.half) * fmax(s.p.faces[0].pixel_u, s.p.faces[0].pixel_v);
    double bend = s.p.perspective ? 3 * s.at.depth * across * across / s.cosine : 0;
    assert_seeded(&r, bias <= 1.01 * need + bend + rounding);
    assert_seeded(&r, middle >= 0 && middle <= bias);
  }
}

/* Of a sloped plane about two thirds of the filter's samples are behind the middle: between 5/8, where it
 * slopes along one side of the pixels only, and 23/32, where along both alike. */
static void two_thirds_are_behind_the_middle(void **state) {
  (void)state;
  enum { SIDE = 40 };
  int tried[2] = {0, 0};
  for (uint64_t seed = 0; seed < most_cases(600); ++seed) {
    rng r = rng_seeded(seed);
    scene s = random_scene(&r, seed % 2, 1e-6, 1e-4);
    if (s.cosine < 0.1 || s.cosine > 0.9) continue;
    receiver_plane plane = seen(&s, SETTING_AUTOMATIC);
    double du = rng_below(&r, 2) ? rng_between(&r, -1, 1) : 0, dv = du != 0 ? rng_between(&r, -1, 1) : 0;
    double middle = receiver_middle(&plane, du, dv);
    if (middle == 0) continue;   /* this pixel lies down the slope, all behind the point */
    int behind = 0;
    for (int i = 0; i < SIDE; ++i)
      for (int j = 0; j < SIDE; ++j) {
        double a = 2 * (i + rng_unit(&r)) / SIDE - 1, b = 2 * (j + rng_unit(&r)) / SIDE - 1;
        behind += plane_depth(&s, du + s.half * a, dv + s.half * b) > s.at.depth - middle;
      }
    double share = behind / (double)(SIDE * SIDE);
    assert_seeded(&r, share > 0.61 && share < 0.74);
    ++tried[seed % 2];
  }
  assert_true(tried[0] > (int)most_cases(600) / 12 && tried[1] > (int)most_cases(600) / 12);
}

/* A rise is added as it is, and a bias that the settings fix takes the place of all that the plane tells. */
static void rise_and_fixed_bias(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(500); ++seed) {
    rng r = rng_seeded(seed);
    scene s = random_scene(&r, seed % 2, 1e-4, 0.02);
    double du = rng_between(&r, -1, 1), dv = rng_between(&r, -1, 1), rise = rng_scale(&r, 1e-3, 10);
    receiver_plane flat = seen(&s, SETTING_AUTOMATIC);
    s.bound.rise = rise;
    receiver_plane raised = seen(&s, SETTING_AUTOMATIC);
    double flat_bias = receiver_bias(&flat, du, dv);
    assert_seeded(&r, receiver_bias(&raised, du, dv) == flat_bias + rise);
    assert_seeded(&r, receiver_middle(&raised, du, dv) == receiver_middle(&flat, du, dv));
    for (int k = 0; k < 2; ++k) {
      double fixed = k * rng_scale(&r, 1e-6, 1);
      receiver_plane set = seen(&s, fixed);
      assert_seeded(&r, receiver_bias(&set, du, dv) == fixed && receiver_middle(&set, du, dv) == 0);
    }
  }
}

/* A plane through the light or along it: no NaN, no infinity; in perspective all the depth and no more. */
static void edge_on(void **state) {
  (void)state;
  static const double normals[4][3] = {{1, 0, 0}, {0, -1, 0}, {0.6, 0.8, 0}, {0, 0, 0}};
  for (int perspective = 0; perspective < 2; ++perspective)
    for (int k = 0; k < 4; ++k) {
      projection p = {.perspective = perspective, .count = 1};
      p.faces[0] = (face){.axes = frame_along((double[]){0, 0, 1}), .pixel_u = 0.01, .pixel_v = 0.02};
      projected at = {.depth = 7, .nearness = perspective ? 1.0 / 7 : 1};
      dsm_plane bound = {{normals[k][0], normals[k][1], normals[k][2]}, 0};
      receiver_plane plane;
      receiver_plane_seen(&p, &at, &bound, &(receiver_region){0.625, 1}, SETTING_AUTOMATIC, &plane);
      if (perspective) assert_true(fabs(receiver_bias(&plane, 0, 0) - 7) < 1e-12);
      else if (k < 3) assert_true(receiver_bias(&plane, 0, 0) > 1e20);
      for (int d = 0; d < 9; ++d) {
        double bias = receiver_bias(&plane, d / 3 - 1, d % 3 - 1);
        double middle = receiver_middle(&plane, d / 3 - 1, d % 3 - 1);
        assert_true(middle >= 0 && middle <= bias && isfinite(bias));
        if (perspective) assert_true(fabs(bias - 7) < 1e-12);
      }
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(bias_covers_the_footprint),
    cmocka_unit_test(two_thirds_are_behind_the_middle),
    cmocka_unit_test(rise_and_fixed_bias),
    cmocka_unit_test(edge_on),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
