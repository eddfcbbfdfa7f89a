/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Where a finer level would tell more than this one does.
 *
 *   V |----.           Between pixels a look-up interpolates. What that misses shows in the second differences of
 *     |     \ <-- bend  neighbours: where visibility runs straight from pixel to pixel, nothing is missed, and where it
 *     |      '----      bends by chance, a finer level would only bend again. So the squared bends of a pixel and its
 *     +--pixels--->     neighbours count, less what noise makes of them; at the depth where they are largest.
 *
 * A slanted surface lies at another depth in each pixel. That is no bend: a value counts as the same as any that its neighbour
 * takes within a pixel's width of the depth; and what lies on an opaque ground is compared at depths relative to that.
 */
#ifndef DSM_BAKE_TILE_NEED_H
#define DSM_BAKE_TILE_NEED_H

#include "core/vertices.h"
#include "map/baked_pixel.h"
#include "map/tile.h"

typedef struct {
  double width, width_at_least;   /* of a pixel at depth z: width * z + width_at_least */
  double aim;                     /* error, root mean square over a picture */
  int first;                      /* whether no coarser level has been looked at */
} need_limits;

/* Some pixels of a tile, on lines across and up: columns and rows rise from 0 to the last of the pixels that count. */
#define SPARSE_MOST 8
typedef struct {
  uint32_t side;   /* at least 3 */
  uint8_t x[SPARSE_MOST], y[SPARSE_MOST];
} sparse_grid;

static inline uint32_t sparse_place(const sparse_grid *grid, uint32_t i, uint32_t j)
{
  return grid->y[j] * TILE_SIDE + grid->x[i];
}

/* Whether what lies between these pixels can be interpolated, in front of a ground or where there is none. The others have no vertices. */
int sparse_is_enough(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const need_limits *limits,
                     const sparse_grid *grid, int ground);

/* Sets `need` of all pixels of a tile from their vertices and variance, as map/tile.h describes it: 0 where interpolation is good
 * enough. */
void tile_need(baked_pixel pixels[TILE_PIXELS], const vertices *stored, const need_limits *limits);

#endif
