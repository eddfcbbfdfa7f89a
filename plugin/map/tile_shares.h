/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * One tile made by several threads: who waits for a tile takes a share in making it.
 *
 *   open ----> taken ----> done      The thread that has claimed the tile offers the shares, does what others leave, and waits for
 *     ^          |                   those that others have taken. A helper that fails, or is cancelled, leaves its share open.
 *     +----------+
 *
 * What a share is made of and what becomes of it must not depend on who makes it.
 */
#ifndef DSM_MAP_TILE_SHARES_H
#define DSM_MAP_TILE_SHARES_H

#include "map/tile_store.h"

struct tile_maker;

enum { MOST_SHARES = 4 };

typedef struct tile_shares {
  uint32_t count;
  /* [any] Makes one share with the scratch of `maker`, the one of the thread that calls. */
  dsm_result (*make)(struct tile_shares *shares, struct tile_maker *maker, uint32_t share);

  /* under the store's mutex; zero at first */
  uint32_t taken;
  enum { SHARE_OPEN, SHARE_TAKEN, SHARE_DONE } state[MOST_SHARES];
} tile_shares;

/* To be called by the thread that has claimed the tile, at most once at a time. DSM_OK: all are done. Else what `make` has
 * returned on this thread. Nobody uses the shares any more. */
dsm_result tile_shares_do(tile_store *store, const tile_key *key, tile_shares *shares, struct tile_maker *maker);

/* Makes shares of a tile that another thread has claimed, while there are any. DSM_OK, or what `make` has returned. */
dsm_result tile_shares_help(tile_store *store, const tile_key *key, struct tile_maker *maker);

#endif
