/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/worker.h"

#include <stdlib.h>
#include <string.h>

dsm_result worker_create(dsm_map *map, void *host_data, tile_maker *maker, dsm_worker **out)
{
  dsm_worker *worker = calloc(1, sizeof *worker);
  *out = worker;
  if (!worker)
    return DSM_NO_MEMORY;
  worker->map = map;
  worker->host_data = host_data;
  worker->maker = maker;
  return DSM_OK;
}

void worker_destroy(dsm_worker *worker)
{
  if (!worker)
    return;
  worker->maker->destroy(worker->maker);
  free(worker);
}

dsm_result worker_need_tile(dsm_worker *worker, const tile_key *key, const tile **out)
{
  dsm_map *map = worker->map;
  *out = NULL;
  if (worker->baking)
    return DSM_TRACE;
  dsm_result result = tile_store_claim(&map->store, key, &worker->claim, map->host.pause, worker->host_data,
                                       out);
  if (result != DSM_OK || *out)
    return result;

  tile_tally tally;
  memset(&tally, 0, sizeof tally);
  worker->baking = 1;
  result = worker->maker->make(worker->maker, key, out, &tally);
  worker->baking = 0;
  if (result == DSM_CANCELLED) {
    tile_store_abandon(&map->store, &worker->claim);
    *out = NULL;
    return DSM_CANCELLED;
  }
  int failed = result != DSM_OK;
  if (failed)
    *out = &tile_failed;
  tile_store_publish(&map->store, &worker->claim, *out);
  map_count_tile(map, &tally, failed);
  return DSM_OK;
}
