/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Where a map's tiles are, and who bakes a missing one.
 *
 *            claim                 publish(tile)
 *   absent ---------> claimed ---------------------> ready     (or failed: publish(&tile_failed))
 *      ^                 |
 *      +---- abandon ----+   (cancelled)
 *
 * A slot holds NULL until its tile is published, and then that tile for good: readers load it with acquire and
 * need no lock. Claims are kept in a short list under a mutex; a thread that needs a claimed tile sleeps at most
 * 20 ms at a time and asks its host in between whether to give up.
 */
#ifndef DSM_MAP_TILE_STORE_H
#define DSM_MAP_TILE_STORE_H

#include <assert.h>
#include <pthread.h>
#include <stdatomic.h>

#include "core/projection.h"
#include "map/tile.h"

typedef struct {
  uint32_t across, up;                /* tiles */
  _Atomic(const tile *) *slots;
} tile_grid;

/* A tile that one thread is baking; lives with that thread. */
typedef struct tile_claim {
  tile_key key;
  struct tile_claim *next;
} tile_claim;

typedef struct {
  tile_grid grids[MAX_FACES];
  uint32_t grid_count;
  pthread_mutex_t mutex;
  pthread_cond_t changed;
  tile_claim *claims;
} tile_store;

dsm_result tile_store_create(tile_store *store, const projection *p);
void tile_store_destroy(tile_store *store);

static inline _Atomic(const tile *) *tile_store_slot(const tile_store *store, const tile_key *key)
{
  const tile_grid *grid = &store->grids[key->face];
  assert(key->level == 0 && key->x < grid->across && key->y < grid->up);
  return &grid->slots[(size_t)key->y * grid->across + key->x];
}

/* The tile if it is published, else NULL. Lock-free. */
static inline const tile *tile_store_peek(const tile_store *store, const tile_key *key)
{
  return atomic_load_explicit(tile_store_slot(store, key), memory_order_acquire);
}

/* Gets the tile, waiting for its baker if there is one. DSM_OK with *out NULL: nobody has it, the caller
 * holds the claim now and must publish or abandon it. DSM_CANCELLED: `pause` said so. */
dsm_result tile_store_claim(tile_store *store, const tile_key *key, tile_claim *claim,
                            int32_t (*pause)(void *data), void *data, const tile **out);
/* Both end the claim and wake those who wait. `t` belongs to the store from now on. */
void tile_store_publish(tile_store *store, tile_claim *claim, const tile *t);
void tile_store_abandon(tile_store *store, tile_claim *claim);

#endif
