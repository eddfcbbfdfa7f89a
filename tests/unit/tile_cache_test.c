/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdatomic.h>
#include <string.h>

/* A reader's two steps are nanoseconds apart. Here it stumbles between them now and then, so that eviction has the time to
 * come in between. */
static void stumble(void) {
  static _Thread_local uint32_t steps;
  if (++steps % 4) return;
  for (volatile int i = 0; i < 300; ++i) {}
}
#undef atomic_store
#define atomic_store(where, what) (stumble(), atomic_store_explicit(where, what, memory_order_seq_cst))

#include "map/tile_store.h"
#include "plain_tile.h"
#include "random.h"

static const tile_plan ONE_VERTEX = {.count = {1}};

static tile *small_tile(uint64_t number) {
  tile *t = tile_create(&ONE_VERTEX);
  if (t) t->near_depth = (double)number;
  return t;
}

static uint64_t small_size(void) {
  tile *t = small_tile(0);
  uint64_t size = t->size;
  tile_destroy(t);
  return size;
}

static int is_there(const tile_cache *cache, uint64_t number) { return atomic_load(&cache->slots[number]) != NULL; }

/* Puts a tile that nobody needs any more. */
static void put(tile_cache *cache, uint64_t number, tile_holder *holder) {
  tile_cache_put(cache, number, small_tile(number), holder);
  tile_holder_release(holder, 0);
}

static int use(tile_cache *cache, uint64_t number, tile_holder *holder) {
  const tile *t = tile_cache_hold(&cache->slots[number], holder);
  tile_holder_release(holder, 0);
  return t != NULL;
}

static void the_unused_go_first(void **state) {
  (void)state;
  tile_cache cache;
  tile_holder holder;
  uint64_t size = small_size();
  assert_int_equal(tile_cache_create(&cache, 12, 4 * size), DSM_OK);
  assert_int_equal(tile_cache_join(&cache, &holder), DSM_OK);
  for (uint64_t i = 0; i < 4; ++i) put(&cache, i, &holder);
  assert_true(cache.bytes == 4 * size && cache.evicted == 0);
  put(&cache, 4, &holder);   /* all have been used: each is passed once, then the first one goes */
  assert_true(!is_there(&cache, 0) && cache.evicted == 1 && cache.bytes == 4 * size);
  assert_true(use(&cache, 1, &holder) && use(&cache, 3, &holder) && use(&cache, 4, &holder));
  put(&cache, 5, &holder);
  assert_false(is_there(&cache, 2));
  assert_true(is_there(&cache, 1) && is_there(&cache, 3) && is_there(&cache, 4) && is_there(&cache, 5));
  put(&cache, 6, &holder);   /* the hand goes on from behind 2: used 3, 4 and 5 are passed, 1 is passed, 3 goes */
  assert_int_equal(cache.evicted, 3);
  assert_true(is_there(&cache, 6) && cache.bytes == 4 * size && cache.bytes_most == 4 * size);
  for (uint64_t i = 0; i < 12; ++i) assert_int_equal(tile_cache_was_made(&cache, i), i < 7);
  assert_false(use(&cache, 0, &holder));
  put(&cache, 0, &holder);   /* made again */
  assert_true(use(&cache, 0, &holder));
  tile_cache_leave(&cache, &holder);
  tile_cache_destroy(&cache);
}

/* Whoever remembers something of a tile by its serial cannot take another tile for it, not even where numbers begin again. */
static void no_two_blocks_have_one_serial(void **state) {
  (void)state;
  enum { TIMES = 9 };
  tile_cache cache;
  tile_holder holder;
  uint32_t seen[TIMES];
  assert_int_equal(tile_cache_create(&cache, 2, 1), DSM_OK);
  assert_int_equal(tile_cache_join(&cache, &holder), DSM_OK);
  cache.serial = UINT32_MAX - 3;
  for (uint64_t i = 0; i < TIMES; ++i) {
    put(&cache, i % 2, &holder);   /* and the other one goes */
    seen[i] = atomic_load(&cache.slots[i % 2])->serial;
    assert_true(seen[i] != 0);
    for (uint64_t k = 0; k < i; ++k) assert_true(seen[k] != seen[i]);
  }
  tile_cache_leave(&cache, &holder);
  tile_cache_destroy(&cache);
}

/* Tiles in use are never freed, not even where they alone exceed the budget; neither is the one just put in. */
static void held_ones_stay(void **state) {
  (void)state;
  enum { HELD = 40 };
  tile_cache cache;
  tile_holder maker, reader;
  uint64_t size = small_size();
  assert_int_equal(tile_cache_create(&cache, HELD + 1, 1), DSM_OK);
  assert_int_equal(tile_cache_join(&cache, &maker), DSM_OK);
  assert_int_equal(tile_cache_join(&cache, &reader), DSM_OK);
  const tile *held[HELD];
  for (uint64_t i = 0; i < HELD; ++i) {
    put(&cache, i, &maker);
    assert_true(is_there(&cache, i));
    assert_int_equal(tile_holder_make_room(&reader), DSM_OK);   /* more than there are places at first */
    held[i] = tile_cache_hold(&cache.slots[i], &reader);
    assert_non_null(held[i]);
    assert_int_equal(cache.bytes, (i + 1) * size);
  }
  for (uint64_t i = 0; i < HELD; ++i) assert_true(is_there(&cache, i) && held[i]->near_depth == (double)i);
  tile_holder_release(&reader, 3);
  tile_holder_release(&maker, 0);
  tile_cache_put(&cache, HELD, small_tile(HELD), &maker);
  for (uint64_t i = 0; i <= HELD; ++i) assert_int_equal(is_there(&cache, i), i < 3 || i == HELD);
  assert_true(cache.bytes == 4 * size && cache.bytes_most == HELD * size);
  tile_cache_leave(&cache, &maker);
  tile_cache_leave(&cache, &reader);
  tile_cache_destroy(&cache);
}

/* A place keeps its tile after the look-up, so that the next one that needs it finds it held. */
static void a_place_is_kept_until_it_is_needed(void **state) {
  (void)state;
  tile_cache cache;
  tile_holder maker, reader;
  assert_int_equal(tile_cache_create(&cache, 3, 1), DSM_OK);
  assert_int_equal(tile_cache_join(&cache, &maker), DSM_OK);
  assert_int_equal(tile_cache_join(&cache, &reader), DSM_OK);
  put(&cache, 0, &maker);
  const tile *t = tile_cache_hold(&cache.slots[0], &reader);
  reader.held = 0;
  put(&cache, 1, &maker);
  assert_true(is_there(&cache, 0));
  assert_ptr_equal(tile_cache_hold(&cache.slots[0], &reader), t);
  reader.held = 0;
  assert_non_null(tile_cache_hold(&cache.slots[1], &reader));   /* takes the place */
  put(&cache, 2, &maker);
  assert_true(!is_there(&cache, 0) && is_there(&cache, 1));
  tile_cache_leave(&cache, &maker);
  tile_cache_leave(&cache, &reader);
  tile_cache_destroy(&cache);
}

static void tiles_without_pixels_cost_nothing(void **state) {
  (void)state;
  tile_cache cache;
  tile_holder holder;
  assert_int_equal(tile_cache_create(&cache, 30, small_size()), DSM_OK);
  assert_int_equal(tile_cache_join(&cache, &holder), DSM_OK);
  for (uint64_t i = 0; i < 28; ++i) {
    tile_cache_put(&cache, i, i % 2 ? &tile_lit : &tile_failed, &holder);
    tile_holder_release(&holder, 0);
  }
  for (uint64_t i = 28; i < 30; ++i) put(&cache, i, &holder);
  for (uint64_t i = 0; i < 30; ++i) assert_int_equal(is_there(&cache, i), i != 28);
  assert_true(cache.evicted == 1 && cache.bytes == small_size());
  tile_cache_leave(&cache, &holder);
  tile_cache_destroy(&cache);
}

/* ---- One thread that reads against one that evicts, as closely as can be ------------------------------------------ */

enum { ROUNDS = 300000 };

typedef struct { tile_cache *cache; tile_holder *holder; atomic_int stop; int wrong; uint64_t seen; } rival;

static void *read_in_turns(void *data) {
  rival *me = data;
  while (!atomic_load_explicit(&me->stop, memory_order_relaxed))
    for (uint64_t number = 0; number < 3; ++number) {
      const tile *t = tile_cache_hold(&me->cache->slots[number], me->holder);
      if (!t) continue;
      for (int k = 0; k < 20; ++k) me->wrong += *(const volatile double *)&t->near_depth != (double)number;
      me->holder->held = 0;
      ++me->seen;
    }
  return NULL;
}

/* There is room for one tile of three. Memory of a tile that is freed is used again at once, for another one. */
static void reading_and_evicting_at_a_time(void **state) {
  (void)state;
  tile_cache cache;
  tile_holder maker, reader;
  assert_int_equal(tile_cache_create(&cache, 3, 1), DSM_OK);
  assert_int_equal(tile_cache_join(&cache, &maker), DSM_OK);
  assert_int_equal(tile_cache_join(&cache, &reader), DSM_OK);
  rival r = {.cache = &cache, .holder = &reader};
  pthread_t id;
  assert_int_equal(pthread_create(&id, NULL, read_in_turns, &r), 0);
  for (int n = 0; n < ROUNDS; ++n)
    if (!is_there(&cache, n % 3)) put(&cache, n % 3, &maker);
  atomic_store(&r.stop, 1);
  pthread_join(id, NULL);
  assert_int_equal(r.wrong, 0);
  assert_true(cache.evicted > 0);
  tile_cache_leave(&cache, &maker);
  tile_cache_leave(&cache, &reader);
  tile_cache_destroy(&cache);
}

/* ---- Many threads, a small cache, and tiles that tell which they are ------------------------------------------ */

enum { THREADS = 8, SIDE = 12, TILES = SIDE * SIDE, AT_ONCE = 5, LOOK_UPS = 6000 };

static uint32_t vertices_of(uint32_t number) { return 20 + number * 37 % 200; }

static tile *telling_tile(uint32_t number) {
  tile_plan plan = {.count = {0}};
  for (int i = 0; i < 4; ++i) plan.count[i * 85] = vertices_of(number);
  tile *t = tile_create(&plan);
  if (!t) return NULL;
  t->near_depth = number;
  for (uint32_t i = 0; i < 4; ++i)
    for (uint32_t k = 0; k < vertices_of(number); ++k)
      tile_put(t, i * 85, k, 0, (float)(number + k), (uint16_t)(number * 3 + i + k));
  return t;
}

static int tells(const tile *t, uint32_t number) {
  if (t->near_depth != number) return 0;
  for (uint32_t i = 0; i < 4; ++i) {
    visibility v = tile_visibility(t, i * 85);
    if (v.count != vertices_of(number)) return 0;
    for (uint32_t k = 0; k < v.count; k += 7)
      if (visibility_depth(&v, k) != (float)(number + k) || visibility_stored(&v, k, 0) != (uint16_t)(number * 3 + i + k)) return 0;
  }
  return 1;
}

typedef struct { tile_store *store; uint64_t seed, made; const char *wrong; } reader;

/* As a worker does it. */
static const tile *get(reader *me, tile_holder *holder, uint32_t number) {
  tile_key key = {0, 0, number % SIDE, number / SIDE};
  const tile *t = tile_cache_hold(tile_store_slot(me->store, &key), holder);
  tile_claim claim;
  if (t || tile_store_claim(me->store, &key, &claim, holder, NULL, NULL, &t) != DSM_OK || t) return t;
  const tile_cache *cache = &me->store->cache;
  if (cache->spool && spool_read(cache->spool, number, &t) != DSM_OK) me->wrong = "the spool";
  if (!t) {
    t = telling_tile(number);
    ++me->made;
  }
  tile_store_publish(me->store, &claim, holder, t);
  return t;
}

static void *read_at_random(void *data) {
  reader *me = data;
  rng r = rng_seeded(me->seed);
  tile_holder holder;
  if (tile_store_join(me->store, &holder) != DSM_OK) return NULL;
  uint32_t near = rng_below(&r, TILES);
  for (int n = 0; n < LOOK_UPS; ++n) {
    uint32_t count = 1 + rng_below(&r, AT_ONCE), numbers[AT_ONCE];
    const tile *held[AT_ONCE];
    if (rng_below(&r, 10) == 0) near = rng_below(&r, TILES);
    for (uint32_t k = 0; k < count; ++k) {
      numbers[k] = (near + rng_below(&r, 6)) % TILES;
      held[k] = get(me, &holder, numbers[k]);
    }
    for (uint32_t k = 0; k < count; ++k)
      if (!held[k] || !tells(held[k], numbers[k])) me->wrong = "a tile";
    if (rng_below(&r, 2)) holder.held = 0;
    else tile_holder_release(&holder, 0);
  }
  tile_store_leave(me->store, &holder);
  return NULL;
}

static void read_with_threads(spool *s, uint64_t seed) {
  projection p;
  memset(&p, 0, sizeof p);
  p.count = 1;
  p.faces[0].width = p.faces[0].height = SIDE * TILE_SIDE;
  tile_store store;
  const uint64_t largest = 8000, budget = 10 * largest;
  assert_int_equal(tile_store_create(&store, &p, budget), DSM_OK);
  store.cache.spool = s;
  reader readers[THREADS];
  pthread_t ids[THREADS];
  uint64_t made = 0;
  for (uint64_t i = 0; i < THREADS; ++i) {
    readers[i] = (reader){.store = &store, .seed = seed + i};
    assert_int_equal(pthread_create(&ids[i], NULL, read_at_random, &readers[i]), 0);
  }
  for (int i = 0; i < THREADS; ++i) {
    pthread_join(ids[i], NULL);
    if (readers[i].wrong) fail_msg("seed %llu: %s is wrong", (unsigned long long)readers[i].seed, readers[i].wrong);
    made += readers[i].made;
  }
  uint64_t bytes = 0, there = 0;
  for (uint32_t i = 0; i < TILES; ++i) {
    const tile *t = atomic_load(&store.cache.slots[i]);
    if (!t) continue;
    assert_true(t->size <= largest && tells(t, i));
    bytes += t->size;
    ++there;
  }
  assert_int_equal(store.cache.bytes, bytes);
  assert_true(store.cache.evicted > 1000 && store.cache.bytes_most <= budget + THREADS * AT_ONCE * largest);
  if (s) assert_true(made <= TILES);   /* and none made twice */
  else assert_int_equal(made, there + store.cache.evicted);
  tile_store_destroy(&store);
}

static void many_threads(void **state) {
  (void)state;
  read_with_threads(NULL, 1);
}

static void many_threads_with_a_spool(void **state) {
  (void)state;
  spool *s;
  assert_int_equal(spool_create("/tmp/dsm-test", TILES * 2, &s), DSM_OK);
  read_with_threads(s, 100);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_unused_go_first),
    cmocka_unit_test(no_two_blocks_have_one_serial),
    cmocka_unit_test(held_ones_stay),
    cmocka_unit_test(a_place_is_kept_until_it_is_needed),
    cmocka_unit_test(tiles_without_pixels_cost_nothing),
    cmocka_unit_test(reading_and_evicting_at_a_time),
    cmocka_unit_test(many_threads),
    cmocka_unit_test(many_threads_with_a_spool),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
