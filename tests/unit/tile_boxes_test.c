/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What boxes spare: no ray that meets a caster, and most of those that meet none. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "bake/tile_boxes.h"

enum { CASTERS = 20 };

static dsm_light light_of_kind(int k) {
  return k == 0 ? parallel_at(0, 0, -10, 0.1, 0.2, 1) : k == 1 ? point_at(0.3, -0.2, -9) : spot_at(0, 0, -1e5, 0, 0, 1, 30);
}

static void make_casters(rng *r, shape *shapes) {
  for (int i = 0; i < CASTERS; ++i)
    shapes[i] = sphere_at(rng_between(r, -2, 2), rng_between(r, -2, 2), rng_between(r, -1, 1), rng_between(r, 0.05, 0.5), 0);
}

/* How far outside all boxes the ray stays, by looking at many points of it. */
static double gap_of(const stage *s, const dsm_ray *ray) {
  enum { STEPS = 2000 };
  double least = INFINITY;
  for (uint64_t k = 0; k < s->map->light.caster_count; ++k)
    for (int i = 0; i <= STEPS; ++i) {
      double outside = 0, depth = ray->near_depth + (ray->far_depth - ray->near_depth) * i / STEPS;
      for (int c = 0; c < 3; ++c) {
        double at = ray->origin[c] + depth * ray->direction[c];
        outside = fmax(outside, fmax(s->map->light.casters[k].low[c] - at, at - s->map->light.casters[k].high[c]));
      }
      least = fmin(least, outside);
    }
  return least;
}

static void only_rays_that_meet_nothing(void **state) {
  (void)state;
  rng r = rng_seeded(9);
  int spared = 0, wasted = 0;
  for (int n = 0; n < 60; ++n) {
    shape shapes[CASTERS];
    stage s;
    make_casters(&r, shapes);
    stage_open(&s, shapes, CASTERS, light_of_kind(n % 3), WORDS("resolution 64"));
    const face *f = &s.map->projection.faces[0];
    bake_job job = {&s.map->host, &s.w, &s.map->projection, &s.map->settings, &s.map->light, NULL, NULL};
    for (int i = 0; i < 30; ++i) {
      tile_key key = {0, 0, rng_below(&r, (f->width + TILE_SIDE - 1) / TILE_SIDE), rng_below(&r, (f->height + TILE_SIDE - 1) / TILE_SIDE)};
      tile_boxes boxes;
      dsm_ray ray;
      tile_boxes_find(&job, &key, &boxes);
      projection_ray(&s.map->projection, 0, key.x * TILE_SIDE + rng_between(&r, 0, TILE_SIDE), key.y * TILE_SIDE + rng_between(&r, 0, TILE_SIDE), &ray);
      double gap = gap_of(&s, &ray);
      int may = tile_boxes_may_meet(&boxes, &ray, 1);
      if (gap <= 0) assert_true(may);
      spared += !may;
      wasted += may && gap > 0.01;
    }
    stage_close(&s);
  }
  assert_true(spared > 300);
  assert_true(wasted == 0);
}

static void nobody_knows(void **state) {
  (void)state;
  tile_boxes boxes;
  dsm_ray ray = {.direction = {0, 0, 1}, .far_depth = 1};
  tile_key key = {0, 0, 0, 0};
  bake_job job = {0};
  tile_boxes_find(&job, &key, &boxes);
  assert_true(tile_boxes_may_meet(&boxes, &ray, 1));
}

/* A bead and a rod are looked for; a wall, and a sheet as thin as the bead, are found anyway. */
static void small_casters_want_finer_pixels(void **state) {
  (void)state;
  static const struct { dsm_box box; int small; } cases[] = {
    {{{-0.02, -0.02, 3}, {0.02, 0.02, 3.04}}, 1},
    {{{-0.02, -0.9, 3}, {0.02, 0.9, 3.04}}, 1},
    {{{-0.9, -0.9, 3}, {0.9, 0.9, 3.04}}, 0},
    {{{-0.5, -0.5, 3}, {0.5, 0.5, 4}}, 0}};
  for (int k = 0; k < 4; ++k) {
    shape shapes[2] = {sphere_at(0, 0, 3, 2, 0), sphere_at(0, 0, 3, 2, 0)};   /* the frame */
    stage s;
    stage_open(&s, shapes, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 32"));
    const face *f = &s.map->projection.faces[0];
    bake_job job = {&s.map->host, &s.w, &s.map->projection, &s.map->settings, &s.map->light, NULL, NULL};
    tile_boxes boxes = {.count = 1, .box = {&cases[k].box}};
    baked_pixel pixels[4][TILE_PIXELS] = {{{0}}};
    int wanting = 0;
    for (uint32_t t = 0; t < 4; ++t) {
      tile_key key = {0, 0, t % 2, t / 2};
      tile_boxes_want_finer(&boxes, &job, &key, 0, f->pixel_u, pixels[t]);
      for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
        double u = f->u0 + (key.x * TILE_SIDE + i % TILE_SIDE + 0.5) * f->pixel_u, v = f->v0 + (key.y * TILE_SIDE + i / TILE_SIDE + 0.5) * f->pixel_v;
        double beside = fmax(fabs(u) - cases[k].box.high[0], fabs(v) - cases[k].box.high[1]);
        wanting += pixels[t][i].need == NEED_ALWAYS;
        if (cases[k].small && beside < 0.5 * f->pixel_u) assert_int_equal(pixels[t][i].need, NEED_ALWAYS);
        if (beside > 2 * f->pixel_u) assert_int_equal(pixels[t][i].need, 0);
      }
    }
    assert_int_equal(wanting > 0, cases[k].small);
    stage_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(only_rays_that_meet_nothing),
    cmocka_unit_test(nobody_knows),
    cmocka_unit_test(small_casters_want_finer_pixels),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
