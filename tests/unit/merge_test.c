/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "core/settings.h"
#include "map/pack_tile.h"
#include "map/read_tile.h"
#include "map/worker.h"
#include "tool/merge_tile.h"

enum { MOST_TILES = 9 };

/* ---- Tiles of random functions against the sum of them -------------------------------------------------------- */

static double value(const vertex *f, size_t count, double z, int behind, int c) {
  if (!behind) return vertices_at(f, count, z).c[c];
  size_t i = count;
  while (i > 0 && f[i - 1].z > z) --i;
  return i > 0 && f[i - 1].z == z ? f[i - 1].v.c[c] : vertices_at(f, count, z).c[c];
}

typedef struct { const tile *tiles[MOST_TILES]; double weights[MOST_TILES]; uint32_t count; } tile_set;

static void random_pixel(rng *r, vertices *stored, baked_pixel *pixel) {
  double z = rng_between(r, 5, 6);
  rgb v = rgb_grey(1);
  for (uint32_t i = rng_below(r, 12); i > 0; --i) {
    if (rng_below(r, 3)) z += rng_between(r, 0.01, 0.4);
    rgb lower = rgb_scale(rng_unit(r), v);
    if (pixel->coloured) lower.c[1] *= rng_unit(r);
    if (rng_below(r, 2)) assert_int_equal(vertices_push(stored, z, v), DSM_OK);
    assert_int_equal(vertices_push(stored, z, lower), DSM_OK);
    z += 0.001;
    v = lower;
  }
  pixel->count = stored->count - pixel->first;
}

static const tile *random_tile(rng *r, double tolerance, int marks) {
  baked_pixel pixels[TILE_PIXELS];
  vertices stored = {0};
  for (int i = 0; i < TILE_PIXELS; ++i) {
    pixels[i] = (baked_pixel){.first = stored.count, .coloured = rng_below(r, 4) == 0, .tolerance = tolerance};
    if (marks && rng_below(r, 20) == 0) pixels[i].marked = 1;
    else random_pixel(r, &stored, &pixels[i]);
  }
  const tile *t;
  const rounding rule = rounding_least();
  assert_int_equal(pack_tile(pixels, &stored, &rule, &t), DSM_OK);
  vertices_free(&stored);
  return t;
}

static void random_set(rng *r, tile_set *set, double tolerance, int marks) {
  double sum = 0;
  set->count = 1 + rng_below(r, MOST_TILES);
  for (uint32_t i = 0; i < set->count; ++i) {
    set->tiles[i] = rng_below(r, 6) ? random_tile(r, tolerance, marks) : &tile_lit;
    sum += set->weights[i] = rng_between(r, 0.2, 1);
  }
  for (uint32_t i = 0; i < set->count; ++i) set->weights[i] /= sum;
}

static void free_set(tile_set *set) {
  for (uint32_t i = 0; i < set->count; ++i) tile_destroy(set->tiles[i]);
}

static double average_at(const tile_set *set, uint32_t place, double z, int behind, int c) {
  double sum = 0;
  for (uint32_t i = 0; i < set->count; ++i) {
    vertices f = {0};
    assert_int_equal(read_pixel(set->tiles[i], place, &f), DSM_OK);
    sum += set->weights[i] * value(f.data, f.count, z, behind, c);
    vertices_free(&f);
  }
  return sum;
}

/* Depths are stored as floats anew, so that a step may move by `slack`: between the values around that, as nothing grows. */
static void check_depth(rng *r, const tile_set *set, const vertices *got, uint32_t place, double z, double tolerance) {
  const double slack = 1e-6;
  for (int c = 0; c < 3; ++c)
    for (int behind = 0; behind < 2; ++behind) {
      double here = value(got->data, got->count, z, behind, c);
      assert_seeded(r, here <= average_at(set, place, z - slack, 0, c) + tolerance + 1e-12);
      assert_seeded(r, here >= average_at(set, place, z + slack, 1, c) - tolerance - 1e-12);
    }
}

static void check_merged(rng *r, const tile_set *set, const tile *merged, double tolerance) {
  for (uint32_t place = 0; place < TILE_PIXELS; place += 7) {
    vertices got = {0}, depths = {0};
    assert_int_equal(read_pixel(merged, place, &got), DSM_OK);
    assert_int_equal(read_pixel(merged, place, &depths), DSM_OK);
    int marked = 0, coloured = 0;
    for (uint32_t i = 0; i < set->count; ++i) {
      assert_int_equal(read_pixel(set->tiles[i], place, &depths), DSM_OK);
      marked |= set->tiles[i]->kind == TILE_STORED && tile_is_marked(set->tiles[i], place);
      coloured |= set->tiles[i]->kind == TILE_STORED && tile_is_coloured(set->tiles[i], place);
    }
    int stored = merged->kind == TILE_STORED;
    assert_seeded(r, marked == (stored && tile_is_marked(merged, place)));
    assert_seeded(r, coloured || !stored || !tile_is_coloured(merged, place));
    for (size_t i = 0; i < depths.count && !marked; ++i) check_depth(r, set, &got, place, depths.data[i].z, tolerance);
    vertices_free(&got);
    vertices_free(&depths);
  }
}

static void merged_tiles_keep_their_bound(void **state) {
  (void)state;
  static const double tolerances[] = {0, 0.003, 0.02, 0.1};
  merge_scratch scratch = {0};
  for (uint64_t seed = 1; seed <= most_cases(120); ++seed) {
    rng r = rng_seeded(seed);
    tile_set set;
    double tolerance = tolerances[rng_below(&r, 4)];
    random_set(&r, &set, 0.01, 1);
    merge_input in = {set.tiles, set.weights, set.count, 0.01, tolerance};
    const tile *merged;
    assert_int_equal(merge_tiles(&in, &scratch, &merged), DSM_OK);
    /* a tolerance below the rounding of stored values cannot be kept */
    check_merged(&r, &set, merged, fmax(tolerance, VALUE_ROUNDING));
    if (merged->kind == TILE_STORED && merged->tolerance > 0)
      assert_seeded(&r, fabs((double)merged->tolerance - (0.01 + tolerance)) < 1e-7);
    tile_destroy(merged);
    free_set(&set);
  }
  merge_scratch_free(&scratch);
}

/* Tiles that know their own error add half of its mean, or as much less as the average has less noise. */
static void automatic_tolerance(void **state) {
  (void)state;
  merge_scratch scratch = {0};
  rng r = rng_seeded(3);
  tile_set set = {.weights = {0.5, 0.25, 0.25}, .count = 3};
  set.tiles[0] = random_tile(&r, 0.01, 0);
  set.tiles[1] = random_tile(&r, 0.04, 0);
  set.tiles[2] = &tile_lit;
  merge_input in = {set.tiles, set.weights, 3, -1, -1};
  const tile *merged;
  assert_int_equal(merge_tiles(&in, &scratch, &merged), DSM_OK);
  assert_true(fabs((double)merged->tolerance - 1.5 * 0.02) < 1e-7);
  check_merged(&r, &set, merged, 0.01);
  tile_destroy(merged);
  in = (merge_input){set.tiles, (const double[]){0.1, 0.1, 0.8}, 3, -1, -1};   /* 0.66 of the noise: still half */
  assert_int_equal(merge_tiles(&in, &scratch, &merged), DSM_OK);
  assert_true(fabs((double)merged->tolerance - 1.5 * 0.025) < 1e-7);
  tile_destroy(merged);
  const tile *many[16];
  double weights[16];
  for (int i = 0; i < 16; ++i) many[i] = set.tiles[0], weights[i] = 1.0 / 16;
  in = (merge_input){many, weights, 16, -1, -1};   /* a quarter of the noise */
  assert_int_equal(merge_tiles(&in, &scratch, &merged), DSM_OK);
  assert_true(fabs((double)merged->tolerance - 1.25 * 0.01) < 1e-7);
  tile_destroy(merged);
  in = (merge_input){set.tiles, set.weights, 3, -1, -1};
  tile_destroy(set.tiles[0]);
  tile_destroy(set.tiles[1]);
  set.tiles[0] = set.tiles[1] = &tile_lit;
  assert_int_equal(merge_tiles(&in, &scratch, &merged), DSM_OK);
  assert_ptr_equal(merged, &tile_lit);
  merge_scratch_free(&scratch);
}

/* ---- A moving ball against its closed form ---------------------------------------------------------------------- */

enum { MOST_INSTANTS = 64, RESOLUTION = 64 };
static const double RADIUS = 0.5, HEIGHT = 6;   /* its centre goes from x = -1 to 1 at z = HEIGHT, under light along z */

static dsm_settings *bounded_settings(const char *const *words) {
  dsm_settings *settings = settings_of(words);
  const double corners[] = {-1.5, -0.5, 5.5, 1.5, 0.5, 6.5};
  char why[200];
  assert_int_equal(dsm_api.settings_set(settings, WORD_BOUNDS, NULL, corners, 6, why, sizeof why), DSM_OK);
  return settings;
}

typedef struct { world w; shape ball; dsm_map *map; dsm_worker *worker; } instant;

static void open_instant(instant *now, double share, const char *const *words) {
  dsm_light light = parallel_at(0, 0, 0, 0, 0, 1);
  memset(now, 0, sizeof *now);
  now->ball = sphere_at(-1 + 2 * share, 0, HEIGHT, RADIUS, 0);
  now->w = (world){.shapes = &now->ball, .count = 1};
  light.casters = &now->ball.box;
  light.caster_count = 1;
  dsm_host host = host_of(&now->w);
  dsm_settings *settings = bounded_settings(words);
  assert_int_equal(dsm_api.map_create(&host, &light, settings, &now->map), DSM_OK);
  dsm_api.settings_destroy(settings);
  assert_int_equal(dsm_api.worker_create(now->map, &now->w, &now->worker), DSM_OK);
}

static void close_instant(instant *now) {
  dsm_api.worker_destroy(now->worker);
  dsm_api.map_destroy(now->map);
}

/* The share of the shutter's time in which the ball's near side is in front of depth z at (x, y). */
static double time_covered(double x, double y, double z) {
  double lifted = fmax(0, HEIGHT - z), square = RADIUS * RADIUS - lifted * lifted - y * y;
  if (z < HEIGHT - RADIUS || square <= 0) return 0;
  double half = sqrt(square);
  return fmax(0, fmin(1, x + half) - fmax(-1, x - half)) / 2;
}

static double pixel_covered(const face *f, uint32_t x, uint32_t y, double z) {
  enum { SIDE = 16 };
  double sum = 0;
  for (int i = 0; i < SIDE * SIDE; ++i)
    sum += time_covered(f->u0 + f->pixel_u * (x + (i % SIDE + 0.5) / SIDE),
                        f->v0 + f->pixel_v * (y + (i / SIDE + 0.5) / SIDE), z);
  return sum / (SIDE * SIDE);
}

typedef struct { double largest, squares; uint64_t count; } error_sum;

static void add_tile(const dsm_map *map, const tile_key *key, const tile *t, error_sum *sum) {
  static const double depths[] = {5.6, 5.75, 5.9, 6.2, 7};
  const face *f = &map->projection.faces[0];
  for (uint32_t place = 0; place < TILE_PIXELS; ++place) {
    uint32_t x = key->x * TILE_SIDE + place % TILE_SIDE, y = key->y * TILE_SIDE + place / TILE_SIDE;
    if (x >= f->width || y >= f->height) continue;
    vertices got = {0};
    assert_int_equal(read_pixel(t, place, &got), DSM_OK);
    for (int d = 0; d < 5; ++d) {
      double error = vertices_at(got.data, got.count, depths[d]).c[0] - (1 - pixel_covered(f, x, y, depths[d]));
      sum->largest = fmax(sum->largest, fabs(error));
      sum->squares += error * error;
      ++sum->count;
    }
    vertices_free(&got);
  }
}

static error_sum merge_instants(uint32_t count, const char *const *words) {
  static instant all[MOST_INSTANTS];
  const tile *tiles[MOST_INSTANTS], *merged;
  double weights[MOST_INSTANTS];
  error_sum sum = {0, 0, 0};
  merge_scratch scratch = {0};
  for (uint32_t i = 0; i < count; ++i) {
    open_instant(&all[i], (i + 0.5) / count, words);
    worker_enter(all[i].worker);
    weights[i] = 1.0 / count;
  }
  const tile_grid *grid = &all[0].map->store.grids[0][0];
  assert_true(memcmp(&all[0].map->projection, &all[count - 1].map->projection, sizeof(projection)) == 0);
  for (tile_key key = {0, 0, 0, 0}; key.y < grid->up; key.x + 1 < grid->across ? ++key.x : (key.x = 0, ++key.y)) {
    for (uint32_t i = 0; i < count; ++i) assert_int_equal(worker_tile(all[i].worker, &key, &tiles[i]), DSM_OK);
    merge_input in = {tiles, weights, count, -1, -1};
    assert_int_equal(merge_tiles(&in, &scratch, &merged), DSM_OK);
    add_tile(all[0].map, &key, merged, &sum);
    tile_destroy(merged);
  }
  for (uint32_t i = 0; i < count; ++i) {
    worker_leave(all[i].worker);
    close_instant(&all[i]);
  }
  merge_scratch_free(&scratch);
  return sum;
}

/* N instants make N steps of 1/N, each half too high and half too low; a pixel's filter smooths some of that. Samples add
 * their own noise, and compression its tolerance of 0.003 + 0.0015. */
static void a_moving_ball(void **state) {
  (void)state;
  for (uint32_t count = 1; count <= MOST_INSTANTS; count *= 2) {
    error_sum sum = merge_instants(count, WORDS("resolution 64", "samples 64", "tolerance 0.003"));
    double rms = sqrt(sum.squares / (double)sum.count);
    print_message("%2u instants: RMS %.4f, largest %.4f\n", count, rms, sum.largest);
    assert_true(rms < 0.32 / count);
    assert_true(sum.largest < 0.9 / count + 0.0045);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(merged_tiles_keep_their_bound),
    cmocka_unit_test(automatic_tolerance),
    cmocka_unit_test(a_moving_ball),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
