/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/visibility.h"

/* The first index whose depth is not in front of z, `count` if there is none. Neighbouring look-ups end near
 * each other (LV 3.4), so the search doubles its stride away from `start` and only then halves what it has
 * enclosed: two comparisons when the start is right, 2 log d when it is d vertices off. */
static uint32_t search(const float *depth, uint32_t count, double z, uint32_t start) {
  uint32_t low = 0, high = count, stride = 1;   /* depth[low - 1] < z <= depth[high], where these exist */
  if (start > count) start = count;
  if (start < count && (double)depth[start] < z) {
    low = start + 1;
    while (stride <= count - low) {
      uint32_t probe = low + stride - 1;
      if (!((double)depth[probe] < z)) {
        high = probe;
        break;
      }
      low = probe + 1;
      stride += stride;
    }
  } else {
    high = start;
    while (stride <= high) {
      uint32_t probe = high - stride;
      if ((double)depth[probe] < z) {
        low = probe + 1;
        break;
      }
      high = probe;
      stride += stride;
    }
  }
  while (low < high) {
    uint32_t middle = low + (high - low) / 2;
    if ((double)depth[middle] < z) low = middle + 1;
    else high = middle;
  }
  return low;
}

rgb visibility_at(const visibility *function, double z, uint32_t *hint) {
  uint32_t i = search(function->depth, function->count, z, *hint);
  *hint = i;
  if (i == 0) return rgb_grey(1);

  /* Behind the last vertex both ends are that vertex, and a zero width never divides. */
  uint32_t last = i < function->count ? i : i - 1;
  double front = (double)function->depth[i - 1], width = (double)function->depth[last] - front;
  double t = width > 0 ? (z - front) / width : 0;
  if (function->channels == 1) {
    double a = (double)function->value[i - 1], b = (double)function->value[last];
    return rgb_grey(t < 1 ? a + t * (b - a) : b);
  }
  const float *a = function->value + 3 * (size_t)(i - 1), *b = function->value + 3 * (size_t)last;
  rgb v;
  for (int c = 0; c < 3; ++c) v.c[c] = t < 1 ? (double)a[c] + t * ((double)b[c] - (double)a[c]) : (double)b[c];
  return v;
}
