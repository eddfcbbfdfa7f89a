/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The one exported symbol. */
#include "bake/baker.h"
#include "core/events.h"
#include "core/settings.h"
#include "map/explore.h"
#include "map/lookup.h"
#include "map/map.h"
#include "map/wanted_tiles.h"
#include "map/whole_map.h"
#include "map/worker.h"
#include "store/saved_map.h"

#ifndef PACKAGE_VERSION
#define PACKAGE_VERSION "0.1"   /* configure knows better */
#endif

__attribute__((visibility("default")))
const dsm_api_table dsm_api = {
  .abi = DSM_ABI,
  .size = sizeof(dsm_api_table),
  .version = PACKAGE_VERSION,
  .blocks = settings_blocks,
  .block_count = BLOCK_COUNT,
  .settings_create = settings_create,
  .settings_set = settings_set,
  .settings_text = settings_text,
  .settings_destroy = settings_destroy,
  .map_create = map_create,
  .map_destroy = map_destroy,
  .worker_create = baker_worker_create,
  .worker_destroy = worker_destroy,
  .lookup = map_lookup,
  .statistics = map_statistics,
  .load = saved_map_load,
  .save_begin = saved_map_begin,
  .bake_next = map_bake_next,
  .save_end = saved_map_end,
  .sink_surface = sink_surface,
  .sink_span = sink_span,
  .sink_mark = sink_mark,
  .tiles_wanted = map_tiles_wanted,
  .bake_tile = map_bake_tile,
  .sink_pixel_rays = sink_pixel_rays,
  .sink_spare = sink_spare,
  .explore = map_explore,
  .explored = map_explored,
};
