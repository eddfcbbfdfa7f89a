/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A tile of a depth map: 16 x 16 pixels with one depth each, in one block of memory that begins as every tile does. So the
 * store, the cache, the spool and files treat it as any other.
 *
 *   +-------------------------------+------+-----------------------------------------+
 *   | tile: near_depth = the least  | most | depth of pixel 0 | of pixel 1 | …       |    INFINITY: no surface
 *   +-------------------------------+------+-----------------------------------------+
 *
 * Depths are floats relative to the near depth. With the least and the most of them, nearly all tiles answer without
 * a look at their pixels (RSC 3.3). A tile without any surface is tile_lit, and takes no memory.
 */
#ifndef DSM_MAP_DEPTH_TILE_H
#define DSM_MAP_DEPTH_TILE_H

#include "dsm.h"
#include "map/tile.h"

typedef struct {
  tile head;                  /* kind TILE_STORED, layout TILE_DEPTHS, no tolerance */
  float most;                 /* of the depths; INFINITY if any pixel has no surface */
  float depth[TILE_PIXELS];   /* >= 0, in rows, the lowest first; one is 0 */
} depth_tile;

static inline int tile_has_depths(const tile *t)
{
  return t->layout == TILE_DEPTHS;
}

static inline const depth_tile *depths_of(const tile *t)
{
  return (const depth_tile *)(const void *)t;   /* which begins with a tile */
}

/* *out: a new tile, or &tile_lit if all are INFINITY. Depths from the light, not NaN. DSM_NO_MEMORY. */
dsm_result depth_tile_pack(const double depth[TILE_PIXELS], const tile **out);

/* The same of depths that are floats already: >= 0, not all INFINITY. */
dsm_result depth_tile_unpack(double near_depth, const float depth[TILE_PIXELS], const tile **out);

#endif
