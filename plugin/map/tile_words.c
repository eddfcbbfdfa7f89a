/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/tile_words.h"

#include <math.h>
#include <string.h>

#include "map/check_tile.h"

enum { HEADER = 2, BITMAP = TILE_PIXELS / 32, QUANTUM_BIAS = 150 };   /* no float has a bit below 2^-149 */

/* Where the parts are, in words. */
typedef struct { size_t counts, coloured, marked, need, records; } places;

static places places_of(uint32_t layout)
{
  places at = {.counts = HEADER};
  at.coloured = at.counts + (layout & TILE_WIDE ? TILE_PIXELS : TILE_PIXELS / 4);
  at.marked = at.coloured + (layout & TILE_COLOURED ? BITMAP : 0);
  at.need = at.marked + (layout & TILE_MARKED ? BITMAP : 0);
  at.records = at.need + (layout & TILE_REFINED ? TILE_PIXELS / 4 : 0);
  return at;
}

static uint64_t bits_of_records(const tile *t)
{
  return ((uint64_t)tile_first(t, TILE_PIXELS - 1) + tile_records(t, TILE_PIXELS - 1)) * t->codes.record_bits;
}

static size_t words_for(uint64_t bits)
{
  return (size_t)((bits + 31) / 32);
}

/* ---- Writing ---------------------------------------------------------------------------------------------------- */

size_t tile_words_count(const tile *t)
{
  return places_of(t->layout).records + words_for(bits_of_records(t));
}

static void set_bit(uint32_t *bitmap, uint32_t place, int value)
{
  bitmap[place / 32] |= (uint32_t)(value != 0) << place % 32;
}

static uint32_t exponent_of_quantum(const visibility_codes *codes)
{
  return codes_are_whole(codes) ? (uint32_t)(QUANTUM_BIAS - ilogb(codes->per_quantum)) : 0;
}

void tile_to_words(const tile *t, uint32_t *words)
{
  const visibility_codes *codes = &t->codes;
  places at = places_of(t->layout);
  uint64_t bits = bits_of_records(t);
  memset(words, 0, (at.records + words_for(bits)) * sizeof *words);
  words[0] = (uint32_t)t->layout | (uint32_t)codes->record_bits << 8 | (uint32_t)codes->value_bits << 16
           | (codes_are_deltas(codes) ? (uint32_t)codes->value_shift << 24 : 0);
  words[1] = exponent_of_quantum(codes);
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    if (t->layout & TILE_WIDE)
      words[at.counts + i] = tile_records(t, i);
    else
      words[at.counts + i / 4] |= tile_records(t, i) << i % 4 * 8;
    if (t->layout & TILE_COLOURED)
      set_bit(words + at.coloured, i, tile_is_coloured(t, i));
    if (t->layout & TILE_MARKED)
      set_bit(words + at.marked, i, tile_is_marked(t, i));
    if (t->layout & TILE_REFINED)
      words[at.need + i / 4] |= tile_need_at(t, i) << i % 4 * 8;
  }
  memcpy(words + at.records, codes_records(codes), (size_t)((bits + 7) / 8));
}

/* ---- Reading ---------------------------------------------------------------------------------------------------- */

static int bit(const uint32_t *bitmap, uint32_t place)
{
  return bitmap[place / 32] >> place % 32 & 1;
}

static uint32_t byte(const uint32_t *bytes, uint32_t place)
{
  return bytes[place / 4] >> place % 4 * 8 & 255;
}

/* What the first words say. 0: no tile has such codes. */
static int read_codes(const uint32_t *words, visibility_codes *codes)
{
  uint32_t record_bits = words[0] >> 8 & 255, value_bits = words[0] >> 16 & 255, depth_bits = words[0] >> 24, quantum = words[1];
  *codes = (visibility_codes){0};
  if (value_bits < 1 || value_bits > VALUE_BITS || quantum > LARGEST_QUANTUM + QUANTUM_BIAS)
    return 0;
  codes->per_quantum = quantum ? ldexp(1, QUANTUM_BIAS - (int)quantum) : 0;
  if (depth_bits) {
    codes_set_deltas(codes, record_bits, depth_bits, value_bits);
    return deltas_are_possible(codes);
  }
  if (record_bits <= value_bits || record_bits > MOST_RECORD_BITS)
    return 0;
  codes_set(codes, record_bits, value_bits);
  return records_are_possible(codes);
}

/* What pixels there are, and how many records all of them have; 0: a coloured one has half a vertex. */
static int read_plan(const uint32_t *words, const places *at, uint32_t layout, tile_plan *plan, uint64_t *records)
{
  *records = 0;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    uint32_t count = layout & TILE_WIDE ? words[at->counts + i] : byte(words + at->counts, i);
    plan->coloured[i] = layout & TILE_COLOURED && bit(words + at->coloured, i);
    plan->marked[i] = layout & TILE_MARKED && bit(words + at->marked, i);
    plan->need[i] = (unsigned char)(layout & TILE_REFINED ? byte(words + at->need, i) : 0);
    if (plan->coloured[i] && count % 2)
      return 0;
    plan->count[i] = plan->coloured[i] ? count / 2 : count;
    *records += count;
  }
  return 1;
}

static int rest_is_zeros(const uint32_t *records, uint64_t bits)
{
  return bits % 32 == 0 || records[bits / 32] >> bits % 32 == 0;
}

dsm_result tile_from_words(const uint32_t *words, size_t count, double near_depth, float tolerance, const tile **out)
{
  tile_plan plan;
  visibility_codes codes;
  uint64_t records;
  *out = NULL;
  if (count < HEADER || !read_codes(words, &codes))
    return DSM_REFUSED;
  uint32_t layout = words[0] & 255;
  places at = places_of(layout);
  if (count < at.records || !read_plan(words, &at, layout, &plan, &records))
    return DSM_REFUSED;
  uint64_t bits = records * codes.record_bits;
  if (count - at.records != (bits + 31) / 32 || !rest_is_zeros(words + at.records, bits))
    return DSM_REFUSED;
  tile *t = tile_create_empty(&plan, codes.record_bits, codes_are_deltas(&codes) ? DELTA_PADDING : 0);
  if (!t)
    return DSM_NO_MEMORY;
  codes.records = t->codes.records;
  t->codes = codes;
  t->near_depth = near_depth;
  t->tolerance = tolerance;
  memcpy((char *)t + codes.records, words + at.records, (size_t)((bits + 7) / 8));
  if (t->layout != layout || !tile_is_sound(t)) {   /* each part only where it is needed: one way to say a tile */
    tile_destroy(t);
    return DSM_REFUSED;
  }
  *out = t;
  return DSM_OK;
}
