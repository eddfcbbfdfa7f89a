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
  size_t i = 0;
  while (i < count && (side == BEHIND ? f[i].z <= z : f[i].z < z)) ++i;
  if (i == 0) return 1;
  if (i == count) return f[count - 1].v.c[c];
  return line_between(f[i - 1].v.c[c], f[i].v.c[c], (long double)z - f[i - 1].z, (long double)f[i].z - f[i - 1].z);
}

/* The product of what all events take, each by itself. */
static inline long double true_transmittance(const event *e, size_t count, double z, int side, int c) {
  long double v = 1;
  for (size_t i = 0; i < count; ++i) {
    long double t = e[i].transmittance.c[c], depth = t > 0 ? -logl(t) : 745;
    int passed = side == BEHIND ? e[i].back <= z : e[i].back < z;
    if (e[i].front == e[i].back) v *= passed ? t : 1;
    else if (e[i].back <= z) v *= expl(-depth);
    else if (e[i].front < z) v *= expl(-depth * ((long double)z - e[i].front) / ((long double)e[i].back - e[i].front));
  }
  return v;
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
