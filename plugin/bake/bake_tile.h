/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * One tile, from rays to stored floats (LV 3.2, 3.3, 5.1, 5.2):
 *
 *   pixels --> rays --> host->trace --> events --> transmittance --> average --> compressed --> tile
 *              a batch of whole pixels at a time   a ray at a time   a pixel at a time
 *                                             \__ surfaces only: at once __/
 */
#ifndef DSM_BAKE_BAKE_TILE_H
#define DSM_BAKE_BAKE_TILE_H

#include "core/noise_profile.h"
#include "bake/step_sweep.h"
#include "core/average.h"
#include "core/events.h"
#include "core/pixel_sample.h"
#include "map/baked_pixel.h"
#include "map/map.h"

/* What a bake needs from elsewhere. */
typedef struct {
  const dsm_host *host;
  void *host_data;              /* of the worker */
  const projection *projection;
  const dsm_settings *settings;
} bake_job;

/* Memory that a worker keeps from tile to tile. Zero-initialise. */
typedef struct {
  dsm_ray *rays;
  size_t *first;        /* of a pixel's rays in `transmittances` */
  double *weights;
  pixel_point *path;
  uint32_t room_rays, room_samples;
  dsm_sink sink;
  vertices transmittances, average, stored;
  average_scratch sweep;
  step_scratch steps;
  noise_profile noise;
  vertices smooth, relative;   /* the average without its noise, and a stretch of it */
  baked_pixel pixels[TILE_PIXELS];   /* vertices in `stored` */
} bake_scratch;

/* Bakes a tile. DSM_OK: *out is the new tile, or &tile_lit if nothing dims it. Other results leave *out
 * NULL: those of `trace`, DSM_CANCELLED if `pause` asked for it, DSM_NO_MEMORY. Adds to `tally`. */
dsm_result bake_tile(const bake_job *job, bake_scratch *scratch, const tile_key *key, const tile **out,
                     tile_tally *tally);
void bake_scratch_free(bake_scratch *scratch);

#endif
