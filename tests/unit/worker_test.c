/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include <signal.h>
#include <sys/resource.h>

#include "fake_maker.h"
#include "map/lookup.h"

enum { THREADS = 4 };

/* Outside of any look-up, what was got is another thread's to evict: for maps that hold all. */
static dsm_result get(dsm_worker *worker, const tile_key *key, const tile **out) {
  worker_enter(worker);
  dsm_result result = worker_tile(worker, key, out);
  worker_leave(worker);
  return result;
}

static void *need_all(void *data) {
  const fake_maker *maker = data;
  for (uint32_t n = 0; n < 3 * ALL; ++n) {
    tile_key key = tile_store_key(&maker->worker->map->store, n * 7 % ALL);
    const tile *got, *again;
    worker_enter(maker->worker);
    if (worker_tile(maker->worker, &key, &got) != DSM_OK
        || worker_need_tile(maker->worker, &key, &again) != DSM_OK || got != again
        || (key.level == 0 && got->kind != ((key.x + key.y) % 3 ? TILE_STORED : TILE_LIT)))
      return data;
    worker_leave(maker->worker);
  }
  return NULL;
}

/* However often, from however many threads, and whether for itself or for coarser tiles. */
static void a_tile_is_made_once(void **state) {
  (void)state;
  for (int threads = 1; threads <= THREADS; threads += THREADS - 1) {
    tallies sum;
    dsm_map *map = open_map(&sum, PLENTY);
    fake_maker makers[THREADS];
    pthread_t ids[THREADS];
    for (int i = 0; i < threads; ++i) open_worker(map, NULL, &makers[i], &sum);
    for (int i = 0; i < threads; ++i) assert_int_equal(pthread_create(&ids[i], NULL, need_all, &makers[i]), 0);
    for (int i = 0; i < threads; ++i) {
      void *failed;
      pthread_join(ids[i], &failed);
      assert_null(failed);
    }
    for (int i = 0; i < FINEST; ++i) assert_int_equal(sum.made[i], 1);
    dsm_statistics s = close_all(map, makers, threads);
    assert_true(s.tiles == ALL && s.tiles_baked == s.tiles && s.tiles_failed == 0 && s.tiles_evicted == 0);
    assert_int_equal(s.rays, 10 * FINEST);
    assert_true(sum.not_baked + sum.full + sum.other == 0);
  }
}

/* The whole map is one look-up away. */
static void a_coarse_tile_is_made_of_finer_ones(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, PLENTY);
  fake_maker maker;
  open_worker(map, NULL, &maker, &sum);
  tile_key corner = {0, 1, 1, 0}, top = tile_store_key(&map->store, ALL - 1);
  const tile *got;
  assert_int_equal(get(maker.worker, &corner, &got), DSM_OK);
  for (int i = 0; i < FINEST; ++i) assert_int_equal(sum.made[i], i % SIDE >= 2 && i / SIDE < 2);
  assert_int_equal(get(maker.worker, &top, &got), DSM_OK);
  assert_int_equal(got->kind, TILE_STORED);
  for (int i = 0; i < FINEST; ++i) assert_int_equal(sum.made[i], 1);
  assert_int_equal(maker.worker->depth, 0);
  assert_int_equal(maker.worker->holder.held, 0);
  assert_int_equal(close_all(map, &maker, 1).tiles_baked, ALL);
}

/* A cancelled tile is absent again, counts for nothing, and is made by whoever needs it next. */
static void cancelled(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, PLENTY);
  fake_maker maker;
  open_worker(map, NULL, &maker, &sum);
  tile_key key = {0, 0, 2, 0};
  const tile *got = &tile_lit;
  maker.answer = DSM_CANCELLED;
  for (int k = 1; k <= 2; ++k) {
    assert_int_equal(get(maker.worker, &key, &got), DSM_CANCELLED);
    assert_null(got);
    assert_null(tile_store_peek(&map->store, &key));
    assert_null(map->store.claims);
    assert_int_equal(sum.made[2], k);
  }
  maker.answer = DSM_OK;
  assert_int_equal(get(maker.worker, &key, &got), DSM_OK);
  tile *same = made_up_tile(&key);
  assert_true(got->kind == TILE_STORED && same_tile(got, same));
  tile_destroy(same);
  dsm_statistics s = close_all(map, &maker, 1);
  assert_true(s.tiles_baked == 1 && s.tiles_failed == 0 && s.rays == 10 && sum.not_baked == 0);
}

/* So are the coarser ones that were to be made of it; what is done stays done. */
static void cancelled_while_it_is_made_for_another(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, PLENTY);
  fake_maker maker;
  open_worker(map, NULL, &maker, &sum);
  maker.cancel_every = 3;
  tile_key top = tile_store_key(&map->store, ALL - 1);
  const tile *got;
  int tries = 1;
  for (; get(maker.worker, &top, &got) == DSM_CANCELLED; ++tries) {
    assert_null(got);
    assert_null(tile_store_peek(&map->store, &top));
    assert_null(map->store.claims);
    assert_int_equal(maker.worker->holder.held, 0);
  }
  assert_int_equal(tries, 1 + (FINEST - 1) / 2);   /* two tiles a try, and the third cancelled */
  assert_int_equal(got->kind, TILE_STORED);
  for (int i = 0; i < FINEST; ++i) assert_in_range(sum.made[i], 1, 2);
  dsm_statistics s = close_all(map, &maker, 1);
  assert_true(s.tiles_baked == ALL && s.rays == 10 * FINEST);
}

/* A tile that fails, fails once: it is kept as such, look-ups trace, and the user is told of the first. */
static void no_memory(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, PLENTY);
  fake_maker maker;
  open_worker(map, NULL, &maker, &sum);
  maker.answer = DSM_NO_MEMORY;
  const tile *got;
  for (uint32_t n = 0; n < 6; ++n) {
    tile_key key = {0, 0, n % 2, 0};
    assert_int_equal(get(maker.worker, &key, &got), DSM_OK);
    assert_ptr_equal(got, &tile_failed);
  }
  assert_true(sum.made[0] == 1 && sum.made[1] == 1);
  dsm_receiver at = {.point = {-0.9, -0.9, 7}};
  double rgb[3] = {7, 7, 7};
  assert_int_equal(map_lookup(maker.worker, &at, rgb), DSM_TRACE);
  assert_true(rgb[0] == 7);
  maker.answer = DSM_OK;
  tile_key coarser = {0, 1, 0, 0};   /* of which two parts are good */
  assert_int_equal(get(maker.worker, &coarser, &got), DSM_OK);
  assert_ptr_equal(got, &tile_failed);
  dsm_statistics s = close_all(map, &maker, 1);
  assert_true(s.tiles_failed == 3 && s.tiles_baked == 2 && sum.not_baked == 1);
}

/* A host whose trace looks up again: the same worker says trace, at the tile it bakes and at another absent
 * one, however often; a second worker waits for the tile until its host gives up. */
static void look_up_inside(fake_maker *maker, const tile_key *key) {
  maker->inside = NULL;
  double rgb[3] = {7, 7, 7};
  for (int k = 0; k < 1000; ++k) {
    dsm_receiver at = {.point = {k % 2 ? 0.6 : -0.9, k % 2 ? 0.6 : -0.9, 7}};
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
  dsm_map *map = open_map(&sum, PLENTY);
  fake_maker makers[2];
  int asked[2] = {0, 0};
  for (int i = 0; i < 2; ++i) open_worker(map, &asked[i], &makers[i], &sum);
  makers[0].inside = look_up_inside;
  makers[0].other = makers[1].worker;
  dsm_receiver at = {.point = {-0.9, -0.9, 7}};
  double rgb[3];
  assert_int_equal(map_lookup(makers[0].worker, &at, rgb), DSM_OK);
  assert_true(rgb[0] == 1 && !makers[0].inside);
  assert_true(asked[0] == 0 && asked[1] == 2);   /* it is the waiter's own host data that is asked */
  for (int i = 1; i < FINEST; ++i) assert_int_equal(sum.made[i], 0);
  at.point[0] = at.point[1] = 0.6;   /* the worker bakes again afterwards */
  assert_int_equal(map_lookup(makers[0].worker, &at, rgb), DSM_OK);
  dsm_statistics s = close_all(map, makers, 2);
  assert_true(s.tiles_baked == 2 && s.tiles_failed == 0);
}

/* Tiles that exist are answered from within a bake too, without end, and what the outer look-up holds stays held. */
static void look_up_the_known(fake_maker *maker, const tile_key *key) {
  (void)key;
  maker->inside = NULL;
  tile_key known = {0, 0, 2, 0}, others[2] = {{0, 0, 0, 1}, {0, 0, 1, 1}};
  const tile *got;
  for (int k = 0; k < 10000; ++k) {
    worker_enter(maker->worker);
    dsm_result result = worker_tile(maker->worker, &known, &got);
    worker_leave(maker->worker);
    assert_true(k > 10 ? result == DSM_OK || result == DSM_TRACE : result == DSM_OK);
  }
  for (int k = 0; k < 2; ++k) assert_int_equal(get(maker->other, &others[k], &got), DSM_OK);   /* evicts what is not held */
}

static void what_the_outer_look_up_holds(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, 1);
  fake_maker makers[2];
  for (int i = 0; i < 2; ++i) open_worker(map, NULL, &makers[i], &sum);
  tile_key key = {0, 0, 1, 0}, known = {0, 0, 2, 0}, next = {0, 0, 3, 1};
  const tile *first, *second, *third;
  worker_enter(makers[0].worker);
  assert_int_equal(worker_tile(makers[0].worker, &key, &first), DSM_OK);
  assert_int_equal(worker_tile(makers[0].worker, &known, &second), DSM_OK);
  makers[0].inside = look_up_the_known;
  makers[0].other = makers[1].worker;
  assert_int_equal(worker_tile(makers[0].worker, &next, &third), DSM_OK);
  assert_int_equal(makers[0].worker->holder.held, 3);
  assert_ptr_equal(tile_store_peek(&map->store, &key), first);
  assert_ptr_equal(tile_store_peek(&map->store, &known), second);
  worker_leave(makers[0].worker);
  assert_true(close_all(map, makers, 2).tiles_evicted > 0);
}

/* ---- Tiles that are not baked --------------------------------------------------------------------------------- */

/* A file that holds all tiles: of every level what chance makes of it, but the last is damaged. */
typedef struct { tile_source base; atomic_int reads; int closed; } fake_file;

static dsm_result read_made_up(tile_source *source, const tile_key *key, const tile **out) {
  fake_file *file = (fake_file *)(void *)source;
  atomic_fetch_add(&file->reads, 1);
  if (key->x == SIDE - 1) return key->y % 2 ? DSM_REFUSED : DSM_NO_MEMORY;
  *out = made_up_tile(key);
  return *out ? DSM_OK : DSM_NO_MEMORY;
}

static void close_file(tile_source *source) { ((fake_file *)(void *)source)->closed++; }

static void a_file_is_read_and_nothing_baked(void **state) {
  (void)state;
  tallies sum;
  for (int with_maker = 0; with_maker < 2; ++with_maker) {
    dsm_map *map = open_map(&sum, PLENTY);
    fake_maker maker = {.sum = &sum};
    fake_file file = {.base = {read_made_up, close_file}};
    map->source = &file.base;
    if (with_maker) open_worker(map, NULL, &maker, &sum);
    else assert_int_equal(worker_create(map, NULL, NULL, &maker.worker), DSM_OK);   /* as a tool does */
    for (int k = 0; k < 2; ++k)
      for (uint64_t n = ALL; n-- > 0;) {   /* the coarsest first: it is read, not made */
        tile_key key = tile_store_key(&map->store, n);
        const tile *got;
        assert_int_equal(get(maker.worker, &key, &got), DSM_OK);
        assert_int_equal(got->kind, key.x == SIDE - 1 ? TILE_FAILED : TILE_STORED);
      }
    assert_true(file.reads == ALL && file.closed == 0);
    for (int i = 0; i < FINEST; ++i) assert_int_equal(sum.made[i], 0);
    dsm_statistics s = {.size = sizeof s};
    map_statistics(map, &s);
    assert_true(s.tiles_read == ALL - SIDE && s.tiles_failed == SIDE && s.tiles_baked == 0);
    assert_true(sum.not_baked == 0 && sum.other == 0);   /* the source itself says what is wrong with it */
    worker_destroy(maker.worker);
    map_destroy(map);
    assert_int_equal(file.closed, 1);
  }
}

static void neither_file_nor_maker(void **state) {
  (void)state;
  tallies sum;
  dsm_map *map = open_map(&sum, PLENTY);
  dsm_worker *worker;
  assert_int_equal(worker_create(map, NULL, NULL, &worker), DSM_OK);
  tile_key key = {0, 1, 1, 1};
  const tile *got;
  assert_int_equal(get(worker, &key, &got), DSM_OK);
  assert_ptr_equal(got, &tile_failed);
  worker_destroy(worker);
  worker_destroy(NULL);
  map_destroy(map);
}

/* ---- A cache that holds next to nothing -------------------------------------------------------------------------- */

/* All tiles of a map without a limit, to compare with. */
static void keep_all(const tile *kept[ALL], dsm_map **map, fake_maker *maker, tallies *sum) {
  *map = open_map(sum, PLENTY);
  open_worker(*map, NULL, maker, sum);
  for (uint64_t n = 0; n < ALL; ++n) {
    tile_key key = tile_store_key(&(*map)->store, n);
    assert_int_equal(get(maker->worker, &key, &kept[n]), DSM_OK);
  }
}

typedef struct { fake_maker maker; const tile *const *kept; uint64_t seed; int wrong; } visitor;

static void *visit(void *data) {
  visitor *me = data;
  dsm_worker *worker = me->maker.worker;
  rng r = rng_seeded(me->seed);
  for (int n = 0; n < 150; ++n) {
    uint64_t numbers[3];
    const tile *got[3];
    worker_enter(worker);
    for (int k = 0; k < 3; ++k) {
      numbers[k] = rng_below(&r, ALL);
      tile_key key = tile_store_key(&worker->map->store, numbers[k]);
      me->wrong += worker_tile(worker, &key, &got[k]) != DSM_OK;
    }
    for (int k = 0; k < 3; ++k) me->wrong += !same_tile(got[k], me->kept[numbers[k]]);
    worker_leave(worker);
  }
  return NULL;
}

/* Whether they are made again or come from a temporary file, the bytes are the same. */
static void visit_with_threads(const tile *const *kept, double cache, int spooled) {
  tallies sum;
  dsm_map *map = open_map(&sum, cache);
  if (spooled) assert_int_equal(map_spool(map, "/tmp/dsm-test"), DSM_OK);
  visitor visitors[THREADS];
  pthread_t ids[THREADS];
  for (int i = 0; i < THREADS; ++i) {
    open_worker(map, NULL, &visitors[i].maker, &sum);
    visitors[i].kept = kept;
    visitors[i].seed = (uint64_t)(10 * spooled + i);
    visitors[i].wrong = 0;
    assert_int_equal(pthread_create(&ids[i], NULL, visit, &visitors[i]), 0);
  }
  for (int i = 0; i < THREADS; ++i) {
    pthread_join(ids[i], NULL);
    if (visitors[i].wrong) fail_msg("seed %llu: %d tiles wrong", (unsigned long long)visitors[i].seed, visitors[i].wrong);
  }
  int most = 0;
  for (int i = 0; i < FINEST; ++i) most = sum.made[i] > most ? sum.made[i] : most;
  dsm_statistics s = {.size = sizeof s};
  map_statistics(map, &s);
  assert_true(spooled ? most == 1 : most > 5);
  /* what is made again costs again, but is no more of the map */
  assert_true(s.tiles_evicted > ALL && s.tiles_baked <= ALL && s.pixels_baked <= FINEST * TILE_PIXELS);
  assert_true(spooled ? s.rays <= 10 * FINEST : s.rays > 10 * FINEST);
  for (int i = 0; i < THREADS; ++i) worker_destroy(visitors[i].maker.worker);
  map_destroy(map);
}

static void a_small_cache_changes_nothing(void **state) {
  (void)state;
  tallies sum;
  const tile *kept[ALL];
  dsm_map *all;
  fake_maker maker;
  keep_all(kept, &all, &maker, &sum);
  for (int spooled = 0; spooled < 2; ++spooled)
    for (double cache = 1; cache < 1e5; cache *= 400) visit_with_threads(kept, cache, spooled);
  close_all(all, &maker, 1);
}

/* Then tiles are made again; the user is told why that takes so long. */
static void a_full_disk(void **state) {
  (void)state;
  tallies sum, again;
  const tile *kept[ALL], *got;
  dsm_map *all, *map = open_map(&again, 1);
  fake_maker maker, other;
  keep_all(kept, &all, &maker, &sum);
  open_worker(map, NULL, &other, &again);
  assert_int_equal(map_spool(map, "/tmp/dsm-test"), DSM_OK);
  struct rlimit before, narrow;
  signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  narrow = (struct rlimit){3u * kept[1]->size, before.rlim_max};
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &narrow), 0);
  int wrong = 0;
  for (uint64_t n = 0; n < 3 * ALL; ++n) {
    tile_key key = tile_store_key(&map->store, n % ALL);
    worker_enter(other.worker);
    wrong += worker_tile(other.worker, &key, &got) != DSM_OK || !same_tile(got, kept[n % ALL]);
    worker_leave(other.worker);
  }
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  assert_int_equal(wrong, 0);
  assert_true(again.made[1] == 1 && again.made[FINEST - 2] > 1);
  assert_true(again.full == 1 && again.not_baked == 0 && again.other == 0);
  close_all(map, &other, 1);
  close_all(all, &maker, 1);
}

/* A coarse tile of many finer ones that do not all fit: what is held at a time is within the budget but for what one
 * thread's own work needs, four tiles a level. */
static void bytes_stay_within_the_budget(void **state) {
  (void)state;
  tallies sum;
  const tile *kept[ALL];
  dsm_map *all;
  fake_maker maker;
  keep_all(kept, &all, &maker, &sum);
  uint64_t largest = 0;
  for (int i = 0; i < ALL; ++i) largest = kept[i]->size > largest ? kept[i]->size : largest;
  for (uint64_t budget = 1; budget < 30 * largest; budget += 3 * largest) {
    tallies again;
    dsm_map *map = open_map(&again, (double)budget);
    dsm_statistics empty = {.size = sizeof empty};
    map_statistics(map, &empty);
    fake_maker other;
    open_worker(map, NULL, &other, &again);
    tile_key top = tile_store_key(&map->store, ALL - 1);
    const tile *got;
    worker_enter(other.worker);
    assert_int_equal(worker_tile(other.worker, &top, &got), DSM_OK);
    assert_true(same_tile(got, kept[ALL - 1]));
    worker_leave(other.worker);
    dsm_statistics s = close_all(map, &other, 1);
    uint64_t most = s.bytes_most - empty.bytes, needed = 2 * 4 * largest + 3 * largest;
    assert_true(most <= (budget > needed ? budget : needed));
    assert_true(s.bytes - empty.bytes <= (budget > largest ? budget : largest));
  }
  close_all(all, &maker, 1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_tile_is_made_once),
    cmocka_unit_test(a_coarse_tile_is_made_of_finer_ones),
    cmocka_unit_test(cancelled),
    cmocka_unit_test(cancelled_while_it_is_made_for_another),
    cmocka_unit_test(no_memory),
    cmocka_unit_test(look_ups_from_within_a_bake),
    cmocka_unit_test(what_the_outer_look_up_holds),
    cmocka_unit_test(a_file_is_read_and_nothing_baked),
    cmocka_unit_test(neither_file_nor_maker),
    cmocka_unit_test(a_small_cache_changes_nothing),
    cmocka_unit_test(a_full_disk),
    cmocka_unit_test(bytes_stay_within_the_budget),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
