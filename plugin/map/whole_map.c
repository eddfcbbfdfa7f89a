/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/whole_map.h"

/* Tracing a tile of the finest level costs about as much as making this many coarser ones of those before. */
static const double FINEST_COST = 16;

/* The next tile that has not been made yet, whether by a look-up or by another call. 0: there is none. */
static int take(dsm_map *map, uint64_t *number)
{
  pthread_mutex_lock(&map->store.mutex);
  while (map->next_tile < map->store.tile_count && tile_cache_was_made(&map->store.cache, map->next_tile))
    map->next_tile++;
  *number = map->next_tile;
  int found = *number < map->store.tile_count;
  map->next_tile += (uint64_t)found;
  pthread_mutex_unlock(&map->store.mutex);
  return found;
}

/* Those after it that have been made are passed over again. */
static void give_back(dsm_map *map, uint64_t number)
{
  pthread_mutex_lock(&map->store.mutex);
  if (number < map->next_tile)
    map->next_tile = number;
  pthread_mutex_unlock(&map->store.mutex);
}

/* In the cost of coarser tiles, of those with lower numbers. */
static double cost_before(const tile_store *store, uint64_t number)
{
  uint64_t finest = 0;
  for (uint32_t i = 0; i < store->face_count; i++)
    finest += (uint64_t)store->grids[i][0].across * store->grids[i][0].up;
  return number < finest ? FINEST_COST * (double)number
                         : FINEST_COST * (double)finest + (double)(number - finest);
}

dsm_result map_bake_next(dsm_worker *worker, double *share)
{
  tile_store *store = &worker->map->store;
  uint64_t number;
  if (!take(worker->map, &number)) {
    *share = 1;
    return DSM_DONE;
  }
  tile_key key = tile_store_key(store, number);
  const tile *made;
  worker_enter(worker);
  dsm_result result = worker_tile(worker, &key, &made);
  worker_leave(worker);
  if (result == DSM_OK)
    *share = cost_before(store, number + 1) / cost_before(store, store->tile_count);
  else
    give_back(worker->map, number);
  return result;
}
