/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A pixel's stored visibility function and its evaluation (LV 3.4). The inner loop of every look-up. */
#ifndef DSM_CORE_VISIBILITY_H
#define DSM_CORE_VISIBILITY_H

#include <stddef.h>
#include <stdint.h>

#include "core/rgb.h"

/* A stored value is this many times the visibility, a whole number; rounding takes up to VALUE_ROUNDING of it. */
#define VALUE_STEPS 65535
#define VALUE_ROUNDING (0.5 / VALUE_STEPS)

/* As in vertices.h, with float depths relative to the tile's near depth. */
typedef struct {
  const float *depth;      /* `count` of them, never falling */
  const uint16_t *value;   /* `channels` for each vertex */
  uint32_t count;
  uint32_t channels;    /* 1 or 3 */
} visibility;

/* Where a depth lies in a function: between vertices a and b, at the share t of the way. */
typedef struct { uint32_t a, b; double t; } visibility_place;

/* The smallest float that is not below z > 0: a float lies in front of one if it lies in front of the other, and
 * the search need not convert what it compares. */
static inline float visibility_depth(double z)
{
  union { float value; uint32_t bits; } f = {(float)z};
  f.bits += (double)f.value < z;
  return f.value;
}

/* The first index whose depth is not in front of z, `count` if there is none. Neighbouring look-ups mostly end where the
 * last one did (LV 3.4); else a binary search without branches, as none of them could be predicted. */
static inline uint32_t visibility_search(const float *depth, uint32_t count, float z, uint32_t start)
{
  if (start - 1 < count && depth[start - 1] < z && (start == count || !(depth[start] < z)))
    return start;
  const float *from = depth;
  uint32_t n = count;
  while (n > 1) {
    uint32_t half = n / 2;
    from += -(uint32_t)(from[half - 1] < z) & half;
    n -= half;
  }
  return (uint32_t)(from - depth) + (*from < z);
}

/* Finds relative depth z in a function that has vertices; at a step, the place in front of it. 0: in front of all
 * vertices, where the value is 1. `hint` is where the caller's last search in this pixel ended, any number at first; the
 * search starts there and leaves its end there. */
static inline int visibility_find(const visibility *function, double z, uint32_t *hint, visibility_place *place)
{
  const float *depth = function->depth;
  if (!(z > (double)depth[0])) {
    *hint = 0;
    return 0;
  }
  uint32_t i = visibility_search(depth, function->count, visibility_depth(z), *hint);
  *hint = i;

  /* Behind the last vertex both ends are that vertex, and a zero width never divides. */
  place->a = i - 1;
  place->b = i < function->count ? i : i - 1;
  double front = (double)depth[place->a], width = (double)depth[place->b] - front;
  place->t = width > 0 ? (z - front) / width : 1;
  return 1;
}

static inline double visibility_value(const visibility *function, const visibility_place *place, uint32_t channel)
{
  double a = function->value[place->a * function->channels + channel];
  double b = function->value[place->b * function->channels + channel];
  return (1.0 / VALUE_STEPS) * (a + place->t * (b - a));
}

/* The value at relative depth z, of any function. */
rgb visibility_at(const visibility *function, double z, uint32_t *hint);

#endif
