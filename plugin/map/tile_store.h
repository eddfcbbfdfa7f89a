/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Where a map's tiles are, and who makes a missing one.
 *
 *            claim                 publish(tile)
 *   absent ---------> claimed ---------------------> ready     (or failed: publish(&tile_failed))
 *    ^  ^                |                             |
 *    |  +---- abandon ---+   (cancelled)               |
 *    +------------------ eviction ---------------------+   (see tile_cache.h; those without pixels stay)
 *
 * Readers hold a ready tile without a lock. Claims are kept in a short list under a mutex; a thread that needs a
 * claimed tile helps to make it (see tile_shares.h), sleeps at most 20 ms at a time, and asks its host in between whether to give up. Who has claimed a tile may
 * claim others to make it of, nearer to the level that is baked without any (the finest; with `accuracy`, the map's first level):
 * an average claims finer ones, and what refines the first level coarser ones. So no two threads wait for each other.
 */
#ifndef DSM_MAP_TILE_STORE_H
#define DSM_MAP_TILE_STORE_H

#include <assert.h>
#include <pthread.h>
#include <stdatomic.h>

#include "core/projection.h"
#include "map/tile.h"
#include "map/tile_cache.h"

/* The tiles of one level of one face. */
typedef struct {
  uint32_t across, up;   /* tiles */
  uint64_t first;        /* number of its first tile; see tile_store_number */
  tile_slot *slots;
} tile_grid;

/* A tile that one thread is making; lives on that thread's stack. */
typedef struct tile_claim {
  tile_key key;
  struct tile_shares *shares;   /* that others may take part in; under the mutex */
  struct tile_claim *next;
} tile_claim;

typedef struct {
  tile_grid grids[MAX_FACES][MAX_LEVELS];
  uint32_t face_count, level_count;   /* of the face that has most levels */
  uint64_t tile_count;                /* of all faces and levels */
  pthread_mutex_t mutex;
  pthread_cond_t changed;
  tile_claim *claims;
  tile_cache cache;
} tile_store;

/* `budget`: bytes that tiles may take. */
dsm_result tile_store_create(tile_store *store, const projection *p, uint64_t budget);
void tile_store_destroy(tile_store *store);   /* after all holders have left */

/* A thread's holder, for as long as it reads tiles. */
dsm_result tile_store_join(tile_store *store, tile_holder *holder);
void tile_store_leave(tile_store *store, tile_holder *holder);

static inline tile_slot *tile_store_slot(const tile_store *store, const tile_key *key)
{
  const tile_grid *grid = &store->grids[key->face][key->level];
  assert(key->x < grid->across && key->y < grid->up);
  return &grid->slots[(size_t)key->y * grid->across + key->x];
}

/* All tiles in one order: level by level from the finest, face by face, row by row. */
uint64_t tile_store_number(const tile_store *store, const tile_key *key);
tile_key tile_store_key(const tile_store *store, uint64_t number);

/* The tile if it is there, else NULL. Nobody holds it: for while no other thread publishes. */
static inline const tile *tile_store_peek(const tile_store *store, const tile_key *key)
{
  return atomic_load_explicit(tile_store_slot(store, key), memory_order_acquire);
}

/* Gets and holds the tile, waiting for its maker if there is one: then `pause` is called first, and each time when something may have
 * changed. DSM_OK with *out NULL: nobody has it, the caller holds the claim now and must publish or abandon it. DSM_CANCELLED: `pause`
 * said so. DSM_NO_MEMORY: for one place more. */
dsm_result tile_store_claim(tile_store *store, const tile_key *key, tile_claim *claim, tile_holder *holder,
                            int32_t (*pause)(void *data), void *data, const tile **out);
/* Both end the claim and wake those who wait. `t` belongs to the store from now on, and is held. */
void tile_store_publish(tile_store *store, tile_claim *claim, tile_holder *holder, const tile *t);
void tile_store_abandon(tile_store *store, tile_claim *claim);

/* Under the mutex: the claim for the tile, NULL if there is none; and to wait for any claim to change, for 20 ms at most. */
tile_claim *tile_store_claimed(const tile_store *store, const tile_key *key);
void tile_store_wait(tile_store *store);

#endif
