/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/pack_tile.h"

#include <math.h>
#include <stdlib.h>

#include "map/compact_tile.h"
#include "map/round_tile.h"

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

/* With the largest quantum if that makes it a tile of deltas; in absolute records, finer ones cost nothing. Where values are told as well
 * as can be, as a tolerance is asked for that is finer than the rays tell, depths are, too, as far as that costs nothing. */
static tile *pack_best(const baked_pixel pixels[TILE_PIXELS], const vertices *stored, const rounding *rule, coded_tile *coded)
{
  depth_scale scale = {INFINITY, 0};
  double far_depth, most = 0, least = 0;
  delta_plan deltas;
  ends_of(pixels, stored, &scale.near_depth, &far_depth);
  if (rule->quantum > 0 && scale.near_depth < INFINITY) {
    most = most_of(pixels, stored, rule, scale.near_depth);
    least = least_quantum(most, rule->value_bits, far_depth - scale.near_depth);
  }
  scale.quantum = most > 0 && rule->value_bits < VALUE_BITS ? ldexp(1, ilogb(most)) : least;
  if (scale.near_depth < INFINITY) {
    coded->near_depth = scale.near_depth;
    coded->tolerance = tolerance_of(pixels);
  }
  for (;; scale.quantum = least) {
    round_tile(pixels, stored, &scale, rule->value_bits, coded);
    coded_tile_shorten(coded);
    if (compact_as_deltas(coded, &deltas))
      return delta_tile(coded, &deltas);
    if (scale.quantum == least)
      return absolute_tile(coded);
  }
}

dsm_result pack_tile(baked_pixel pixels[TILE_PIXELS], const vertices *stored, const rounding *rule, const tile **out)
{
  coded_tile coded = {.count = 0};
  size_t room = 0;
  int told = 0;   /* something else than vertices */
  *out = NULL;
  for (int i = 0; i < TILE_PIXELS; i++) {
    const baked_pixel *p = &pixels[i];
    coded.plan.marked[i] = p->marked || p->absent;
    coded.plan.need[i] = p->need;
    coded.volume |= p->volume != 0;
    told |= coded.plan.marked[i] || p->need;
    room += p->count;
  }
  if (!room && !told) {
    *out = &tile_lit;
    return DSM_OK;
  }
  coded.vertices = room < UINT32_MAX ? malloc((room + 1) * sizeof *coded.vertices) : NULL;
  if (coded.vertices)
    *out = pack_best(pixels, stored, rule, &coded);
  free(coded.vertices);
  if (!*out)
    return DSM_NO_MEMORY;
  for (int i = 0; i < TILE_PIXELS; i++) {
    pixels[i].count = coded.plan.count[i];
    pixels[i].coloured = coded.plan.coloured[i];
  }
  return DSM_OK;
}
