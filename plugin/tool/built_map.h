/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A map that dsmtool makes: tiles of the finest level come from a maker, coarser levels are made of them as in any map, and
 * the whole is written to a file. Memory stays within the cache's default size, however large the map is. */
#ifndef DSM_TOOL_BUILT_MAP_H
#define DSM_TOOL_BUILT_MAP_H

#include "map/worker.h"
#include "store/map_header.h"

/* `maker` makes tiles of level 0 and prints a sentence where it fails; it is destroyed in any case. Sets what of the header
 * depends on the tiles. Returns the exit status, having printed a sentence unless it is STATUS_FINE. */
int built_map_write(const char *path, map_header *header, tile_maker *maker);

/* For makers: counts a tile that is ready. */
void built_tile_count(const tile *t, tile_tally *tally);

#endif
