/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "core/settings.h"

static dsm_result create(world *w, dsm_light light, dsm_map **map) {
  dsm_host host = host_of(w);
  *map = (dsm_map *)1;
  return dsm_api.map_create(&host, &light, NULL, map);
}

static void bad_lights_are_refused_with_a_sentence(void **state) {
  (void)state;
  dsm_box good = {{0, 0, 1}, {1, 1, 2}};
  dsm_light lights[9];
  for (int i = 0; i < 9; ++i) {
    lights[i] = spot_at(0, 0, 0, 0, 0, 1, 20);
    lights[i].casters = &good;
    lights[i].caster_count = 1;
  }
  dsm_box turned = {{0, 0, 2}, {1, 1, 1}}, endless = {{0, 0, 0}, {1, INFINITY, 1}};
  lights[0].kind = 3;
  lights[1].origin[1] = NAN;
  lights[2].direction[2] = 0;
  lights[3].cos_angle = 1.5;
  lights[4].kind = DSM_LIGHT_PARALLEL;
  lights[4].radius = -1;
  lights[5].casters = NULL;
  lights[6].casters = &turned;
  lights[7].casters = &endless;
  lights[8].size = 8;
  for (int i = 0; i < 9; ++i) {
    world w = {0};
    dsm_map *map;
    assert_int_equal(create(&w, lights[i], &map), DSM_INVALID);
    assert_null(map);
    assert_int_equal(w.sentences, 1);
    assert_true(w.last[strlen(w.last) - 1] == '.');
  }
  world w = {0};
  dsm_host host = host_of(&w);
  dsm_map *map;
  host.trace = NULL;
  assert_int_equal(dsm_api.map_create(&host, &lights[0], NULL, &map), DSM_INVALID);
  host = host_of(&w);
  host.size = 4;
  assert_int_equal(dsm_api.map_create(&host, &lights[0], NULL, &map), DSM_INVALID);
}

static void every_bound_of_a_box_is_looked_at(void **state) {
  (void)state;
  static const double wrong[] = {NAN, INFINITY, -INFINITY, 1e151};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 9; ++k) {
      dsm_box boxes[2] = {{{0, 0, 1}, {1, 1, 2}}, {{0, 0, 1}, {1, 1, 2}}};
      if (k < 4) boxes[1].low[i] = wrong[k];
      else if (k < 8) boxes[1].high[i] = wrong[k - 4];
      else boxes[1].low[i] = 2.5;
      dsm_light light = spot_at(0, 0, 0, 0, 0, 1, 20);
      light.casters = boxes;
      light.caster_count = 2;
      world w = {0};
      dsm_map *map;
      assert_int_equal(create(&w, light, &map), DSM_INVALID);
      assert_non_null(strstr(w.last, "without a finite, ordered box."));
      light.caster_count = 1;
      assert_int_equal(create(&w, light, &map), DSM_OK);
      dsm_api.map_destroy(map);
    }
  dsm_light light = spot_at(0, 0, 0, 0, 0, 1, 20);
  light.cos_angle = -1.5;
  world w = {0};
  dsm_map *map;
  assert_int_equal(create(&w, light, &map), DSM_INVALID);
  light = parallel_at(0, 0, 0, 0, 0, 1);
  light.direction[1] = NAN;
  assert_int_equal(create(&w, light, &map), DSM_INVALID);
  assert_string_equal(w.last, "The shadow map's light has no direction.");
}

/* What is wrong is refused all the same by a host without ears, and by one without hands. */
static void hosts_without_report_or_room(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  world w = {.shapes = &ball, .count = 1};
  dsm_host host = host_of(&w);
  dsm_light light = spot_at(0, 0, 0, 0, 0, 1, 20);
  dsm_map *map = (dsm_map *)1;
  light.casters = &ball.box;
  light.caster_count = 1;
  assert_int_equal(dsm_api.map_create(&host, &light, NULL, NULL), DSM_INVALID);
  assert_int_equal(dsm_api.map_create(NULL, &light, NULL, &map), DSM_INVALID);
  assert_null(map);
  assert_int_equal(dsm_api.map_create(&host, NULL, NULL, &map), DSM_INVALID);
  assert_int_equal(w.sentences, 1);
  host.report = NULL;
  assert_int_equal(dsm_api.map_create(&host, NULL, NULL, &map), DSM_INVALID);
  assert_int_equal(dsm_api.map_create(&host, &light, NULL, &map), DSM_OK);
  /* and a tile that fails is told to nobody */
  dsm_worker *worker;
  double rgb[3];
  dsm_receiver at = in_air(0, 0, 9);
  w.fail_with = DSM_NO_MEMORY;
  assert_int_equal(dsm_api.worker_create(map, &w, &worker), DSM_OK);
  assert_int_equal(dsm_api.lookup(worker, &at, rgb), DSM_TRACE);
  dsm_statistics got = {.size = 0, .tiles = 77};
  dsm_api.statistics(map, &got);
  assert_true(got.size == 0 && got.tiles == 77);
  dsm_api.worker_destroy(worker);
  dsm_api.map_destroy(map);
  assert_int_equal(w.sentences, 1);
}

static void nothing_to_destroy(void **state) {
  (void)state;
  dsm_api.map_destroy(NULL);
  dsm_api.worker_destroy(NULL);
  dsm_api.settings_destroy(NULL);
  assert_true(dsm_api.abi == DSM_ABI && dsm_api.size == sizeof(dsm_api_table) && dsm_api.block_count == BLOCK_COUNT);
}

static void no_casters_all_lit(void **state) {
  (void)state;
  for (uint32_t kind = 0; kind < 3; ++kind) {
    dsm_light light = spot_at(1, 2, 3, 0, 1, 0, 30);
    light.kind = kind;
    stage s;
    stage_open(&s, NULL, 0, light, NULL);
    double rgb[3] = {0};
    dsm_receiver at = in_air(4, 5, 6);
    assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_OUTSIDE);
    assert_true(rgb[0] == 1 && rgb[1] == 1 && rgb[2] == 1);
    dsm_statistics got = {.size = sizeof got};
    dsm_api.statistics(s.map, &got);
    assert_true(got.faces == 0 && got.tiles == 0 && got.pixels == 0 && got.rays == 0);
    stage_close(&s);
  }
}

/* Degenerate cones: no light, hardly any, and nearly all of it. */
static void odd_cones(void **state) {
  (void)state;
  static const double degrees[] = {0, 0.001, 59.999, 60.001, 90, 179, 180};
  for (int i = 0; i < 7; ++i) {
    shape ball = sphere_at(0, 0, 5, 1, 0);
    stage s;
    stage_open(&s, &ball, 1, spot_at(0, 0, 0, 0, 0, 1, degrees[i]), WORDS("resolution 64"));
    double centre = light_of(&s, in_air(0, 0, 9), 0);
    if (i > 0) assert_true(centre == 0);
    assert_true(light_of(&s, in_air(0, 0, 3), 0) == 1 && light_of(&s, in_air(0, 0, -3), 0) == 1);
    assert_true(light_of(&s, in_air(0, 0, 0), 0) == 1);
    stage_close(&s);
  }
}

static void statistics_add_up(void **state) {
  (void)state;
  shape all[] = {sphere_at(0, 0, 5, 1, 0), sheet_at(7, 1, 0.5, 0.6, 0.7)};
  stage s;
  stage_open(&s, all, 2, parallel_at(0, 0, 1, 0, 0, 1), WORDS("resolution 50", "samples 4"));
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(s.map, &got);
  assert_true(got.faces == 1 && got.tiles == 16 + 4 + 5 && got.tiles_baked == 0 && got.pixels == 2500 && got.pixels_baked == 0);
  assert_true(fabs(got.near_depth - 3) < 1e-8 && fabs(got.far_depth - 6) < 1e-8);
  uint64_t empty = got.bytes;
  for (double x = -1.01; x < 1.02; x += 0.02)
    for (double y = -1.01; y < 1.02; y += 0.02) light_of(&s, in_air(x, y, 9), 0);
  dsm_api.statistics(s.map, &got);
  assert_true(got.tiles_baked == 16 && got.pixels_baked == 2500 && got.rays == 10000 && got.tiles_failed == 0);
  assert_true(got.pixels_coloured > 400 && got.pixels_coloured < 900 && got.pixels_marked == 0);
  assert_true(got.vertices > 4000 && got.vertices <= got.vertices_in && got.events > 10000);
  /* a step is two vertices, of 10 bytes where it is coloured */
  assert_true(got.bytes > empty + 20 * got.pixels_coloured && got.bake_seconds >= got.trace_seconds);
  assert_true(got.bytes_most == got.bytes && got.tiles_evicted == 0 && got.tiles_read == 0);
  /* a host that knows only the beginning gets only that */
  dsm_statistics part = {.size = 24};
  part.pixels = 12345;
  dsm_api.statistics(s.map, &part);
  assert_true(part.tiles == 25 && part.pixels == 12345 && part.size == 24);
  stage_close(&s);
}

/* The same look-ups, in an order that jumps about, with room for all tiles and for hardly one: the same bits. */
static void a_small_cache_gives_the_same_answers(void **state) {
  (void)state;
  enum { MOST = 500 };
  static double light[2][MOST];
  int points = UNLESS_SLOW(MOST, 100);
  shape all[] = {sphere_at(0, 0, 5, 1, 0), sheet_at(7, 1, 0.5, 0.6, 0.7), fog_in((dsm_box){{-1, -1, 3}, {1, 1, 4}}, 1, 2, 3, 0)};
  dsm_statistics got[2], empty = {.size = sizeof empty};
  for (int small = 0; small < 2; ++small) {
    stage s;
    stage_open(&s, all, 3, parallel_at(0, 0, 1, 0, 0, 1), WORDS("resolution 100", "samples 4", small ? "cache 0.05" : "cache 50"));
    dsm_api.statistics(s.map, &empty);
    rng r = rng_seeded(5);
    for (int i = 0; i < points; ++i) {
      dsm_receiver at = in_air(rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 3, 9));
      at.has_footprint = i % 10 == 0;
      at.footprint[0][0] = at.footprint[1][1] = rng_scale(&r, 0.01, 1);
      light[small][i] = light_of(&s, at, 1);
    }
    got[small].size = sizeof got[small];
    dsm_api.statistics(s.map, &got[small]);
    stage_close(&s);
  }
  assert_memory_equal(light[0], light[1], sizeof light[0]);
  assert_true(got[0].tiles_evicted == 0 && got[1].tiles_evicted > 100);
  assert_true(got[0].tiles_again == 0 && got[1].tiles_again > 100 && got[1].tiles_again <= got[1].tiles_evicted);
  assert_true(got[1].tiles_baked == got[0].tiles_baked && got[1].vertices == got[0].vertices);
  assert_true(got[1].pixels_baked == got[0].pixels_baked && got[1].rays > 3 * got[0].rays);
  uint64_t room = 0.05 * 1024 * 1024;
  assert_true(got[0].bytes_most - empty.bytes > 5 * room && got[1].bytes - empty.bytes <= 3 * room);   /* with what the last one held */
  assert_true(5 * (got[1].bytes_most - empty.bytes) < got[0].bytes_most - empty.bytes);   /* a dozen tiles at a time */
}

static void settings_and_light_are_copied(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  world w = {.shapes = &ball, .count = 1};
  dsm_light light = parallel_at(0, 0, 0, 0, 0, 2);   /* direction is made unit length */
  dsm_box box = ball.box;
  light.casters = &box;
  light.caster_count = 1;
  dsm_host host = host_of(&w);
  dsm_settings *settings = settings_of(WORDS("resolution 32"));
  dsm_map *map;
  assert_int_equal(dsm_api.map_create(&host, &light, settings, &map), DSM_OK);
  dsm_api.settings_destroy(settings);
  memset(&light, 0, sizeof light);
  memset(&box, 0, sizeof box);
  memset(&host, 0, sizeof host);
  dsm_worker *worker;
  double rgb[3];
  dsm_receiver at = in_air(0, 0, 9);
  assert_int_equal(dsm_api.worker_create(map, &w, &worker), DSM_OK);
  assert_int_equal(dsm_api.lookup(worker, &at, rgb), DSM_OK);
  assert_true(rgb[0] == 0);
  dsm_api.worker_destroy(worker);
  dsm_api.map_destroy(map);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(bad_lights_are_refused_with_a_sentence),
    cmocka_unit_test(every_bound_of_a_box_is_looked_at),
    cmocka_unit_test(hosts_without_report_or_room),
    cmocka_unit_test(nothing_to_destroy),
    cmocka_unit_test(no_casters_all_lit),
    cmocka_unit_test(odd_cones),
    cmocka_unit_test(statistics_add_up),
    cmocka_unit_test(a_small_cache_gives_the_same_answers),
    cmocka_unit_test(settings_and_light_are_copied),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
