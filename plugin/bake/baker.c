/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/baker.h"

#include <stdlib.h>

#include "bake/bake_depth.h"
#include "bake/bake_tile.h"

typedef struct {
  pixel_baker pixels;     /* first: a tile_maker of ours is the baker that begins with it */
  depth_scratch depths;   /* in place of its scratch, for a map of depths */
} baker;

static dsm_result make(tile_maker *maker, const tile_key *key, const wanted_pixels *wanted, const tile **out,
                       tile_tally *tally)
{
  baker *b = (baker *)maker;
  const bake_job *job = &b->pixels.job;
  return job->settings->block == BLOCK_SHADOW_MAP ? bake_depth(job, &b->depths, key, out, tally)
                                                  : bake_tile(job, &b->pixels.scratch, key, wanted, out, tally);
}

static void destroy(tile_maker *maker)
{
  baker *b = (baker *)maker;
  bake_scratch_free(&b->pixels.scratch);
  depth_scratch_free(&b->depths);
  free(b);
}

dsm_result baker_worker_create(dsm_map *map, void *host_data, dsm_worker **worker)
{
  *worker = NULL;
  baker *b = calloc(1, sizeof *b);
  dsm_result result = DSM_NO_MEMORY;
  if (b) {
    tile_maker *maker = &b->pixels.maker;
    *maker = (tile_maker){make, destroy};
    b->pixels.job = (bake_job){&map->host, host_data, &map->projection, &map->settings, &map->light, &map->store, maker};
    result = worker_create(map, host_data, maker, worker);
    if (result != DSM_OK)
      destroy(maker);
  }
  if (result != DSM_OK)
    map_report(map, 2, "There is no memory for a thread's part in a shadow map.");
  return result;
}
