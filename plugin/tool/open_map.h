/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A map file as the commands read it: tile by tile, each in memory only while it is looked at. */
#ifndef DSM_TOOL_OPEN_MAP_H
#define DSM_TOOL_OPEN_MAP_H

#include "map/read_tile.h"
#include "store/map_file.h"
#include "tool/command.h"

typedef struct {
  const char *path;    /* the caller's, and outlives this */
  map_header header;
  map_file *file;
} open_map;

/* What has failed, in the sentence that came with it. Returns STATUS_TROUBLE. */
int trouble_because(dsm_result result, const map_reason *why);

/* STATUS_FINE, or STATUS_TROUBLE and a sentence has been printed; likewise below. */
int open_map_begin(open_map *map, const char *path);
/* The same for commands that know visibility alone: a map of depths is refused. */
int open_map_begin_deep(open_map *map, const char *path);
void open_map_end(open_map *map);   /* one that was never opened but is all zeros may be passed too */

/* Opens a map, as one of the two above does, has it worked on, and closes it. Returns what the work returns. */
typedef int map_opener(open_map *map, const char *path);
typedef int map_work(const open_map *map, void *data);
int with_open_map(map_opener *begin, const char *path, map_work *work, void *data);

/* *out is the caller's, for tile_destroy. */
int open_map_tile(const open_map *map, const tile_key *key, const tile **out);

static inline int open_map_has_depths(const open_map *map)
{
  return map->header.block == BLOCK_SHADOW_MAP;
}

/* One level of one face. */
typedef struct {
  uint32_t face, level;
  uint32_t width, height;   /* pixels */
  uint32_t across, up;      /* tiles */
} map_grid;

/* False if the face has no such level, or no pixels. */
int map_grid_of(const projection *p, uint32_t face, uint32_t level, map_grid *grid);
/* The grid that --face and --level name. */
int open_map_grid(const open_map *map, const place_choice *choice, map_grid *grid);

/* Counts through all tiles of a map, finest level first: start with *key all zeros and *more 0; false at the end. */
int next_tile(const projection *p, tile_key *key, int *more);

/* Shows all tiles of a map, finest level first, up to one that cannot be read. */
typedef void tile_visitor(void *data, const map_grid *grid, const tile_key *key, const tile *t);
int open_map_visit(const open_map *map, tile_visitor *visit, void *data);

/* Pixels of a tile that lie on its grid. */
typedef struct { uint32_t across, up; } tile_extent;
tile_extent tile_extent_of(const map_grid *grid, const tile_key *key);

#endif
