/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A tile's compressed pixels, in double, rounded to codes. */
#ifndef DSM_MAP_ROUND_TILE_H
#define DSM_MAP_ROUND_TILE_H

#include "core/vertices.h"
#include "map/baked_pixel.h"
#include "map/coded_tile.h"

/* Where depths count from, and in what; quantum 0: in floats. */
typedef struct { double near_depth, quantum; } depth_scale;

/* Fills in counts and colours of the plan, vertices, and how they are coded; t->vertices has room for those of all pixels. Depths are floats,
 * values have `value_bits`. Drops vertices that coincide, once rounded, with one before and one behind, and colours that rounding has made grey. */
void round_tile(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const depth_scale *scale, uint32_t value_bits,
                coded_tile *t);

#endif
