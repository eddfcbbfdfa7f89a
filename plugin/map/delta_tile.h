/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A coded tile in the shortest records: see core/delta_records.h. */
#ifndef DSM_MAP_DELTA_TILE_H
#define DSM_MAP_DELTA_TILE_H

#include "map/coded_tile.h"

/* Records of a pixel; a look-up reads half of them on average. */
enum { MOST_DELTAS = 500 };

/* Bits of a record, and those of them that are the depth's. */
typedef struct { uint32_t bits, depth_bits; } delta_shape;

typedef struct {
  tile_plan records;   /* counts are of records */
  delta_shape shape;
} delta_plan;

/* The shortest records. 0: they would not take fewer than `most` bytes, or the tile has depths that are floats, or is coloured, or has
 * a pixel of too many records, or one whose values grow, or that tells twice at one depth that it begins with 1. */
int delta_tile_plan(const coded_tile *t, uint64_t most, delta_plan *plan);

/* A new tile as planned. NULL: out of memory. */
tile *delta_tile(const coded_tile *t, const delta_plan *plan);

#endif
