/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/smooth_noise.h"

#include <math.h>
#include <string.h>

#include "core/compress.h"
#include "core/extremes.h"

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
    s->allowed = lesser(s->allowed, peak);
  else if (length <= limits->thin * v->data[s->first].z + limits->thin_at_least)
    s->allowed = limits->most;
  return 1;
}

/* Vertices of a stretch relative to the light in front of it. */
static dsm_result divide(const vertices *v, const stretch *s, int channels, rgb front, vertices *out)
{
  dsm_result result = DSM_OK;
  out->count = 0;
  for (size_t i = s->first; i <= s->last && result == DSM_OK; i++) {
    rgb relative = rgb_grey(1);
    for (int c = 0; c < channels; c++)
      if (front.c[c] > 0)
        relative.c[c] = v->data[i].v.c[c] / front.c[c];
    result = vertices_push(out, v->data[i].z, relative);
  }
  return result;
}

/* A function that begins with a step from 1 does not store the near side of it; behind other vertices it must. */
static dsm_result store_near_side(vertices *list, size_t begin)
{
  if (list->count == begin)
    return DSM_OK;
  vertex first = list->data[begin];
  if (first.v.c[0] == 1 && first.v.c[1] == 1 && first.v.c[2] == 1)
    return DSM_OK;
  dsm_result result = vertices_push(list, first.z, first.v);
  if (result == DSM_OK) {
    memmove(&list->data[begin + 1], &list->data[begin], (list->count - 1 - begin) * sizeof(vertex));
    list->data[begin].v = rgb_grey(1);
  }
  return result;
}

/* Appends one stretch, compressed. Compression starts from 1, so it works on values relative to those in front. */
static dsm_result compress_stretch(const vertices *v, const stretch *s, int channels, rgb front,
                                   vertices *scratch, vertices *out)
{
  const vertex *from = v->data + s->first;
  double largest = channels == 1 ? front.c[0] : rgb_max(front);
  if (s->first > 0) {
    dsm_result result = divide(v, s, channels, front, scratch);
    if (result != DSM_OK)
      return result;
    from = scratch->data;
  }
  size_t begin = out->count;
  dsm_result result = compress_minimal(from, s->last + 1 - s->first, channels, largest > 0 ? s->allowed / largest : 0, out);
  return result == DSM_OK && s->first > 0 ? store_near_side(out, begin) : result;
}

/* Appends one stretch without its noise; both its ends are held, or the first if it never ends. *held: that took vertices of its
 * own. */
static dsm_result smooth_stretch(const vertices *v, const stretch *s, int channels, vertices *scratch,
                                 vertices *out, int *held)
{
  *held = s->first > 0;
  rgb front = s->first == 0 ? rgb_grey(1) : v->data[s->first].v, end = v->data[s->last].v;
  /* a slope may lead up to here */
  dsm_result result = s->first > 0 ? vertices_push(out, v->data[s->first].z, front) : DSM_OK;
  size_t begin = out->count;
  if (result == DSM_OK)
    result = compress_stretch(v, s, channels, front, scratch, out);
  if (result != DSM_OK)
    return result;
  for (size_t i = begin; i < out->count; i++) {
    rgb absolute = rgb_mul(out->data[i].v, front);
    for (int c = 0; c < 3; c++)
      out->data[i].v.c[c] = s->open ? absolute.c[c] : greater(absolute.c[c], end.c[c]);
  }
  if (s->open)
    return DSM_OK;
  double z = v->data[s->last].z;
  rgb before = out->count > begin ? out->data[out->count - 1].v : front;
  if (before.c[0] == end.c[0] && before.c[1] == end.c[1] && before.c[2] == end.c[2])
    return out->count > begin ? DSM_OK : vertices_push(out, z, end);
  *held = 1;
  result = vertices_push(out, z, before);
  return result == DSM_OK ? vertices_push(out, z, end) : result;
}

dsm_result smooth_noise(const vertices *mean, const noise_profile *profile, int channels,
                        const noise_limits *limits, vertices *scratch, vertices *out, int *compressed)
{
  size_t next = 0;
  stretch s;
  *compressed = 0;
  while (next < mean->count && find_stretch(mean, profile, limits, next, &s)) {
    for (; next < s.first; next++) {
      dsm_result result = vertices_push(out, mean->data[next].z, mean->data[next].v);
      if (result != DSM_OK)
        return result;
    }
    int held;
    dsm_result result = smooth_stretch(mean, &s, channels, scratch, out, &held);
    if (result != DSM_OK)
      return result;
    next = s.last + 1;
    *compressed = next == mean->count && s.allowed >= limits->least && !held;
  }
  for (; next < mean->count; next++) {
    dsm_result result = vertices_push(out, mean->data[next].z, mean->data[next].v);
    if (result != DSM_OK)
      return result;
  }
  return DSM_OK;
}
