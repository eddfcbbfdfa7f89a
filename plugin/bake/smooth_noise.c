/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/smooth_noise.h"

#include <math.h>

#include "core/compress.h"

/* From the first vertex of the place where noise begins to the last vertex of the place where it ends. */
typedef struct {
  size_t first, last;
  int open;             /* the noise never ends */
  double allowed;
} stretch;

/* Of the least tolerance. Disagreement below is left to the last compression; it must not be so high that a
 * stretch ends wherever only one ray of hundreds disagrees. */
static const double NOISY = 0.25;

static size_t last_of_place(const vertices *v, size_t i)
{
  while (i + 1 < v->count && v->data[i + 1].z == v->data[i].z)
    i++;
  return i;
}

/* The next noisy stretch whose noise begins behind the place that starts at `from`, or at a later one. */
static int find_stretch(const vertices *v, const noise_profile *profile, const noise_limits *limits,
                        size_t from, stretch *s)
{
  double least = NOISY * limits->least;
  size_t i = from;
  for (; i < v->count; i = last_of_place(v, i) + 1)
    if (profile->allowed[last_of_place(v, i)] > least)
      break;
  if (i >= v->count)
    return 0;
  double squares = 0, length = 0, peak = 0;
  s->first = i;
  for (;;) {
    size_t last = last_of_place(v, i);
    double noise = profile->allowed[last];
    s->last = last;
    s->open = last + 1 == v->count && noise > least;
    if (!(noise > least) || s->open) {
      if (s->open)
        peak = noise;   /* what is left behind everything is what most receivers see */
      break;
    }
    double run = v->data[last + 1].z - v->data[last].z;
    squares += noise * noise * run;
    length += run;
    i = last + 1;
  }
  s->allowed = length > 0 ? sqrt(squares / length) : peak;
  if (s->open)
    s->allowed = fmin(s->allowed, peak);
  else if (length <= limits->thin * v->data[s->first].z + limits->thin_at_least)
    s->allowed = limits->most;
  return 1;
}

/* Compresses one stretch. The greedy starts from 1, so values are taken relative to those in front. */
static dsm_result smooth_stretch(const vertices *v, const stretch *s, int channels, vertices *scratch,
                                 vertices *out)
{
  rgb front = s->first == 0 ? rgb_grey(1) : v->data[s->first].v, end = v->data[s->last].v;
  double largest = channels == 1 ? front.c[0] : rgb_max(front);
  /* a slope may lead up to here */
  dsm_result result = s->first > 0 ? vertices_push(out, v->data[s->first].z, front) : DSM_OK;
  size_t begin = out->count;
  scratch->count = 0;
  for (size_t i = s->first; i <= s->last && result == DSM_OK; i++) {
    rgb relative;
    for (int c = 0; c < 3; c++)
      relative.c[c] = front.c[c] > 0 ? v->data[i].v.c[c] / front.c[c] : 1;
    result = vertices_push(scratch, v->data[i].z, relative);
  }
  if (result == DSM_OK)
    result = compress_greedy(scratch->data, scratch->count, channels, largest > 0 ? s->allowed / largest : 0,
                             out);
  if (result != DSM_OK)
    return result;
  for (size_t i = begin; i < out->count; i++) {
    rgb absolute = rgb_mul(out->data[i].v, front);
    for (int c = 0; c < 3; c++)
      out->data[i].v.c[c] = s->open ? absolute.c[c] : fmax(absolute.c[c], end.c[c]);
  }
  if (s->open)
    return DSM_OK;
  double z = v->data[s->last].z;
  rgb before = out->count > begin ? out->data[out->count - 1].v : front;
  if (before.c[0] == end.c[0] && before.c[1] == end.c[1] && before.c[2] == end.c[2])
    return out->count > begin ? DSM_OK : vertices_push(out, z, end);
  result = vertices_push(out, z, before);
  return result == DSM_OK ? vertices_push(out, z, end) : result;
}

dsm_result smooth_noise(const vertices *mean, const noise_profile *profile, int channels,
                        const noise_limits *limits, vertices *scratch, vertices *out)
{
  size_t next = 0;
  stretch s;
  while (next < mean->count && find_stretch(mean, profile, limits, next, &s)) {
    for (; next < s.first; next++) {
      dsm_result result = vertices_push(out, mean->data[next].z, mean->data[next].v);
      if (result != DSM_OK)
        return result;
    }
    dsm_result result = smooth_stretch(mean, &s, channels, scratch, out);
    if (result != DSM_OK)
      return result;
    next = s.last + 1;
  }
  for (; next < mean->count; next++) {
    dsm_result result = vertices_push(out, mean->data[next].z, mean->data[next].v);
    if (result != DSM_OK)
      return result;
  }
  return DSM_OK;
}
