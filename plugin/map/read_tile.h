/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A stored pixel as vertices in double again: for coarser levels, merging and tools. */
#ifndef DSM_MAP_READ_TILE_H
#define DSM_MAP_READ_TILE_H

#include "core/vertices.h"
#include "map/tile.h"

/* Appends a function's vertices, in time that grows with their number; 0 is at `near_depth`. DSM_NO_MEMORY: appends none. */
dsm_result read_vertices(const visibility *v, double near_depth, vertices *out);

/* Appends the pixel's vertices, depths counted from the light; none if it is lit or marked. */
dsm_result read_pixel(const tile *t, uint32_t place, vertices *out);

#endif
