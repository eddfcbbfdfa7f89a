/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What a map with `accuracy` learns from a few places of the picture: how wide footprints are, what the first level is off by there, and how
 * coarse it may be read. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "map/view.h"

static const double AIM = 0.01;

static dsm_light sun(void) { return parallel_at(0, 0, 0, 0, 0, 1); }

/* Two small spheres make the frame -2 to 2; a large one is in the middle. */
static const shape SCENE[] = {
  {SPHERE, {{-2, -2, 1}, {-1.8, -1.8, 1.2}}, {0, 0, 0}, {0}, 0, 0},
  {SPHERE, {{1.8, 1.8, 1}, {2, 2, 1.2}}, {0, 0, 0}, {0}, 0, 0},
  {SPHERE, {{-1, -1, 2}, {1, 1, 4}}, {0, 0, 0}, {0}, 0, 0}};

static void open_scene(stage *s, const char *accuracy) { stage_open(s, SCENE, 3, sun(), WORDS(accuracy)); }

/* Below the casters, with a footprint of so many pixels of the first level along x and y. */
static dsm_receiver place(const stage *s, double x, double y, double across, double up) {
  double pixel = ldexp(s->map->projection.faces[0].pixel_u, (int)s->map->first_level);
  return (dsm_receiver){.point = {x, y, 6}, .has_footprint = 1, .footprint = {{across * pixel, 0, 0}, {0, up * pixel, 0}}};
}

static void explore(stage *s, dsm_receiver at) { assert_int_equal(dsm_api.explore(s->worker, &at), DSM_OK); }

static exploration explored_at(stage *s, dsm_receiver at) {
  s->map->explored = (exploration){0};
  explore(s, at);
  return s->map->explored;
}

static uint64_t tiles_baked(const stage *s) {
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(s->map, &got);
  return got.tiles_baked;
}

/* A footprint asks for pixels of its own variance; a long one, for as small ones as four of them along it are. */
static void widths(void **state) {
  (void)state;
  stage s;
  open_scene(&s, "accuracy 0.01");
  double first = ldexp(1, (int)s.map->first_level);
  static const double sides[][2] = {{0.9, 0.9}, {0.3, 0.3}, {0.1, 0.1}, {0.5, 0.01}, {0.9, 0.3}, {40, 40}, {0.02, 0.4}};
  for (int k = 0; k < 7; ++k) {
    double longer = fmax(sides[k][0], sides[k][1]) * first, shorter = fmax(1, fmin(sides[k][0], sides[k][1]) * first);
    double scale = fmax(1 + (shorter * shorter - 1) / 3, (longer * longer - shorter * shorter) / 9);
    exploration e = explored_at(&s, place(&s, 0.3, 0.2, sides[k][0], sides[k][1]));
    assert_int_equal(e.looked, 1);
    assert_true(fabs(exp2(e.octaves) - sqrt(scale) / first) < 1e-6 * sqrt(scale) / first);
  }
  stage_close(&s);
}

/* The first level is wrong at edges alone, and the more the larger the footprint is for which it is read; but for one as large as its
 * pixels it is as good as any, and nothing is baked to find that. */
static void errors(void **state) {
  (void)state;
  stage s;
  open_scene(&s, "accuracy 0.01");
  assert_true(explored_at(&s, place(&s, 1, 0, 8, 8)).squares == 0);
  assert_int_equal(tiles_baked(&s), 0);
  assert_true(explored_at(&s, place(&s, 1.6, -1.6, 0.3, 0.3)).squares == 0);
  assert_true(explored_at(&s, place(&s, 0, 0, 0.3, 0.3)).squares == 0);
  assert_true(tiles_baked(&s) > 0);
  exploration narrow = explored_at(&s, place(&s, 1, 0, 0.2, 0.2)), wide = explored_at(&s, place(&s, 1, 0, 0.6, 0.6));
  assert_true(narrow.squares > AIM * AIM);
  double squared = narrow.squares / exp2(narrow.octaves);
  assert_true(fabs(wide.squares / exp2(wide.octaves) - squared) < 1e-9 * squared);
  assert_true(wide.octaves > narrow.octaves + 1);
  s.map->explored = (exploration){0};
  for (int k = 0; k < 3; ++k) explore(&s, place(&s, 1, 0, 0.2, 0.2));
  assert_int_equal(s.map->explored.looked, 3);
  assert_true(fabs(s.map->explored.squares - 3 * narrow.squares) < 1e-9 * narrow.squares);
  stage_close(&s);
}

/* Light that grows is ray-traced, and a ray makes no error, though the sphere's edge is one like others. */
static void rays_are_right(void **state) {
  (void)state;
  shape shapes[] = {SCENE[0], SCENE[1], SCENE[2]};
  for (int c = 0; c < 3; ++c) shapes[2].pass[c] = 1.5;
  stage s;
  stage_open(&s, shapes, 3, sun(), WORDS("accuracy 0.01"));
  for (double x = 0.9; x < 1.1; x += 0.01) {
    dsm_receiver at = place(&s, x, 0, 0.3, 0.3);
    explore(&s, at);
  }
  assert_int_equal(s.map->explored.looked, 20);
  assert_true(s.map->explored.squares == 0);
  stage_close(&s);
}

/* What is seen of two faces of a cube counts by their weights. */
static void seams(void **state) {
  (void)state;
  shape around[] = {sphere_at(2, 0, 2, 1, 0), sphere_at(-2, 1, -3, 1, 0), sphere_at(0, -3, 0, 1, 0)};
  stage s;
  stage_open(&s, around, 3, point_at(0, 0, 0), WORDS("accuracy 0.01"));
  const projection *p = &s.map->projection;
  assert_int_equal(p->count, MAX_FACES);
  int seen = 0;
  for (int i = 0; i < 80; ++i) {
    dsm_receiver at = {.point = {6 - 0.0003 * (i % 3), 3 + 0.005 * i, 6}, .has_footprint = 1, .footprint = {{1e-5, 0, 0}, {0, 1e-5, 0}}};
    projected hits[3];
    uint32_t count = projection_find(p, at.point, 0.5, hits);
    exploration e = explored_at(&s, at);
    double sum = 0;
    assert_int_equal(e.looked, count);
    worker_enter(s.worker);
    for (uint32_t k = 0; k < count; ++k) {
      view v;
      double squared;
      view_begin(&v, s.worker, &at);
      v.at = &hits[k];
      assert_int_equal(view_first_error(&v, 0, hits[k].x, hits[k].y, &squared), DSM_OK);
      sum += hits[k].weight * squared * exp2(e.octaves / count);
    }
    worker_leave(s.worker);
    assert_true(fabs(e.squares - sum) <= 1e-9 * sum);
    seen += count == 2 && sum > 0;
  }
  assert_true(seen > 3);

  /* a long footprint is read at one place there, with pixels of its whole variance */
  projected hit[3];
  assert_int_equal(projection_find(p, (double[3]){3, 0, 6}, 0.5, hit), 1);
  double pixel = p->faces[hit[0].face].pixel_u * 6, first = ldexp(1, (int)s.map->first_level), longer = first / 2;
  dsm_receiver at = {.point = {3, 0, 6}, .has_footprint = 1, .footprint = {{longer * pixel, 0, 0}, {0, pixel, 0}}};
  exploration e = explored_at(&s, at);
  assert_true(fabs(exp2(e.octaves) * first - sqrt(1 + (longer * longer - 1) / 3)) < 1e-6 * first);
  stage_close(&s);
}

static uint32_t finest_made(const stage *s) {
  const tile_store *store = &s->map->store;
  for (tile_key key = {0, 0, 0, 0}; key.level < store->level_count; ++key.level) {
    const tile_grid *grid = &store->grids[0][key.level];
    for (key.y = 0; key.y < grid->up; ++key.y)
      for (key.x = 0; key.x < grid->across; ++key.x)
        if (tile_cache_was_made(&store->cache, tile_store_number(store, &key))) return key.level;
  }
  return MAX_LEVELS;
}

/* Where a bead may be missed, the next level is looked at, and the next, but none that the footprint does not ask for. */
static void beads(void **state) {
  (void)state;
  static const struct { double side; uint32_t finer; } cases[] = {{0.9, 1}, {0.4, 3}, {0.2, 4}};
  for (int k = 0; k < 3; ++k) {
    stage s;
    open_scene(&s, "accuracy 0.01");
    const face *f = &s.map->projection.faces[0];
    double at[2];   /* the middle of a tile of the first level, and within one of each finer level */
    for (int c = 0; c < 2; ++c) at[c] = (c ? f->v0 : f->u0) + ldexp(TILE_SIDE * 2 + 8.5, (int)s.map->first_level) * (c ? f->pixel_v : f->pixel_u);
    stage_close(&s);
    shape shapes[] = {SCENE[0], SCENE[1], sphere_at(at[0], at[1], 3, 0.0005, 0)};
    stage_open(&s, shapes, 3, sun(), WORDS("accuracy 0.01"));
    explore(&s, place(&s, at[0], at[1], cases[k].side, cases[k].side));
    assert_int_equal(finest_made(&s), s.map->first_level - cases[k].finer);
    stage_close(&s);
  }
}

/* What a look-up refuses, and places without a footprint, tell nothing; nor does a bake that is cancelled. */
static void nothing_to_learn(void **state) {
  (void)state;
  static const double odd[] = {NAN, INFINITY, -INFINITY};
  stage s;
  open_scene(&s, "accuracy 0.01");
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 13; ++i) {
      dsm_receiver at = place(&s, 1, 0, 0.3, 0.3);
      at.plane_count = 1;
      at.planes[0] = (dsm_plane){{0, 0, -1}, 0};
      double *numbers[] = {&at.point[0], &at.footprint[0][0], &at.footprint[1][0], &at.planes[0].normal[0]};
      *(i < 12 ? &numbers[i / 3][i % 3] : &at.planes[0].rise) = odd[k];
      assert_int_equal(dsm_api.explore(s.worker, &at), DSM_INVALID);
    }
  dsm_receiver at = place(&s, 1, 0, 0.3, 0.3);
  at.plane_count = 3;
  assert_int_equal(dsm_api.explore(s.worker, &at), DSM_INVALID);
  at = place(&s, 1, 0, 0.3, 0.3);
  at.has_footprint = 0;
  explore(&s, at);
  explore(&s, place(&s, 100, 0, 0.3, 0.3));
  assert_int_equal(s.map->explored.looked, 0);
  assert_int_equal(tiles_baked(&s), 0);
  at.has_footprint = 1;
  s.w.stop = 1;
  assert_int_equal(dsm_api.explore(s.worker, &at), DSM_CANCELLED);
  s.w.stop = 0;
  assert_true(s.map->explored.squares == 0);
  explore(&s, at);
  assert_true(s.map->explored.squares > 0);
  stage_close(&s);

  stage_open(&s, SCENE, 3, sun(), WORDS("resolution 64"));   /* without accuracy */
  double coarser = s.map->coarser;
  explore(&s, at);
  assert_int_equal(s.map->explored.looked, 0);
  s.map->explored.looked = 5;
  dsm_api.explored(s.map, 100, 3);
  assert_true(s.map->coarser == coarser && s.map->explored_level == 0);
  stage_close(&s);
}

/* As wide as pixels of the aim's errors may be, from what was seen: `squares` of so many camera rays, of which `across` lie side by side. */
static double width_after(const char *accuracy, double squares, uint64_t rays, double across) {
  stage s;
  open_scene(&s, accuracy);
  s.map->explored = (exploration){.squares = squares, .octaves = -20, .looked = 10};
  dsm_api.explored(s.map, rays, across);
  double width = sqrt(s.map->coarser);
  stage_close(&s);
  return width;
}

static int is_near(double a, double b) { return fabs(a - b) < 1e-9 * fabs(b); }

/* Errors go with the width, and with its cube where an image pixel averages several; they are shared among all camera rays, seen or not. */
static void how_coarse(void **state) {
  (void)state;
  const double squares = 0.12 * 1000 * AIM * AIM;   /* with pixels of the footprint's width the error is the aim */
  stage s;
  open_scene(&s, "accuracy 0.01");
  double own = sqrt(s.map->coarser);
  stage_close(&s);
  assert_true(own > 1 && own < 2.5);
  assert_true(is_near(width_after("accuracy 0.01", squares / 20, 1000, 3), 20));
  assert_true(is_near(width_after("accuracy 0.01", squares / 40, 1000, 3), 40));
  assert_true(is_near(width_after("accuracy 0.01", squares / 20, 500, 3), 10));
  assert_true(is_near(width_after("accuracy 0.02", squares / 10, 1000, 3), 40));
  assert_true(is_near(width_after("accuracy 0.01", squares / 3, 1000, 3), 3));
  assert_true(is_near(width_after("accuracy 0.01", squares / 5, 1000, 9), cbrt(5 * 81)));
  assert_true(is_near(width_after("accuracy 0.01", 100 * squares, 1000, 3), own));
  assert_true(is_near(width_after("accuracy 0.01", squares / 1e5, 1000, 3), 64));
  assert_true(is_near(width_after("accuracy 0.01", 0, 1000, 3), 64));
  assert_true(is_near(width_after("accuracy 0.01", 0, 1000, 0), own));   /* which nobody can mean */
  assert_true(is_near(width_after("accuracy 0.01", 0, 1000, NAN), own));
}

static uint32_t level_after(stage *s, double octaves, double width) {
  s->map->explored = (exploration){.squares = 0.12 * AIM * AIM * 1000 / width, .octaves = octaves * 10, .looked = 10};
  s->map->coarser = 1;
  dsm_api.explored(s->map, 1000, 1);
  return s->map->explored_level;
}

/* The nearest to what camera rays read then, on average, and no coarser than the first. */
static void which_level(void **state) {
  (void)state;
  stage s;
  open_scene(&s, "accuracy 0.01");
  uint32_t first = s.map->first_level;
  assert_true(first >= 3);
  assert_int_equal(level_after(&s, -2, 2), first - 1);
  assert_int_equal(level_after(&s, -2.4, 2), first - 1);
  assert_int_equal(level_after(&s, -2.6, 2), first - 2);
  assert_int_equal(level_after(&s, -1, 8), first);
  assert_int_equal(level_after(&s, -2 * (double)first, 1), 0);
  assert_int_equal(level_after(&s, 0.4 - first, 1), 0);
  assert_int_equal(level_after(&s, 0.6 - first, 1), 1);
  s.map->explored = (exploration){0};
  s.map->coarser = 7;
  dsm_api.explored(s.map, 1000, 1);
  assert_true(s.map->coarser == 7);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(widths),
    cmocka_unit_test(errors),
    cmocka_unit_test(rays_are_right),
    cmocka_unit_test(seams),
    cmocka_unit_test(beads),
    cmocka_unit_test(nothing_to_learn),
    cmocka_unit_test(how_coarse),
    cmocka_unit_test(which_level),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
