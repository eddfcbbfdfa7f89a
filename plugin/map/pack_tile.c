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

/* Counts what is left of a pixel when only the first and last of vertices at one rounded depth stay, and puts
 * it into `t` if that is not NULL. Middle ones say nothing: a step is two vertices. */
static size_t pack_pixel(const vertices *stored, const baked_pixel *p, const depth_scale *scale, uint32_t value_bits, tile *t,
                         uint32_t place)
{
  const vertex *v = stored->data + p->first;
  size_t n = 0;
  float last = 0, before = 0;   /* the depths of the last two kept */
  for (size_t i = 0; i < p->count; i++) {
    float z = rounded_depth(v[i].z, scale);
    if (n < 2 || z != last || z != before)
      n++;
    before = n > 1 ? last : z;
    last = z;
    for (uint32_t c = 0; t && c < (p->coloured ? 3u : 1u); c++)
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

/* The least power of two of which depths take no more bytes than with the largest that the rule allows; 0: a float tells no less. */
static double quantum_of(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const rounding *rule, double near_depth,
                         double range)
{
  double most = rule->quantum * (rule->perspective ? near_depth : 1), steep = 0;
  for (int i = 0; i < TILE_PIXELS; i++)
    if (pixels[i].volume)
      steep = fmax(steep, steepest(stored, &pixels[i]));
  most = fmin(most, rule->slack / steep);
  for (uint32_t bytes = 2; bytes < MOST_RECORD_BYTES; bytes++) {
    int bits = (int)(8 * bytes - rule->value_bits), exponent;
    bits = bits < MOST_CODE_BITS ? bits : MOST_CODE_BITS;
    frexp(range / (ldexp(1, bits) - 3), &exponent);   /* which is less than 2^exponent */
    if (bits > 2 && range > 0 && ldexp(1, exponent) <= most)
      return ldexp(1, exponent);
  }
  return 0;
}

/* The near depth is INFINITY if no pixel stores anything. */
static depth_scale scale_of(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const rounding *rule)
{
  depth_scale scale = {INFINITY, 0};
  double far_depth = -INFINITY;
  for (int i = 0; i < TILE_PIXELS; i++)
    if (pixels[i].count) {
      scale.near_depth = fmin(scale.near_depth, stored->data[pixels[i].first].z);
      far_depth = fmax(far_depth, stored->data[pixels[i].first + pixels[i].count - 1].z);
    }
  if (rule->quantum > 0 && scale.near_depth < INFINITY)
    scale.quantum = quantum_of(pixels, stored, rule, scale.near_depth, far_depth - scale.near_depth);
  return scale;
}

dsm_result pack_tile(baked_pixel pixels[TILE_PIXELS], const vertices *stored, const rounding *rule, const tile **out)
{
  depth_scale scale = scale_of(pixels, stored, rule);
  int marked = 0, volume = 0;
  for (int i = 0; i < TILE_PIXELS; i++) {
    marked |= pixels[i].marked || pixels[i].absent;
    volume |= pixels[i].volume;
  }
  *out = NULL;
  if (scale.near_depth == INFINITY && !marked) {
    *out = &tile_lit;
    return DSM_OK;
  }
  tile_plan plan;
  for (int i = 0; i < TILE_PIXELS; i++) {
    baked_pixel *p = &pixels[i];
    p->coloured = p->coloured && stays_coloured(stored, p, rule->value_bits);
    size_t kept = p->count ? pack_pixel(stored, p, &scale, rule->value_bits, NULL, 0) : 0;
    if (kept > UINT32_MAX)
      return DSM_NO_MEMORY;
    plan.count[i] = (uint32_t)kept;
    plan.coloured[i] = p->coloured != 0;
    plan.marked[i] = p->marked || p->absent;
    plan.need[i] = p->need;
  }
  tile *t = tile_create(&plan);
  if (!t)
    return DSM_NO_MEMORY;
  if (scale.near_depth < INFINITY) {
    t->near_depth = scale.near_depth;
    t->tolerance = tolerance_of(pixels);
  }
  t->volume = volume != 0;
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    if (pixels[i].count)
      pixels[i].count = pack_pixel(stored, &pixels[i], &scale, rule->value_bits, t, i);
  *out = tile_compact(t);
  return DSM_OK;
}
