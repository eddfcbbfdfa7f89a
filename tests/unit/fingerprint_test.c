/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "map/worker.h"
#include "store/fingerprint.h"

/* A host that keeps the rays that it is asked for. */
typedef struct {
  world w;   /* first: trace_world is handed this */
  dsm_ray rays[3000];
  uint32_t count;
  int backwards, looked_up;
  dsm_worker *worker;
} keeping;

static dsm_result keep_and_trace(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  keeping *k = data;
  for (uint32_t i = 0; i < count && k->count < 3000; ++i) k->rays[k->count++] = rays[i];
  double rgb[3];
  dsm_receiver receiver = in_air(0.2, 0.3, 6);
  k->looked_up += dsm_api.lookup(k->worker, &receiver, rgb) == DSM_TRACE;
  if (!k->backwards) return trace_world(data, rays, count, tolerance, sink);
  shape turned[10];   /* the same events in another order */
  world w = k->w;
  for (int i = 0; i < w.count; ++i) turned[i] = w.shapes[w.count - 1 - i];
  w.shapes = turned;
  return trace_world(&w, rays, count, tolerance, sink);
}

static dsm_map *open_map(keeping *k, const shape *shapes, int count, dsm_light light, const char *const *words) {
  memset(k, 0, sizeof *k);
  k->w.shapes = shapes;
  k->w.count = count;
  dsm_map *map = map_of(&k->w, light, words);
  map->host.trace = keep_and_trace;
  assert_int_equal(dsm_api.worker_create(map, k, &k->worker), DSM_OK);
  return map;
}

static scene_print print_of(keeping *k) {
  scene_print print;
  char text[MAP_REASON_SIZE];
  map_reason why = {text, sizeof text};
  if (fingerprint_take(k->worker, &print, &why) != DSM_OK) fail_msg("%s", text);
  return print;
}

static scene_print print_scene(const shape *shapes, int count, dsm_light light, int backwards, const char *const *words) {
  keeping k;
  dsm_map *map = open_map(&k, shapes, count, light, words);
  k.backwards = backwards;
  scene_print print = print_of(&k);
  assert_int_equal(k.count, 1024);
  assert_true(k.looked_up > 0);   /* a look-up meanwhile is told to trace */
  dsm_api.worker_destroy(k.worker);
  map_close(&k.w, map);
  return print;
}

static int same_prints(scene_print a, scene_print b) {
  return strcmp(a.casters, b.casters) == 0 && strcmp(a.probes, b.probes) == 0;
}

enum { SHAPES = 5 };
static shape scene[SHAPES];

static void set_scene(void) {
  scene[0] = sphere_at(0, 0, 5, 1, 0.5);
  scene[1] = sphere_at(0.5, 0.5, 5.5, 1, 0);
  scene[2] = fog_in((dsm_box){{-1, -1, 4}, {1, 1, 6}}, 0.5, 0.4, 0.3, 0.2);
  scene[3] = sheet_at(7, 2, 0.9, 0.8, 0.7);
  scene[4] = sheet_at(7, 2, 0.5, 0.6, 0.7);   /* at the same depth */
}

static void the_same_scene_has_the_same_print(void **state) {
  (void)state;
  set_scene();
  dsm_light lights[] = {spot_at(0, 0, 0, 0, 0, 1, 40), point_at(0, 0, 5), parallel_at(0, 0, 0, 0, 0, 1)};
  for (int i = 0; i < 3; ++i) {
    scene_print a = print_scene(scene, SHAPES, lights[i], 0, NULL);
    assert_true(same_prints(a, print_scene(scene, SHAPES, lights[i], 0, NULL)));
    assert_true(same_prints(a, print_scene(scene, SHAPES, lights[i], 1, NULL)));   /* the host's order does not matter */
    assert_int_equal(strlen(a.casters), DIGEST_CHARS - 1);
    assert_int_equal(strlen(a.probes), DIGEST_CHARS - 1);
  }
}

static void changes_show(void **state) {
  (void)state;
  set_scene();
  dsm_light light = spot_at(0, 0, 0, 0, 0, 1, 40);
  scene_print a = print_scene(scene, SHAPES, light, 0, NULL), b;
  scene[1].box.low[0] -= 1e-3;
  b = print_scene(scene, SHAPES, light, 0, NULL);
  assert_true(strcmp(a.casters, b.casters) != 0);
  set_scene();
  scene[0].pass[2] += 1e-4;
  b = print_scene(scene, SHAPES, light, 0, NULL);
  assert_true(strcmp(a.casters, b.casters) == 0 && strcmp(a.probes, b.probes) != 0);
  set_scene();
  scene[2].density[1] *= 1.001;
  b = print_scene(scene, SHAPES, light, 0, NULL);
  assert_true(strcmp(a.casters, b.casters) == 0 && strcmp(a.probes, b.probes) != 0);
}

/* Rounding of the host's does not: 1e-6 of a ray's range of depths is a thousand times more. */
static void rounding_does_not_show(void **state) {
  (void)state;
  dsm_light light = parallel_at(0, 0, 0, 0, 0, 1);
  shape one[2] = {sheet_at(5, 2, 0.25, 0.25, 0.25), sheet_at(9, 2, 0, 0, 0)};
  scene_print a = print_scene(one, 2, light, 0, NULL);
  one[0].pass[1] += 1e-9;
  scene_print b = print_scene(one, 2, light, 0, NULL);
  assert_true(strcmp(a.probes, b.probes) == 0);
  one[0].pass[1] += 2e-6;
  b = print_scene(one, 2, light, 0, NULL);
  assert_true(strcmp(a.probes, b.probes) != 0);
}

/* Every cell of a 16 x 16 grid over the face has two to six of the 1,024 rays. */
static void probes_are_everywhere(void **state) {
  (void)state;
  set_scene();
  keeping k;
  dsm_map *map = open_map(&k, scene, SHAPES, parallel_at(0, 0, 0, 0, 0, 1), NULL);
  print_of(&k);
  int cells[16][16] = {{0}};
  for (uint32_t i = 0; i < k.count; ++i) {
    double past[3];
    for (int c = 0; c < 3; ++c) past[c] = k.rays[i].origin[c] + k.rays[i].direction[c] * k.rays[i].far_depth;
    projected hit[3];
    assert_int_equal(projection_find(&map->projection, past, 0.5, hit), 1);
    const face *f = &map->projection.faces[0];
    int x = (int)(hit[0].x / f->width * 16), y = (int)(hit[0].y / f->height * 16);
    assert_true(x >= 0 && x < 16 && y >= 0 && y < 16);
    ++cells[y][x];
  }
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) assert_in_range(cells[y][x], 2, 6);
  dsm_api.worker_destroy(k.worker);
  map_close(&k.w, map);
}

static void nothing_has_a_print(void **state) {
  (void)state;
  keeping k;
  dsm_map *map = open_map(&k, NULL, 0, spot_at(0, 0, 0, 0, 0, 1, 40), NULL);
  scene_print print = print_of(&k);
  assert_int_equal(k.count, 0);
  assert_string_equal(print.casters, print.probes);
  dsm_api.worker_destroy(k.worker);
  map_close(&k.w, map);
}

static void what_the_host_returns_is_passed_on(void **state) {
  (void)state;
  set_scene();
  keeping k;
  dsm_map *map = open_map(&k, scene, SHAPES, spot_at(0, 0, 0, 0, 0, 1, 40), NULL);
  scene_print print;
  char text[MAP_REASON_SIZE];
  map_reason why = {text, sizeof text};
  k.w.fail_with = DSM_NO_MEMORY;
  assert_int_equal(fingerprint_take(k.worker, &print, &why), DSM_NO_MEMORY);
  k.w.fail_with = DSM_CANCELLED;
  assert_int_equal(fingerprint_take(k.worker, &print, &why), DSM_CANCELLED);
  k.w.fail_with = DSM_OK;
  k.w.stop = 1;
  assert_int_equal(fingerprint_take(k.worker, &print, &why), DSM_CANCELLED);
  k.w.stop = 0;
  assert_int_equal(fingerprint_take(k.worker, &print, &why), DSM_OK);
  dsm_api.worker_destroy(k.worker);
  map_close(&k.w, map);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_same_scene_has_the_same_print),
    cmocka_unit_test(changes_show),
    cmocka_unit_test(rounding_does_not_show),
    cmocka_unit_test(probes_are_everywhere),
    cmocka_unit_test(nothing_has_a_print),
    cmocka_unit_test(what_the_host_returns_is_passed_on),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
