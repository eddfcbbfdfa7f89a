/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A tile: 16 x 16 pixels of visibility in one block of memory, immutable once published.
 *
 *   +--------+---------------------+----------------+-----------------+-----------------------------------------+
 *   | header | where pixels begin  | which coloured | which marked    | pixel 0: depths, values | pixel 1: … | … |
 *   +--------+---------------------+----------------+-----------------+-----------------------------------------+
 *              257 x 16 or 32 bits   256 bits if any  256 bits if any   words of 32 bits
 *
 * A vertex takes 6 bytes, or 10 where it is coloured. Its depth is a float relative to the tile's near depth, a
 * double: the nearest vertex of the tile itself, so that a float's 24 bits cover the tile's range of depths and not
 * the light's distance; fewer would widen the bias of every surface. Its visibility is a whole number of 65535ths:
 * half of that is a 250th of the least automatic tolerance, and compression leaves room for it (VALUE_ROUNDING).
 * A pixel without vertices takes 2 bytes.
 */
#ifndef DSM_MAP_TILE_H
#define DSM_MAP_TILE_H

#include <stdatomic.h>
#include <stddef.h>

#include "core/visibility.h"

#define TILE_SIDE 16
#define TILE_PIXELS (TILE_SIDE * TILE_SIDE)

/* The places of a pixel and of its up to eight neighbours in the tile, row by row. */
typedef struct { uint32_t place[9], count; } tile_patch;

static inline tile_patch tile_around(uint32_t place)
{
  uint32_t x = place % TILE_SIDE, y = place / TILE_SIDE;
  tile_patch p = {.count = 0};
  for (uint32_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < TILE_SIDE; j++)
    for (uint32_t i = x > 0 ? x - 1 : 0; i <= x + 1 && i < TILE_SIDE; i++)
      p.place[p.count++] = j * TILE_SIDE + i;
  return p;
}

/* Names a tile. Level 0 is the finest. */
typedef struct {
  uint32_t face, level;
  uint32_t x, y;   /* in tiles */
} tile_key;

/* How much a look-up at a pixel wants the next finer level. 0: that would tell nothing more. Else 1 + NEED_OCTAVE * log2 of the squared
 * error that interpolation makes there, in units of what is let pass; in NEED_ALWAYS there is nothing to read at this level. Between
 * pixels the finer level counts where more than NEED_SHARE of them, weighted, want it. */
enum { NEED_OCTAVE = 16, NEED_MOST = 254, NEED_ALWAYS = 255 };
#define NEED_SHARE 0.5

typedef enum { TILE_STORED, TILE_LIT, TILE_FAILED } tile_kind;

enum { TILE_WIDE = 1, TILE_COLOURED = 2, TILE_MARKED = 4,   /* what of the optional parts a tile has */
       TILE_DEPTHS = 8,                                      /* alone: no visibility at all, see depth_tile.h */
       TILE_REFINED = 16 };                                  /* the need of each pixel is at the end of the block */

typedef struct {
  double near_depth;      /* scene units from the light */
  float tolerance;        /* error of visibility that compression may have added, rms over the pixels that have any */
  uint32_t size;          /* bytes of the whole block */
  uint16_t words;         /* offset of the vertices in bytes */
  uint8_t kind;           /* tile_kind; only TILE_STORED is followed by pixels */
  uint8_t layout;         /* TILE_WIDE, … */
  atomic_uchar used;      /* since the cache last looked */
} tile;

/* What a tile is to hold: pixels in rows, the lowest first. */
typedef struct {
  uint32_t count[TILE_PIXELS];             /* vertices; 0: lit */
  unsigned char coloured[TILE_PIXELS];     /* three values a vertex instead of one */
  unsigned char marked[TILE_PIXELS];       /* light can grow here: nothing stored, trace the ray */
  unsigned char need[TILE_PIXELS];         /* see NEED_OCTAVE */
} tile_plan;

/* Shared by all tiles without a caster, and by all that could not be baked. */
extern const tile tile_lit, tile_failed;

/* A tile laid out as planned, vertices zeroed, to be filled through tile_depths and tile_values before anybody else
 * sees it. NULL: out of memory, or more than 4 GB. */
tile *tile_create(const tile_plan *plan);
void tile_destroy(const tile *t);   /* the shared ones may be passed too */

/* The pixel's first word, counted from t->words. `place` is row * TILE_SIDE + column, or TILE_PIXELS: the end. */
static inline uint32_t tile_first(const tile *t, uint32_t place)
{
  const void *table = t + 1;
  return t->layout & TILE_WIDE ? ((const uint32_t *)table)[place] : ((const uint16_t *)table)[place];
}

static inline int tile_bit(const tile *t, size_t offset, uint32_t place)
{
  return ((const unsigned char *)t)[offset + place / 8] >> place % 8 & 1;
}

static inline int tile_is_marked(const tile *t, uint32_t place)
{
  return t->layout & TILE_MARKED && tile_bit(t, t->words - TILE_PIXELS / 8, place);
}

static inline int tile_is_coloured(const tile *t, uint32_t place)
{
  return t->layout & TILE_COLOURED
      && tile_bit(t, t->words - (t->layout & TILE_MARKED ? 2 : 1) * (TILE_PIXELS / 8), place);
}

/* See NEED_OCTAVE. */
static inline uint32_t tile_need_at(const tile *t, uint32_t place)
{
  return t->layout & TILE_REFINED ? ((const unsigned char *)t)[t->size - TILE_PIXELS + place] : 0;
}

/* The pixel's vertices; none if it is lit or marked. A pixel of n vertices takes n words of depths and n/2 or 3n/2 words
 * of values, rounded up; so its number of words tells n. */
static inline visibility tile_visibility(const tile *t, uint32_t place)
{
  uint32_t first, words;
  visibility v;
  if ((t->layout & ~TILE_REFINED) == 0) {   /* nearly all tiles */
    const uint16_t *table = (const uint16_t *)(const void *)(t + 1);
    first = table[place];
    words = table[place + 1] - first;
    v.channels = 1;
  }
  else {
    first = tile_first(t, place);
    words = tile_first(t, place + 1) - first;
    v.channels = tile_is_coloured(t, place) ? 3 : 1;
  }
  v.count = (uint32_t)(v.channels == 1 ? words * 2ull / 3 : words * 2ull / 5);
  v.depth = (const float *)(const void *)((const char *)t + t->words) + first;
  v.value = (const uint16_t *)(const void *)(v.depth + v.count);
  return v;
}

static inline float *tile_depths(tile *t, uint32_t place)
{
  return (float *)(size_t)tile_visibility(t, place).depth;
}

static inline uint16_t *tile_values(tile *t, uint32_t place)
{
  return (uint16_t *)(size_t)tile_visibility(t, place).value;
}

#endif
