/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "tool/function_gap.h"

/* A function read from front to back. */
typedef struct {
  const vertex *next, *end;
  double z;     /* how far it has been read */
  rgb behind;   /* the value there, behind a step */
} reader;

static double next_depth(const reader *r)
{
  return r->next < r->end ? r->next->z : INFINITY;
}

/* The value in front of a step at `z`, which is not behind the next vertex. Before its first vertex a function is 1. */
static rgb value_before(const reader *r, const vertex *first, double z)
{
  if (r->next == r->end || r->next == first || !(r->next->z > r->z))
    return r->behind;
  return rgb_lerp(r->behind, r->next->v, (z - r->z) / (r->next->z - r->z));
}

static void read_to(reader *r, const vertex *first, double z)
{
  r->behind = value_before(r, first, z);
  r->z = z;
  while (r->next < r->end && r->next->z <= z)
    r->behind = (r->next++)->v;
}

static void widen(function_gap *gap, rgb difference)
{
  for (int c = 0; c < 3; c++)
    gap->largest = fmax(gap->largest, fabs(difference.c[c]));
}

/* A vertex in front of near_depth or behind far_depth widens the gap, but not the integral. */
function_gap function_gap_of(const vertex *a, size_t a_count, const vertex *b, size_t b_count, double near_depth,
                             double far_depth)
{
  function_gap gap = {0, 0};
  reader ra = {a, a + a_count, -INFINITY, rgb_grey(1)}, rb = {b, b + b_count, -INFINITY, rgb_grey(1)};
  for (;;) {
    double from = fmax(near_depth, ra.z), to = fmin(next_depth(&ra), next_depth(&rb));
    rgb start = rgb_sub(ra.behind, rb.behind), end = start;
    widen(&gap, start);
    if (to < INFINITY)
      end = rgb_sub(value_before(&ra, a, to), value_before(&rb, b, to));
    widen(&gap, end);
    double length = fmin(to, far_depth) - from;
    if (length > 0) {
      if (to < INFINITY && to > ra.z && ra.z > -INFINITY) {   /* cut to the range of depths */
        rgb whole_start = start, whole_end = end;
        start = rgb_lerp(whole_start, whole_end, (from - ra.z) / (to - ra.z));
        end = rgb_lerp(whole_start, whole_end, (from + length - ra.z) / (to - ra.z));
      }
      for (int c = 0; c < 3; c++)
        gap.squares += length * (start.c[c] * start.c[c] + start.c[c] * end.c[c] + end.c[c] * end.c[c]) / 9;
    }
    if (to == INFINITY)
      return gap;
    read_to(&ra, a, to);
    read_to(&rb, b, to);
  }
}
