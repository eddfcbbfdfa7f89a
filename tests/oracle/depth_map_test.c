/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Depth maps with percentage closer filtering, against the percentage itself: over all pixels of the map, one by one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "map/depth_tile.h"
#include "map/map.h"
#include "oracle.h"

/* Depth where a light ray meets the first of the shapes, all opaque. */
static double first_depth(world *w, const dsm_ray *ray) {
  double first = INFINITY;
  for (int i = 0; i < w->count; ++i) {
    const shape *s = &w->shapes[i];
    if (s->kind == SHEET) {
      double z = (s->box.low[2] - ray->origin[2]) / ray->direction[2];
      double x = ray->origin[0] + z * ray->direction[0], y = ray->origin[1] + z * ray->direction[1];
      if (z > 0 && x >= s->box.low[0] && x <= s->box.high[0] && y >= s->box.low[1] && y <= s->box.high[1]) first = fmin(first, z);
      continue;
    }
    double along = 0, away = 0, radius = 0.5 * (s->box.high[0] - s->box.low[0]), to[3];
    for (int k = 0; k < 3; ++k) {
      to[k] = 0.5 * (s->box.low[k] + s->box.high[k]) - ray->origin[k];
      along += to[k] * ray->direction[k];
    }
    for (int k = 0; k < 3; ++k) away += (to[k] - along * ray->direction[k]) * (to[k] - along * ray->direction[k]);
    if (away <= radius * radius && along > 0) first = fmin(first, along - sqrt(radius * radius - away));
  }
  return first;
}

static double pixel_depth(stage *s, uint32_t face_index, uint32_t x, uint32_t y) {
  dsm_ray ray;
  projection_ray(&s->map->projection, face_index, x + 0.5, y + 0.5, &ray);
  return first_depth(&s->w, &ray);
}

/* Share of draws of the bias with which depth z is behind a surface at d. */
static double behind(double z, double d, const double bias[2]) {
  if (!(d < INFINITY)) return 0;
  if (bias[1] <= bias[0]) return z > d + bias[0];
  return fmin(1, fmax(0, (z - d - bias[0]) / (bias[1] - bias[0])));
}

/* How much of a box or gaussian around `at`, `half` to each side, lies in pixel i. */
static double weight_in(double at, double half, uint32_t i, int gaussian) {
  double a = fmax(-1, fmin(1, (i - at) / half)), b = fmax(-1, fmin(1, (i + 1 - at) / half));
  return gaussian ? (erf(b * sqrt(2)) - erf(a * sqrt(2))) / (2 * erf(sqrt(2))) : (b - a) / 2;
}

/* The proportion of the region that is in shadow, by the definition (RSC 2), for maps of one face. */
static double percentage(stage *s, const double point[3], double half_x, double half_y, const double bias[2], int gaussian) {
  const face *f = &s->map->projection.faces[0];
  projected hits[3];
  if (projection_find(&s->map->projection, point, INFINITY, hits) == 0) return 0;
  projected at = hits[0];
  double dark = 0;
  for (uint32_t y = 0; y < f->height; ++y) {
    double up = weight_in(at.y, half_y, y, gaussian);
    for (uint32_t x = 0; x < f->width && up > 0; ++x) {
      double w = up * weight_in(at.x, half_x, x, gaussian);
      if (w > 0) dark += w * behind(at.depth, pixel_depth(s, 0, x, y), bias);
    }
  }
  return dark;
}

/* The automatic bounds of a region that reaches so many pixels: 1.5 and 2 of what it and a pixel more are wide there. */
static void automatic_bias(stage *s, const double point[3], double half, double bias[2]) {
  const face *f = &s->map->projection.faces[0];
  double along = 0;
  for (int k = 0; k < 3; ++k) along += (point[k] - s->map->projection.origin[k]) * f->axes.forward[k];
  double width = (half + 1) * fmax(f->pixel_u, f->pixel_v) * (s->map->projection.perspective ? along : 1);
  bias[0] = s->map->settings.depth_bias[0] < 0 ? 1.5 * width : s->map->settings.depth_bias[0];
  bias[1] = s->map->settings.depth_bias[1] < 0 ? 2 * width : s->map->settings.depth_bias[1];
}

/* The mean of look-ups at points that are the same but for their hash, and how much it may be off. */
static double mean_light(stage *s, dsm_receiver at, int count, rng *r) {
  double sum = 0, scale = fabs(at.point[0]) + fabs(at.point[1]) + fabs(at.point[2]), point[3];
  for (int i = 0; i < 3; ++i) point[i] = at.point[i];
  for (int k = 0; k < count; ++k) {
    for (int i = 0; i < 3; ++i) at.point[i] = point[i] + rng_between(r, -1e-12, 1e-12) * scale;
    double light = light_of(s, at, 0);
    assert_seeded(r, light == light_of(s, at, 1) && light == light_of(s, at, 2));
    sum += light / count;
  }
  return sum;
}

enum { BALLS = 60 };
static shape balls[BALLS];

static void make_balls(void) {
  rng r = rng_seeded(4);
  for (int i = 0; i < BALLS; ++i)
    balls[i] = sphere_at(rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 4, 6), rng_between(&r, 0.05, 0.3), 0);
}

/* Whatever the light and the pattern: over many seeds the look-up is the percentage over its region. */
static void mean_is_the_percentage(dsm_light light, const char *const *words, int gaussian) {
  stage s;
  rng r = rng_seeded(11);
  stage_open(&s, balls, BALLS, light, words);
  int between = 0;
  for (int k = 0; k < 120; ++k) {
    dsm_receiver at = in_air(rng_between(&r, -1.2, 1.2), rng_between(&r, -1.2, 1.2), rng_between(&r, 3.9, 6.5));
    double bias[2];
    automatic_bias(&s, at.point, 3, bias);
    double expected = 1 - percentage(&s, at.point, 3, 3, bias, gaussian), got = mean_light(&s, at, 300, &r);
    between += expected > 0.1 && expected < 0.9;
    /* 4800 samples have a standard error of 0.007 at most */
    if (fabs(got - expected) > 0.035) fail_msg("seed %llu, %d: %g, not %g", (unsigned long long)r.seed, k, got, expected);
  }
  assert_true(between > 25);
  stage_close(&s);
}

static void percentages(void **state) {
  (void)state;
  mean_is_the_percentage(parallel_at(0, 0, 0, 0, 0, 1), WORDS("shadow_map", "resolution 60"), 0);
  mean_is_the_percentage(parallel_at(0, 0, 0, 0, 0, 1), WORDS("shadow_map", "resolution 60", "pattern uniform"), 0);
  mean_is_the_percentage(parallel_at(0, 0, 0, 0, 0, 1), WORDS("shadow_map", "resolution 60", "pattern inside"), 0);
  mean_is_the_percentage(parallel_at(0, 0, 0, 0, 0, 1), WORDS("shadow_map", "resolution 60", "pattern gaussian"), 1);
  mean_is_the_percentage(spot_at(0, 0, 0, 0, 0, 1, 30), WORDS("shadow_map", "resolution 50 70", "bias 0.1 0.5"), 0);
  mean_is_the_percentage(point_at(3, 0, -1), WORDS("shadow_map", "resolution 64", "bias 0.2"), 0);
  mean_is_the_percentage(spot_at(1e5, 0, 0, -1e5, 0, 5, 1), WORDS("shadow_map", "resolution 64"), 0);
}

/* A half plane: the share is the distance to its edge over the region's width, to the stratum. */
static void half_plane(void **state) {
  (void)state;
  shape all[] = {sheet_at(5, 1, 0, 0, 0), sheet_at(6, 1, 1, 1, 1)};   /* the second one is clear: no depth */
  all[0].box.low[0] = 0;
  stage s;
  rng r = rng_seeded(2);
  stage_open(&s, all, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("shadow_map", "resolution 66"));
  double pixel = s.map->projection.faces[0].pixel_u;
  for (double t = -8; t <= 8; t += 0.05) {   /* pixels from the edge */
    double expected = fmax(0, fmin(1, 0.5 - t / 6)), light = light_of(&s, in_air(t * pixel, 0.3, 9), 0);
    assert_seeded(&r, fabs(light - expected) <= 0.25 + 1e-9);   /* one of four columns is in doubt */
    assert_seeded(&r, fabs(mean_light(&s, in_air(t * pixel, 0.3, 9), 200, &r) - expected) < 0.02);
  }
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(s.map, &got);
  assert_int_equal(got.samples % 16, 0);
  assert_true(got.samples > 16 * 60000 && got.vertices > 0 && got.vertices <= got.pixels_baked / 2);
  stage_close(&s);
}

/* A camera ray's own footprint is the region: twice size_factor times as wide, but never below min_size. */
static void footprints(void **state) {
  (void)state;
  stage s;
  rng r = rng_seeded(8);
  stage_open(&s, balls, BALLS, parallel_at(0, 0, 0, 0, 0, 1), WORDS("shadow_map", "resolution 100", "size_factor 2", "bias 0.01 0.02"));
  const double bias[2] = {0.01, 0.02};
  double pixel = s.map->projection.faces[0].pixel_u;
  for (int k = 0; k < 60; ++k) {
    dsm_receiver at = in_air(rng_between(&r, -1, 1), rng_between(&r, -1, 1), 7);
    double a = rng_between(&r, -3, 3), b = rng_between(&r, -3, 3), c = rng_between(&r, -3, 3), d = rng_between(&r, -3, 3);
    if (k % 4 == 0) b = d = 0.1;
    at.has_footprint = 1;
    at.footprint[0][0] = -a * pixel;   /* right of a light that looks along z is ±x; signs do not matter */
    at.footprint[0][1] = b * pixel;
    at.footprint[0][2] = 3;            /* along the light: nothing */
    at.footprint[1][0] = c * pixel;
    at.footprint[1][1] = d * pixel;
    double half_x = fmax(2, 2 * (fabs(a) + fabs(c))), half_y = fmax(2, 2 * (fabs(b) + fabs(d)));
    double expected = 1 - percentage(&s, at.point, half_x, half_y, bias, 0), got = mean_light(&s, at, 300, &r);
    if (fabs(got - expected) > 0.035) fail_msg("seed %llu, %d: %g, not %g", (unsigned long long)r.seed, k, got, expected);
  }
  stage_close(&s);
}

/* Depth of the pixel that a direction falls into, whichever face has it. */
static double depth_towards(stage *s, const double d[3]) {
  const projection *p = &s->map->projection;
  for (uint32_t i = 0; i < p->count; ++i) {
    const face *f = &p->faces[i];
    double z = 0, u = 0, v = 0;
    for (int k = 0; k < 3; ++k) {
      z += d[k] * f->axes.forward[k];
      u += d[k] * f->axes.right[k];
      v += d[k] * f->axes.up[k];
    }
    if (!(z > 0) || fabs(u) > z || fabs(v) > z || !f->width) continue;
    double x = floor((u / z - f->u0) * f->per_u), y = floor((v / z - f->v0) * f->per_v);
    if (x < 0 || y < 0 || x >= f->width || y >= f->height) return INFINITY;
    return pixel_depth(s, i, (uint32_t)x, (uint32_t)y);
  }
  return INFINITY;
}

/* Around a cube's edges and corners, too, the region is whole. */
static void cube(void **state) {
  (void)state;
  enum { BUBBLES = 120, GRID = 40 };
  static shape bubbles[BUBBLES];
  rng r = rng_seeded(9);
  for (int i = 0; i < BUBBLES; ++i) {
    double d[3], size = 0;
    for (int k = 0; k < 3; ++k) {
      d[k] = rng_between(&r, -1, 1);
      if (i % 2 == 0) d[k] = (d[k] > 0 ? 1 : -1) + 0.1 * d[k];   /* many at the corners */
      size += d[k] * d[k];
    }
    for (int k = 0; k < 3; ++k) d[k] *= rng_between(&r, 2, 4) / sqrt(size);
    bubbles[i] = sphere_at(1 + d[0], 2 + d[1], 3 + d[2], 0.4, 0);
  }
  stage s;
  stage_open(&s, bubbles, BUBBLES, point_at(1, 2, 3), WORDS("shadow_map", "resolution 60", "bias 0.01"));
  assert_int_equal(s.map->projection.count, 6);
  int between = 0, dark = 0;
  for (int n = 0; n < 120; ++n) {
    double d[3], expected = 0, pixel = s.map->projection.faces[0].pixel_u;
    int axis = (int)rng_below(&r, 3);
    for (int k = 0; k < 3; ++k) d[k] = (rng_below(&r, 2) ? 1 : -1) * (1 + rng_between(&r, -0.05, 0.05));
    if (n % 2) d[axis] = rng_between(&r, -0.9, 0.9);
    int main_axis = fabs(d[0]) > fabs(d[1]) ? (fabs(d[0]) > fabs(d[2]) ? 0 : 2) : (fabs(d[1]) > fabs(d[2]) ? 1 : 2);
    for (int i = 0; i < GRID * GRID; ++i) {
      double at[3];
      int side = 0;
      for (int k = 0; k < 3; ++k) {
        at[k] = d[k] / fabs(d[main_axis]);
        if (k != main_axis) at[k] += 6 * pixel * (((side++ ? i / GRID : i % GRID) + 0.5) / GRID - 0.5);
      }
      expected += depth_towards(&s, at) < 7 ? 1.0 / (GRID * GRID) : 0;
    }
    double size = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    double got = 1 - mean_light(&s, in_air(1 + 8 * d[0] / size, 2 + 8 * d[1] / size, 3 + 8 * d[2] / size), 300, &r);
    if (fabs(got - expected) > 0.045) fail_msg("seed %llu, %d: %g, not %g", (unsigned long long)r.seed, n, got, expected);
    between += expected > 0.1 && expected < 0.9;
    dark += expected > 0.9;
  }
  assert_true(between > 20 && dark > 5);
  stage_close(&s);
}

/* What is left of the light decides: half of it, over colours, surfaces and fog. */
static void depth_is_where_half_is_gone(void **state) {
  (void)state;
  struct { double r, g, b; int sheets; double depth; } cases[] = {
    {0, 0, 0, 1, 5}, {0.5, 0.5, 0.5, 1, 5}, {0.6, 0.6, 0.6, 1, INFINITY}, {0.6, 0.6, 0.6, 2, 6}, {0.9, 0.9, 0.9, 4, INFINITY},
    {1, 0.4, 0, 1, 5}, {1, 1, 0, 1, INFINITY}, {1, 1, 0, 3, INFINITY}, {4, 4, 4, 1, INFINITY}, {0.7, 0.7, 0.7, 4, 6}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    shape all[4];
    for (int k = 0; k < cases[i].sheets; ++k) all[k] = sheet_at(5 + k, 1, cases[i].r, cases[i].g, cases[i].b);
    stage s;
    stage_open(&s, all, cases[i].sheets, parallel_at(0, 0, 0, 0, 0, 1), WORDS("shadow_map", "resolution 20", "bias 0"));
    for (double z = 4.75; z < 10; z += 0.5)
      assert_true(light_of(&s, in_air(0.05, 0.02, z), 0) == (z > cases[i].depth ? 0 : 1));
    stage_close(&s);
  }
  shape fog = fog_in((dsm_box){{-1, -1, 5}, {1, 1, 9}}, 1, 1, 1, 0.5);   /* exp(-(d + d^2/4)) falls to a half at d = 0.6023… */
  double half = -2 + sqrt(4 + 4 * log(2));
  stage s;
  stage_open(&s, &fog, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("shadow_map", "resolution 20", "bias 0"));
  assert_true(light_of(&s, in_air(0, 0, 5 + half - 0.002), 0) == 1 && light_of(&s, in_air(0, 0, 5 + half + 0.002), 0) == 0);
  stage_close(&s);
}

/* Jittered rays are the same each time, in their own pixel, and not all in its middle. */
static void depth_samples(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  const tile *tiles[3];
  stage s[3];
  for (int i = 0; i < 3; ++i) {
    stage_open(&s[i], &ball, 1, parallel_at(0, 0, 0, 0, 0, 1),
               i ? WORDS("shadow_map", "resolution 16", "depth_samples jittered") : WORDS("shadow_map", "resolution 16"));
    light_of(&s[i], in_air(0, 0, 9), 0);
    tiles[i] = tile_store_peek(&s[i].map->store, &(tile_key){0, 0, 0, 0});
    assert_true(tiles[i]->kind == TILE_STORED && tile_has_depths(tiles[i]));
  }
  const depth_tile *regular = depths_of(tiles[0]), *jittered = depths_of(tiles[1]);
  assert_memory_equal(jittered->depth, depths_of(tiles[2])->depth, sizeof jittered->depth);
  const face *f = &s[0].map->projection.faces[0];
  int differ = 0, inside = 0;
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    double near = INFINITY, far = 0, x = f->u0 + (i % 16) * f->pixel_u, y = f->v0 + i / 16 * f->pixel_v;
    double middle = 5 - sqrt(fmax(0, 1 - pow(x + f->pixel_u / 2, 2) - pow(y + f->pixel_v / 2, 2)));
    for (int k = 0; k < 121; ++k) {
      double square = pow(x + f->pixel_u * (k % 11) / 10, 2) + pow(y + f->pixel_v * (k / 11) / 10, 2);
      double depth = square < 1 ? 5 - sqrt(1 - square) : INFINITY;
      near = fmin(near, depth);
      far = fmax(far, depth);
    }
    if (!(far < INFINITY)) continue;   /* on the outline */
    ++inside;
    double a = tiles[0]->near_depth + (double)regular->depth[i], b = tiles[1]->near_depth + (double)jittered->depth[i];
    assert_true(fabs(a - middle) < 1e-6 && b >= near - 1e-3 && b <= far + 1e-3);
    differ += a != b;
  }
  assert_true(inside > 80 && differ == inside);
  for (int i = 0; i < 3; ++i) stage_close(&s[i]);
}

static void numbers_that_are_none(void **state) {
  (void)state;
  stage s;
  stage_open(&s, balls, BALLS, spot_at(0, 0, 0, 0, 0, 1, 30), WORDS("shadow_map", "resolution 64"));
  const double odd[] = {NAN, INFINITY, -INFINITY};
  double rgb[3] = {7, 7, 7};
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 9; ++i) {
      dsm_receiver at = in_air(0, 0, 7);
      at.has_footprint = 1;
      *(i < 3 ? &at.point[i] : &at.footprint[(i - 3) / 3][i % 3]) = odd[k];
      assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_INVALID);
      assert_true(rgb[0] == 7);
    }
  for (int k = 0; k < 200; ++k) {   /* any finite number is fine */
    rng r = rng_seeded((uint64_t)k + 1);
    dsm_receiver at = in_air(0, 0, 0);
    at.has_footprint = 1;
    for (int i = 0; i < 9; ++i)
      *(i < 3 ? &at.point[i] : &at.footprint[(i - 3) / 3][i % 3]) = rng_between(&r, -1, 1) * rng_scale(&r, 1e-300, 1e300);
    light_of(&s, at, 0);
  }
  light_of(&s, in_air(0, 0, 0), 0);
  assert_true(light_of(&s, in_air(0, 0, -5), 0) == 1);
  stage_close(&s);
  stage_open(&s, NULL, 0, point_at(0, 0, 0), WORDS("shadow_map"));
  assert_true(light_of(&s, in_air(1, 2, 3), 0) == 1);
  stage_close(&s);
}

/* The automatic bias goes with the scene: one a million times as large has the same shadows. */
static void scale_of_the_world(void **state) {
  (void)state;
  static shape larger[BALLS];
  double first = -1;
  for (double scale = 1e-6; scale < 1e7; scale *= 1e3) {
    for (int i = 0; i < BALLS; ++i) {
      larger[i] = balls[i];
      for (int k = 0; k < 3; ++k) {
        larger[i].box.low[k] *= scale;
        larger[i].box.high[k] *= scale;
      }
    }
    stage s;
    stage_open(&s, larger, BALLS, point_at(3 * scale, 0, -scale), WORDS("shadow_map", "resolution 128"));
    rng r = rng_seeded(5);
    double dark = 0;
    for (int k = 0; k < 4000; ++k)
      dark += 1 - light_of(&s, in_air(scale * rng_between(&r, -1, 1), scale * rng_between(&r, -1, 1), scale * rng_between(&r, 4, 7)), 0);
    if (first < 0) first = dark;
    assert_true(dark > 400 && dark < 3600 && fabs(dark - first) < 30);   /* other points have other samples */
    stage_close(&s);
  }
}

/* A flat wall under slanted light does not shadow itself, whatever the region, and is dark behind another one. */
static void walls(void **state) {
  (void)state;
  shape all[] = {sheet_at(10, 5, 0, 0, 0), sheet_at(20, 12, 0, 0, 0)};
  for (int degrees = 0; degrees <= 55; degrees += 11) {
    double t = tan(degrees * acos(-1) / 180);
    stage s;
    stage_open(&s, all, 2, parallel_at(0, 0, 0, t, 0, 1), WORDS("shadow_map", "resolution 128"));
    rng r = rng_seeded((uint64_t)degrees);
    for (int k = 0; k < 2000; ++k) {
      dsm_receiver at = on_plane(rng_between(&r, -5, 5), rng_between(&r, -5, 5), 10, 0, 0, -1);
      at.has_footprint = (uint32_t)k % 2;
      for (int i = 0; i < 4; ++i) at.footprint[i / 2][i % 2] = rng_between(&r, -0.3, 0.3);
      assert_seeded(&r, light_of(&s, at, 0) == 1);
      at.point[2] = 20;
      at.point[0] = 10 * t + rng_between(&r, -2, 2);
      at.point[1] = rng_between(&r, -2, 2);
      assert_seeded(&r, light_of(&s, at, 0) == 0);
    }
    stage_close(&s);
  }
}

/* A tile whose pixels all have one depth is answered without a look at them only where every draw of the bias agrees. */
static void between_the_bounds(void **state) {
  (void)state;
  shape sheet = sheet_at(5, 1, 0, 0, 0);
  const char *const *orders[] = {WORDS("shadow_map", "resolution 130", "bias 0.2 1.2"), WORDS("shadow_map", "resolution 130", "bias 1.2 0.2")};
  for (int k = 0; k < 2; ++k) {
    stage s;
    stage_open(&s, &sheet, 1, parallel_at(0, 0, 0, 0, 0, 1), orders[k]);
    rng r = rng_seeded(6);
    for (double z = 4.9; z < 6.6; z += 0.1) {
      double expected = fmax(0, fmin(1, (z - 5.2) / 1));
      assert_seeded(&r, fabs(1 - mean_light(&s, in_air(0.1, -0.2, z), 300, &r) - expected) < 0.03);
    }
    stage_close(&s);
  }
}

/* A tile that failed is for the ray tracer, and one that is lit takes no memory. */
static void failures(void **state) {
  (void)state;
  stage s;
  double rgb[3] = {7, 7, 7};
  stage_open(&s, balls, BALLS, parallel_at(0, 0, 0, 0, 0, 1), WORDS("shadow_map", "resolution 64"));
  dsm_receiver at = in_air(0, 0, 7);
  s.w.stop = 1;
  assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_CANCELLED);
  s.w.stop = 0;
  s.w.fail_with = DSM_NO_MEMORY;
  assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_TRACE);
  assert_true(rgb[0] == 7 && s.w.sentences == 1);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(percentages),
    cmocka_unit_test(half_plane),
    cmocka_unit_test(footprints),
    cmocka_unit_test(cube),
    cmocka_unit_test(depth_is_where_half_is_gone),
    cmocka_unit_test(depth_samples),
    cmocka_unit_test(numbers_that_are_none),
    cmocka_unit_test(scale_of_the_world),
    cmocka_unit_test(walls),
    cmocka_unit_test(between_the_bounds),
    cmocka_unit_test(failures),
  };
  make_balls();
  return cmocka_run_group_tests(tests, NULL, NULL);
}
