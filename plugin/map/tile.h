/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A tile: 16 x 16 pixels of visibility in one block of memory, immutable once published.
 *
 *   +--------+--------------------+----------------+--------------+-----------------------------------+-------------+
 *   | header | where pixels begin | which coloured | which marked | records of pixel 0 | of pixel 1 | … | need of all |
 *   +--------+--------------------+----------------+--------------+-----------------------------------+-------------+
 *              320 or 1028 bytes    256 bits if any  256 bits if any  8 to 48 bits each                 256 bytes if any
 *
 * Where pixels begin: 32 times 16 bits, of every eighth pixel, and 256 bytes, how many records each has; where that
 * is not enough, 257 times 32 bits.
 *
 * A grey vertex takes one and a half to two bytes in most maps that have a tolerance, 10 to 16 bits and now and then as many again
 * (delta_records.h); in pixels that are long, coloured, or of noise with values of 16 bits, 3 to 6 bytes (visibility.h), and twice as
 * many where it is coloured. For how many bits its numbers need see rounding.h. Its depth is relative to the tile's near
 * depth, a double: the nearest vertex of the tile itself, so that the digits cover the tile's range of depths and not the
 * light's distance. A pixel without vertices takes a byte and a quarter.
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

enum { TILE_WIDE = 1, TILE_COLOURED = 2, TILE_MARKED = 4,   /* what of the optional parts a tile has, in files, too */
       TILE_DEPTHS = 8,                                      /* alone: no visibility at all, see depth_tile.h */
       TILE_REFINED = 16 };                                  /* the need of each pixel is at the end of the block */

typedef struct {
  visibility_codes codes; /* first: counts from here are counts from the tile */
  double near_depth;      /* scene units from the light */
  float tolerance;        /* error of visibility that compression may have added, rms over the pixels that have any */
  uint32_t size;          /* bytes of the whole block */
  uint8_t kind;           /* tile_kind; only TILE_STORED is followed by pixels */
  uint8_t layout;         /* TILE_WIDE, … */
  atomic_uchar used;      /* since the cache last looked */
  uint8_t volume;         /* not of surfaces alone; for coarser levels that are made of it, so files do not hold it */
  uint32_t serial;        /* of this block in its map, from 1 on; for hints, which outlive tiles */
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

/* Bytes of a tile with records of so many bits, and bytes behind them. */
uint64_t tile_bytes(const tile_plan *plan, uint32_t record_bits, uint32_t padding);
/* Such a tile, to be filled before anybody else sees it: its records are zeros, and how they are to be read is not said yet but for where they
 * begin. NULL: out of memory, or more than 4 GB. */
tile *tile_create_empty(const tile_plan *plan, uint32_t record_bits, uint32_t padding);
void tile_destroy(const tile *t);   /* the shared ones may be passed too */

/* The first of the 16-bit numbers, and of the bytes, of the narrow table. */
static inline const uint16_t *tile_starts(const tile *t)
{
  return (const uint16_t *)(const void *)(t + 1);
}

static inline const unsigned char *tile_counts(const tile *t)
{
  return (const unsigned char *)(tile_starts(t) + TILE_PIXELS / 8);
}

/* The pixel's first record. `place` is row * TILE_SIDE + column. */
static inline uint32_t tile_first(const tile *t, uint32_t place)
{
  if (t->layout & TILE_WIDE)
    return ((const uint32_t *)(const void *)(t + 1))[place];
  uint64_t counts, pairs = 0x00FF00FF00FF00FFu;   /* the product's top 16 bits add up those in front of this one, two by two */
  memcpy(&counts, tile_counts(t) + (place & ~7u), sizeof counts);
  counts = counts << 8 << (56 - 8 * (place & 7));
  counts = (counts & pairs) + (counts >> 8 & pairs);
  return tile_starts(t)[place / 8] + (uint32_t)(counts * 0x0001000100010001u >> 48);
}

static inline uint32_t tile_records(const tile *t, uint32_t place)
{
  const uint32_t *wide = (const uint32_t *)(const void *)(t + 1);
  return t->layout & TILE_WIDE ? wide[place + 1] - wide[place] : tile_counts(t)[place];
}

static inline int tile_bit(const tile *t, size_t offset, uint32_t place)
{
  return ((const unsigned char *)t)[offset + place / 8] >> place % 8 & 1;
}

static inline int tile_is_marked(const tile *t, uint32_t place)
{
  return t->layout & TILE_MARKED && tile_bit(t, t->codes.records - TILE_PIXELS / 8, place);
}

static inline int tile_is_coloured(const tile *t, uint32_t place)
{
  return t->layout & TILE_COLOURED
      && tile_bit(t, t->codes.records - (t->layout & TILE_MARKED ? 2 : 1) * (TILE_PIXELS / 8), place);
}

/* See NEED_OCTAVE. */
static inline uint32_t tile_need_at(const tile *t, uint32_t place)
{
  return t->layout & TILE_REFINED ? ((const unsigned char *)t)[t->size - TILE_PIXELS + place] : 0;
}

/* For evaluation alone: `count` of deltas is that of their records. The pixel's records begin with the `first`. */
static inline visibility tile_visibility_from(const tile *t, uint32_t place, size_t first)
{
  uint32_t records = tile_records(t, place);
  int coloured = tile_is_coloured(t, place);
  return (visibility){&t->codes, (uint32_t)first, records, coloured ? records / 2 : records, coloured ? 3 : 1};
}

/* The pixel's vertices; none if it is lit or marked. */
static inline visibility tile_visibility(const tile *t, uint32_t place)
{
  visibility v = tile_visibility_from(t, place, tile_first(t, place));
  if (codes_are_deltas(&t->codes))
    v.count = delta_vertices(v.codes, v.first, v.records);
  return v;
}

#endif
