/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>

#include "map/lookup.h"

enum { SIDE = 4, THREADS = 4 };   /* tiles across and up */

typedef struct { atomic_int made[SIDE * SIDE], destroyed, reports; } tallies;

/* Counts instead of baking. `inside`, if set, is called from within `make`. */
typedef struct counter {
  tile_maker base;
  tallies *sum;
  dsm_result answer;
  void (*inside)(struct counter *maker, const tile_key *key);
  dsm_worker *worker, *other;
} counter;

static dsm_result count_and_make(tile_maker *base, const tile_key *key, const tile **out, tile_tally *tally) {
  counter *maker = (counter *)(void *)base;
  const tile_key *claimed = &maker->worker->claim.key;
  if (tally->rays || claimed->x != key->x || claimed->y != key->y)
    return DSM_INVALID;   /* cmocka asserts in the main thread only */
  atomic_fetch_add(&maker->sum->made[key->y * SIDE + key->x], 1);
  if (maker->inside) maker->inside(maker, key);
  tally->rays = 10;
  if (maker->answer != DSM_OK) return maker->answer;
  *out = (key->x + key->y) % 2 ? tile_create(key->x) : &tile_lit;
  return DSM_OK;
}

static void count_destroyed(tile_maker *base) {
  atomic_fetch_add(&((counter *)(void *)base)->sum->destroyed, 1);
}

static dsm_result no_rays(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  (void)data, (void)rays, (void)count, (void)tolerance, (void)sink;
  return DSM_INVALID;
}

static int32_t give_up(void *data) { return data && ++*(int *)data == 2; }

static void count_reports(void *data, int32_t severity, const char *sentence) {
  int known = severity == 1 && strstr(sentence, "could not be baked");
  atomic_fetch_add(&((tallies *)data)->reports, known ? 1 : 1000);
}

static dsm_map *open_map(tallies *sum) {
  memset(sum, 0, sizeof *sum);
  dsm_host host = {.size = sizeof host, .data = sum, .trace = no_rays, .pause = give_up,
                   .report = count_reports};
  dsm_box box = {{-1, -1, 4}, {1, 1, 6}};
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_PARALLEL, .direction = {0, 0, 1},
                     .casters = &box, .caster_count = 1};
  dsm_settings settings;
  settings_defaults(&settings);
  settings.resolution[0] = settings.resolution[1] = SIDE * TILE_SIDE;
  dsm_map *map;
  assert_int_equal(map_create(&host, &light, &settings, &map), DSM_OK);
  assert_true(map->store.grids[0].across == SIDE && map->store.grids[0].up == SIDE);
  return map;
}

static void open_worker(dsm_map *map, void *host_data, counter *maker, tallies *sum) {
  *maker = (counter){.base = {count_and_make, count_destroyed}, .sum = sum};
  assert_int_equal(worker_create(map, host_data, &maker->base, &maker->worker), DSM_OK);
}

static dsm_statistics close_all(dsm_map *map, counter *makers, int count) {
  dsm_statistics s = {.size = sizeof s};
  map_statistics(map, &s);
  for (int i = 0; i < count; ++i) {
    worker_destroy(makers[i].worker);
    assert_int_equal(makers[i].sum->destroyed, i + 1);
  }
  worker_destroy(NULL);
  map_destroy(map);
  return s;
}

static void *need_all(void *data) {
  const counter *maker = data;
  for (uint32_t n = 0; n < 3 * SIDE * SIDE; ++n) {
    tile_key key = {0, 0, n % SIDE, n / SIDE % SIDE};
    const tile *got, *again;
    if (worker_tile(maker->worker, &key, &got) != DSM_OK
        || worker_need_tile(maker->worker, &key, &again) != DSM_OK || got != again
        || got->kind != ((key.x + key.y) % 2 ? TILE_STORED : TILE_LIT))
      return data;
  }
  return NULL;
}

/* However often and from however many threads. */
static void a_tile_is_made_once(void **state) {
  (void)state;
  for (int threads = 1; threads <= THREADS; threads += THREADS - 1) {
    tallies sum;
    dsm_map *map = open_map(&sum);
    counter makers[THREADS];
    pthread_t ids[THREADS];
    for (int i = 0; i < threads; ++i) open_worker(map, NULL, &makers[i], &sum);
    for (int i = 0; i < threads; ++i) assert_int_equal(pthread_create(&ids[i], NULL, need_all, &makers[i]), 0);
    for (int i = 0; i < threads; ++i) {
      void *failed;
      pthread_join(ids[i], &failed);
      assert_null(failed);
    }
    for (int i = 0; i < SIDE * SIDE; ++i) assert_int_equal(sum.made[i], 1);
    dsm_statistics s = close_all(map, makers, threads);
    assert_true(s.tiles == SIDE * SIDE && s.tiles_baked == s.tiles && s.tiles_failed == 0);
    assert_int_equal(s.rays, 10 * s.tiles);
    assert_int_equal(sum.reports, 0);
  }
}

/* A cancelled tile is absent again, counts for nothing, and is made by whoever needs it next. */
static void cancelled(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum);
  counter maker;
  open_worker(map, NULL, &maker, &sum);
  tile_key key = {0, 0, 2, 1};
  const tile *got = &tile_lit;
  maker.answer = DSM_CANCELLED;
  for (int k = 1; k <= 2; ++k) {
    assert_int_equal(worker_tile(maker.worker, &key, &got), DSM_CANCELLED);
    assert_null(got);
    assert_null(tile_store_peek(&map->store, &key));
    assert_null(map->store.claims);
    assert_int_equal(sum.made[1 * SIDE + 2], k);
  }
  maker.answer = DSM_OK;
  assert_int_equal(worker_tile(maker.worker, &key, &got), DSM_OK);
  assert_true(got->kind == TILE_STORED && got->floats == 2);
  dsm_statistics s = close_all(map, &maker, 1);
  assert_true(s.tiles_baked == 1 && s.tiles_failed == 0 && s.rays == 10 && sum.reports == 0);
}

/* A tile that fails, fails once: it is kept as such, look-ups trace, and the user is told of the first. */
static void no_memory(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum);
  counter maker;
  open_worker(map, NULL, &maker, &sum);
  maker.answer = DSM_NO_MEMORY;
  const tile *got;
  for (uint32_t n = 0; n < 6; ++n) {
    tile_key key = {0, 0, n % 2, 0};
    assert_int_equal(worker_tile(maker.worker, &key, &got), DSM_OK);
    assert_ptr_equal(got, &tile_failed);
  }
  assert_true(sum.made[0] == 1 && sum.made[1] == 1);
  dsm_receiver at = {.point = {-0.9, -0.9, 7}};
  double rgb[3] = {7, 7, 7};
  assert_int_equal(map_lookup(maker.worker, &at, rgb), DSM_TRACE);
  assert_true(rgb[0] == 7);
  dsm_statistics s = close_all(map, &maker, 1);
  assert_true(s.tiles_failed == 2 && s.tiles_baked == 0 && sum.reports == 1);
}

/* A host whose trace looks up again: the same worker says trace, at the tile it bakes and at another absent
 * one; a second worker waits for the tile until its host gives up. */
static void look_up_inside(counter *maker, const tile_key *key) {
  maker->inside = NULL;
  double rgb[3] = {7, 7, 7};
  for (int k = 0; k < 2; ++k) {
    dsm_receiver at = {.point = {k ? 0.6 : -0.9, k ? 0.6 : -0.9, 7}};
    assert_int_equal(map_lookup(maker->worker, &at, rgb), DSM_TRACE);
  }
  assert_true(rgb[0] == 7);
  const tile *got = &tile_lit;
  assert_int_equal(worker_need_tile(maker->worker, key, &got), DSM_TRACE);
  assert_null(got);
  got = &tile_lit;
  assert_int_equal(worker_need_tile(maker->other, key, &got), DSM_CANCELLED);
  assert_null(got);
}

static void look_ups_from_within_a_bake(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum);
  counter makers[2];
  int asked[2] = {0, 0};
  for (int i = 0; i < 2; ++i) open_worker(map, &asked[i], &makers[i], &sum);
  makers[0].inside = look_up_inside;
  makers[0].other = makers[1].worker;
  dsm_receiver at = {.point = {-0.9, -0.9, 7}};
  double rgb[3];
  assert_int_equal(map_lookup(makers[0].worker, &at, rgb), DSM_OK);
  assert_true(rgb[0] == 1 && !makers[0].inside);
  assert_true(asked[0] == 0 && asked[1] == 2);   /* it is the waiter's own host data that is asked */
  for (int i = 1; i < SIDE * SIDE; ++i) assert_int_equal(sum.made[i], 0);
  at.point[0] = at.point[1] = 0.6;   /* the worker bakes again afterwards */
  assert_int_equal(map_lookup(makers[0].worker, &at, rgb), DSM_OK);
  dsm_statistics s = close_all(map, makers, 2);
  assert_true(s.tiles_baked == 2 && s.tiles_failed == 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_tile_is_made_once),
    cmocka_unit_test(cancelled),
    cmocka_unit_test(no_memory),
    cmocka_unit_test(look_ups_from_within_a_bake),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
