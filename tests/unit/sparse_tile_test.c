/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Tiles of few pixels: those between are what the fog's closed form says; edges, second casters and surfaces are not passed over,
 * but for a flat ground, whose depths are a plane's. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "bake/bake_tile.h"
#include "bake/sparse_tile.h"
#include "random.h"

static wanted_pixels all_wanted;   /* set in main */

typedef struct { stage s; const tile *t; tile_tally tally; } one_tile;

/* 128 pixels along a face. Of the casters so many are told of. */
static one_tile bake_from(dsm_light from, const shape *shapes, int count, const char *accuracy, uint32_t x, uint32_t y, uint64_t known) {
  one_tile out = {.tally = {0}};
  stage_open(&out.s, shapes, count, from, WORDS(accuracy, "resolution 128"));
  dsm_map *map = out.s.map;
  dsm_light light = map->light;
  light.caster_count = known;
  bake_job job = {&map->host, &out.s.w, &map->projection, &map->settings, known ? &light : NULL, NULL, NULL};
  bake_scratch scratch = {0};
  tile_key key = {0, 0, x, y};
  assert_int_equal(bake_tile(&job, &scratch, &key, &all_wanted, &out.t, &out.tally), DSM_OK);
  bake_scratch_free(&scratch);
  return out;
}

/* Light along z. */
static one_tile bake(const shape *shapes, int count, const char *accuracy, uint32_t x, uint32_t y, uint64_t known) {
  return bake_from(parallel_at(0, 0, 0, 0, 0, 1), shapes, count, accuracy, x, y, known);
}

static void done(one_tile *tested) {
  tile_destroy(tested->t);
  stage_close(&tested->s);
}

/* Thicker to one side, differently in each colour if it has any. */
static shape fog_of(double x0, double x1, int coloured) {
  shape fog = fog_in((dsm_box){{x0, -2, 2}, {x1, 2, 4}}, 0.3, coloured ? 0.2 : 0.3, coloured ? 0.4 : 0.3, 0.3);
  fog.axis = 0;
  return fog;
}

/* What is left at depth z above a pixel's middle. */
static double left_at(const stage *s, const shape *fog, uint32_t x, uint32_t y, double z, int c) {
  dsm_ray ray;
  projection_ray(&s->map->projection, 0, x + 0.5, y + 0.5, &ray);
  double at = ray.origin[2], span[2];
  if (!cross_box(&fog->box, &ray, span) || z + at <= 2) return 1;
  return exp(-fog->density[c] * fog_integral(fog, &ray, span[0], fmin(z, span[1])));
}

static void smooth_fog_takes_few_rays(void **state) {
  (void)state;
  for (int coloured = 0; coloured < 2; ++coloured) {
    shape fog = fog_of(-2, 2, coloured);
    one_tile tested = bake(&fog, 1, "accuracy 0.01", 3, 4, 1);
    assert_true(tested.tally.rays == 16);
    assert_int_equal(tested.t->kind, TILE_STORED);
    rng r = rng_seeded(9);
    for (int k = 0; k < 2000; ++k) {
      uint32_t px = rng_below(&r, TILE_SIDE), py = rng_below(&r, TILE_SIDE), hint = 0;
      double z = rng_between(&r, 0, 6);
      visibility stored = tile_visibility(tested.t, py * TILE_SIDE + px);
      rgb got = visibility_at(&stored, z - tested.t->near_depth, &hint);
      for (int c = 0; c < 3; ++c) {
        double truth = left_at(&tested.s, &fog, 3 * TILE_SIDE + px, 4 * TILE_SIDE + py, z, c);
        /* both compressions by 0.002; a ray goes anywhere in its pixel, and from one to the next V changes by less than 0.003 */
        if (fabs(got.c[c] - truth) > 0.0055) fail_msg("pixel %u, %u at depth %g: %g, not %g", px, py, z, got.c[c], truth);
      }
    }
    done(&tested);
  }
}

/* Where its sides are, and where something else may be. */
static void edges_are_found(void **state) {
  (void)state;
  shape things[] = {fog_of(-2, 2, 0), sphere_at(-0.3, 0.3, 3, 0.02, 0)};
  one_tile tested = bake(things, 1, "accuracy 0.01", 0, 4, 1);
  assert_true(tested.tally.rays >= 256);
  uint32_t edge = 0, hint = 0;
  while (left_at(&tested.s, things, edge, 70, 5, 0) == 1) edge++;
  assert_true(edge > 0 && edge < TILE_SIDE - 1);
  visibility before = tile_visibility(tested.t, 6 * TILE_SIDE + edge - 1), after = tile_visibility(tested.t, 6 * TILE_SIDE + edge + 1);
  assert_true(before.count == 0 || visibility_at(&before, 5, &hint).c[0] > 0.99);
  assert_true(fabs(visibility_at(&after, 5, &hint).c[0] - exp(-0.6)) < 0.02);
  done(&tested);
  for (uint32_t y = 0; y < 8; ++y)
    for (uint32_t x = 0; x < 8; ++x) {
      tested = bake(things, 2, "accuracy 0.01", x, y, 2);
      stage *s = &tested.s;
      projected hits[3];
      assert_int_equal(projection_find(&s->map->projection, (double[]){-0.3, 0.3, 3}, 0, hits), 1);
      if ((uint32_t)hits[0].x / TILE_SIDE == x && (uint32_t)hits[0].y / TILE_SIDE == y) assert_true(tested.tally.rays >= 256);
      else if (x > 1 && x < 6 && y > 1 && y < 6) assert_true(tested.tally.rays == 16 || tested.tally.rays >= 256);
      done(&tested);
    }
}

static void surfaces_are_not_interpolated(void **state) {
  (void)state;
  shape glass = sheet_at(3, 2, 0.5, 0.5, 0.5);
  one_tile tested = bake(&glass, 1, "accuracy 0.01", 3, 4, 1);
  assert_true(tested.tally.rays >= 256);
  done(&tested);
  shape both[] = {fog_of(-2, 2, 0), glass};   /* parts of one caster */
  tested = bake(both, 2, "accuracy 0.01", 3, 4, 1);
  assert_true(tested.tally.rays >= 256);
  done(&tested);
  tested = bake(both, 1, "accuracy 0.01", 3, 4, 0);   /* nobody knows the casters */
  assert_true(tested.tally.rays >= 256);
  done(&tested);
}

/* Where light through a pixel's middle meets the sheet. */
static double sheet_depth(const stage *s, const shape *sheet, uint32_t x, uint32_t y) {
  dsm_ray ray;
  projection_ray(&s->map->projection, 0, x + 0.5, y + 0.5, &ray);
  return (sheet->box.low[2] - ray.origin[2]) / ray.direction[2];
}

/* A ground ends all light where its plane says, slanted and in perspective too, and what is in front of it stays: alone it takes 64 rays
 * (and 16 before), under a fog 16. */
static void flat_ground_takes_few_rays(void **state) {
  (void)state;
  shape things[] = {sheet_at(5, 2, 0, 0, 0), fog_of(-2, 2, 0)};
  const dsm_light lights[] = {parallel_at(0, 0, 0, 0, 0, 1), parallel_at(-1, 0, 0, 0.5, 0.1, 1), parallel_at(-4, 0, 0, 0.9, 0.1, 1), spot_at(-6, 0.5, 0, 1.2, 0, 1, 30)};
  for (int kind = 0; kind < 4; ++kind)
    for (int fog = 0; fog < (kind < 2 ? 2 : 1); ++fog) {   /* light of the others comes through the sides of the fog */
      one_tile tested = bake_from(lights[kind], things, 1 + fog, "accuracy 0.01", 3, 4, 1 + (uint64_t)fog);
      if (tested.tally.rays != (fog ? 16 : 80)) fail_msg("light %d, fog %d: %u rays", kind, fog, (unsigned)tested.tally.rays);
      for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
        double z = sheet_depth(&tested.s, things, 3 * TILE_SIDE + i % TILE_SIDE, 4 * TILE_SIDE + i / TILE_SIDE), pixel = 4.0 / 128;
        visibility stored = tile_visibility(tested.t, i);
        uint32_t hint = 0;
        double before = visibility_at(&stored, z - 0.1 * pixel - tested.t->near_depth, &hint).c[0];
        double behind = visibility_at(&stored, z + 0.1 * pixel - tested.t->near_depth, &hint).c[0];
        if (fog ? before > 0.9 || before < 0.3 : before < 1) fail_msg("light %d, pixel %u: %g in front of the ground", kind, i, before);
        if (behind > 0) fail_msg("light %d, pixel %u: %g behind the ground", kind, i, behind);
      }
      done(&tested);
    }
}

/* Not where something else may be, nor where it ends, nor where it lets light through. */
static void what_is_no_flat_ground_is_baked(void **state) {
  (void)state;
  shape things[] = {sheet_at(5, 2, 0, 0, 0), sphere_at(0.3, 0.3, 3, 0.002, 0)}, ball = sphere_at(0, 0, 5, 2, 0);
  one_tile tested = bake(things, 2, "accuracy 0.01", 3, 4, 2);
  assert_true(tested.tally.rays == 80 || tested.tally.rays >= 256);
  projected hits[3];
  assert_int_equal(projection_find(&tested.s.map->projection, (double[]){0.3, 0.3, 3}, 0, hits), 1);
  uint32_t x = (uint32_t)hits[0].x / TILE_SIDE, y = (uint32_t)hits[0].y / TILE_SIDE;
  done(&tested);
  tested = bake(things, 2, "accuracy 0.01", x, y, 2);
  assert_true(tested.tally.rays >= 256);
  done(&tested);
  tested = bake(things, 1, "accuracy 0.01", 0, 4, 1);
  assert_true(tested.tally.rays >= 256);
  done(&tested);
  tested = bake(&ball, 1, "accuracy 0.01", 2, 3, 1);
  assert_true(tested.tally.rays >= 256);
  done(&tested);
}

/* Where no caster's box is, nothing is traced. */
static void light_is_free(void **state) {
  (void)state;
  shape balls[] = {sphere_at(-2, -2, 3, 0.2, 0), sphere_at(2, 2, 3, 0.2, 0)};
  one_tile tested = bake(balls, 2, "accuracy 0.01", 4, 4, 2);
  assert_true(tested.tally.rays == 0);
  assert_ptr_equal(tested.t, &tile_lit);
  done(&tested);
  tested = bake(balls, 2, "accuracy 0.01", 0, 0, 2);
  assert_true(tested.tally.rays > 0);
  done(&tested);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(smooth_fog_takes_few_rays),
    cmocka_unit_test(edges_are_found),
    cmocka_unit_test(surfaces_are_not_interpolated),
    cmocka_unit_test(flat_ground_takes_few_rays),
    cmocka_unit_test(what_is_no_flat_ground_is_baked),
    cmocka_unit_test(light_is_free),
  };
  memset(&all_wanted, 1, sizeof all_wanted);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
