/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/coded_tile.h"

#include <math.h>

enum { NO_BIT = 1000 };   /* above all of a float */

static float float_of(uint32_t bits)
{
  union { uint32_t bits; float value; } f = {bits};
  return f.value;
}

/* The lowest bit of a depth >= 0, as the exponent of 2. */
static int lowest_bit(uint32_t depth)
{
  uint32_t exponent = depth >> 23, digits = depth & 0x7FFFFF;
  if (depth == 0)
    return NO_BIT;
  return exponent ? (int)exponent - 150 + __builtin_ctz(digits | 0x800000) : __builtin_ctz(digits) - 149;
}

static void shorten_depths(coded_tile *t)
{
  int lowest = NO_BIT;
  uint32_t farthest = 0;   /* of floats >= 0 the larger one has the larger bits */
  for (uint32_t i = 0; i < t->count; i++) {
    uint32_t depth = t->vertices[i].depth;
    int bit = lowest_bit(depth);
    lowest = bit < lowest ? bit : lowest;
    farthest = depth > farthest ? depth : farthest;
  }
  double per_quantum = lowest < NO_BIT ? ldexp(1, -lowest) : 1, codes = (double)float_of(farthest) * per_quantum + 2;
  t->per_quantum = 0;
  t->depth_bits = FLOAT_BITS;
  if (t->count == 0 || !(codes <= (double)(1u << MOST_CODE_BITS)))
    return;
  t->per_quantum = per_quantum;
  for (t->depth_bits = 1; (1u << t->depth_bits) < (uint32_t)codes;)
    t->depth_bits++;
  for (uint32_t i = 0; i < t->count; i++)
    t->vertices[i].depth = (uint32_t)((double)float_of(t->vertices[i].depth) * per_quantum);   /* exact */
}

/* Whether fewer bits tell a value, given its code and the code of 1. */
static int tells(uint32_t bits, uint32_t code, uint32_t one)
{
  uint32_t fewer = (1u << bits) - 1, value = value_of_code(code, one);
  return value_of_code(code_of_value(value, fewer), fewer) == value;
}

static int tells_all(const coded_tile *t, uint32_t bits)
{
  const coded_vertex *v = t->vertices;
  uint32_t one = (1u << t->value_bits) - 1;
  for (uint32_t place = 0; place < TILE_PIXELS; place++)
    for (const coded_vertex *end = v + t->plan.count[place]; v < end; v++)
      for (uint32_t c = 0; c < coded_channels(t, place); c++)
        if (!tells(bits, v->value[c], one))
          return 0;
  return 1;
}

static void set_value_bits(coded_tile *t, uint32_t bits)
{
  uint32_t from = (1u << t->value_bits) - 1, to = (1u << bits) - 1;
  coded_vertex *v = t->vertices;
  for (uint32_t place = 0; place < TILE_PIXELS && bits != t->value_bits; place++)
    for (coded_vertex *end = v + t->plan.count[place]; v < end; v++)
      for (uint32_t c = 0; c < coded_channels(t, place); c++)
        v->value[c] = (uint16_t)code_of_value(value_of_code(v->value[c], from), to);
  t->value_bits = bits;
}

void coded_tile_shorten(coded_tile *t)
{
  uint32_t bits = 1;
  shorten_depths(t);
  while (bits < t->value_bits && !tells_all(t, bits))
    bits++;
  set_value_bits(t, t->count == 0 || t->depth_bits + bits > 5 * 8 ? VALUE_BITS : bits);
}

tile *coded_tile_lay_out(const coded_tile *from, const tile_plan *records, uint32_t bits, uint32_t padding)
{
  tile *t = tile_create_empty(records, bits, padding);
  if (!t)
    return NULL;
  t->codes.per_quantum = from->per_quantum;
  t->near_depth = from->near_depth;
  t->tolerance = from->tolerance;
  t->volume = from->volume;
  return t;
}
