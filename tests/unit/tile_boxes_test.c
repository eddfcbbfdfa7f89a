/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What boxes spare: no ray that meets a caster, and most of those that meet none. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "bake/tile_boxes.h"

enum { CASTERS = 20, RAYS = 3, SPAN = 2 };

enum { LIGHTS = 5 };
static dsm_light light_of_kind(int k) {
  switch (k % LIGHTS) {
    case 0: return parallel_at(0, 0, -10, 0.1, 0.2, 1);
    case 1: return parallel_at(0, 0, -10, 0, 0, 1);   /* along the boxes' planes */
    case 2: return point_at(0.3, -0.2, -9);
    case 3: return point_at(0.1, 0.2, 0.1);           /* a cube */
    default: return spot_at(0, 0, -1e5, 0, 0, 1, 30);
  }
}

/* Boxes, sheets, rods and points. */
static void make_casters(rng *r, shape *shapes) {
  for (int i = 0; i < CASTERS; ++i) {
    dsm_box box;
    for (int c = 0; c < 3; ++c) {
      box.low[c] = rng_between(r, -SPAN, SPAN);
      box.high[c] = box.low[c] + (rng_below(r, 4) ? rng_between(r, 0.05, 0.7) : 0);
    }
    shapes[i] = fog_in(box, 1, 1, 1, 0);
  }
}

/* Whether the ray comes within `slack` of the box, between its two depths. */
static int meets(const dsm_box *box, const dsm_ray *ray, double slack) {
  dsm_box wide = *box;
  double span[2];
  for (int c = 0; c < 3; ++c) {
    wide.low[c] -= slack;
    wide.high[c] += slack;
  }
  return cross_box(&wide, ray, span);
}

static int one_meets(const dsm_light *light, const dsm_ray rays[RAYS], double slack) {
  for (uint64_t k = 0; k < light->caster_count; ++k)
    for (int i = 0; i < RAYS; ++i)
      if (meets(&light->casters[k], &rays[i], slack)) return 1;
  return 0;
}

static bake_job job_of(stage *s) {
  return (bake_job){&s->map->host, &s->w, &s->map->projection, &s->map->settings, &s->map->light, NULL, NULL};
}

/* From a pixel of the tile or from what is filtered into it; the ray may be cut short at either end. */
static void any_ray(rng *r, const stage *s, const tile_key *key, dsm_ray *ray) {
  double reach = 0.5 * s->map->settings.filter_width, at[2];
  for (int i = 0; i < 2; ++i)
    at[i] = ldexp((i ? key->y : key->x) * TILE_SIDE + rng_between(r, -reach, TILE_SIDE + reach), (int)key->level);
  projection_ray(&s->map->projection, key->face, at[0], at[1], ray);
  double length = ray->far_depth - ray->near_depth;
  if (rng_below(r, 3) == 0) ray->near_depth += rng_unit(r) * length;
  if (rng_below(r, 3) == 0) ray->far_depth -= rng_unit(r) * (ray->far_depth - ray->near_depth);
}

static tile_key any_key(rng *r, const projection *p) {
  tile_key key = {rng_below(r, p->count), rng_below(r, 3), 0, 0};
  const face *f = &p->faces[key.face];
  key.x = rng_below(r, (level_pixels(f->width, key.level) + TILE_SIDE - 1) / TILE_SIDE);
  key.y = rng_below(r, (level_pixels(f->height, key.level) + TILE_SIDE - 1) / TILE_SIDE);
  return key;
}

static void only_rays_that_meet_nothing(void **state) {
  (void)state;
  rng r = rng_seeded(9);
  int spared[LIGHTS] = {0};
  for (int n = 0; n < 100; ++n) {
    shape shapes[CASTERS];
    stage s;
    make_casters(&r, shapes);
    stage_open(&s, shapes, 1 + (int)rng_below(&r, CASTERS), light_of_kind(n), WORDS("resolution 128", "filter box 3"));
    bake_job job = job_of(&s);
    double slack = n % LIGHTS == 4 ? 1e-3 : 1e-6;   /* of a light that is so far away */
    for (int i = 0; i < 300; ++i) {
      tile_key key = any_key(&r, &s.map->projection);
      if (s.map->projection.faces[key.face].width == 0) continue;
      tile_boxes boxes;
      dsm_ray rays[RAYS];
      tile_boxes_find(&job, &key, &boxes);
      for (int k = 0; k < RAYS; ++k) any_ray(&r, &s, &key, &rays[k]);
      int may = tile_boxes_may_meet(&boxes, rays, RAYS);
      if (one_meets(&s.map->light, rays, 0)) assert_true(may);
      if (!one_meets(&s.map->light, rays, slack)) assert_false(may);
      spared[n % LIGHTS] += !may;
    }
    stage_close(&s);
  }
  for (int k = 0; k < LIGHTS; ++k) assert_true(spared[k] > 100);
}

/* A ray to a point on the outside of a box, of no length beyond it. */
static void rounding_does_not_decide(void **state) {
  (void)state;
  rng r = rng_seeded(4);
  for (int n = 0; n < 20000; ++n) {
    double size = rng_scale(&r, 1e-3, 1e3);
    dsm_box box;
    dsm_ray ray;
    for (int c = 0; c < 3; ++c) {
      box.low[c] = rng_between(&r, -size, size);
      box.high[c] = box.low[c] + (rng_below(&r, 2) ? rng_unit(&r) * size : 0);
      ray.direction[c] = rng_below(&r, 3) ? rng_between(&r, -1, 1) : c == 2;
    }
    double length = sqrt(ray.direction[0] * ray.direction[0] + ray.direction[1] * ray.direction[1] + ray.direction[2] * ray.direction[2]);
    ray.near_depth = ray.far_depth = rng_between(&r, 0, 10 * size);
    for (int c = 0; c < 3; ++c) {
      ray.direction[c] /= length;
      ray.origin[c] = (rng_below(&r, 2) ? box.high[c] : box.low[c]) - ray.far_depth * ray.direction[c];
    }
    tile_boxes boxes = {.count = 1, .box = {&box}};
    assert_true(tile_boxes_may_meet(&boxes, &ray, 1));
  }
  static const dsm_box none = {{0, 0, 0}, {0, 0, 0}};
  tile_boxes boxes = {.count = 1, .box = {&none}};
  dsm_ray ray = {.direction = {0, 0, 1}};
  assert_true(tile_boxes_may_meet(&boxes, &ray, 1));
}

/* Nearly along two of its planes: into a box that is far away, and past one. */
static void grazing_rays(void **state) {
  (void)state;
  static const dsm_box near_by = {{1e-3, -1, 0}, {1, 1, 1e7}}, beside = {{0.1, -1, 0}, {1, 1, 1e7}};
  tile_boxes one = {.count = 1, .box = {&near_by}}, other = {.count = 1, .box = {&beside}};
  for (int k = -1; k <= 1; ++k) {
    dsm_ray ray = {.direction = {k * 5e-10, 0, 1}, .near_depth = 1, .far_depth = 1e7};
    if (k > 0) assert_true(tile_boxes_may_meet(&one, &ray, 1));
    assert_false(tile_boxes_may_meet(&other, &ray, 1));
  }
}

/* A light along z: a box is found if it reaches into the square that the tile's pixels are filtered from, and no other is. */
static void boxes_of_a_tile(void **state) {
  (void)state;
  rng r = rng_seeded(3);
  int found = 0;
  for (int n = 0; n < 40; ++n) {
    shape shapes[CASTERS];
    stage s;
    make_casters(&r, shapes);
    stage_open(&s, shapes, CASTERS, light_of_kind(1), WORDS("resolution 128", "filter box 3"));
    bake_job job = job_of(&s);
    const face *f = &s.map->projection.faces[0];
    for (int i = 0; i < 20; ++i) {
      tile_key key = any_key(&r, &s.map->projection);
      double pixel[2] = {ldexp(f->pixel_u, (int)key.level), ldexp(f->pixel_v, (int)key.level)}, low[2], high[2];
      uint32_t least = 0, most = 0;
      tile_boxes boxes;
      tile_boxes_find(&job, &key, &boxes);
      for (int c = 0; c < 2; ++c) {
        low[c] = (c ? f->v0 : f->u0) + pixel[c] * TILE_SIDE * (c ? key.y : key.x);
        high[c] = low[c] + pixel[c] * TILE_SIDE;
      }
      for (int k = 0; k < CASTERS; ++k) {
        const dsm_box *b = &s.map->light.casters[k];
        double beside = -INFINITY;   /* pixels; the frame's u and v are x and y */
        for (int c = 0; c < 2; ++c) beside = fmax(beside, fmax(low[c] - b->high[c], b->low[c] - high[c]) / pixel[c]);
        int is_there = 0;
        for (uint32_t j = 0; j < boxes.count; ++j) is_there |= boxes.box[j] == b;
        least += beside < 1.5;
        most += beside < 3.01;
        if (beside < 1.5) assert_true(is_there);
      }
      assert_in_range(boxes.count, least, most);
      found += boxes.count > 0;
    }
    stage_close(&s);
  }
  assert_true(found > 100);
}

/* As many boxes as there is room for are known, each of them; with one more nothing is. So it is with casters of the whole scene. */
static void so_many_boxes(void **state) {
  (void)state;
  enum { ALL = 2001 };
  static dsm_box casters[ALL];
  shape shapes[2] = {sphere_at(-1, -1, 3, 1, 0), sphere_at(1, 1, 3, 1, 0)};   /* the frame */
  stage s;
  stage_open(&s, shapes, 2, light_of_kind(1), WORDS("resolution 32"));
  bake_job job = job_of(&s);
  dsm_light light = s.map->light;
  light.casters = casters;
  job.light = &light;
  tile_boxes boxes;
  for (uint32_t k = 0; k < ALL; ++k) {   /* in the first tile of four, in a row */
    double x = -1.9 + 0.001 * k;
    casters[k] = (dsm_box){{x, -1, 3}, {x + 0.0005, -0.9, 3.1}};
  }
  tile_key first = {0, 0, 0, 0}, last = {0, 0, 1, 1};
  dsm_ray ray = {.direction = {0, 0, 1}, .far_depth = 20};
  for (light.caster_count = 1; light.caster_count <= MOST_TILE_BOXES + 1; ++light.caster_count) {
    tile_boxes_find(&job, &first, &boxes);
    assert_int_equal(boxes.count, light.caster_count);
    const dsm_box *b = &casters[light.caster_count - 1];
    ray.origin[0] = b->low[0] + 0.0002;
    ray.origin[1] = -0.95;
    assert_true(tile_boxes_may_meet(&boxes, &ray, 1));
    ray.origin[0] = b->high[0] + 0.0002;
    assert_int_equal(tile_boxes_may_meet(&boxes, &ray, 1), light.caster_count > MOST_TILE_BOXES);
  }
  light.caster_count = ALL - 1;
  tile_boxes_find(&job, &last, &boxes);
  assert_int_equal(boxes.count, 0);
  light.caster_count = ALL;
  tile_boxes_find(&job, &last, &boxes);
  assert_int_equal(boxes.count, MOST_TILE_BOXES + 1);
  stage_close(&s);
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

static int wants_finer(stage *s, const tile_key *key, const dsm_box *box, double width, double width_at_least, int absent) {
  bake_job job = job_of(s);
  tile_boxes boxes = {.count = 1, .box = {box}};
  baked_pixel pixels[TILE_PIXELS] = {{0}};
  int wanting = 0;
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) pixels[i].absent = absent;
  tile_boxes_want_finer(&boxes, &job, key, width, width_at_least, pixels);
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) wanting += pixels[i].need == NEED_ALWAYS;
  return wanting;
}

/* Thinner than two pixels and no wider than eight, at the depth where it is. */
static void how_small_is_small(void **state) {
  (void)state;
  shape shapes[2] = {sphere_at(0, 0, 3, 2, 0), sphere_at(0, 0, 3, 2, 0)};
  tile_key key = {0, 0, 0, 0}, coarse = {0, 1, 0, 0};
  for (int perspective = 0; perspective < 2; ++perspective) {
    stage s;
    stage_open(&s, shapes, 2, perspective ? point_at(0, 0, -6) : parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 32"));
    double w = perspective ? 0.01 : 0, least = perspective ? 0 : 0.1;   /* 0.1 at depth 10 */
    for (int k = 0; k < 2; ++k) {
      double thin = 0.1 * (k ? 1.9 : 2.1), wide = 0.1 * (k ? 7.8 : 8.2), far = perspective ? 4 : 3;
      dsm_box bead = {{-0.2, -0.2, far}, {-0.2 + thin, -0.2 + thin, far + thin}}, rod = {{-0.2 - wide, -0.2, far}, {-0.2, 0.8, far + 0.1}};
      assert_int_equal(wants_finer(&s, &key, &bead, w, least, 0) > 0, k);
      assert_int_equal(wants_finer(&s, &key, &rod, w, least, 0) > 0, k);
      assert_int_equal(wants_finer(&s, &coarse, &bead, w, least, 0) > 0, k);
      assert_int_equal(wants_finer(&s, &key, &bead, w, least, 1), 0);
    }
    stage_close(&s);
  }
}

/* Pixels of a coarser level reach farther; of a deep rod the near end counts; with too many boxes nothing is wanted. */
static void where_finer_is_wanted(void **state) {
  (void)state;
  shape shapes[2] = {sphere_at(0, 0, 3, 2, 0), sphere_at(0, 0, 3, 2, 0)};
  stage s;
  stage_open(&s, shapes, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 32"));
  const face *f = &s.map->projection.faces[0];
  for (uint32_t level = 0; level < 2; ++level) {
    tile_key key = {0, level, 0, 0};
    double pixel = ldexp(f->pixel_u, (int)level), x = f->u0 + 3.5 * pixel, y = f->v0 + 5.5 * pixel;   /* the middle of one */
    dsm_box bead = {{x, y, 3}, {x + 1e-3, y + 1e-3, 3.001}};
    assert_int_equal(wants_finer(&s, &key, &bead, 0, pixel, 0), 4);
    bead = (dsm_box){{x - 0.1 * pixel, y - 0.1 * pixel, 3}, {x + 0.1 * pixel, y + 0.1 * pixel, 3.001}};
    assert_int_equal(wants_finer(&s, &key, &bead, 0, pixel, 0), 9);
  }
  dsm_box many = {{-0.1, -0.1, 3}, {-0.05, -0.05, 3.05}};
  bake_job job = job_of(&s);
  tile_key key = {0, 0, 0, 0};
  tile_boxes boxes = {.count = MOST_TILE_BOXES + 1};
  baked_pixel pixels[TILE_PIXELS] = {{0}};
  for (int k = 0; k < MOST_TILE_BOXES; ++k) boxes.box[k] = &many;
  assert_true(wants_finer(&s, &key, &many, 0, 1, 0) > 0);
  tile_boxes_want_finer(&boxes, &job, &key, 0, 1, pixels);
  for (int i = 0; i < TILE_PIXELS; ++i) assert_int_equal(pixels[i].need, 0);
  stage_close(&s);

  stage_open(&s, shapes, 2, point_at(0, 0, -6), WORDS("resolution 32"));
  dsm_box deep = {{-0.2, -0.2, 2}, {-0.1, -0.1, 4}};   /* 0.1 wide, 8 to 10 away */
  assert_int_equal(wants_finer(&s, &key, &deep, 0.1 / 2 / 9, 0, 0), 0);
  assert_true(wants_finer(&s, &key, &deep, 0.1 / 2 / 7.9, 0, 0) > 0);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(only_rays_that_meet_nothing),
    cmocka_unit_test(rounding_does_not_decide),
    cmocka_unit_test(grazing_rays),
    cmocka_unit_test(boxes_of_a_tile),
    cmocka_unit_test(so_many_boxes),
    cmocka_unit_test(nobody_knows),
    cmocka_unit_test(small_casters_want_finer_pixels),
    cmocka_unit_test(how_small_is_small),
    cmocka_unit_test(where_finer_is_wanted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
