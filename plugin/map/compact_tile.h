/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A coded tile in as few bytes as look-ups read fast. */
#ifndef DSM_MAP_COMPACT_TILE_H
#define DSM_MAP_COMPACT_TILE_H

#include "map/delta_tile.h"

/* Whether deltas tell the tile, and spare enough; if so, how. */
int compact_as_deltas(const coded_tile *t, delta_plan *plan);

/* A new tile of absolute records. NULL: out of memory, or more than 4 GB. */
tile *absolute_tile(const coded_tile *t);

#endif
