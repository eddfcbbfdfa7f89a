/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/round_tile.h"

#include "core/extremes.h"

static uint16_t rounded(double value, uint32_t one)
{
  return (uint16_t)(lesser(1, greater(value, 0)) * one + 0.5);
}

/* Up to a multiple of the quantum, then as the bits of a float. */
static uint32_t rounded_depth(double relative, double quantum)
{
  double units = quantum > 0 ? relative / quantum : 0x1p52;
  if (units < 0x1p52) {   /* else it is whole */
    double whole = (double)(int64_t)units;
    relative = (whole + (whole < units)) * quantum;
  }
  union { float value; uint32_t bits; } f = {(float)relative};
  return f.bits;
}

static int is_one(const coded_vertex *v, int channels, uint32_t one)
{
  int ones = 0;
  for (int c = 0; c < channels; c++)
    ones += v->value[c] == one;
  return ones == channels;
}

/* Of the vertices at one rounded depth only the first and the last stay. Middle ones say nothing, as a step is two vertices; nor does 1 in
 * front of the first step. Returns how many are left. */
static uint32_t round_pixel(const vertex *v, size_t count, int channels, const depth_scale *scale, uint32_t one, coded_vertex *to)
{
  uint32_t n = 0;
  for (const vertex *end = v + count; v < end; v++) {
    uint32_t depth = rounded_depth(v->z - scale->near_depth, scale->quantum);
    int coincides = n == 0 ? 0 : n == 1 ? depth == to[0].depth && is_one(&to[0], channels, one)
                                        : depth == to[n - 1].depth && depth == to[n - 2].depth;
    coded_vertex *k = &to[n - (uint32_t)coincides];
    n += !coincides;
    k->depth = depth;
    for (int c = 0; c < channels; c++)
      k->value[c] = rounded(v->v.c[c], one);
  }
  return n;
}

static int has_colour(const coded_vertex *v, uint32_t count)
{
  for (const coded_vertex *end = v + count; v < end; v++)
    if (v->value[0] != v->value[1] || v->value[0] != v->value[2])
      return 1;
  return 0;
}

void round_tile(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const depth_scale *scale, uint32_t value_bits,
                coded_tile *t)
{
  coded_vertex *to = t->vertices;
  uint32_t one = (1u << value_bits) - 1;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    const baked_pixel *p = &pixels[i];
    uint32_t kept = p->count ? round_pixel(stored->data + p->first, p->count, p->coloured ? 3 : 1, scale, one, to) : 0;
    t->plan.count[i] = kept;
    t->plan.coloured[i] = p->coloured && has_colour(to, kept);
    to += kept;
  }
  t->count = (uint32_t)(to - t->vertices);
  t->per_quantum = 0;
  t->depth_bits = FLOAT_BITS;
  t->value_bits = value_bits;
}
