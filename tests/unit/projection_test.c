/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "core/face_fit.h"
#include "random.h"

static void fit(const dsm_light *light, const uint32_t resolution[2], double filter_width, projection *out) {
  dsm_settings settings;
  settings_defaults(&settings);
  settings.resolution[0] = resolution[0];
  settings.resolution[1] = resolution[1];
  settings.filter_width = filter_width;
  face_fit(light, &settings, out);
}

static const uint32_t SQUARE[2] = {64, 0};

static dsm_light random_light(rng *r, uint32_t kind) {
  dsm_light light = {.size = sizeof light, .kind = kind};
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    light.origin[i] = rng_below(r, 4) ? rng_between(r, -5, 5) : rng_scale(r, 1, 1e9);
    light.direction[i] = rng_below(r, 3) ? rng_between(r, -1, 1) : 0;
  }
  light.direction[rng_below(r, 3)] += 2;
  for (int i = 0; i < 3; ++i) size += light.direction[i] * light.direction[i];
  for (int i = 0; i < 3; ++i) light.direction[i] /= sqrt(size);
  light.cos_angle = cos(acos(-1) / 180 * (rng_below(r, 2) ? rng_between(r, 0.001, 60) : rng_between(r, 60, 179)));
  light.radius = rng_below(r, 2) ? 0 : rng_between(r, 0, 5);
  return light;
}

static void random_boxes(rng *r, dsm_box *boxes, uint32_t n, const double origin[3]) {
  for (uint32_t k = 0; k < n; ++k)
    for (int i = 0; i < 3; ++i) {
      double near_light = rng_below(r, 2) ? fmax(-50, fmin(50, origin[i])) : 0;
      boxes[k].low[i] = near_light + rng_between(r, -5, 5);
      boxes[k].high[i] = boxes[k].low[i] + (rng_below(r, 4) ? rng_between(r, 0, 3) : 0);
    }
}

/* Whether the light shines there at all. */
static int shines(const dsm_light *light, const double point[3]) {
  double q[3], along = 0, square = 0;
  for (int i = 0; i < 3; ++i) {
    q[i] = point[i] - light->origin[i];
    along += q[i] * light->direction[i];
    square += q[i] * q[i];
  }
  switch (light->kind) {
    case DSM_LIGHT_SPOT: return along >= light->cos_angle * sqrt(square) + 1e-9 * sqrt(square);
    case DSM_LIGHT_PARALLEL:
      return along > 0 && (light->radius == 0 || square - along * along < 0.999 * light->radius * light->radius);
    default: return square > 0;
  }
}

/* Every lit point of a caster is inside the grid of its faces, margin kept, and between their depths; and the ray
 * through its pixel coordinates goes through it. */
static void casters_are_inside_and_rays_come_back(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(6000); ++seed) {
    rng r = rng_seeded(seed);
    dsm_light light = random_light(&r, rng_below(&r, 3));
    dsm_box boxes[6];
    light.casters = boxes;
    light.caster_count = 1 + rng_below(&r, 6);
    random_boxes(&r, boxes, (uint32_t)light.caster_count, light.origin);
    uint32_t resolution[2] = {1 + rng_below(&r, 200), rng_below(&r, 3) ? 0 : 1 + rng_below(&r, 200)};
    double width = rng_between(&r, 0.01, 5);
    double margin = ceil(0.5 * width + 0.5);
    projection p;
    fit(&light, resolution, width, &p);
    for (int k = 0; k < 60; ++k) {
      const dsm_box *box = &boxes[rng_below(&r, (uint32_t)light.caster_count)];
      double point[3], reach = 0;
      for (int i = 0; i < 3; ++i) {
        point[i] = rng_below(&r, 4) ? rng_between(&r, box->low[i], box->high[i]) : box->low[i];
        reach = fmax(reach, fabs(point[i] - light.origin[i]));
      }
      if (!shines(&light, point)) continue;
      projected hits[3];
      uint32_t n = projection_find(&p, point, 0.5, hits);
      double sum = 0;
      assert_seeded(&r, n > 0);
      for (uint32_t h = 0; h < n; ++h) {
        const face *f = &p.faces[hits[h].face];
        sum += hits[h].weight;
        assert_seeded(&r, hits[h].depth >= f->near_depth && hits[h].depth <= f->far_depth);
        double slack = p.count == MAX_FACES ? 0.51 : 1e-3;   /* cubes answer half a pixel beyond their edge */
        assert_seeded(&r, hits[h].x >= margin - slack && hits[h].x <= f->width - margin + slack);
        assert_seeded(&r, hits[h].y >= margin - slack && hits[h].y <= f->height - margin + slack);
        dsm_ray ray;
        projection_ray(&p, hits[h].face, hits[h].x, hits[h].y, &ray);
        for (int i = 0; i < 3; ++i)
          assert_seeded(&r, fabs(ray.origin[i] + hits[h].depth * ray.direction[i] - point[i]) <= 1e-13 * reach + 1e-12);
      }
      assert_seeded(&r, fabs(sum - 1) < 1e-12);
    }
  }
}

static void resolution_is_that_of_the_longer_side(void **state) {
  (void)state;
  dsm_box box = {{-2, -1, 5}, {2, 1, 6}};
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_PARALLEL, .direction = {0, 0, 1}, .casters = &box, .caster_count = 1};
  projection p;
  fit(&light, SQUARE, 1, &p);
  assert_int_equal(p.faces[0].width, 64);
  assert_int_equal(p.faces[0].height, 33);   /* 31 over the caster, and the margin */
  assert_true(p.faces[0].pixel_u == p.faces[0].pixel_v);
  assert_true(fabs(p.faces[0].pixel_u - 4.0 / 62) < 1e-12);
  uint32_t both[2] = {30, 70};
  fit(&light, both, 1, &p);
  assert_true(p.faces[0].width == 30 && p.faces[0].height == 70);
  uint32_t one[2] = {1, 1};
  fit(&light, one, 1, &p);
  assert_true(p.faces[0].width == 3 && p.faces[0].height == 3);
  light.radius = 0.5;
  fit(&light, SQUARE, 1, &p);
  assert_true(p.faces[0].width == 64 && p.faces[0].height == 64 && fabs(p.faces[0].pixel_u - 1.0 / 62) < 1e-12);
}

static void a_caster_of_no_size(void **state) {
  (void)state;
  dsm_box boxes[2] = {{{1, 2, 3}, {1, 2, 3}}, {{1, 2, 3}, {1, 2, 3}}};
  for (uint32_t kind = 0; kind < 3; ++kind)
    for (int at_light = 0; at_light < 2; ++at_light) {
      dsm_light light = {.size = sizeof light, .kind = kind, .direction = {0, 0.6, 0.8}, .cos_angle = 0.9, .casters = boxes, .caster_count = 2};
      if (at_light) memcpy(light.origin, boxes[0].low, sizeof light.origin);
      projection p;
      fit(&light, SQUARE, 1, &p);
      for (uint32_t i = 0; i < p.count; ++i) {
        const face *f = &p.faces[i];
        assert_true(f->width <= 64 && f->height <= 64);
        if (f->width) assert_true(f->pixel_u > 0 && f->pixel_v > 0 && isfinite(f->per_u) && f->near_depth <= f->far_depth);
      }
      double points[3][3] = {{1, 2, 3}, {1.1, 2.2, 3.3}, {-5, 0, 7}};
      for (int k = 0; k < 3; ++k) {
        projected hits[3];
        uint32_t n = projection_find(&p, points[k], 0.5, hits);
        for (uint32_t h = 0; h < n; ++h) assert_true(isfinite(hits[h].x) && isfinite(hits[h].y) && isfinite(hits[h].depth));
      }
    }
}

static void no_casters_no_faces(void **state) {
  (void)state;
  projection p;
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_POINT};
  projected hits[3];
  fit(&light, SQUARE, 1, &p);
  assert_int_equal(projection_find(&p, (double[]){1, 2, 3}, 0.5, hits), 0);
  /* behind a spotlight, out of its cone, out of a cylinder, behind its plane: no pixels either */
  dsm_box box = {{-1, -1, -9}, {1, 1, -8}};
  light = (dsm_light){.size = sizeof light, .kind = DSM_LIGHT_SPOT, .direction = {0, 0, 1}, .cos_angle = 0.9, .casters = &box, .caster_count = 1};
  fit(&light, SQUARE, 1, &p);
  assert_int_equal(p.faces[0].width, 0);
  light.kind = DSM_LIGHT_PARALLEL;
  fit(&light, SQUARE, 1, &p);
  assert_int_equal(p.faces[0].width, 0);
  box = (dsm_box){{5, 5, 8}, {6, 6, 9}};
  light.radius = 1;
  fit(&light, SQUARE, 1, &p);
  assert_int_equal(p.faces[0].width, 0);
  light.kind = DSM_LIGHT_SPOT;
  fit(&light, SQUARE, 1, &p);
  assert_int_equal(p.faces[0].width, 0);
}

/* One face as long as 60 degrees are enough, else six. */
static void point_lights_choose_between_one_face_and_six(void **state) {
  (void)state;
  dsm_box box = {{-1, -1, 2}, {1, 1, 3}};
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_POINT, .casters = &box, .caster_count = 1};
  projection p;
  fit(&light, SQUARE, 1, &p);
  assert_int_equal(p.count, 1);
  box.low[2] = 0.5;
  fit(&light, SQUARE, 1, &p);
  assert_int_equal(p.count, 6);
  assert_int_equal(p.faces[1].width, 0);
  light.origin[2] = -1e9;
  fit(&light, SQUARE, 1, &p);
  assert_int_equal(p.count, 1);
  assert_true(fabs(p.faces[0].near_depth - (1e9 + 0.5)) < 1e-5 && fabs(p.faces[0].far_depth - (1e9 + 3)) < 1e-5);
}

/* Around a cube's edges and corners the weights of the faces change without a jump and add up to 1. */
static void cube_weights_are_continuous(void **state) {
  (void)state;
  dsm_box box = {{-1, -1, -1}, {1, 1, 1}};
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_POINT, .origin = {0.25, 0.5, -0.25}, .casters = &box, .caster_count = 1};
  projection p;
  fit(&light, SQUARE, 1, &p);
  for (uint64_t seed = 0; seed < most_cases(300); ++seed) {
    rng r = rng_seeded(seed);
    double start[3], step[3], before[MAX_FACES] = {0};
    for (int i = 0; i < 3; ++i) {
      start[i] = light.origin[i] + (rng_below(&r, 3) ? (rng_below(&r, 2) ? 3 : -3) : rng_between(&r, -3, 3));
      step[i] = rng_between(&r, -1, 1) * 1e-3;
    }
    for (int t = -200; t <= 200; ++t) {
      double point[3], now[MAX_FACES] = {0}, sum = 0;
      for (int i = 0; i < 3; ++i) point[i] = start[i] + t * step[i];
      projected hits[3];
      uint32_t n = projection_find(&p, point, 0.5, hits);
      for (uint32_t h = 0; h < n; ++h) {
        const face *f = &p.faces[hits[h].face];
        now[hits[h].face] = hits[h].weight;
        sum += hits[h].weight;
        assert_seeded(&r, hits[h].x > 0.5 - 1e-9 && hits[h].x < f->width - 0.5 + 1e-9);
      }
      assert_seeded(&r, fabs(sum - 1) < 1e-12);
      for (int i = 0; i < MAX_FACES && t > -200; ++i) assert_seeded(&r, fabs(now[i] - before[i]) < 0.05);
      memcpy(before, now, sizeof before);
    }
  }
}

static void frames_are_orthonormal(void **state) {
  (void)state;
  rng r = rng_seeded(4);
  for (int k = 0; k < 1000; ++k) {
    double d[3] = {rng_between(&r, -1, 1), k % 3 ? rng_between(&r, -1, 1) : 1, k % 7 ? rng_between(&r, -1, 1) : 0};
    if (k == 0) d[0] = d[2] = 0;
    double size = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int i = 0; i < 3; ++i) d[i] /= size;
    frame f = frame_along(d);
    const double *axis[3] = {f.right, f.up, f.forward};
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        double dot = 0;
        for (int i = 0; i < 3; ++i) dot += axis[a][i] * axis[b][i];
        assert_seeded(&r, fabs(dot - (a == b)) < 1e-14);
      }
  }
}

/* face_level_within against a count of all levels, at all sizes next to powers of two. */
static void levels_end_at_one_pixel(void **state) {
  (void)state;
  for (uint32_t power = 0; power < 15; ++power)
    for (uint32_t width = (1u << power) - (power > 0); width <= (1u << power) + 1; ++width)
      for (uint32_t height = 1; height <= width; height += width > 1 ? width - 1 : 1) {
        face f = {.width = width, .height = height}, turned = {.width = height, .height = width};
        for (uint32_t level = 0; level < MAX_LEVELS; ++level) {
          uint32_t last = face_levels(&f) - 1, expected = level < last ? level : last;
          assert_int_equal(face_level_within(&f, level), expected);
          assert_int_equal(face_level_within(&turned, level), expected);
        }
      }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(casters_are_inside_and_rays_come_back),
    cmocka_unit_test(resolution_is_that_of_the_longer_side),
    cmocka_unit_test(a_caster_of_no_size),
    cmocka_unit_test(no_casters_no_faces),
    cmocka_unit_test(point_lights_choose_between_one_face_and_six),
    cmocka_unit_test(cube_weights_are_continuous),
    cmocka_unit_test(frames_are_orthonormal),
    cmocka_unit_test(levels_end_at_one_pixel),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
