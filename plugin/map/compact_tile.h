/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Fewer bytes for exactly the same tile. */
#ifndef DSM_MAP_COMPACT_TILE_H
#define DSM_MAP_COMPACT_TILE_H

#include "map/tile.h"

/* The tile that tile_create has made, in the shortest records that hold exactly its depths and values: depths as multiples
 * of the largest power of two that divides all of them, if that takes no more than MOST_CODE_BITS; values in the fewest bits that
 * tell them. Takes `t`; gives it back if there is nothing to be won, or no memory for a moment. */
tile *tile_compact(tile *t);

#endif
