/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* One thread's way into a map: its scratch, its search hints, and what makes a tile that is missing. */
#ifndef DSM_MAP_WORKER_H
#define DSM_MAP_WORKER_H

#include "map/map.h"
#include "map/wanted_pixels.h"

/* Makes a tile that its caller has claimed. The baker is above this room (bake/baker.h) and hands itself in. */
typedef struct tile_maker {
  /* DSM_OK: *out is a new tile or &tile_lit. DSM_CANCELLED, DSM_NO_MEMORY, …: nothing made. `tally` is
   * zeroed. Of the pixels those that are `wanted` are enough. */
  dsm_result (*make)(struct tile_maker *maker, const tile_key *key, const wanted_pixels *wanted, const tile **out,
                     tile_tally *tally);
  void (*destroy)(struct tile_maker *maker);
} tile_maker;

/* Is told of tiles that are not there, while a look-up takes them for lit: see wanted_tiles.h. */
typedef struct tile_wish {
  void (*tell)(struct tile_wish *wish, const tile_key *key);
} tile_wish;

/* Where the last search in a pixel ended (LV 3.4): two direct-mapped caches. That of absolute records is without tags: pixels 32
 * apart share a place, and a wrong hint only costs its search some steps. In deltas a mark counts for the very tile that it
 * was made in, whatever has been evicted since. */
#define HINT_SIDE 32
#define MARK_SIDE 16

typedef struct {
  uint32_t serial;   /* of the tile; 0: no mark */
  delta_mark mark;
} search_mark;

struct dsm_worker {
  dsm_map *map;
  void *host_data;
  tile_maker *maker;   /* NULL: what is in no file has failed */
  tile_holder holder;
  uint32_t depth;      /* of worker_enter */
  int baking;          /* a host must not look up with a worker whose tile it traces; it is told to trace */
  tile_wish *wish;     /* NULL but within map_tiles_wanted */
  uint32_t hints[HINT_SIDE * HINT_SIDE];
  search_mark marks[MARK_SIDE * MARK_SIDE];
  struct dsm_worker *next;   /* of the map's; under store.mutex */
  _Atomic uint64_t samples;  /* written by its thread alone; see dsm_statistics */
};

/* `maker` belongs to the worker if this returns DSM_OK; it may be NULL. */
dsm_result worker_create(dsm_map *map, void *host_data, tile_maker *maker, dsm_worker **worker);
void worker_destroy(dsm_worker *worker);

static inline void worker_count_samples(dsm_worker *worker, uint64_t samples)
{
  uint64_t before = atomic_load_explicit(&worker->samples, memory_order_relaxed);
  atomic_store_explicit(&worker->samples, before + samples, memory_order_relaxed);
}

/* Of this worker and all that follow it. Under store.mutex. */
uint64_t worker_samples(const dsm_worker *worker);

/* Around every look-up, and whatever else reads tiles. May be nested. */
static inline void worker_enter(dsm_worker *worker)
{
  worker->depth++;
}

static inline void worker_leave(dsm_worker *worker)
{
  assert(worker->depth > 0);
  if (--worker->depth == 0)
    worker->holder.held = 0;
}

/* The tile, made or waited for. DSM_OK, DSM_TRACE (called from within the worker's own bake),
 * DSM_CANCELLED, DSM_NO_MEMORY. */
dsm_result worker_need_tile(dsm_worker *worker, const tile_key *key, const tile **out);

/* As above. The tile stays valid until the outermost worker_leave, or, for what is got while a coarser tile is being made
 * of it, until that is done. */
static inline dsm_result worker_tile(dsm_worker *worker, const tile_key *key, const tile **out)
{
  assert(worker->depth > 0);
  *out = tile_cache_hold(tile_store_slot(&worker->map->store, key), &worker->holder);
  return *out ? DSM_OK : worker_need_tile(worker, key, out);
}

#endif
