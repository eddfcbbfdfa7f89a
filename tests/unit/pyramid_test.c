/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Coarser levels against the exact average of the finest pixels that they cover. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "core/average.h"
#include "core/rounding.h"
#include "map/read_tile.h"
#include "map/worker.h"

enum { BALLS = 300 };

static shape balls[BALLS];

static void scatter(uint64_t seed, int coloured) {
  rng r = rng_seeded(seed);
  for (int i = 0; i < BALLS; ++i) {
    balls[i] = sphere_at(rng_between(&r, -1, 1), rng_between(&r, -0.7, 0.7), rng_between(&r, 2, 4), 0.06, 0.7);
    if (coloured && i % 3 == 0) balls[i].pass[i % 2] = 0.2;
  }
}

static const tile *tile_of(stage *s, uint32_t level, uint32_t x, uint32_t y, uint32_t *place) {
  tile_key key = {0, level, x / TILE_SIDE, y / TILE_SIDE};
  const tile *t = NULL;
  *place = y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE;
  assert_int_equal(worker_tile(s->worker, &key, &t), DSM_OK);
  assert_true(t->kind != TILE_FAILED);
  return t;
}

/* The average of all finest pixels of a map with tolerance 0 under a pixel of a level; what is outside is lit. */
static void exact(stage *s, uint32_t level, uint32_t x, uint32_t y, vertices *out) {
  const face *f = &s->map->projection.faces[0];
  uint32_t side = 1u << level, count = side * side;
  vertices all = {0};
  size_t *first = malloc((count + 1) * sizeof *first);
  double *weights = malloc(count * sizeof *weights);
  for (uint32_t i = 0; i < count; ++i) {
    uint32_t px = x * side + i % side, py = y * side + i / side, place;
    first[i] = all.count;
    weights[i] = 1.0 / count;
    if (px >= f->width || py >= f->height) continue;
    const tile *t = tile_of(s, 0, px, py, &place);
    assert_int_equal(read_pixel(t, place, &all), DSM_OK);
  }
  first[count] = all.count;
  average_scratch scratch = {0};
  average_input in = {all.data, first, weights, count};
  out->count = 0;
  assert_int_equal(average_sweep(&in, &scratch, out), DSM_OK);
  average_free(&scratch);
  vertices_free(&all);
  free(first);
  free(weights);
}

static const double FLOATS = 1e-6;   /* depths are rounded to floats */

static double excess(const vertices *got, const vertices *want, double z, double moved) {
  rgb v = vertices_at(got->data, got->count, z);
  rgb above = rgb_sub(v, vertices_at(want->data, want->count, z - moved));
  rgb below = rgb_sub(vertices_at(want->data, want->count, z + FLOATS), v);
  return fmax(0, fmax(rgb_max(above), rgb_max(below)));
}

/* The largest difference over all depths of two functions that never grow, where vertices of the first have moved so far away: it is
 * just in front of or behind a vertex of either. */
static double apart(const vertices *got, const vertices *want, double moved) {
  double most = 0;
  for (int k = 0; k < 2; ++k) {
    const vertices *v = k ? want : got;
    for (size_t i = 0; i < v->count; ++i)
      for (int shift = -1; shift <= 1; ++shift)
        for (int side = -1; side <= 1; side += 2)
          most = fmax(most, excess(got, want, v->data[i].z + shift * moved + side * 1e-9, moved));
  }
  return most;
}

/* Every level of a map is within twice the base's tolerance of the truth, and no farther than the sum of its own and
 * the finer levels' tolerances. */
static void error_of_each_level(void **state) {
  (void)state;
  static const char *const tolerances[] = {"tolerance 0.1", "tolerance 0.03", "tolerance 0.004"};
  static const double bound[] = {0.1, 0.03, 0.004};
  for (int k = 0; k < 3; ++k) {
    scatter((uint64_t)k, k == 1);
    stage rough, fine;
    const char *resolution = k == 0 ? "resolution 75 53" : "resolution 64";
    stage_open(&rough, balls, BALLS, parallel_at(0, 0, 0, 0, 0, 1), WORDS(resolution, tolerances[k]));
    worker_enter(rough.worker);
    stage_open(&fine, balls, BALLS, parallel_at(0, 0, 0, 0, 0, 1), WORDS(resolution, "tolerance 0"));
    worker_enter(fine.worker);
    const face *f = &rough.map->projection.faces[0];
    vertices want = {0}, got = {0};
    for (uint32_t level = 0; level < face_levels(f); ++level) {
      double worst = 0, sum = bound[k] * (2 - ldexp(1, -(int)level));
      double moved = FLOATS;
      for (uint32_t l = 0; l <= level; ++l)
        moved += rounding_for(&rough.map->projection, 0, l, l, rounding_value_bits(ldexp(bound[k], -(int)l)), ldexp(bound[k], -(int)l)).quantum;
      for (uint32_t y = 0; y < level_pixels(f->height, level); ++y)
        for (uint32_t x = 0; x < level_pixels(f->width, level); ++x) {
          uint32_t place;
          const tile *t = tile_of(&rough, level, x, y, &place);
          got.count = 0;
          assert_int_equal(read_pixel(t, place, &got), DSM_OK);
          exact(&fine, level, x, y, &want);
          worst = fmax(worst, apart(&got, &want, moved));
        }
      if (!(worst <= sum + 1e-5)) fail_msg("level %u: %g of %g", level, worst, sum);
      if (level == 0) assert_true(worst > 0.3 * bound[k]);   /* the tolerance is in use */
    }
    vertices_free(&want);
    vertices_free(&got);
    worker_leave(rough.worker);
    worker_leave(fine.worker);
    stage_close(&rough);
    stage_close(&fine);
  }
}

/* The tolerance halves from level to level, in stored tiles too. */
static void tolerance_is_halved(void **state) {
  (void)state;
  scatter(5, 0);
  stage s;
  stage_open(&s, balls, BALLS, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 128", "tolerance 0.064"));
  worker_enter(s.worker);
  for (uint32_t level = 0; level < 7; ++level) {
    uint32_t place;
    const tile *t = tile_of(&s, level, 0, 0, &place);
    assert_true(t->kind != TILE_STORED || fabs(t->tolerance - ldexp(0.064, -(int)level)) < 1e-8);
  }
  worker_leave(s.worker);
  stage_close(&s);
}

enum { GRAINS = 4000 };

/* Memory of a level's tiles. */
static double bytes_of(stage *s, uint32_t level) {
  const tile_grid *grid = &s->map->store.grids[0][level];
  double sum = 0;
  for (uint32_t y = 0; y < grid->up; ++y)
    for (uint32_t x = 0; x < grid->across; ++x) {
      uint32_t place;
      const tile *t = tile_of(s, level, x * TILE_SIDE, y * TILE_SIDE, &place);
      sum += t->kind == TILE_STORED ? t->size : 0;
    }
  return sum;
}

/* A pixel of level 1 is within half the finest tolerance of the average of the four below it. */
static void near_its_parts(stage *s, uint32_t x, uint32_t y) {
  static const double weights[4] = {0.25, 0.25, 0.25, 0.25};
  vertices all = {0}, want = {0}, got = {0};
  average_scratch scratch = {0};
  size_t first[5];
  double tolerance = 0;
  uint32_t place;
  for (uint32_t q = 0; q < 4; ++q) {
    first[q] = all.count;
    const tile *t = tile_of(s, 0, 2 * x + q % 2, 2 * y + q / 2, &place);
    assert_int_equal(read_pixel(t, place, &all), DSM_OK);
    tolerance = fmax(tolerance, t->kind == TILE_STORED ? (double)t->tolerance : 0);
  }
  first[4] = all.count;
  average_input in = {all.data, first, weights, 4};
  assert_int_equal(average_sweep(&in, &scratch, &want), DSM_OK);
  const tile *coarse = tile_of(s, 1, x, y, &place);
  assert_int_equal(read_pixel(coarse, place, &got), DSM_OK);
  double moved = FLOATS + rounding_reach(&s->map->projection, 0, 1, 1);
  double off = apart(&got, &want, moved);
  if (!(off <= tolerance / 2 + 1e-5)) fail_msg("%g of %g", off, tolerance / 2);
  average_free(&scratch);
  vertices_free(&all);
  vertices_free(&want);
  vertices_free(&got);
}

/* Grains finer than a pixel, so that every ray ends elsewhere. At the automatic tolerance one ray's step is noise at each level, and
 * all levels together take at most what LV 5.3 expects, 1.55 of the finest; but no level loses more than its tolerance. */
static void steps_of_single_rays(void **state) {
  (void)state;
  static const char *const samples[] = {"samples 4", "samples 16"};
  shape *grains = malloc(GRAINS * sizeof *grains);
  rng r = rng_seeded(11);
  for (int i = 0; i < GRAINS; ++i)
    grains[i] = sphere_at(rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 2, 4), 0.01, 0);
  for (int k = 0; k < 2; ++k) {
    stage s;
    stage_open(&s, grains, GRAINS, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 128", samples[k]));
    worker_enter(s.worker);
    const face *f = &s.map->projection.faces[0];
    double base = bytes_of(&s, 0), all = base;
    for (uint32_t level = 1; level < face_levels(f); ++level) all += bytes_of(&s, level);
    if (!(all <= 1.55 * base)) fail_msg("%s: all levels take %g of the finest", samples[k], all / base);
    for (int i = 0; i < 200; ++i)
      near_its_parts(&s, (uint32_t)rng_between(&r, 0, f->width / 2), (uint32_t)rng_between(&r, 0, f->height / 2));
    worker_leave(s.worker);
    stage_close(&s);
  }
  free(grains);
}

/* A single pixel in the end, which has seen all; and where nothing is, nothing is stored at any level. */
static void down_to_one_pixel(void **state) {
  (void)state;
  shape corner[] = {sheet_at(5, 1, 0.5, 0.5, 0.5), sphere_at(3.9, 3.9, 5, 0.05, 0)};
  stage s;
  stage_open(&s, corner, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 200", "tolerance 0"));
  worker_enter(s.worker);
  const face *f = &s.map->projection.faces[0];
  uint32_t levels = face_levels(f), place;
  assert_true(level_pixels(f->width, levels - 1) == 1 && level_pixels(f->width, levels - 2) > 1);
  const tile *t = tile_of(&s, levels - 1, 0, 0, &place);
  uint32_t hint = 0;
  visibility v = tile_visibility(t, place);
  double covered = 2.0 * 2 / (256 * f->pixel_u * 256 * f->pixel_v);   /* eight levels of 256 pixels, most outside */
  double ball = 3.1415927 * 0.05 * 0.05 / (256 * f->pixel_u * 256 * f->pixel_v);
  assert_true(fabs(visibility_at(&v, 100, &hint).c[0] - (1 - 0.5 * covered - ball)) < 2e-4);
  for (uint32_t level = 0; level < 3; ++level)
    assert_int_equal(tile_of(&s, level, level_pixels(f->width, level) - 1, 0, &place)->kind, TILE_LIT);
  worker_leave(s.worker);
  stage_close(&s);
}

/* One marked pixel marks what covers it, at every level. */
static dsm_result mark_one(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  dsm_result result = trace_world(data, rays, count, tolerance, sink);
  for (uint32_t i = 0; i < count && result == DSM_OK; ++i)
    if (fabs(rays[i].origin[0] - 0.5) < 1e-3 && fabs(rays[i].origin[1] - 0.5) < 0.02)
      result = dsm_api.sink_mark(sink, i);
  return result;
}

static void marks_spread_upwards(void **state) {
  (void)state;
  shape sheet = sheet_at(5, 1, 0.5, 0.5, 0.5);
  stage s;
  stage_open(&s, &sheet, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 64", "samples 64"));
  worker_enter(s.worker);
  s.map->host.trace = mark_one;
  const face *f = &s.map->projection.faces[0];
  uint32_t x = (uint32_t)((0.5 - f->u0) / f->pixel_u), y = (uint32_t)((0.5 - f->v0) / f->pixel_v), marked, place;
  for (uint32_t level = 0; level < face_levels(f); ++level) {
    const tile *t = tile_of(&s, level, x >> level, y >> level, &place);
    int any = tile_is_marked(t, place);
    if (level == 0) marked = (uint32_t)any;
    assert_true(marked ? any : 1);
  }
  assert_true(marked);
  worker_leave(s.worker);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(error_of_each_level),
    cmocka_unit_test(tolerance_is_halved),
    cmocka_unit_test(steps_of_single_rays),
    cmocka_unit_test(down_to_one_pixel),
    cmocka_unit_test(marks_spread_upwards),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
