/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* One pixel, from the events of its rays to compressed vertices (LV 3.2, 3.3, 5.1, 5.2). */
#ifndef DSM_BAKE_BAKE_PIXEL_H
#define DSM_BAKE_BAKE_PIXEL_H

#include "bake/smooth_noise.h"
#include "bake/step_sweep.h"
#include "core/average.h"
#include "core/events.h"
#include "map/baked_pixel.h"
#include "map/map.h"

/* What a bake needs from elsewhere. */
typedef struct {
  const dsm_host *host;
  void *host_data;              /* of the worker */
  const projection *projection;
  const dsm_settings *settings;
  const dsm_light *light;       /* its casters; NULL: nobody knows them */
  tile_store *store;            /* where other threads may wait for a tile, and help; NULL: nobody does */
  struct tile_maker *maker;     /* of this thread; with a store */
} bake_job;

/* Memory that a worker keeps from pixel to pixel. Zero-initialise. */
typedef struct {
  size_t *first;        /* of the rays in `transmittances` */
  double *weights;
  uint32_t room;        /* rays */
  vertices transmittances, average;
  average_scratch sweep;
  step_scratch steps;
  noise_profile noise;
  vertices smooth, relative;   /* the average without its noise, and a stretch of it */
} pixel_scratch;

/* The smallest tolerance that a pixel of this map can come to have: what tracing has to be good for. */
double finest_tolerance(const dsm_settings *settings);

/* That stored values are rounded to. All where the step of a single ray is taller than the tolerance, or may be: functions are stairs
 * of whole rays then, and rounding would make unequal what coarser levels merge. */
uint32_t bake_value_bits(const dsm_settings *settings);

/* Of pixels that cover 2^level of the finest along a side, from this many rays each. */
noise_limits limits_of(const bake_job *job, uint32_t face, uint32_t level, uint32_t samples);

/* Averages and compresses the pixel of rays first_ray … first_ray + samples - 1, appends its vertices to `stored`, and
 * describes them in *pixel. The sink is in order. DSM_OK or DSM_NO_MEMORY. */
dsm_result bake_pixel(const bake_job *job, pixel_scratch *scratch, const dsm_sink *sink, const noise_limits *limits,
                      uint32_t first_ray, uint32_t samples, vertices *stored, baked_pixel *pixel, tile_tally *tally);
void pixel_scratch_free(pixel_scratch *scratch);

#endif
