/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What dims the rays of one batch: the sink that a host's `trace` fills, and its order for reading. */
#ifndef DSM_CORE_EVENTS_H
#define DSM_CORE_EVENTS_H

#include <stddef.h>

#include "core/rgb.h"
#include "dsm.h"

/* A surface has front == back and takes all its light there; a span takes it exponentially from front to
 * back. */
typedef struct {
  double front, back;
  rgb transmittance;
  uint32_t ray;
} event;

struct dsm_sink {
  const dsm_ray *rays;
  uint32_t ray_count;
  event *events;
  size_t count, capacity;
  size_t *first;      /* after sink_order: events of ray r are first[r] … first[r+1]-1 */
  const event *ordered;    /* sink_order's output: `events` if they came in order, else `sorted` */
  event *sorted;
  unsigned char *marked;   /* a byte a ray: its light can grow with depth */
  unsigned char *spared;   /* a byte a ray: it does not count */
  uint32_t pixel_rays;     /* see sink_pixel_rays; sink_begin sets it to 1 */
  size_t room_rays, room_sorted;
  uint64_t dropped, clamped;
};

/* Empties the sink for a new batch; keeps its memory. The counters of bad input are kept too. */
dsm_result sink_begin(dsm_sink *sink, const dsm_ray *rays, uint32_t ray_count);
/* The rules of dsm.h for bad numbers, and some more. A span whose front is behind its back is turned round
 * and counted as clamped. A span that is partly or wholly outside the ray keeps its whole transmittance.
 * What is off by less than rounding (1e-9 of the depths, 1e-6 above transmittance 1) is put right but
 * neither counted nor marked. A ray that is not in the batch is DSM_INVALID, and counted as dropped. */
dsm_result sink_surface(dsm_sink *sink, uint32_t ray, double depth, const double transmittance[3]);
dsm_result sink_span(dsm_sink *sink, uint32_t ray, double front, double back, const double transmittance[3]);
dsm_result sink_mark(dsm_sink *sink, uint32_t ray);
uint32_t sink_pixel_rays(const dsm_sink *sink);
dsm_result sink_spare(dsm_sink *sink, uint32_t ray);
/* Sorts events by ray, then by front depth; equal depths keep the host's order. O(n log n), and O(n) with no copy
 * where the host has reported them so. */
dsm_result sink_order(dsm_sink *sink);
void sink_free(dsm_sink *sink);

#endif
