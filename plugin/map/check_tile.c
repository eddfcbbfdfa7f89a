/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/check_tile.h"

#include "map/delta_tile.h"

enum { LARGEST_FLOAT = 0x7F7FFFFF };   /* as bits: of floats >= 0 the larger one has the larger bits */

int records_are_possible(const visibility_codes *codes)
{
  uint32_t bits = codes->record_bits, depth_bits = bits - codes->value_bits;
  if (bits % 8)
    return 0;
  return codes_are_whole(codes) ? bits <= MOST_CODE_BITS + VALUE_BITS : depth_bits >= FLOAT_BITS;
}

int deltas_are_possible(const visibility_codes *codes)
{
  uint32_t bits = codes->record_bits, depth_bits = codes->value_shift;
  return codes_are_whole(codes) && bits <= MOST_DELTA_BITS && depth_bits >= LEAST_DEEPER_BITS && depth_bits + LEAST_FALL_BITS <= bits;
}

/* The least code behind all depths, of absolute records. */
static uint64_t end_of_depths(const visibility_codes *codes)
{
  uint64_t left_over = ~0ull >> codes->depth_shift;
  if (!codes_are_whole(codes))
    return (uint64_t)LARGEST_FLOAT + 1;
  return left_over <= MOST_DEPTH_CODE ? left_over : (uint64_t)MOST_DEPTH_CODE + 1;
}

/* Depths do not fall, and values do not grow. */
static int grey_is_sound(const visibility *v, uint64_t end)
{
  const visibility_codes *codes = v->codes;
  uint64_t depth = 0;
  uint32_t value = codes->value_mask;
  for (uint32_t i = 0; i < v->count; i++) {
    uint64_t word = visibility_word(v, i), deeper = word >> codes->depth_shift;
    uint32_t darker = codes_value(codes, word);
    if (deeper < depth || deeper >= end || darker > value)
      return 0;
    depth = deeper;
    value = darker;
  }
  return 1;
}

/* Nor do those of the other channels, which differ from the first one somewhere. */
static int colours_are_sound(const visibility *v)
{
  const visibility_codes *codes = v->codes;
  uint32_t second = codes->value_mask;
  uint64_t third = codes->value_mask;
  int differ = 0;
  for (uint32_t i = 0; i < v->count; i++) {
    uint64_t word = visibility_word(v, v->count + (size_t)i);
    uint32_t first = codes_value(codes, visibility_word(v, i));
    if (codes_value(codes, word) > second || word >> codes->depth_shift > third)
      return 0;
    second = codes_value(codes, word);
    third = word >> codes->depth_shift;
    differ |= first != second || second != third;
  }
  return differ;
}

/* A pixel of deltas: only the last vertex can be too deep or too dark, as both numbers only grow. Every record says something, and the last
 * one is a vertex, or the start. */
static int deltas_are_sound(const visibility_codes *codes, const delta_word_shape *s, uint32_t first, uint32_t count)
{
  uint32_t one = (1u << s->bits) - 1, all = (1u << s->depth_bits) - 1, at = first * s->bits, end = at + count * s->bits;
  uint32_t start = (uint32_t)delta_word(s->records, at) & one;
  uint64_t depth = start >> 1, fall = 0;
  int is_vertex = 1;
  at += s->bits;
  if (start & 1) {
    uint64_t more = at < end ? delta_word(s->records, at) & one : 0;
    if (more == 0)
      return 0;
    depth |= more << (s->bits - 1);
    at += s->bits;
  }
  for (; at < end; at += s->bits) {
    uint32_t record = (uint32_t)delta_word(s->records, at) & one, deeper = record & all, rest = record >> s->depth_bits;
    is_vertex = deeper != all;
    if (!is_vertex && rest < 2)
      return 0;
    depth += is_vertex ? deeper : rest & 1 ? 0 : (uint64_t)(rest >> 1) * all;
    fall += is_vertex ? rest : rest & 1 ? (uint64_t)(rest >> 1) << (s->bits - s->depth_bits) : 0;
  }
  return is_vertex && depth <= MOST_DEPTH_CODE && fall <= codes->value_mask;
}

static int tile_of_deltas_is_sound(const tile *t)
{
  delta_word_shape s = delta_shape_of(&t->codes);
  if (t->layout & TILE_COLOURED)
    return 0;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    uint32_t count = tile_records(t, i);
    if (count > MOST_DELTAS || (count && !deltas_are_sound(&t->codes, &s, tile_first(t, i), count)))
      return 0;
  }
  return 1;
}

static int tile_of_depths_and_values_is_sound(const tile *t)
{
  const visibility_codes *codes = &t->codes;
  if (t->layout & TILE_COLOURED && codes->record_bits < 2 * codes->value_bits)
    return 0;
  uint64_t end = end_of_depths(codes);
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    visibility v = tile_visibility(t, i);
    if (!grey_is_sound(&v, end) || (v.channels == 3 && !colours_are_sound(&v)))
      return 0;
  }
  return 1;
}

int tile_is_sound(const tile *t)
{
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    if (tile_is_marked(t, i) && tile_records(t, i) > 0)
      return 0;
  return codes_are_deltas(&t->codes) ? tile_of_deltas_is_sound(t) : tile_of_depths_and_values_is_sound(t);
}
