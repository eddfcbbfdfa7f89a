/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The noise of an average, pair of neighbouring rays by pair: what average_and_noise and step_sweep are held against. */
#ifndef DSM_TESTS_NOISE_DIRECT_H
#define DSM_TESTS_NOISE_DIRECT_H

#include <math.h>
#include <stdlib.h>

#include "core/average.h"

/* The first vertex of the average at or behind z. */
static size_t first_not_before(const vertices *mean, double z)
{
  size_t low = 0, high = mean->count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (mean->data[middle].z < z)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* The last vertex of the average at or in front of z; the first if there is none. */
static size_t last_not_behind(const vertices *mean, double z)
{
  size_t i = first_not_before(mean, z);
  while (i < mean->count && mean->data[i].z == z)
    i++;
  return i > 0 ? i - 1 : 0;
}

/* One ray's function, read from front to back. */
typedef struct {
  const vertex *first, *next, *end;
  vertex behind;         /* value behind the vertices read so far */
} reader;

static reader reader_of(const average_input *in, uint32_t ray)
{
  return (reader){in->all + in->first[ray], in->all + in->first[ray], in->all + in->first[ray + 1], {-INFINITY, rgb_grey(1)}};
}

static double next_depth(const reader *r)
{
  return r->next < r->end ? r->next->z : INFINITY;
}

/* The value just in front of depth z, which is not behind the next vertex. */
static rgb value_before(const reader *r, double z)
{
  if (r->next == r->end || !(r->next->z > r->behind.z) || r->next == r->first)
    return r->behind.v;
  return rgb_lerp(r->behind.v, r->next->v, (z - r->behind.z) / (r->next->z - r->behind.z));
}

static void read_to(reader *r, double z)
{
  vertex here = {z, value_before(r, z)};
  while (r->next < r->end && r->next->z <= z)
    here.v = (r->next++)->v;
  r->behind = here;
}

static double square_gap(rgb a, rgb b)
{
  rgb d = rgb_sub(a, b);
  return rgb_max(rgb_mul(d, d));
}

/* Adds the squared difference of two rays where they differ, as what a running sum changes by: each stretch
 * between two of their depths costs two searches, however many vertices of other rays it spans. */
static void add_pair(reader a, reader b, const vertices *mean, double *squares, double *pairs)
{
  for (;;) {
    double from = fmax(a.behind.z, b.behind.z), to = fmin(next_depth(&a), next_depth(&b));
    double behind = square_gap(a.behind.v, b.behind.v);
    double square = behind;
    if (to < INFINITY)
      square = fmax(square, square_gap(value_before(&a, to), value_before(&b, to)));
    if (square > 0) {
      size_t i = last_not_behind(mean, from), j = to < INFINITY ? first_not_before(mean, to) : mean->count;
      if (i < j) {
        squares[i] += square;
        pairs[i] += 1;
        if (j < mean->count) {
          squares[j] -= square;
          pairs[j] -= 1;
        }
      }
    }
    if (to == INFINITY)
      return;
    read_to(&a, to);
    read_to(&b, to);
  }
}

/* What the noise of `in`, whose average is `mean`, allows from each vertex to the next, into `allowed`. */
static void noise_direct(const average_input *in, const vertices *mean, double *allowed)
{
  size_t n = mean->count;
  double *squares = calloc(n + 1, sizeof *squares), *pairs = calloc(n + 1, sizeof *pairs), square = 0, pair = 0;
  for (uint32_t k = 0; k + 1 < in->count; k++)
    add_pair(reader_of(in, k), reader_of(in, k + 1), mean, squares, pairs);
  for (size_t i = 0; i < n; i++) {
    square += squares[i];
    pair += pairs[i];
    if (pair < 0.5)   /* whole numbers, and exact; the squares have rounded */
      square = 0;
    double n_rays = in->count, error = n_rays > 1 ? sqrt(square / (2 * n_rays * (n_rays - 1))) : 0;
    allowed[i] = fmin(noise_ceiling(n_rays), error * (pair > 8 ? 0.5 : 1.01 / sqrt(fmax(1, pair / 2))));
  }
  free(squares);
  free(pairs);
}

#endif
