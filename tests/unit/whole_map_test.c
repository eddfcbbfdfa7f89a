/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "fake_maker.h"
#include "map/whole_map.h"

enum { THREADS = 4 };

/* The share grows with each tile to 1; fine tiles weigh more, and come first. */
static void one_thread(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, PLENTY);
  fake_maker maker;
  open_worker(map, NULL, &maker, &sum);
  double last = 0, share = -1;
  for (uint64_t n = 0; n < ALL; ++n) {
    assert_int_equal(map_bake_next(maker.worker, &share), DSM_OK);
    assert_true(share > last && share <= 1);
    last = share;
    for (uint64_t k = 0; k < ALL; ++k) {
      tile_key key = tile_store_key(&map->store, k);
      assert_int_equal(tile_store_peek(&map->store, &key) != NULL, k <= n);
    }
    if (n == FINEST - 1) assert_true(share > 0.9 && share < 1);
  }
  assert_true(share == 1);
  for (int k = 0; k < 3; ++k) {
    share = -1;
    assert_int_equal(map_bake_next(maker.worker, &share), DSM_DONE);
    assert_true(share == 1);
  }
  assert_int_equal(maker.worker->depth, 0);
  dsm_statistics s = close_all(map, &maker, 1);
  assert_true(s.tiles_baked == ALL && s.rays == 10 * FINEST);
}

/* What look-ups have made is not taken. */
static void some_are_there(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, PLENTY);
  fake_maker maker;
  open_worker(map, NULL, &maker, &sum);
  tile_key corner = {0, 1, 1, 1};
  const tile *got;
  worker_enter(maker.worker);
  assert_int_equal(worker_tile(maker.worker, &corner, &got), DSM_OK);
  worker_leave(maker.worker);
  double share;
  int calls = 0;
  while (map_bake_next(maker.worker, &share) == DSM_OK) ++calls;
  assert_int_equal(calls, ALL - 5);
  assert_int_equal(close_all(map, &maker, 1).tiles_baked, ALL);
}

/* The next call takes it again. */
static void cancelled(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, PLENTY);
  fake_maker maker;
  open_worker(map, NULL, &maker, &sum);
  maker.cancel_every = 2;
  double share = 0;
  for (uint64_t n = 0; n < ALL; ++n) {
    dsm_result result = map_bake_next(maker.worker, &share);
    double before = share;
    if (result == DSM_CANCELLED) {
      result = map_bake_next(maker.worker, &share);
      assert_true(n == 0 || share > before);
    }
    assert_int_equal(result, DSM_OK);
    for (uint64_t k = 0; k < ALL; ++k) assert_int_equal(tile_cache_was_made(&map->store.cache, k), k <= n);
  }
  assert_int_equal(map_bake_next(maker.worker, &share), DSM_DONE);
  for (int i = 0; i < FINEST; ++i) assert_int_equal(sum.made[i], i == 0 ? 1 : 2);
  close_all(map, &maker, 1);
}

/* While one tile is being made, another thread takes the next. */
static void bake_another(fake_maker *maker, const tile_key *key) {
  maker->inside = NULL;
  double share;
  assert_true(key->x == 0 && key->y == 0);
  assert_int_equal(map_bake_next(maker->other, &share), DSM_OK);
  assert_true(maker->sum->made[0] == 1 && maker->sum->made[1] == 1);
}

static void nobody_waits(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, PLENTY);
  fake_maker makers[2];
  int asked = 0;
  open_worker(map, NULL, &makers[0], &sum);
  open_worker(map, &asked, &makers[1], &sum);
  makers[0].inside = bake_another;
  makers[0].other = makers[1].worker;
  double share;
  assert_int_equal(map_bake_next(makers[0].worker, &share), DSM_OK);
  assert_int_equal(asked, 0);
  assert_int_equal(close_all(map, makers, 2).tiles_baked, 2);
}

typedef struct { fake_maker maker; dsm_result end; int cancelled; } helper;

static void *bake_all(void *data) {
  helper *me = data;
  double share;
  while ((me->end = map_bake_next(me->maker.worker, &share)) == DSM_OK || me->end == DSM_CANCELLED)
    me->cancelled += me->end == DSM_CANCELLED;
  return NULL;
}

/* Also where tiles are cancelled now and then, and where the cache holds none: each is made once. */
static void threads_share_the_work(void **state) {
  (void)state;
  for (int how = 0; how < 4; ++how) {
    int cancels = how & 1, small = how >> 1;
    tallies sum;
    dsm_map *map = open_map(&sum, small ? 1 : PLENTY);
    assert_int_equal(map_spool(map, "/tmp/dsm-test"), DSM_OK);
    helper helpers[THREADS];
    fake_maker *makers[THREADS];
    pthread_t ids[THREADS];
    for (int i = 0; i < THREADS; ++i) {
      makers[i] = &helpers[i].maker;
      open_worker(map, NULL, makers[i], &sum);
      makers[i]->cancel_every = cancels ? 3 : 0;
      helpers[i].cancelled = 0;
      assert_int_equal(pthread_create(&ids[i], NULL, bake_all, &helpers[i]), 0);
    }
    int cancelled = 0;
    for (int i = 0; i < THREADS; ++i) {
      pthread_join(ids[i], NULL);
      assert_int_equal(helpers[i].end, DSM_DONE);
      cancelled += helpers[i].cancelled;
    }
    int made = 0;
    for (int i = 0; i < FINEST; ++i) made += sum.made[i];
    assert_int_equal(made, FINEST + cancelled);
    assert_true(!cancels == !cancelled);
    for (uint64_t n = 0; n < ALL; ++n) assert_true(tile_cache_was_made(&map->store.cache, n));
    dsm_statistics s = {.size = sizeof s};
    map_statistics(map, &s);
    assert_true(s.tiles_baked == ALL && s.pixels_baked == FINEST * TILE_PIXELS && s.rays == 10 * FINEST);
    for (int i = 0; i < THREADS; ++i) worker_destroy(makers[i]->worker);
    map_destroy(map);
  }
}

/* A map without casters has no tiles. */
static void nothing_to_do(void **state) {
  (void)state;
  dsm_host host = {.size = sizeof host, .trace = no_rays};
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_POINT};
  dsm_map *map;
  dsm_worker *worker;
  assert_int_equal(map_create(&host, &light, NULL, &map), DSM_OK);
  assert_int_equal(worker_create(map, NULL, NULL, &worker), DSM_OK);
  double share = -1;
  assert_int_equal(map_bake_next(worker, &share), DSM_DONE);
  assert_true(share == 1);
  worker_destroy(worker);
  map_destroy(map);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(one_thread),
    cmocka_unit_test(some_are_there),
    cmocka_unit_test(cancelled),
    cmocka_unit_test(nobody_waits),
    cmocka_unit_test(threads_share_the_work),
    cmocka_unit_test(nothing_to_do),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
