/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A tile: 16 x 16 pixels of visibility in one block of memory, immutable once published.
 *
 *   +--------+-----------+-----------+-----+-------------------------------------------------+
 *   | header | pixel 0,0 | pixel 1,0 |  …  | depths of 0,0 | values of 0,0 | depths of 1,0 … |
 *   +--------+-----------+-----------+-----+-------------------------------------------------+
 *              one word pair each: where its floats start, how many vertices, flags
 *
 * Depths are floats relative to the tile's near depth, a double: the nearest vertex of the tile itself, so that
 * a float's 24 bits cover the tile's range of depths and not the light's distance.
 */
#ifndef DSM_MAP_TILE_H
#define DSM_MAP_TILE_H

#include <stddef.h>

#include "core/visibility.h"

#define TILE_SIDE 16
#define TILE_PIXELS (TILE_SIDE * TILE_SIDE)

/* Names a tile. Level 0 is the finest; coarser levels come with the pyramid. */
typedef struct {
  uint32_t face, level;
  uint32_t x, y;   /* in tiles */
} tile_key;

enum {
  PIXEL_COLOURED = 1u << 31,   /* three values a vertex instead of one */
  PIXEL_MARKED = 1u << 30,     /* light can grow here: nothing stored, trace the ray */
  PIXEL_COUNT = PIXEL_MARKED - 1
};

typedef struct {
  uint32_t start;   /* index of its first float */
  uint32_t word;    /* vertex count and flags */
} tile_pixel;

typedef enum { TILE_STORED, TILE_LIT, TILE_FAILED } tile_kind;

typedef struct {
  double near_depth;      /* scene units from the light */
  double depth_rounding;  /* more than the rounding of a stored depth, scene units */
  size_t size;            /* bytes of the whole block */
  uint32_t kind;          /* tile_kind; only TILE_STORED is followed by pixels */
  uint32_t floats;
} tile;

/* Shared by all tiles without a caster, and by all that could not be baked. */
extern const tile tile_lit, tile_failed;

static inline const tile_pixel *tile_pixels(const tile *t) { return (const tile_pixel *)(const void *)(t + 1); }
static inline const float *tile_floats(const tile *t) { return (const float *)(tile_pixels(t) + TILE_PIXELS); }

static inline visibility tile_visibility(const tile *t, const tile_pixel *pixel)
{
  visibility v;
  v.count = pixel->word & PIXEL_COUNT;
  v.channels = pixel->word & PIXEL_COLOURED ? 3 : 1;
  v.depth = tile_floats(t) + pixel->start;
  v.value = v.depth + v.count;
  return v;
}

/* NULL: out of memory. Zeroed, with room for `floats`. */
tile *tile_create(uint32_t floats);
void tile_destroy(const tile *t);   /* the shared ones may be passed too */

#endif
