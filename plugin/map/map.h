/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* One light's map: its host, settings, faces and tiles, and what baking them has cost. */
#ifndef DSM_MAP_MAP_H
#define DSM_MAP_MAP_H

#include "core/projection.h"
#include "core/settings.h"
#include "map/tile_store.h"

/* What one tile that was made adds to dsm_statistics; see there. */
typedef struct {
  uint64_t pixels, pixels_marked, pixels_coloured;
  uint64_t rays, events, events_dropped, events_clamped;
  uint64_t vertices_in, vertices;
  double bake_seconds, trace_seconds;
} tile_tally;

void tile_tally_add(tile_tally *sum, const tile_tally *tally);

/* Where tiles come from that are not baked. */
typedef struct tile_source {
  /* [any] DSM_OK: *out is a new tile, or &tile_lit. DSM_REFUSED, DSM_NO_MEMORY: nothing; the source tells the host once. */
  dsm_result (*read)(struct tile_source *source, const tile_key *key, const tile **out);
  void (*destroy)(struct tile_source *source);
} tile_source;

/* What the end of a saving must know of its beginning. */
typedef struct map_saving {
  void (*destroy)(struct map_saving *saving);
} map_saving;

/* With `accuracy`: what has been seen of the picture before the first look-up; see explore.h. */
typedef struct {
  double squares;   /* sum of what the first level's errors would be if its pixels were as wide as the footprints */
  double octaves;   /* sum of the footprints' widths in pixels of the first level, as logarithms of 2 */
  uint64_t looked;  /* how many there were */
} exploration;

struct dsm_map {
  dsm_host host;
  dsm_light light;         /* direction of unit length */
  dsm_settings settings;
  projection projection;
  double support;          /* half width of a pixel's filter support, with some safety; map pixels */
  double blur;             /* width of the look-up's own filter, map pixels */
  uint32_t blur_level;     /* the coarsest level that it needs */
  uint32_t first_level;    /* this level and all finer ones are baked, each tile for itself; coarser ones are averages */
  double coarser;          /* with `accuracy`: see footprint_coarser */
  exploration explored;
  uint32_t explored_level; /* what camera rays read then, on average; 0: not known */
  tile_store store;
  tile_source *source;     /* NULL: tiles are baked; set before the first look-up */
  map_saving *saving;      /* NULL: the map is not going to be saved */

  /* all below under store.mutex */
  tile_tally tally;
  uint64_t tiles_baked, tiles_failed, tiles_read, tiles_again;
  uint64_t next_tile;      /* see whole_map.h */
  int told_bad_events, told_failure, told_full, told_small;
  struct dsm_worker *workers;
  uint64_t samples;        /* compared by those who have left */
};

/* Whether it holds depths, not visibility. */
static inline int map_has_depths(const dsm_map *map)
{
  return map->settings.block == BLOCK_SHADOW_MAP;
}

/* Published; see dsm.h. */
dsm_result map_create(const dsm_host *host, const dsm_light *light, const dsm_settings *settings,
                      dsm_map **map);
/* The same with faces that are known already; all is valid, and the host may lack `trace`. */
dsm_result map_create_framed(const dsm_host *host, const dsm_light *light, const dsm_settings *settings,
                             const projection *faces, dsm_map **map);
void map_destroy(dsm_map *map);
void map_statistics(const dsm_map *map, dsm_statistics *out);

/* [one] From now on tiles that are evicted are kept in a temporary file in the folder of `beside`, a path, instead of being made
 * again. DSM_REFUSED: there can be no such file, and all goes on without. map_spool_end frees the disk again. */
dsm_result map_spool(dsm_map *map, const char *beside);
void map_spool_end(dsm_map *map);

/* [any] Count a tile that has just been made or read, or failed to be, before it is published. The first tells the host once a
 * map of bad events, of failure, and of a full disk. A tile that is made again after its eviction adds to
 * what making tiles has cost, but not to what the map holds. */
void map_count_made(dsm_map *map, const tile_key *key, const tile_tally *tally, int failed);
void map_count_read(dsm_map *map, const tile_key *key, int failed);

void map_report(const dsm_map *map, int32_t severity, const char *sentence);

#endif
