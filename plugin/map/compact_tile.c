/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/compact_tile.h"

#include <math.h>
#include <stdlib.h>

#include "map/delta_tile.h"

enum { NO_BIT = 1000 };   /* above all of a float */

/* Look-ups take longer in deltas, so these have to take fewer bytes than this share of what absolute records take. */
static const double DELTAS_SPARE = 0.8;

/* The lowest bit of a depth >= 0, as the exponent of 2. */
static int lowest_bit(float depth)
{
  union { float value; uint32_t bits; } f = {depth};
  uint32_t exponent = f.bits >> 23, digits = f.bits & 0x7FFFFF;
  if (f.bits == 0)
    return NO_BIT;
  return exponent ? (int)exponent - 150 + __builtin_ctz(digits | 0x800000) : __builtin_ctz(digits) - 149;
}

/* The depths' quantum and the bits of their codes, or floats. One code is left over, behind all depths. */
static uint32_t choose_depths(const tile *t, visibility_codes *to)
{
  int lowest = NO_BIT;
  float most = 0;
  for (uint32_t place = 0; place < TILE_PIXELS; place++) {
    visibility v = tile_visibility(t, place);
    for (uint32_t i = 0; i < v.count; i++) {
      float depth = (float)visibility_depth(&v, i);
      int bit = lowest_bit(depth);
      lowest = bit < lowest ? bit : lowest;
      most = depth > most ? depth : most;
    }
  }
  double per_quantum = lowest < NO_BIT ? ldexp(1, -lowest) : 1, codes = (double)most * per_quantum + 2;
  if (!(codes <= (double)(1u << MOST_CODE_BITS)))
    return FLOAT_BITS;
  to->per_quantum = per_quantum;
  uint32_t bits = 1;
  while ((1u << bits) < (uint32_t)codes)
    bits++;
  return bits;
}

static int tells(uint32_t bits, uint32_t value)
{
  uint32_t most = (1u << bits) - 1;
  return value_of_code(code_of_value(value, most), most) == value;
}

/* The least number of bits, from `bits` on, that tell all values of a pixel. */
static uint32_t bits_of_pixel(const visibility *v, uint32_t bits)
{
  for (uint32_t i = 0; i < v->count * v->channels; i++)
    if (!tells(bits, visibility_stored(v, i / v->channels, i % v->channels)))
      return bits_of_pixel(v, bits + 1);
  return bits;
}

static uint32_t choose_values(const tile *t)
{
  uint32_t bits = 1;
  for (uint32_t place = 0; place < TILE_PIXELS; place++) {
    visibility v = tile_visibility(t, place);
    uint32_t needed = bits_of_pixel(&v, bits);
    if (needed > bits) {
      bits = needed;
      place = UINT32_MAX;   /* once more from the first: what fewer bits tell, more need not */
    }
  }
  return bits;
}

static void translate(const tile *from, uint32_t place, tile *to)
{
  const visibility_codes *codes = &to->codes;
  visibility v = tile_visibility(from, place);
  size_t first = tile_first(from, place);
  for (uint32_t i = 0; i < v.count; i++) {
    uint64_t depth = visibility_word(&v, i) >> from->codes.depth_shift, values[3] = {0};
    if (codes->per_quantum > 0)
      depth = (uint64_t)(visibility_depth(&v, i) * codes->per_quantum);   /* exact */
    for (uint32_t c = 0; c < v.channels; c++)
      values[c] = code_of_value(visibility_stored(&v, i, c), codes->value_mask);
    tile_put_record(to, first + i, depth << codes->value_bits | values[0]);
    if (v.channels == 3)
      tile_put_record(to, first + (size_t)v.count + i, values[2] << codes->value_bits | values[1]);
  }
}

tile *tile_compact(tile *t)
{
  uint32_t last = TILE_PIXELS - 1;
  uint64_t records = (uint64_t)tile_first(t, last) + tile_records(t, last);
  uint32_t behind = t->layout & TILE_REFINED ? TILE_PIXELS : 0;
  visibility_codes codes = t->codes;
  uint32_t depth_bits = choose_depths(t, &codes), value_bits = choose_values(t);
  if (t->layout & TILE_COLOURED && depth_bits < value_bits)
    depth_bits = value_bits;
  codes_set(&codes, (depth_bits + value_bits + 7) / 8 * 8, value_bits);
  uint64_t size = codes.records + codes.record_bits / 8 * records + behind;
  tile *deltas = delta_tile_of(t, &codes, (size_t)(DELTAS_SPARE * (double)(size < t->size ? size : t->size)));
  if (deltas) {
    tile_destroy(t);
    return deltas;
  }
  tile *compact = size < t->size ? calloc(1, size) : NULL;
  if (!compact)
    return t;
  memcpy(compact, t, t->codes.records);   /* the table stays as it is */
  memcpy((char *)compact + size - behind, (const char *)t + t->size - behind, behind);
  compact->codes = codes;
  compact->size = (uint32_t)size;
  for (uint32_t place = 0; place < TILE_PIXELS; place++)
    translate(t, place, compact);
  tile_destroy(t);
  return compact;
}
