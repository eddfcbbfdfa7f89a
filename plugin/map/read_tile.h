/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A stored pixel as vertices in double again: for coarser levels, merging and tools. */
#ifndef DSM_MAP_READ_TILE_H
#define DSM_MAP_READ_TILE_H

#include "core/vertices.h"
#include "map/tile.h"

/* Appends the pixel's vertices, depths counted from the light; none if it is lit or marked. */
dsm_result read_pixel(const tile *t, uint32_t place, vertices *out);

#endif
