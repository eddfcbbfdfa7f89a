/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/pack_tile.h"

#include <math.h>

static uint16_t rounded(double value)
{
  return (uint16_t)(fmin(1, fmax(0, value)) * VALUE_STEPS + 0.5);
}

/* Counts what is left of a pixel when only the first and last of vertices at one float depth stay, and copies
 * it if `depth` is not NULL. Middle ones say nothing: a step is two vertices. */
static size_t pack_pixel(const vertex *v, size_t count, int channels, double near_depth, float *depth,
                         uint16_t *value)
{
  size_t n = 0;
  float last = 0, before = 0;   /* the depths of the last two kept */
  for (size_t i = 0; i < count; i++) {
    float z = (float)(v[i].z - near_depth);
    if (n < 2 || z != last || z != before)
      n++;
    before = n > 1 ? last : z;
    last = z;
    if (depth) {
      depth[n - 1] = z;
      for (int c = 0; c < channels; c++)
        value[(n - 1) * channels + c] = rounded(v[i].v.c[c]);
    }
  }
  return n;
}

static int stays_coloured(const vertex *v, size_t count)
{
  for (size_t i = 0; i < count; i++)
    if (rounded(v[i].v.c[0]) != rounded(v[i].v.c[1]) || rounded(v[i].v.c[1]) != rounded(v[i].v.c[2]))
      return 1;
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

dsm_result pack_tile(baked_pixel pixels[TILE_PIXELS], const vertices *stored, const tile **out)
{
  double near_depth = INFINITY;
  int marked = 0;
  for (int i = 0; i < TILE_PIXELS; i++) {
    const baked_pixel *p = &pixels[i];
    marked |= p->marked || p->absent;
    if (p->count)
      near_depth = fmin(near_depth, stored->data[p->first].z);
  }
  *out = NULL;
  if (near_depth == INFINITY && !marked) {
    *out = &tile_lit;
    return DSM_OK;
  }
  tile_plan plan;
  for (int i = 0; i < TILE_PIXELS; i++) {
    baked_pixel *p = &pixels[i];
    const vertex *v = p->count ? stored->data + p->first : NULL;
    size_t kept = pack_pixel(v, p->count, 0, near_depth, NULL, NULL);
    if (kept > UINT32_MAX)
      return DSM_NO_MEMORY;
    p->coloured = p->coloured && stays_coloured(v, p->count);
    plan.count[i] = (uint32_t)kept;
    plan.coloured[i] = p->coloured != 0;
    plan.marked[i] = p->marked || p->absent;
    plan.need[i] = p->need;
  }
  tile *t = tile_create(&plan);
  if (!t)
    return DSM_NO_MEMORY;
  if (near_depth < INFINITY) {
    t->near_depth = near_depth;
    t->tolerance = tolerance_of(pixels);
  }
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    baked_pixel *p = &pixels[i];
    if (p->count)
      p->count = pack_pixel(stored->data + p->first, p->count, p->coloured ? 3 : 1, near_depth, tile_depths(t, i),
                            tile_values(t, i));
  }
  *out = t;
  return DSM_OK;
}
