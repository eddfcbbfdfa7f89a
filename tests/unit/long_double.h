/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What the library computes in doubles, in long doubles and the slow way: the truth of random cases. */
#ifndef TESTS_LONG_DOUBLE_H
#define TESTS_LONG_DOUBLE_H

#include <math.h>

#include "core/average.h"
#include "core/events.h"
#include "core/vertices.h"

/* At a depth, the value in front of a step there, or behind it. */
enum { FRONT, BEHIND };

static inline long double line_between(long double a, long double b, long double run, long double all) {
  return a + (b - a) * run / all;
}

static inline long double true_value(const vertex *f, size_t count, double z, int side, int c) {
  size_t i = 0, end = count;   /* the first vertex behind; in front of a step, the first that is not in front of it */
  while (i < end) {
    size_t middle = i + (end - i) / 2;
    if (side == BEHIND ? f[middle].z <= z : f[middle].z < z) i = middle + 1;
    else end = middle;
  }
  if (i == 0) return 1;
  if (i == count) return f[count - 1].v.c[c];
  return line_between(f[i - 1].v.c[c], f[i].v.c[c], (long double)z - f[i - 1].z, (long double)f[i].z - f[i - 1].z);
}

/* The optical depth of an event; where nothing passes it, infinite for a surface, and for a span what the library says. */
static inline long double true_depth(const event *e, int c) {
  if (e->transmittance.c[c] > 0) return -logl(e->transmittance.c[c]);
  return e->front == e->back ? HUGE_VALL : 745;
}

/* The product of what all events take, each by itself: their optical depths are depths[i][c]. In order of their fronts. */
static inline long double true_transmittance(const event *e, long double (*depths)[3], size_t count, double z, int side, int c) {
  long double sum = 0;
  for (size_t i = 0; i < count && e[i].front <= z; ++i) {
    if (e[i].front == e[i].back) sum += side == BEHIND || e[i].back < z ? depths[i][c] : 0;
    else if (e[i].back <= z) sum += depths[i][c];
    else sum += depths[i][c] * (((long double)z - e[i].front) / ((long double)e[i].back - e[i].front));
  }
  return expl(-sum);
}

static inline long double true_average(const average_input *in, double z, int side, int c) {
  long double sum = 0, weights = 0;
  for (uint32_t i = 0; i < in->count; ++i) {
    sum += in->weights[i] * true_value(in->all + in->first[i], in->first[i + 1] - in->first[i], z, side, c);
    weights += in->weights[i];
  }
  return sum / weights;
}

#endif
