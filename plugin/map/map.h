/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* One light's map: its host, settings, faces and tiles, and what baking them has cost. */
#ifndef DSM_MAP_MAP_H
#define DSM_MAP_MAP_H

#include "core/projection.h"
#include "core/settings.h"
#include "map/tile_store.h"

/* What one baked tile adds to dsm_statistics; see there. */
typedef struct {
  uint64_t pixels, pixels_marked, pixels_coloured;
  uint64_t rays, events, events_dropped, events_clamped;
  uint64_t vertices_in, vertices;
  uint64_t bytes;
  double bake_seconds, trace_seconds;
} tile_tally;

struct dsm_map {
  dsm_host host;
  dsm_settings settings;
  projection projection;
  double footprint;        /* half width of a pixel's filter support, with some safety; map pixels */
  tile_store store;

  /* all below under store.mutex */
  tile_tally tally;
  uint64_t tiles_baked, tiles_failed;
  int told_bad_events, told_failure;
};

/* Published; see dsm.h. */
dsm_result map_create(const dsm_host *host, const dsm_light *light, const dsm_settings *settings,
                      dsm_map **map);
void map_destroy(dsm_map *map);
void map_statistics(const dsm_map *map, dsm_statistics *out);

/* Counts a tile that has just been baked, or failed, and tells the host once a map of bad events and of
 * failure. */
void map_count_tile(dsm_map *map, const tile_tally *tally, int failed);

void map_report(const dsm_map *map, int32_t severity, const char *sentence);

#endif
