/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/worker.h"

#include <stdlib.h>
#include <string.h>

#include "map/pyramid.h"
#include "map/tile_shares.h"

dsm_result worker_create(dsm_map *map, void *host_data, tile_maker *maker, dsm_worker **out)
{
  *out = NULL;
  dsm_worker *worker = calloc(1, sizeof *worker);
  if (!worker)
    return DSM_NO_MEMORY;
  worker->map = map;
  worker->host_data = host_data;
  worker->maker = maker;
  dsm_result result = tile_store_join(&map->store, &worker->holder);
  if (result != DSM_OK) {
    free(worker);
    return result;
  }
  pthread_mutex_lock(&map->store.mutex);
  worker->next = map->workers;
  map->workers = worker;
  pthread_mutex_unlock(&map->store.mutex);
  *out = worker;
  return DSM_OK;
}

uint64_t worker_samples(const dsm_worker *worker)
{
  uint64_t sum = 0;
  for (; worker; worker = worker->next)
    sum += atomic_load_explicit(&worker->samples, memory_order_relaxed);
  return sum;
}

static void leave_map(dsm_worker *worker)
{
  dsm_map *map = worker->map;
  pthread_mutex_lock(&map->store.mutex);
  map->samples += atomic_load_explicit(&worker->samples, memory_order_relaxed);
  dsm_worker **link = &map->workers;
  while (*link != worker)
    link = &(*link)->next;
  *link = worker->next;
  pthread_mutex_unlock(&map->store.mutex);
}

void worker_destroy(dsm_worker *worker)
{
  if (!worker)
    return;
  leave_map(worker);
  tile_store_leave(&worker->map->store, &worker->holder);
  if (worker->maker)
    worker->maker->destroy(worker->maker);
  free(worker);
}

static dsm_result bake(dsm_worker *worker, const tile_key *key, const tile **out, tile_tally *tally)
{
  if (!worker->maker)
    return DSM_REFUSED;
  wanted_pixels wanted;
  memset(&wanted, 1, sizeof wanted);
  if (key->level < worker->map->first_level) {
    dsm_result result = wanted_pixels_of(worker, key, &wanted);
    if (result != DSM_OK)
      return result;
  }
  worker->baking = 1;
  dsm_result result = worker->maker->make(worker->maker, key, &wanted, out, tally);
  worker->baking = 0;
  return result;
}

/* DSM_OK: *out is the claimed tile, from the best source there is, or &tile_failed. DSM_CANCELLED. */
static dsm_result make_tile(dsm_worker *worker, const tile_key *key, const tile **out)
{
  dsm_map *map = worker->map;
  const spool *kept = map->store.cache.spool;
  if (map->source) {
    int failed = map->source->read(map->source, key, out) != DSM_OK;
    if (failed)
      *out = &tile_failed;
    map_count_read(map, key, failed);
    return DSM_OK;
  }
  if (kept && spool_read(kept, tile_store_number(&map->store, key), out) == DSM_OK && *out)
    return DSM_OK;
  tile_tally tally;
  memset(&tally, 0, sizeof tally);
  dsm_result result = key->level > map->first_level ? pyramid_make(worker, key, out) : bake(worker, key, out, &tally);
  if (result == DSM_CANCELLED)
    return result;
  if (result != DSM_OK)
    *out = &tile_failed;
  map_count_made(map, key, &tally, (*out)->kind == TILE_FAILED);
  return DSM_OK;
}

typedef struct { dsm_worker *worker; const tile_key *key; } waiting;

/* What a thread does before it sleeps: its part of the tile that it waits for, and what its host likes. If it fails there, it just waits. */
static int32_t help_and_pause(void *data)
{
  const waiting *w = data;
  dsm_worker *worker = w->worker;
  dsm_map *map = worker->map;
  if (worker->maker) {
    worker->baking = 1;
    dsm_result result = tile_shares_help(&map->store, w->key, worker->maker);
    worker->baking = 0;
    if (result == DSM_CANCELLED)
      return 1;
  }
  return map->host.pause && map->host.pause(worker->host_data);
}

dsm_result worker_need_tile(dsm_worker *worker, const tile_key *key, const tile **out)
{
  dsm_map *map = worker->map;
  *out = NULL;
  if (worker->wish) {
    worker->wish->tell(worker->wish, key);
    *out = &tile_lit;
    return DSM_OK;
  }
  if (worker->baking)
    return DSM_TRACE;
  tile_claim claim;
  waiting waits = {worker, key};
  dsm_result result = tile_store_claim(&map->store, key, &claim, &worker->holder, help_and_pause, &waits, out);
  if (result != DSM_OK || *out)
    return result;
  uint32_t held = worker->holder.held;
  const tile *made = NULL;
  result = make_tile(worker, key, &made);
  tile_holder_release(&worker->holder, held);   /* what it was made of */
  if (result == DSM_OK) {
    tile_store_publish(&map->store, &claim, &worker->holder, made);
    *out = made;
  }
  else
    tile_store_abandon(&map->store, &claim);
  return result;
}
