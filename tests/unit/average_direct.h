/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The average as its definition says it, depth by depth, in O(n^2): what faster ways to it are held against. */
#ifndef TESTS_AVERAGE_DIRECT_H
#define TESTS_AVERAGE_DIRECT_H

#include <stdlib.h>

#include "core/average.h"
#include "core/compensated.h"

static inline double direct_total(const compensated *of) { return fmin(1, fmax(0, compensated_total(of))); }

static inline int is_zero(rgb a) { return a.c[0] == 0 && a.c[1] == 0 && a.c[2] == 0; }

static inline int direct_by_depth(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* The value behind depth z. */
static inline rgb value_behind(const vertex *data, size_t count, double z) {
  size_t low = 0, high = count;   /* the first vertex behind z */
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (data[middle].z <= z) low = middle + 1;
    else high = middle;
  }
  if (low == 0) return rgb_grey(1);
  if (low == count || data[low - 1].z == z) return data[low - 1].v;
  const vertex *a = &data[low - 1], *b = &data[low];
  return rgb_lerp(a->v, b->v, (z - a->z) / (b->z - a->z));
}

/* The average in front of z, and behind it if some function steps there (else the two are the same). */
static inline void sum_at(const average_input *in, double z, rgb *before, rgb *after) {
  compensated b[3] = {{0, 0}}, a[3] = {{0, 0}};
  int steps = 0;
  for (uint32_t i = 0; i < in->count; ++i) {
    const vertex *data = in->all + in->first[i];
    size_t count = in->first[i + 1] - in->first[i];
    rgb front = vertices_at(data, count, z), behind = value_behind(data, count, z);
    steps |= !is_zero(rgb_sub(front, behind));
    for (int c = 0; c < 3; ++c) {
      compensated_add(&b[c], in->weights[i] * front.c[c]);
      compensated_add(&a[c], in->weights[i] * behind.c[c]);
    }
  }
  for (int c = 0; c < 3; ++c) {
    before->c[c] = direct_total(&b[c]);
    after->c[c] = steps ? direct_total(&a[c]) : before->c[c];
  }
}

static inline int grows(const average_input *in) {
  for (uint32_t i = 0; i < in->count; ++i)
    for (size_t k = in->first[i] + 1; k < in->first[i + 1]; ++k)
      if (rgb_max(rgb_sub(in->all[k].v, in->all[k - 1].v)) > 0) return 1;
  return 0;
}

static inline dsm_result average_direct(const average_input *in, vertices *out) {
  size_t begin = out->count, depths = 0, count = 0;
  if (in->count > 0) count = in->first[in->count] - in->first[0];
  if (count == 0) return DSM_OK;
  double *z = count <= SIZE_MAX / sizeof *z ? malloc(count * sizeof *z) : NULL;
  if (!z) return DSM_NO_MEMORY;
  for (size_t i = 0; i < count; ++i) z[i] = in->all[in->first[0] + i].z;
  qsort(z, count, sizeof *z, direct_by_depth);
  for (size_t i = 0; i < count; ++i)
    if (depths == 0 || z[i] != z[depths - 1]) z[depths++] = z[i];

  int may_grow = grows(in);
  rgb last = rgb_grey(1), before, after;
  dsm_result result = DSM_OK;
  for (size_t d = 0; !result && d < depths; ++d) {
    sum_at(in, z[d], &before, &after);
    for (int c = 0; c < 3; ++c) {   /* weights add up to 1 but for rounding */
      if (d == 0 && after.c[c] == before.c[c]) after.c[c] = 1;
      if (d == 0) before.c[c] = 1;
      if (!may_grow) before.c[c] = fmin(before.c[c], last.c[c]);
      if (!may_grow) after.c[c] = fmin(after.c[c], before.c[c]);
    }
    last = after;
    result = vertices_push(out, z[d], before);
    if (!result && !is_zero(rgb_sub(after, before))) result = vertices_push(out, z[d], after);
  }
  if (result) out->count = begin;
  free(z);
  return result;
}

#endif
