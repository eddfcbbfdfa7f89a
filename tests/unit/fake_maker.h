/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A map whose tiles are made up instead of baked, and counted. Include after cmocka.h. */
#ifndef TESTS_FAKE_MAKER_H
#define TESTS_FAKE_MAKER_H

#include <string.h>

#include "map/worker.h"
#include "plain_tile.h"
#include "random.h"

enum { SIDE = 4, FINEST = SIDE * SIDE, ALL = 16 + 4 + 1 + 4 };   /* tiles across and up; of level 0; of levels down to one pixel */

/* What all makers of a map have done together, and the sentences that the host was told. */
typedef struct {
  atomic_int made[FINEST], destroyed, not_baked, full, other;
} tallies;

typedef struct fake_maker {
  tile_maker base;
  tallies *sum;
  dsm_result answer;
  int calls, cancel_every;                                        /* 0: never */
  void (*inside)(struct fake_maker *maker, const tile_key *key);   /* called from within `make` */
  dsm_worker *worker, *other;
} fake_maker;

/* Chance decides, and only the key. Every third tile is lit. */
static inline tile *made_up_tile(const tile_key *key) {
  rng r = rng_seeded(1000 + key->y * SIDE + key->x);
  tile_plan plan = {.count = {0}};
  for (int i = 0; i < TILE_PIXELS; ++i) {
    plan.count[i] = 2 * rng_below(&r, 8);
    plan.coloured[i] = key->x == 1 && rng_below(&r, 4) == 0;
  }
  tile *t = tile_create(&plan);
  if (!t) return NULL;
  t->near_depth = rng_between(&r, 4, 5);
  t->tolerance = 0.01f;
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    uint32_t channels = plan.coloured[i] ? 3 : 1;
    double z = 0, value = 1;
    for (uint32_t k = 0; k < plan.count[i]; ++k) {
      for (uint32_t c = 0; c < channels; ++c) tile_put(t, i, k, c, (float)z, (uint16_t)(VALUE_STEPS * value / (1 + c)));
      if (k % 2 == 0) value *= rng_unit(&r);
      else z += 0.1 * rng_unit(&r);
    }
  }
  return t;
}

static inline int is_claimed_now(dsm_map *map, const tile_key *key) {
  int found = 0;
  pthread_mutex_lock(&map->store.mutex);
  for (const tile_claim *c = map->store.claims; c; c = c->next)
    found |= c->key.level == key->level && c->key.x == key->x && c->key.y == key->y;
  pthread_mutex_unlock(&map->store.mutex);
  return found;
}

static inline dsm_result make_up(tile_maker *base, const tile_key *key, const wanted_pixels *wanted, const tile **out, tile_tally *tally) {
  (void)wanted;
  fake_maker *maker = (fake_maker *)(void *)base;
  if (tally->rays || key->level || !is_claimed_now(maker->worker->map, key)) abort();
  atomic_fetch_add(&maker->sum->made[key->y * SIDE + key->x], 1);
  if (maker->inside) maker->inside(maker, key);
  tally->rays = 10;
  if (maker->cancel_every && ++maker->calls % maker->cancel_every == 0) return DSM_CANCELLED;
  if (maker->answer != DSM_OK) return maker->answer;
  tally->pixels = TILE_PIXELS;
  *out = (key->x + key->y) % 3 ? made_up_tile(key) : &tile_lit;
  return *out ? DSM_OK : DSM_NO_MEMORY;
}

static inline void count_destroyed(tile_maker *base) {
  atomic_fetch_add(&((fake_maker *)(void *)base)->sum->destroyed, 1);
}

static inline dsm_result no_rays(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  (void)data, (void)rays, (void)count, (void)tolerance, (void)sink;
  return DSM_INVALID;
}

/* The second time, of a worker that has a counter as its host data. */
static inline int32_t give_up(void *data) { return data && ++*(int *)data == 2; }

static inline void count_reports(void *data, int32_t severity, const char *sentence) {
  tallies *sum = data;
  atomic_int *which = severity != 1 ? &sum->other
                    : strstr(sentence, "could not be baked") ? &sum->not_baked
                    : strstr(sentence, "takes no more") ? &sum->full : &sum->other;
  atomic_fetch_add(which, 1);
}

/* SIDE x SIDE tiles, of which `cache` bytes are held. */
static inline dsm_map *open_map(tallies *sum, double cache) {
  memset(sum, 0, sizeof *sum);
  dsm_host host = {.size = sizeof host, .data = sum, .trace = no_rays, .pause = give_up, .report = count_reports};
  static const dsm_box box = {{-1, -1, 4}, {1, 1, 6}};
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_PARALLEL, .direction = {0, 0, 1},
                     .casters = &box, .caster_count = 1};
  dsm_settings settings;
  settings_defaults(&settings);
  settings.resolution[0] = settings.resolution[1] = SIDE * TILE_SIDE;
  settings.cache = cache / (1024 * 1024);
  dsm_map *map;
  assert_int_equal(map_create(&host, &light, &settings, &map), DSM_OK);
  assert_true(map->store.grids[0][0].across == SIDE && map->store.grids[0][0].up == SIDE);
  assert_int_equal(map->store.tile_count, ALL);
  return map;
}

#define PLENTY 1e9

static inline void open_worker(dsm_map *map, void *host_data, fake_maker *maker, tallies *sum) {
  *maker = (fake_maker){.base = {make_up, count_destroyed}, .sum = sum};
  assert_int_equal(worker_create(map, host_data, &maker->base, &maker->worker), DSM_OK);
}

static inline dsm_statistics close_all(dsm_map *map, fake_maker *makers, int count) {
  dsm_statistics s = {.size = sizeof s};
  map_statistics(map, &s);
  for (int i = 0; i < count; ++i) {
    worker_destroy(makers[i].worker);
    assert_int_equal(makers[i].sum->destroyed, i + 1);
  }
  map_destroy(map);
  return s;
}

/* What the cache writes into them excepted. */
static inline int same_tile(const tile *a, const tile *b) {
  return a->size == b->size && memcmp(a, b, offsetof(tile, used)) == 0 && a->volume == b->volume
      && memcmp(a + 1, b + 1, a->size - sizeof(tile)) == 0;
}

#endif
