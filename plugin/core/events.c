/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/events.h"

#include <stdlib.h>
#include <string.h>

/* A host works with rounding of its own. What is off by less than this is put right without being called
 * wrong: a depth by this share of the ray's two ends, a transmittance above 1 by this much (hosts keep
 * colours as floats). */
static const double depth_slack = 1e-9;
static const double colour_slack = 1e-6;

dsm_result sink_begin(dsm_sink *sink, const dsm_ray *rays, uint32_t ray_count) {
  sink->rays = rays;
  sink->ray_count = 0;
  sink->count = 0;
  if (!sink->first || ray_count > sink->room_rays) {
    size_t room = ray_count;
    if (room >= SIZE_MAX / sizeof *sink->first) return DSM_NO_MEMORY;
    size_t *first = realloc(sink->first, (room + 1) * sizeof *first);
    if (first) sink->first = first;
    unsigned char *marked = realloc(sink->marked, room + 1);
    if (marked) sink->marked = marked;
    unsigned char *spared = realloc(sink->spared, room + 1);
    if (spared) sink->spared = spared;
    if (!first || !marked || !spared) return DSM_NO_MEMORY;
    sink->room_rays = room;
  }
  sink->ray_count = ray_count;
  sink->pixel_rays = 1;
  memset(sink->marked, 0, ray_count);
  memset(sink->spared, 0, ray_count);
  return DSM_OK;
}

/* Moves a depth to the nearer end of its ray; 1 if it was farther off than by rounding. */
static int clamp_depth(const dsm_ray *ray, double *depth) {
  double slack = depth_slack * (fabs(ray->near_depth) + fabs(ray->far_depth)), was = *depth;
  if (was < ray->near_depth) *depth = ray->near_depth;
  if (was > ray->far_depth) *depth = ray->far_depth;
  return fabs(*depth - was) > slack;
}

dsm_result sink_span(dsm_sink *sink, uint32_t ray, double front, double back, const double transmittance[3]) {
  event e = {front, back, {{transmittance[0], transmittance[1], transmittance[2]}}, ray};
  /* A sum is finite only if all its terms are, unless the terms are too large to be depths or colours
   * anyway. */
  if (ray >= sink->ray_count || !isfinite(front + back + e.transmittance.c[0] + e.transmittance.c[1]
                                          + e.transmittance.c[2])) {
    ++sink->dropped;
    return ray >= sink->ray_count ? DSM_INVALID : DSM_OK;
  }

  int wrong = front > back;
  if (wrong) {
    e.front = back;
    e.back = front;
  }
  wrong |= clamp_depth(&sink->rays[ray], &e.front);
  wrong |= clamp_depth(&sink->rays[ray], &e.back);
  for (int c = 0; c < 3; ++c) {
    double *t = &e.transmittance.c[c];
    if (*t > 1 + colour_slack) sink->marked[ray] = 1;
    if (*t > 1) *t = 1;
    if (*t < 0) wrong = 1;
    if (!(*t > 0)) *t = 0;
  }
  sink->clamped += (uint64_t)wrong;

  if (sink->count == sink->capacity) {
    size_t capacity = sink->capacity + sink->capacity / 2 + 64;
    if (capacity < sink->capacity || capacity > SIZE_MAX / sizeof(event)) return DSM_NO_MEMORY;
    event *events = realloc(sink->events, capacity * sizeof *events);
    if (!events) return DSM_NO_MEMORY;
    sink->events = events;
    sink->capacity = capacity;
  }
  sink->events[sink->count++] = e;
  return DSM_OK;
}

dsm_result sink_surface(dsm_sink *sink, uint32_t ray, double depth, const double transmittance[3]) {
  return sink_span(sink, ray, depth, depth, transmittance);
}

dsm_result sink_mark(dsm_sink *sink, uint32_t ray) {
  if (ray >= sink->ray_count) {
    ++sink->dropped;
    return DSM_INVALID;
  }
  sink->marked[ray] = 1;
  return DSM_OK;
}

uint32_t sink_pixel_rays(const dsm_sink *sink) { return sink->pixel_rays; }

dsm_result sink_spare(dsm_sink *sink, uint32_t ray) {
  if (ray >= sink->ray_count || sink->pixel_rays < 2) {
    ++sink->dropped;
    return DSM_INVALID;
  }
  sink->spared[ray] = 1;
  return DSM_OK;
}

/* A stable merge sort by front depth. Hosts report spans in order, so a pair of halves that already fits is
 * left alone: sorted input costs n comparisons and no copies. */
static void sort_by_front(event *events, size_t count, event *scratch) {
  if (count < 2) return;
  size_t half = count / 2;
  sort_by_front(events, half, scratch);
  sort_by_front(events + half, count - half, scratch);
  if (events[half - 1].front <= events[half].front) return;

  memcpy(scratch, events, half * sizeof *events);
  size_t left = 0, right = half, to = 0;
  while (left < half && right < count)
    events[to++] = events[right].front < scratch[left].front ? events[right++] : scratch[left++];
  memcpy(events + to, scratch + left, (half - left) * sizeof *events);   /* the right rest is in place */
}

static int follows(const event *a, const event *b) {
  return a->ray < b->ray || (a->ray == b->ray && a->front <= b->front);
}

/* By ray, with a counting sort, which keeps the host's order; then each ray's by depth. first[r] is where ray r
 * begins. */
static dsm_result sort_events(dsm_sink *sink, size_t longest) {
  size_t *first = sink->first, room = sink->count + longest / 2 + 1;   /* the end is for merging in */
  if (room > sink->room_sorted) {
    if (room > SIZE_MAX / sizeof(event)) return DSM_NO_MEMORY;
    event *sorted = realloc(sink->sorted, room * sizeof *sorted);
    if (!sorted) return DSM_NO_MEMORY;
    sink->sorted = sorted;
    sink->room_sorted = room;
  }
  for (size_t i = 0; i < sink->count; ++i) sink->sorted[first[sink->events[i].ray]++] = sink->events[i];
  /* Filling has moved each start to its end, which is the next ray's start. */
  memmove(first + 1, first, sink->ray_count * sizeof *first);
  first[0] = 0;

  for (uint32_t r = 0; r < sink->ray_count; ++r)
    sort_by_front(sink->sorted + first[r], first[r + 1] - first[r], sink->sorted + sink->count);
  return DSM_OK;
}

dsm_result sink_order(dsm_sink *sink) {
  size_t *first = sink->first, longest = 0, sum = 0;
  int in_order = 1;

  memset(first, 0, ((size_t)sink->ray_count + 1) * sizeof *first);
  for (size_t i = 0; i < sink->count; ++i) {
    ++first[sink->events[i].ray];
    in_order &= i == 0 || follows(&sink->events[i - 1], &sink->events[i]);
  }
  for (uint32_t r = 0; r <= sink->ray_count; ++r) {
    size_t n = first[r];
    if (n > longest) longest = n;
    first[r] = sum;
    sum += n;
  }
  dsm_result result = in_order ? DSM_OK : sort_events(sink, longest);
  sink->ordered = in_order ? sink->events : sink->sorted;
  return result;
}

void sink_free(dsm_sink *sink) {
  free(sink->events);
  free(sink->first);
  free(sink->sorted);
  free(sink->marked);
  free(sink->spared);
  *sink = (dsm_sink){0};
}
