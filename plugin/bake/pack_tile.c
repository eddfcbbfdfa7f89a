/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/pack_tile.h"

#include <math.h>

/* Half a step of a float is 2^-25 to 2^-24 of its size; four times that keeps a receiver in front of its own
 * step. */
static const double DEPTH_ROUNDING = 0x1p-22;

/* Counts what is left of a pixel when only the first and last of vertices at one float depth stay, and copies
 * it if `depth` is not NULL. Middle ones say nothing: a step is two vertices. */
static size_t pack_pixel(const vertex *v, size_t count, int channels, double near_depth, float *depth,
                         float *value)
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
        value[(n - 1) * channels + c] = (float)v[i].v.c[c];
    }
  }
  return n;
}

dsm_result pack_tile(baked_pixel pixels[TILE_PIXELS], const vertices *stored, const tile **out)
{
  double near_depth = INFINITY, far_depth = -INFINITY;
  int marked = 0;
  for (int i = 0; i < TILE_PIXELS; i++) {
    const baked_pixel *p = &pixels[i];
    marked |= p->marked;
    if (p->count) {
      near_depth = fmin(near_depth, stored->data[p->first].z);
      far_depth = fmax(far_depth, stored->data[p->first + p->count - 1].z);
    }
  }
  *out = NULL;
  if (!(near_depth <= far_depth) && !marked) {
    *out = &tile_lit;
    return DSM_OK;
  }
  size_t kept[TILE_PIXELS], floats = 0;
  for (int i = 0; i < TILE_PIXELS; i++) {
    const baked_pixel *p = &pixels[i];
    kept[i] = pack_pixel(p->count ? stored->data + p->first : NULL, p->count, 0, near_depth, NULL, NULL);
    if (kept[i] > PIXEL_COUNT)
      return DSM_NO_MEMORY;
    floats += kept[i] * (p->coloured ? 4 : 2);
  }
  if (floats > UINT32_MAX)
    return DSM_NO_MEMORY;
  tile *t = tile_create((uint32_t)floats);
  if (!t)
    return DSM_NO_MEMORY;
  if (near_depth <= far_depth) {
    t->near_depth = near_depth;
    t->depth_rounding = DEPTH_ROUNDING * (far_depth - near_depth);
  }
  tile_pixel *pixel = (tile_pixel *)(void *)(t + 1);
  float *data = (float *)(void *)(pixel + TILE_PIXELS);
  uint32_t at = 0;
  for (int i = 0; i < TILE_PIXELS; i++) {
    baked_pixel *p = &pixels[i];
    int channels = p->coloured ? 3 : 1;
    pixel[i].start = at;
    pixel[i].word = p->marked ? PIXEL_MARKED : (uint32_t)kept[i];
    if (kept[i] && p->coloured)
      pixel[i].word |= PIXEL_COLOURED;
    if (kept[i])
      pack_pixel(stored->data + p->first, p->count, channels, near_depth, data + at, data + at + kept[i]);
    p->count = kept[i];
    at += (uint32_t)kept[i] * (channels + 1);
  }
  *out = t;
  return DSM_OK;
}
