/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* One tile of a depth map (RSC 3.1): one light ray a pixel, and the depth where half of its light is gone. */
#ifndef DSM_BAKE_BAKE_DEPTH_H
#define DSM_BAKE_BAKE_DEPTH_H

#include "bake/bake_tile.h"
#include "map/depth_tile.h"

/* Memory that a worker keeps from tile to tile. Zero-initialise. */
typedef struct {
  dsm_ray rays[TILE_PIXELS];
  dsm_sink sink;
  vertices light;   /* of one ray */
} depth_scratch;

/* As bake_tile. What passes more than half of the light, taken over the colours and over all that is in front, leaves no depth: a
 * depth map knows no transparent casters. Light that grows counts as light that passes. */
dsm_result bake_depth(const bake_job *job, depth_scratch *scratch, const tile_key *key, const tile **out, tile_tally *tally);
void depth_scratch_free(depth_scratch *scratch);

#endif
