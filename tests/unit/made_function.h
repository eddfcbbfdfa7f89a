/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Functions for the tests of compression, and what its results must be. Include after cmocka.h and random.h. */
#ifndef TESTS_MADE_FUNCTION_H
#define TESTS_MADE_FUNCTION_H

#include <math.h>
#include <stdlib.h>

#include "core/vertices.h"

enum { MOST = 64 };

static inline vertex grey(double z, double v) { return (vertex){z, rgb_grey(v)}; }


/* Every order of magnitude of depth, depths that coincide or nearly so, plateaus, ramps and steps. */
static inline size_t hard_function(rng *r, vertex *e, int may_grow) {
  size_t n = rng_below(r, MOST);
  double scale = rng_scale(r, 1e-6, 1e6), z = rng_unit(r), gentle = rng_between(r, 0.3, 1), v = 1;
  uint32_t steepness = rng_below(r, 4);
  for (size_t i = 0; i < n; ++i) {
    if ((i || rng_below(r, 4) == 0) && rng_below(r, 3))
      v = may_grow ? fmin(1, v * rng_between(r, 0.5, 1.6)) : v * rng_between(r, gentle, 1);
    if (rng_below(r, 200) == 0) v = 0;
    e[i] = grey(z * scale, v);
    switch (rng_below(r, 5)) {
      case 0: break;
      case 1: z = steepness == 0 ? nextafter(z, HUGE_VAL) : z + rng_unit(r); break;
      case 2: z += rng_scale(r, steepness < 2 ? 1e-12 : 1e-4, 1e-2); break;
      default: z += rng_unit(r); break;
    }
  }
  return n;
}

static inline int by_depth(const void *a, const void *b) {
  double x = ((const vertex *)a)->z, y = ((const vertex *)b)->z;
  return (x > y) - (x < y);
}

/* A pixel of hair: n hits, each of which takes 1/n of the light, down to some coverage. In clusters or not. */
static inline size_t hair(rng *r, vertex *e, int n, int clusters) {
  int hits = rng_below(r, 2) ? n : (int)(n * rng_between(r, 0.3, 1));
  double centre[4];
  for (int i = 0; i < 4; ++i) centre[i] = rng_between(r, 5, 6);
  for (int i = 0; i < hits; ++i) {
    double spread = rng_unit(r) + rng_unit(r) + rng_unit(r) - 1.5;
    e[2 * i].z = e[2 * i + 1].z = clusters ? centre[rng_below(r, 4)] + 0.03 * spread : rng_between(r, 5, 6);
  }
  qsort(e, 2 * (size_t)hits, sizeof *e, by_depth);
  for (int i = 0; i < 2 * hits; ++i) e[i].v = rgb_grey(1 - (i + 1) / 2 / (double)n);
  return 2 * (size_t)hits;
}

static inline double value_front(const vertex *v, size_t n, size_t *i, double z) {
  while (*i < n && v[*i].z < z) ++*i;
  if (*i == 0) return 1;
  const vertex *a = &v[*i - 1], *b = a + 1;
  if (*i == n) return a->v.c[0];
  return b->z == z ? b->v.c[0] : a->v.c[0] + (b->v.c[0] - a->v.c[0]) * ((z - a->z) / (b->z - a->z));
}

static inline double value_behind(const vertex *v, size_t n, size_t i, double z) {
  double y = value_front(v, n, &i, z);
  for (; i < n && v[i].z == z; ++i) y = v[i].v.c[0];
  return y;
}

static inline double shown(double y) { return fmax(0, fmin(1, y)); }

/* The largest distance: at all depths of both, on both sides, since between them both are straight. */
static inline double largest_error(const vertex *in, size_t n, const vertices *out) {
  double worst = 0;
  for (size_t a = 0, b = 0, i = 0, j = 0; i < n || j < out->count;) {
    double z = j == out->count || (i < n && in[i].z <= out->data[j].z) ? in[i].z : out->data[j].z;
    worst = fmax(worst, fabs(shown(value_front(in, n, &a, z)) - value_front(out->data, out->count, &b, z)));
    worst = fmax(worst, fabs(shown(value_behind(in, n, a, z)) - value_behind(out->data, out->count, b, z)));
    while (i < n && in[i].z <= z) ++i;
    while (j < out->count && out->data[j].z <= z) ++j;
  }
  return worst;
}

/* In [0,1], falling if `falls`, between the first and the last depth, steps only where the input has tall ones. */
static inline int is_tidy(const vertex *in, size_t n, const vertices *out, int falls, double tolerance) {
  size_t a = 0;
  for (size_t i = 0; i < out->count; ++i) {
    const vertex *v = &out->data[i];
    double z = v->z, y = v->v.c[0];
    if (!(y >= 0 && y <= 1) || !rgb_is_grey(v->v) || z < in[0].z || z > in[n - 1].z) return 0;
    if (falls && y > (i ? v[-1].v.c[0] : 1)) return 0;
    if (i && z < v[-1].z) return 0;
    int steps = i == 0 ? y != 1 : z == v[-1].z;
    double height = fabs(shown(value_front(in, n, &a, z)) - shown(value_behind(in, n, a, z)));
    if (steps && i && !(height > tolerance) && !(i + 1 == out->count && y == 0)) return 0;
    if (i > 1 && z == v[-2].z) return 0;
  }
  return 1;
}

/* Tall steps are steps, and the end is 0 if the input's is. */
static inline int keeps_the_essential(const vertex *in, size_t n, const vertices *out, double tolerance) {
  size_t a = 0, b = 0;
  for (size_t i = 0; i < n; ++i) {
    double z = in[i].z;
    if (!(fabs(shown(value_front(in, n, &a, z)) - shown(value_behind(in, n, a, z))) > tolerance)) continue;
    double front = value_front(out->data, out->count, &b, z);
    if (b == out->count || out->data[b].z != z) return 0;
    if (!(b == 0 && front == 1) && (b + 1 >= out->count || out->data[b + 1].z != z)) return 0;
  }
  return n == 0 || in[n - 1].v.c[0] > 0 || (out->count > 0 && out->data[out->count - 1].v.c[0] == 0);
}

#endif
