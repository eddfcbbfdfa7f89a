/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/compact_tile.h"

/* Look-ups take longer in deltas, so these have to take fewer bytes than this share of what absolute records take. */
static const double DELTAS_SPARE = 0.8;

/* The second records of coloured pixels have a value in place of the depth. */
static uint32_t record_bits(const coded_tile *t)
{
  uint32_t depth_bits = t->depth_bits;
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    if (t->plan.coloured[i] && depth_bits < t->value_bits)
      depth_bits = t->value_bits;
  return (depth_bits + t->value_bits + 7) / 8 * 8;
}

int compact_as_deltas(const coded_tile *t, delta_plan *plan)
{
  return delta_tile_plan(t, (uint64_t)(DELTAS_SPARE * (double)tile_bytes(&t->plan, record_bits(t), 0)), plan);
}

static unsigned char *put(unsigned char *to, uint64_t record, uint32_t bytes)
{
  for (; bytes > 0; bytes--, record >>= 8)
    *to++ = (unsigned char)record;
  return to;
}

tile *absolute_tile(const coded_tile *from)
{
  uint32_t bits = record_bits(from), value_bits = from->value_bits;
  tile *t = coded_tile_lay_out(from, &from->plan, bits, 0);
  if (!t)
    return NULL;
  codes_set(&t->codes, bits, value_bits);
  unsigned char *to = (unsigned char *)t + t->codes.records;
  const coded_vertex *v = from->vertices;
  for (uint32_t place = 0; place < TILE_PIXELS; place++) {
    const coded_vertex *end = v + from->plan.count[place];
    for (const coded_vertex *k = v; k < end; k++)
      to = put(to, (uint64_t)k->depth << value_bits | k->value[0], bits / 8);
    for (const coded_vertex *k = v; k < end && from->plan.coloured[place]; k++)
      to = put(to, (uint64_t)k->value[2] << value_bits | k->value[1], bits / 8);
    v = end;
  }
  return t;
}
