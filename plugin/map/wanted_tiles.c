/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/wanted_tiles.h"

#include "map/lookup.h"

typedef struct {
  tile_wish wish;
  const dsm_map *map;
  void (*wanted)(void *data, const dsm_tiles *tiles);
  void *data;
} listener;

static uint32_t smaller(uint64_t a, uint32_t b)
{
  return a < b ? (uint32_t)a : b;
}

/* A coarse tile is made of the finest ones below it. */
static void tell(tile_wish *wish, const tile_key *key)
{
  const listener *l = (const listener *)(const void *)wish;
  const tile_grid *finest = &l->map->store.grids[key->face][0];
  dsm_tiles tiles = {
    .face = key->face, .level = key->level, .x = key->x << key->level, .y = key->y << key->level,
    .past_x = smaller(((uint64_t)key->x + 1) << key->level, finest->across),
    .past_y = smaller(((uint64_t)key->y + 1) << key->level, finest->up)};
  l->wanted(l->data, &tiles);
}

dsm_result map_tiles_wanted(dsm_worker *worker, const dsm_receiver *receiver,
                            void (*wanted)(void *data, const dsm_tiles *tiles), void *data)
{
  if (worker->wish)
    return DSM_INVALID;   /* from within `wanted` */
  listener l = {{tell}, worker->map, wanted, data};
  double rgb[3];
  worker->wish = &l.wish;
  dsm_result result = map_lookup(worker, receiver, rgb);
  worker->wish = NULL;
  return result == DSM_OUTSIDE || result == DSM_TRACE ? DSM_OK : result;
}

dsm_result map_bake_tile(dsm_worker *worker, uint32_t face, uint32_t x, uint32_t y)
{
  const tile_store *store = &worker->map->store;
  if (face >= store->face_count || x >= store->grids[face][0].across || y >= store->grids[face][0].up)
    return DSM_INVALID;
  tile_key key = {face, 0, x, y};
  const tile *t;
  worker_enter(worker);
  dsm_result result = worker_tile(worker, &key, &t);
  worker_leave(worker);
  return result;
}
