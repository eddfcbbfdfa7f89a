/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/pixel_tolerance.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double LV_TOLERANCE = 0.25;   /* over sqrt(N): half of the worst noise that N rays can have (LV 4) */

static dsm_result make_room(tolerance_scratch *s, size_t count)
{
  if (s->room < count) {
    tolerance_free(s);
    size_t room = count + count / 2;
    s->variance = malloc(room * sizeof *s->variance);
    s->pairs = malloc(room * sizeof *s->pairs);
    if (!s->variance || !s->pairs) {
      tolerance_free(s);
      return DSM_NO_MEMORY;
    }
    s->room = room;
  }
  memset(s->variance, 0, count * sizeof *s->variance);
  memset(s->pairs, 0, count * sizeof *s->pairs);
  return DSM_OK;
}

void tolerance_free(tolerance_scratch *s)
{
  free(s->variance);
  free(s->pairs);
  *s = (tolerance_scratch){0};
}

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
  const vertex *next, *end;
  vertex behind;         /* value behind the vertices read so far */
} reader;

static reader reader_of(const average_input *in, uint32_t ray)
{
  return (reader){in->all + in->first[ray], in->all + in->first[ray + 1], {-INFINITY, rgb_grey(1)}};
}

static double next_depth(const reader *r)
{
  return r->next < r->end ? r->next->z : INFINITY;
}

/* The value just in front of depth z, which is not behind the next vertex. */
static rgb value_before(const reader *r, double z)
{
  if (r->next == r->end || !(r->next->z > r->behind.z) || r->behind.z == -INFINITY)
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

/* Adds the squared difference of two rays where they differ, as the difference of running sums: each stretch between
 * two of their depths costs two searches, however many vertices of other rays it spans. */
static void add_pair(reader a, reader b, const vertices *mean, tolerance_scratch *s)
{
  for (;;) {
    double from = fmax(a.behind.z, b.behind.z), to = fmin(next_depth(&a), next_depth(&b));
    double behind = square_gap(a.behind.v, b.behind.v);
    double square = to < INFINITY ? fmax(behind, square_gap(value_before(&a, to), value_before(&b, to))) : behind;
    if (square > 0) {
      size_t i = last_not_behind(mean, from), j = to < INFINITY ? first_not_before(mean, to) : mean->count;
      if (i < j) {
        s->variance[i] += square;
        s->pairs[i] += 1;
        if (j < mean->count) {
          s->variance[j] -= square;
          s->pairs[j] -= 1;
        }
      }
    }
    if (to == INFINITY)
      return;
    read_to(&a, to);
    read_to(&b, to);
  }
}

/* Half the standard error; but not less than what a single one of the disagreeing rays adds, as that ray's own step
 * lies where chance put it. */
static double allowed(double square_sum, double pairs, double rays, double least, double most)
{
  double half = pairs > 4 ? 0.5 : 1 / sqrt(fmax(1, pairs));
  return fmax(least, fmin(most, half * sqrt(fmax(0, square_sum)) / rays));
}

dsm_result pixel_tolerance(const average_input *in, const uint32_t *order, const vertices *mean, double least,
                           tolerance_scratch *s, double *tolerance)
{
  size_t n = mean->count;
  *tolerance = least;
  if (n == 0 || in->count < 2)
    return DSM_OK;
  dsm_result result = make_room(s, n);
  if (result != DSM_OK)
    return result;
  for (uint32_t k = 0; k + 1 < in->count; k += 2)
    add_pair(reader_of(in, order[k]), reader_of(in, order[k + 1]), mean, s);

  double rays = in->count, most = fmax(least, LV_TOLERANCE / sqrt(rays));
  double variance = 0, pairs = 0, here = least, squares = 0, length = 0;
  const vertex *v = mean->data;
  for (size_t i = 0; i < n; i++) {
    variance += s->variance[i];
    pairs += s->pairs[i];
    here = allowed(variance, pairs, rays, least, most);
    double stretch = i + 1 < n ? v[i + 1].z - v[i].z : 0;
    squares += here * here * stretch;
    length += stretch;
  }
  double along = length > 0 ? sqrt(squares / length) : here;
  *tolerance = rgb_max(v[n - 1].v) > 0 ? fmin(along, here) : along;
  return DSM_OK;
}
