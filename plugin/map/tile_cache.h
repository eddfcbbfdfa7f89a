/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The tiles that a map holds now, by number: at most a given number of bytes (LV 5.4).
 *
 *    slots            0    1    2    3    4    5    6           NULL: not made yet, or evicted
 *                  +----+----+----+----+----+----+----+
 *                  | t0 |    | t2 |    | t4 | t5 |    | ...
 *                  +-^--+----+-^--+----+----+-^--+----+
 *                    |         |              '---------------- hand: where eviction goes on. It passes a tile once
 *    places          |         |                                that was used since its last visit (second chance)
 *    thread A   | t0 '  |   t2 '  |       | ...
 *    thread B   | t0    |         | ...                         t4 and t5 are in no place: they may go
 *
 * Readers take no lock. A reader writes the tile that it finds in a slot to a place of its own, and trusts it only if
 * a later load of the slot finds it still there (hazard pointers: Michael 2004). Eviction does the reverse:
 *
 *         reader                                      eviction
 *    1    place = t                              1    slot = NULL
 *    2    slot == t?  then t is held             2    t in a place?  then slot = t again, else free t
 *
 * All four are sequentially consistent. If the reader's first step comes before eviction's second, t is seen there.
 * If not, eviction's first step came before the reader's second, which does not find t. A reader that finds NULL asks
 * under the mutex, under which all eviction happens, and finds what has been put back.
 *
 * A place keeps its tile until another is put there, so that a look-up that needs what the last one needed writes
 * nothing. A thread that is idle, or bakes for long, keeps the few tiles of one look-up from being freed and no others.
 */
#ifndef DSM_MAP_TILE_CACHE_H
#define DSM_MAP_TILE_CACHE_H

#include "dsm.h"
#include "map/spool.h"
#include "map/tile.h"

typedef _Atomic(const tile *) tile_slot;

/* One thread's places. Only that thread writes to it. */
typedef struct tile_holder {
  tile_slot *places;         /* `room` of them */
  uint32_t held, room;       /* the first `held` are needed, the others may be used anew */
  struct tile_holder *next;
} tile_holder;

typedef struct {
  tile_slot *slots;
  uint64_t count;
  unsigned char *made;       /* a bit for each tile that has ever been put in */
  uint64_t budget;           /* bytes */
  uint64_t bytes, bytes_most, evicted;
  uint64_t hand;
  uint32_t serial;           /* of the last tile that was put in */
  tile_holder *holders;
  spool *spool;              /* where evicted tiles go; NULL: nowhere, they can be made again */
} tile_cache;

dsm_result tile_cache_create(tile_cache *cache, uint64_t count, uint64_t budget);
void tile_cache_destroy(tile_cache *cache);

static inline void tile_touch(const tile *t)
{
  atomic_uchar *used = (atomic_uchar *)(size_t)&t->used;   /* the one thing that changes in a published tile */
  if (!atomic_load_explicit(used, memory_order_relaxed))   /* mostly set, and then its cache line stays shared */
    atomic_store_explicit(used, 1, memory_order_relaxed);
}

/* [any] Holds the tile in this slot until the holder's `held` is lowered again. NULL: the slot is empty, or the holder has
 * no place left. */
static inline const tile *tile_cache_hold(const tile_slot *slot, tile_holder *holder)
{
  if (holder->held == holder->room)
    return NULL;
  tile_slot *place = &holder->places[holder->held];
  for (;;) {
    const tile *t = atomic_load(slot);
    if (!t)
      return NULL;
    if (t == atomic_load_explicit(place, memory_order_relaxed)) {
      tile_touch(t);
      holder->held++;
      return t;
    }
    atomic_store(place, t);
  }
}

/* Back to `held` places; the others are emptied, so that their tiles can be freed. */
void tile_holder_release(tile_holder *holder, uint32_t held);

/* All below: one thread at a time for a cache. */

/* A holder that has joined has room for one tile at least, until it leaves. */
dsm_result tile_cache_join(tile_cache *cache, tile_holder *holder);
void tile_cache_leave(tile_cache *cache, tile_holder *holder);
dsm_result tile_holder_make_room(tile_holder *holder);   /* for one more */

/* Fills an empty slot; `t` belongs to the cache from now on, and is held. Then evicts others that nobody holds until all
 * are within the budget. */
void tile_cache_put(tile_cache *cache, uint64_t number, const tile *t, tile_holder *holder);

static inline int tile_cache_was_made(const tile_cache *cache, uint64_t number)
{
  return cache->made[number / 8] >> number % 8 & 1;
}

#endif
