/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A tile in the shortest records: see core/delta_records.h. */
#ifndef DSM_MAP_DELTA_TILE_H
#define DSM_MAP_DELTA_TILE_H

#include "map/tile.h"

/* Records of a pixel; a look-up reads half of them on average. */
enum { MOST_DELTAS = 500 };

/* A new tile of the same depths, which are whole multiples of the codes' quantum, and values, which their value bits tell.
 * NULL: it would not take fewer than `most` bytes, or is coloured, or has a pixel of too many records, or one whose values grow, or that
 * tells twice at one depth that it begins with 1; or no memory. */
tile *delta_tile_of(const tile *from, const visibility_codes *codes, size_t most);

#endif
