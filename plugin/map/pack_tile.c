/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/pack_tile.h"

#include <math.h>

#include "map/compact_tile.h"

/* Where depths of a tile count from, and in what; quantum 0: in floats. */
typedef struct { double near_depth, quantum; } depth_scale;

static uint16_t rounded(double value, uint32_t bits)
{
  uint32_t most = (1u << bits) - 1, code = (uint32_t)(fmin(1, fmax(0, value)) * most + 0.5);
  return (uint16_t)value_of_code(code, most);
}

static float rounded_depth(double z, const depth_scale *scale)
{
  double relative = z - scale->near_depth;
  return (float)(scale->quantum > 0 ? ceil(relative / scale->quantum) * scale->quantum : relative);
}

static int is_one(const vertex *v, int channels, uint32_t value_bits)
{
  int ones = 0;
  for (int c = 0; c < channels; c++)
    ones += rounded(v->v.c[c], value_bits) == VALUE_STEPS;
  return ones == channels;
}

/* Counts what is left of a pixel when only the first and last of vertices at one rounded depth stay, and puts
 * it into `t` if that is not NULL. Middle ones say nothing, as a step is two vertices; nor does 1 in front of the first step. */
static size_t pack_pixel(const vertices *stored, const baked_pixel *p, const depth_scale *scale, uint32_t value_bits, tile *t,
                         uint32_t place)
{
  const vertex *v = stored->data + p->first;
  int channels = p->coloured ? 3 : 1, only_one = 0;
  size_t n = 0;
  float last = 0, before = 0;   /* the depths of the last two kept */
  for (size_t i = 0; i < p->count; i++) {
    float z = rounded_depth(v[i].z, scale);
    if (n < 2 ? !(only_one && z == last) : z != last || z != before)
      n++;
    before = n > 1 ? last : z;
    last = z;
    only_one = n == 1 && is_one(&v[i], channels, value_bits);
    for (uint32_t c = 0; t && c < (uint32_t)channels; c++)
      tile_put(t, place, (uint32_t)n - 1, c, z, rounded(v[i].v.c[c], value_bits));
  }
  return n;
}

static int stays_coloured(const vertices *stored, const baked_pixel *p, uint32_t value_bits)
{
  for (size_t i = p->first; i < p->first + p->count; i++) {
    const double *c = stored->data[i].v.c;
    uint16_t red = rounded(c[0], value_bits);
    if (red != rounded(c[1], value_bits) || red != rounded(c[2], value_bits))
      return 1;
  }
  return 0;
}

/* Root mean square over the pixels that store anything. */
static float tolerance_of(const baked_pixel pixels[TILE_PIXELS])
{
  double squares = 0;
  int stored = 0;
  for (int i = 0; i < TILE_PIXELS; i++)
    if (pixels[i].count) {
      squares += pixels[i].tolerance * pixels[i].tolerance;
      stored++;
    }
  return stored ? (float)sqrt(squares / stored) : 0;
}

/* The fastest fall of visibility, a scene unit, but for steps. */
static double steepest(const vertices *stored, const baked_pixel *p)
{
  double most = 0;
  for (size_t i = p->first + 1; i < p->first + p->count; i++) {
    const vertex *a = &stored->data[i - 1], *b = &stored->data[i];
    for (int c = 0; b->z > a->z && c < (p->coloured ? 3 : 1); c++)
      most = fmax(most, (a->v.c[c] - b->v.c[c]) / (b->z - a->z));
  }
  return most;
}

/* Largest quantum that the rule allows. */
static double most_of(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const rounding *rule, double near_depth)
{
  double most = rule->quantum * (rule->perspective ? near_depth : 1), steep = 0;
  for (int i = 0; i < TILE_PIXELS; i++)
    if (pixels[i].volume)
      steep = fmax(steep, steepest(stored, &pixels[i]));
  return fmin(most, rule->slack / steep);
}

/* The least power of two of which depths take no more bytes in absolute records than with the largest quantum; 0: a float tells no less. */
static double least_quantum(double most, uint32_t value_bits, double range)
{
  for (uint32_t bits_taken = 16; bits_taken < MOST_RECORD_BITS; bits_taken += 8) {
    int bits = (int)(bits_taken - value_bits), exponent;
    bits = bits < MOST_CODE_BITS ? bits : MOST_CODE_BITS;
    frexp(range / (ldexp(1, bits) - 3), &exponent);   /* which is less than 2^exponent */
    if (bits > 2 && range > 0 && ldexp(1, exponent) <= most)
      return ldexp(1, exponent);
  }
  return 0;
}

/* Where the nearest and the farthest vertex are; INFINITY, -INFINITY if no pixel stores anything. */
static void ends_of(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, double *near_depth, double *far_depth)
{
  *near_depth = INFINITY;
  *far_depth = -INFINITY;
  for (int i = 0; i < TILE_PIXELS; i++)
    if (pixels[i].count) {
      *near_depth = fmin(*near_depth, stored->data[pixels[i].first].z);
      *far_depth = fmax(*far_depth, stored->data[pixels[i].first + pixels[i].count - 1].z);
    }
}

/* A new compact tile whose depths have this scale; NULL: no memory. */
static tile *pack_at(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const depth_scale *scale, uint32_t value_bits,
                     tile_plan *plan)
{
  int volume = 0;
  for (int i = 0; i < TILE_PIXELS; i++) {
    const baked_pixel *p = &pixels[i];
    size_t kept = p->count ? pack_pixel(stored, p, scale, value_bits, NULL, 0) : 0;
    if (kept > UINT32_MAX)
      return NULL;
    plan->count[i] = (uint32_t)kept;
    volume |= p->volume;
  }
  tile *t = tile_create(plan);
  if (!t)
    return NULL;
  if (scale->near_depth < INFINITY) {
    t->near_depth = scale->near_depth;
    t->tolerance = tolerance_of(pixels);
  }
  t->volume = volume != 0;
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    if (pixels[i].count)
      pack_pixel(stored, &pixels[i], scale, value_bits, t, i);
  return tile_compact(t);
}

/* With the largest quantum if that makes it a tile of deltas; in absolute records, finer ones cost nothing. Where values are told as well
 * as can be, as a tolerance is asked for that is finer than the rays tell, depths are, too, as far as that costs nothing. */
static tile *pack_best(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const rounding *rule, tile_plan *plan)
{
  depth_scale scale = {INFINITY, 0};
  double far_depth, most, least;
  ends_of(pixels, stored, &scale.near_depth, &far_depth);
  if (!(rule->quantum > 0 && scale.near_depth < INFINITY))
    return pack_at(pixels, stored, &scale, rule->value_bits, plan);
  most = most_of(pixels, stored, rule, scale.near_depth);
  least = least_quantum(most, rule->value_bits, far_depth - scale.near_depth);
  scale.quantum = most > 0 && rule->value_bits < VALUE_BITS ? ldexp(1, ilogb(most)) : least;
  tile *t = pack_at(pixels, stored, &scale, rule->value_bits, plan);
  if (!t || scale.quantum == least || codes_are_deltas(&t->codes))
    return t;
  tile_destroy(t);
  scale.quantum = least;
  return pack_at(pixels, stored, &scale, rule->value_bits, plan);
}

dsm_result pack_tile(baked_pixel pixels[TILE_PIXELS], const vertices *stored, const rounding *rule, const tile **out)
{
  tile_plan plan;
  int stored_or_marked = 0;
  *out = NULL;
  for (int i = 0; i < TILE_PIXELS; i++) {
    baked_pixel *p = &pixels[i];
    p->coloured = p->coloured && stays_coloured(stored, p, rule->value_bits);
    plan.coloured[i] = p->coloured != 0;
    plan.marked[i] = p->marked || p->absent;
    plan.need[i] = p->need;
    stored_or_marked |= p->count || plan.marked[i];
  }
  if (!stored_or_marked) {
    *out = &tile_lit;
    return DSM_OK;
  }
  *out = pack_best(pixels, stored, rule, &plan);
  if (!*out)
    return DSM_NO_MEMORY;
  for (int i = 0; i < TILE_PIXELS; i++)
    pixels[i].count = plan.count[i];
  return DSM_OK;
}
