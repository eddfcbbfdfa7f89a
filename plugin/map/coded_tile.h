/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A tile between its pixels and its records: what it is to hold, and the vertices in numbers that can be stored.
 *
 *   pixels in double --> codes --> the same in the fewest bits --> records of depths and values, or of deltas
 *              round_tile.c   coded_tile.c           compact_tile.c           delta_tile.c
 */
#ifndef DSM_MAP_CODED_TILE_H
#define DSM_MAP_CODED_TILE_H

#include "map/tile.h"

typedef struct {
  uint32_t depth;      /* whole, or the bits of a float; relative to the near depth */
  uint16_t value[3];   /* grey pixels have the first alone */
} coded_vertex;

typedef struct {
  tile_plan plan;
  coded_vertex *vertices;            /* one pixel's after the other's */
  uint32_t count;
  double per_quantum;                /* of depths, as in visibility_codes; 0: they are floats */
  uint32_t depth_bits, value_bits;   /* that tell all of the codes; of depths, one is left over behind all */
  double near_depth;
  float tolerance;
  uint8_t volume;
} coded_tile;

static inline uint32_t coded_channels(const coded_tile *t, uint32_t place)
{
  return t->plan.coloured[place] ? 3 : 1;
}

/* Of depths that are floats, and values of any bits: depths as multiples of the largest power of two that divides all of them, if
 * that takes no more than MOST_CODE_BITS; values in the fewest bits that tell exactly the same, but where six bytes have room for all. */
void coded_tile_shorten(coded_tile *t);

/* A new tile without records: with so many of them in each pixel, `bits` each, and bytes behind them. NULL: out of memory. */
tile *coded_tile_lay_out(const coded_tile *t, const tile_plan *records, uint32_t bits, uint32_t padding);

#endif
