/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Many threads bake one map on demand: the bytes do not depend on how many there are, on their order, or on stops. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <pthread.h>
#include <stdatomic.h>

#include "map/worker.h"
#include "oracle.h"

enum { SHAPES = 60, MOST_THREADS = 8 };

typedef struct {
  world w;              /* first: trace_world is handed this */
  rng random;
  int stops_often;
  dsm_map *map;
  uint64_t cancelled, odd_results;
} thread_host;

static shape scene[SHAPES];

static void make_scene(void) {
  rng r = rng_seeded(42);
  for (int i = 0; i < SHAPES - 1; ++i)
    scene[i] = sphere_at(rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 3, 5), 0.1, i % 3 ? 0 : 0.5);
  scene[SHAPES - 1] = fog_in((dsm_box){{-1, -1, 3}, {1, 1, 5}}, 0.3, 0.2, 0.1, 1);
}

static int32_t pause_sometimes(void *data) {
  thread_host *host = data;
  return host->stops_often && rng_below(&host->random, 400) == 0;
}

/* Every tile's middle, in an order of the thread's own, until each has been answered. */
static void *look_everywhere(void *data) {
  thread_host *host = data;
  dsm_worker *worker = NULL;
  if (dsm_api.worker_create(host->map, host, &worker) != DSM_OK) {
    ++host->odd_results;
    return NULL;
  }
  uint64_t count = host->map->store.tile_count;
  uint64_t *order = malloc(count * sizeof *order);
  for (uint64_t i = 0; i < count; ++i) {
    uint64_t k = rng_below(&host->random, (uint32_t)i + 1);
    order[i] = order[k];
    order[k] = i;
  }
  worker_enter(worker);
  for (uint64_t i = 0; i < count; ++i) {
    tile_key key = tile_store_key(&host->map->store, order[i]);
    const tile *got;
    dsm_result result;
    while ((result = worker_tile(worker, &key, &got)) == DSM_CANCELLED) ++host->cancelled;
    host->odd_results += result != DSM_OK || got->kind == TILE_FAILED;
  }
  worker_leave(worker);
  free(order);
  dsm_api.worker_destroy(worker);
  return NULL;
}

/* A smaller map where fewer cases are asked for. `together`: all threads in one order, so that they need the same tiles. */
static dsm_map *bake_with(int threads, int stops_often, int together, uint64_t seed) {
  char resolution[32];
  snprintf(resolution, sizeof resolution, "resolution %d", UNLESS_SLOW(150, 100));
  world w = {.shapes = scene, .count = SHAPES};
  dsm_box boxes[SHAPES];
  for (int i = 0; i < SHAPES; ++i) boxes[i] = scene[i].box;
  dsm_light light = spot_at(0, 0, 0, 0, 0, 1, 30);
  light.casters = boxes;
  light.caster_count = SHAPES;
  dsm_host host = host_of(&w);
  host.pause = pause_sometimes;
  dsm_settings *settings = settings_of(WORDS(resolution, "samples 9", "filter gaussian 2"));
  dsm_map *map = NULL;
  assert_int_equal(dsm_api.map_create(&host, &light, settings, &map), DSM_OK);
  dsm_api.settings_destroy(settings);
  thread_host hosts[MOST_THREADS];
  pthread_t ids[MOST_THREADS];
  uint64_t cancelled = 0;
  for (int i = 0; i < threads; ++i) {
    hosts[i] = (thread_host){.w = w, .random = rng_seeded(together ? seed : seed + (uint64_t)i), .stops_often = stops_often, .map = map};
    assert_int_equal(pthread_create(&ids[i], NULL, look_everywhere, &hosts[i]), 0);
  }
  for (int i = 0; i < threads; ++i) {
    pthread_join(ids[i], NULL);
    assert_int_equal(hosts[i].odd_results, 0);
    cancelled += hosts[i].cancelled;
  }
  if (stops_often) assert_true(cancelled > 0);
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(map, &got);
  assert_int_equal(got.tiles_baked, got.tiles);
  assert_int_equal(got.pixels_baked, got.pixels);
  assert_int_equal(got.rays, 9 * got.pixels);
  return map;
}

/* All but the mark that the cache keeps in a tile. */
static int same_tile_bytes(const tile *s, const tile *t) {
  return s->near_depth == t->near_depth && s->tolerance == t->tolerance
      && s->size == t->size && s->kind == t->kind && memcmp(s + 1, t + 1, s->size - sizeof *s) == 0;
}

static void same_bytes(const dsm_map *a, const dsm_map *b) {
  size_t stored = 0;
  assert_int_equal(a->store.tile_count, b->store.tile_count);
  for (uint64_t n = 0; n < a->store.tile_count; ++n) {
    tile_key key = tile_store_key(&a->store, n);
    const tile *s = tile_store_peek(&a->store, &key), *t = tile_store_peek(&b->store, &key);
    assert_non_null(s);
    assert_non_null(t);
    assert_true(same_tile_bytes(s, t));
    stored += s->kind == TILE_STORED;
  }
  assert_true(stored > 50);
}

static void any_number_of_threads(void **state) {
  (void)state;
  dsm_map *one = bake_with(1, 0, 0, 1);
  for (int threads = 2; threads <= MOST_THREADS; threads += threads < 4 ? 1 : 4) {
    for (int together = 0; together < 2; ++together) {
      dsm_map *many = bake_with(threads, 0, together, 100u * (uint64_t)threads);
      same_bytes(one, many);
      dsm_api.map_destroy(many);
    }
  }
  dsm_api.map_destroy(one);
}

static void stopped_and_resumed(void **state) {
  (void)state;
  dsm_map *one = bake_with(1, 0, 0, 1);
  for (int k = 0; k < 3; ++k) {
    dsm_map *many = bake_with(k ? 4 : 1, 1, k == 2, 7);
    same_bytes(one, many);
    dsm_api.map_destroy(many);
  }
  dsm_api.map_destroy(one);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(any_number_of_threads),
    cmocka_unit_test(stopped_and_resumed),
  };
  make_scene();
  return cmocka_run_group_tests(tests, NULL, NULL);
}
