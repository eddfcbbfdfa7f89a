/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "core/face_fit.h"
#include "random.h"

enum { BOXES = 40 };

static void fit(const dsm_light *light, const uint32_t resolution[2], double filter_width, projection *out) {
  dsm_settings settings;
  settings_defaults(&settings);
  settings.resolution[0] = resolution[0];
  settings.resolution[1] = resolution[1];
  settings.filter_width = filter_width;
  face_fit(light, &settings, out);
}

/* All coordinates are multiples of 1/64, so that moving light and casters together changes no rounding. */
static double step(rng *r, double low, double high) { return floor(64 * rng_between(r, low, high)) / 64; }

static dsm_light random_light(rng *r, dsm_box boxes[BOXES]) {
  dsm_light light = {.size = sizeof light, .kind = rng_below(r, 3), .casters = boxes};
  double length = 0, spread = rng_below(r, 2) ? 2 : 6;
  for (int i = 0; i < 3; ++i) {
    light.origin[i] = step(r, -5, 5);
    light.direction[i] = rng_between(r, -1, 1);
    length += light.direction[i] * light.direction[i];
  }
  for (int i = 0; i < 3; ++i) light.direction[i] /= sqrt(length);
  light.cos_angle = cos(acos(-1) / 180 * (rng_below(r, 2) ? rng_between(r, 1, 60) : rng_between(r, 60, 179)));
  light.radius = rng_below(r, 2) ? 0 : rng_between(r, 0.5, 5);
  light.caster_count = 1 + rng_below(r, rng_below(r, 2) ? 4 : BOXES);
  for (uint64_t k = 0; k < light.caster_count; ++k)
    for (int i = 0; i < 3; ++i) {
      boxes[k].low[i] = step(r, -spread, spread);
      boxes[k].high[i] = boxes[k].low[i] + (rng_below(r, 5) ? step(r, 0, 3) : 0);
    }
  return light;
}

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static int shines(const dsm_light *light, const double q[3]) {
  double along = dot(q, light->direction), square = dot(q, q);
  if (light->kind == DSM_LIGHT_POINT) return square > 0;
  if (light->kind == DSM_LIGHT_SPOT) return along > (light->cos_angle + 1e-9) * sqrt(square);
  return along > 0 && (light->radius == 0 || square - along * along < 0.999 * light->radius * light->radius);
}

/* Each point of a caster that the light reaches, seen by each face that looks its way: the filter of the
 * outermost pixels, half a pixel from the border, does not reach it. No use of projection_find. */
static void casters_keep_out_of_the_margin(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(5000); ++seed) {
    rng r = rng_seeded(seed);
    dsm_box boxes[BOXES];
    dsm_light light = random_light(&r, boxes);
    uint32_t resolution[2] = {1 + rng_below(&r, 150), rng_below(&r, 3) ? 0 : 1 + rng_below(&r, 150)};
    double width = rng_between(&r, 0.01, 5), margin = 0.5 + 0.5 * width - 1e-3;
    projection p;
    fit(&light, resolution, width, &p);
    for (int k = 0; k < 40; ++k) {
      const dsm_box *box = &boxes[rng_below(&r, (uint32_t)light.caster_count)];
      double q[3];
      for (int i = 0; i < 3; ++i) {
        double t = rng_below(&r, 2) ? rng_unit(&r) : rng_below(&r, 2);   /* corners and edges often */
        q[i] = box->low[i] + t * (box->high[i] - box->low[i]) - light.origin[i];
      }
      if (!shines(&light, q)) continue;
      int faces = 0;
      for (uint32_t i = 0; i < p.count; ++i) {
        const face *f = &p.faces[i];
        double z = dot(q, f->axes.forward), u = dot(q, f->axes.right), v = dot(q, f->axes.up);
        if (!(z > 0) || (p.count == MAX_FACES && !(fabs(u) <= z && fabs(v) <= z))) continue;
        ++faces;
        double tangent = p.perspective ? 1 / z : 1, depth = p.perspective ? sqrt(dot(q, q)) : z;
        double x = (u * tangent - f->u0) / f->pixel_u, y = (v * tangent - f->v0) / f->pixel_v;
        assert_seeded(&r, x >= margin && x <= f->width - margin);
        assert_seeded(&r, y >= margin && y <= f->height - margin);
        assert_seeded(&r, depth >= f->near_depth && depth <= f->far_depth);
        assert_seeded(&r, fabs(f->per_u * f->pixel_u - 1) < 1e-15 && fabs(f->per_v * f->pixel_v - 1) < 1e-15);
      }
      assert_seeded(&r, faces > 0);
    }
  }
}

/* No side of any face is longer than asked for, and the longest is as long. */
static void resolution_is_met(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(5000); ++seed) {
    rng r = rng_seeded(seed);
    dsm_box boxes[BOXES];
    dsm_light light = random_light(&r, boxes);
    uint32_t resolution[2] = {20 + rng_below(&r, 100), rng_below(&r, 3) ? 0 : 20 + rng_below(&r, 100)};
    uint32_t longest[2] = {0, 0};
    projection p;
    fit(&light, resolution, rng_between(&r, 0.01, 5), &p);
    for (uint32_t i = 0; i < p.count; ++i) {
      longest[0] = p.faces[i].width > longest[0] ? p.faces[i].width : longest[0];
      longest[1] = p.faces[i].height > longest[1] ? p.faces[i].height : longest[1];
    }
    const face *f = &p.faces[0];
    double least = 1e-9;   /* casters that are points or lines have nothing to fill the face with */
    if (longest[0] && resolution[1]) {
      assert_seeded(&r, longest[0] <= resolution[0] && longest[1] <= resolution[1]);
      if (f->pixel_u > least) assert_seeded(&r, longest[0] == resolution[0]);
      if (f->pixel_v > least) assert_seeded(&r, longest[1] == resolution[1]);
    }
    else if (longest[0] && f->pixel_u > least)
      assert_seeded(&r, (longest[0] > longest[1] ? longest[0] : longest[1]) == resolution[0]);
  }
}

static void a_cubes_faces_look_six_ways(void **state) {
  (void)state;
  dsm_box box = {{-3, -3, -3}, {3, 3, 3}};
  dsm_light light = {.size = sizeof light, .casters = &box, .caster_count = 1};
  for (int degrees = 0; degrees < 180; degrees += 15) {
    rng r = rng_seeded((uint64_t)degrees);
    light.kind = degrees > 60 ? DSM_LIGHT_SPOT : DSM_LIGHT_POINT;
    light.cos_angle = cos(acos(-1) / 180 * degrees) + 1e-12;   /* 90 degrees are in front, whatever cos says */
    memcpy(light.direction, frame_along((double[]){0.48, 0.6, 0.64}).right, sizeof light.direction);
    projection p;
    fit(&light, (uint32_t[]){40, 0}, 1, &p);
    assert_int_equal(p.count, MAX_FACES);
    for (int i = 0; i < MAX_FACES; ++i) {
      const frame *a = &p.faces[i].axes;
      double turn[3] = {a->up[1] * a->forward[2] - a->up[2] * a->forward[1],
                        a->up[2] * a->forward[0] - a->up[0] * a->forward[2],
                        a->up[0] * a->forward[1] - a->up[1] * a->forward[0]};
      assert_seeded(&r, fabs(dot(turn, a->right) - 1) < 1e-14 && fabs(dot(a->up, a->forward)) < 1e-14);
      for (int k = 0; k < i; ++k)
        assert_seeded(&r, dot(a->forward, p.faces[k].axes.forward) < 1e-14);   /* across or opposite */
      int back = light.kind == DSM_LIGHT_SPOT && degrees <= 90 && dot(a->forward, light.direction) < -0.5;
      assert_seeded(&r, (p.faces[i].width == 0) == back);
      if (!back) assert_seeded(&r, p.faces[i].pixel_u == p.faces[0].pixel_u);
    }
    assert_true(p.overlap > 0 && p.overlap <= 0.5 * p.faces[0].pixel_u);
  }
}

/* The grid follows the casters' places around the light, not where both are nor how casters are ordered. */
static void only_what_the_light_sees_matters(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(1000); ++seed) {
    rng r = rng_seeded(seed);
    dsm_box boxes[BOXES], moved[BOXES];
    dsm_light light = random_light(&r, boxes), other = light;
    double by[3] = {step(&r, -1000, 1000), step(&r, -1000, 1000), step(&r, -1000, 1000)};
    other.casters = moved;
    for (int i = 0; i < 3; ++i) {
      other.origin[i] += by[i];
      for (uint64_t k = 0; k < light.caster_count; ++k) {
        moved[light.caster_count - 1 - k].low[i] = boxes[k].low[i] + by[i];
        moved[light.caster_count - 1 - k].high[i] = boxes[k].high[i] + by[i];
      }
    }
    projection p, q;
    fit(&light, (uint32_t[]){64, 0}, 1, &p);
    fit(&other, (uint32_t[]){64, 0}, 1, &q);
    assert_seeded(&r, memcmp(q.origin, other.origin, sizeof q.origin) == 0 && p.count == q.count);
    assert_seeded(&r, memcmp(p.faces, q.faces, sizeof p.faces) == 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(casters_keep_out_of_the_margin),
    cmocka_unit_test(resolution_is_met),
    cmocka_unit_test(a_cubes_faces_look_six_ways),
    cmocka_unit_test(only_what_the_light_sees_matters),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
