/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Files of maps of depths; what they have in common with deep ones is in map_file_test.c. */
#define _XOPEN_SOURCE 700   /* mkdtemp */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "made_map.h"
#include "map/map.h"

static char text[MAP_REASON_SIZE];
static map_reason why = {text, sizeof text};

/* Maps of depths: flat parts, INFINITY, tiles without any surface, one level. */
static void depths_are_read_as_written(void **state) {
  (void)state;
  int lit = 0, full = 0, cut = 0;
  for (uint64_t seed = 0; seed < 16; ++seed) {
    rng r = rng_seeded(seed);
    made_map m = made_map_random(&r, seed % 2 ? MAX_FACES : 1, seed == 0 ? 900 : 60, MADE_DEPTHS, 0);
    const char *path = made_path("depths.exr");
    if (map_file_write(path, &m.header, give_made, &m, NULL, &why) != DSM_OK) fail_msg("%s", text);
    map_header header;   /* each of its texts has been compared with what was written already */
    map_file *file;
    if (map_file_open(path, &header, &file, &why) != DSM_OK) fail_msg("%s", text);
    assert_seeded(&r, header.block == BLOCK_SHADOW_MAP && header.projection.one_level && header.jittered == m.header.jittered);
    assert_seeded(&r, header.vertices == m.header.vertices && header.light.kind == m.header.light.kind);
    dsm_result result = DSM_OK;
    assert_seeded(&r, made_map_differs(&m, file, &result, &why) == m.parts.tile_count && result == DSM_OK);
    for (uint64_t i = 0; i < m.parts.tile_count; ++i) {
      lit += m.tiles[i] == &tile_lit;
      if (m.tiles[i] != &tile_lit) *(depths_of(m.tiles[i])->most < INFINITY ? &full : &cut) += 1;
    }
    map_file_close(file);
    map_header_free(&header);
    made_map_free(&m);
  }
  assert_true(lit && full && cut);
  made_folder_files(1);
}

/* Whatever kind it is of, the file of the other kind is refused, and so is one with other settings of the bake. */
static void kinds_are_told_apart(void **state) {
  (void)state;
  rng r = rng_seeded(1);
  map_header deep = random_header(&r, 1, 20, MADE_GREY), depths = deep, other;
  depths.block = BLOCK_SHADOW_MAP;
  depths.samples = 77;   /* of the look-up, here */
  other = depths;
  assert_int_equal(map_header_compare(&depths, &deep, "some.exr", &why), DSM_REFUSED);
  assert_string_equal(text, "The shadow map \"some.exr\" is that of a deep_shadow block, and cannot be used in a shadow_map block.");
  assert_int_equal(map_header_compare(&deep, &depths, "some.exr", &why), DSM_REFUSED);
  assert_string_equal(text, "The shadow map \"some.exr\" is that of a shadow_map block, and cannot be used in a deep_shadow block.");
  other.samples = 78;
  other.tolerance = 0.3;
  assert_int_equal(map_header_compare(&depths, &other, "some.exr", &why), DSM_OK);
  depths.jittered = !other.jittered;
  assert_int_equal(map_header_compare(&depths, &other, "some.exr", &why), DSM_REFUSED);
  assert_non_null(strstr(text, "'depth_samples' was \"" ));
  map_header_free(&deep);
}

/* Any bit of a depth counts, and so does the tile's number; and what no tile can hold is none. */
static void every_depth_counts(void **state) {
  (void)state;
  rng r = rng_seeded(2);
  for (int k = 0; k < 300; ++k) {
    const tile *t = random_depths(&r), *back;
    deep_tile deep = {.words = NULL};
    assert_int_equal(store_tile(t, STORED_DEPTHS, &deep), DSM_OK);
    tile_record record = tile_record_of(t, &deep, 7);
    assert_int_equal(restore_tile(&deep, STORED_DEPTHS, &record, 7, &back), DSM_OK);
    assert_true(same_tiles(t, back));
    tile_destroy(back);
    assert_int_equal(restore_tile(&deep, STORED_DEPTHS, &record, 8, &back), DSM_REFUSED);
    deep.words[rng_below(&r, TILE_PIXELS)] ^= 1u << rng_below(&r, 32);
    assert_seeded(&r, restore_tile(&deep, STORED_DEPTHS, &record, 7, &back) == DSM_REFUSED && !back);
    free(deep.words);
    tile_destroy(t);
  }
  const float odd[] = {NAN, -1, -INFINITY};
  for (int k = 0; k < 4; ++k) {   /* the last one: no depth is 0 */
    deep_tile deep = {.words = calloc(TILE_PIXELS, sizeof(uint32_t)), .room = TILE_PIXELS};
    float one = 1;
    const tile *back;
    for (int i = 0; i < TILE_PIXELS; ++i) {
      deep.count[i] = 1;
      if (k == 3) memcpy(&deep.words[i], &one, sizeof one);
    }
    if (k < 3) memcpy(&deep.words[9], &odd[k], sizeof odd[k]);
    assert_int_equal(restore_tile(&deep, STORED_DEPTHS, &record_of_lit, 0, &back), DSM_REFUSED);
    free(deep.words);
  }
}

/* Bakes the whole map and saves it. */
static void save(stage *s, const char *path) {
  double share;
  dsm_result result = dsm_api.save_begin(s->worker, path);
  while (result == DSM_OK) result = dsm_api.bake_next(s->worker, &share);
  assert_int_equal(result, DSM_DONE);
  assert_int_equal(dsm_api.save_end(s->worker, NULL), DSM_OK);
}

/* A loaded map answers with the same bits, traces nothing, and may have other settings of the look-up. */
static void loaded_is_as_baked(void **state) {
  (void)state;
  enum { BALLS = 30, POINTS = 4000 };
  static shape balls[BALLS];
  rng r = rng_seeded(12);
  for (int i = 0; i < BALLS; ++i)
    balls[i] = sphere_at(rng_between(&r, -2, 2), rng_between(&r, -2, 2), rng_between(&r, -2, 2), 0.4, 0);
  const dsm_light lights[] = {point_at(0.1, 0.2, 0.3), spot_at(0, 0, -9, 0, 0, 1, 20), parallel_at(0, 9, 0, 0.2, -1, 0)};
  for (int k = 0; k < 3; ++k) {
    static double light[3][POINTS];
    const char *path = made_path("baked.exr");
    for (int run = 0; run < 3; ++run) {   /* baked when needed, saved, loaded */
      stage s;
      stage_open(&s, balls, BALLS, lights[k], run < 2 ? WORDS("shadow_map", "resolution 90", "samples 9")
                                                    : WORDS("shadow_map", "resolution 90", "samples 9", "cache 0.02"));
      if (run == 1) save(&s, path);
      if (run == 2 && dsm_api.load(s.worker, path) != DSM_OK) fail_msg("%s", s.w.last);
      rng points = rng_seeded(3);
      for (int i = 0; i < POINTS; ++i)
        light[run][i] = light_of(&s, in_air(rng_between(&points, -4, 4), rng_between(&points, -4, 4), rng_between(&points, -4, 4)), 0);
      dsm_statistics got = {.size = sizeof got};
      dsm_api.statistics(s.map, &got);
      assert_true(run < 2 ? got.rays > 0 : got.rays == 0 && got.tiles_read > 0);
      stage_close(&s);
    }
    assert_memory_equal(light[0], light[1], sizeof light[0]);
    assert_memory_equal(light[0], light[2], sizeof light[0]);
    stage other;
    stage_open(&other, balls, BALLS, lights[k], WORDS("resolution 90"));
    assert_int_equal(dsm_api.load(other.worker, path), DSM_REFUSED);
    assert_non_null(strstr(other.w.last, "is that of a shadow_map block"));
    stage_close(&other);
    stage_open(&other, balls, BALLS, lights[k], WORDS("shadow_map", "resolution 90", "depth_samples jittered"));
    assert_int_equal(dsm_api.load(other.worker, path), DSM_REFUSED);
    assert_non_null(strstr(other.w.last, "'depth_samples' was \"regular\", and is \"jittered\""));
    stage_close(&other);
    stage_open(&other, balls, BALLS - 1, lights[k], WORDS("shadow_map", "resolution 90"));
    assert_int_equal(dsm_api.load(other.worker, path), DSM_REFUSED);
    assert_non_null(strstr(other.w.last, "another scene"));
    stage_close(&other);
    made_folder_files(1);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(depths_are_read_as_written),
    cmocka_unit_test(kinds_are_told_apart),
    cmocka_unit_test(every_depth_counts),
    cmocka_unit_test(loaded_is_as_baked),
  };
  return cmocka_run_group_tests(tests, made_folder_open, made_folder_close);
}
