/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* dsmtool check: reads every tile and says what is wrong with it. */
#include <math.h>
#include <stdio.h>

#include "core/rounding.h"
#include "map/depth_tile.h"
#include "map/read_tile.h"
#include "tool/open_map.h"

typedef struct {
  const open_map *map;
  uint64_t tiles, tiles_wrong, pixels;
  vertices pixel;   /* the one that is looked at */
} tally;

/* What is wrong with a pixel, or NULL. Who reads a tile sees already that depths never fall, that visibility never grows and
 * stays in [0,1]; and before its first vertex it is 1. */
static const char *wrong_with(const vertices *pixel, double reach)
{
  const vertex *v = pixel->data;
  for (size_t i = 0; i < pixel->count; i++) {
    if (v[i].z > reach)
      return "has a depth behind the casters";
    if (i > 1 && v[i].z <= v[i - 2].z)
      return "has three vertices at one depth";
  }
  return NULL;
}

/* What is wrong with one pixel of a tile, or NULL. */
static const char *wrong_in(vertices *pixel, const tile *t, uint32_t place, const tile_extent *extent, const face *f, double moved)
{
  double rounding = 0x1p-20 * (f->far_depth - f->near_depth);   /* depths became floats on their way here */
  int outside = place % TILE_SIDE >= extent->across || place / TILE_SIDE >= extent->up;
  if (tile_has_depths(t)) {
    double depth = t->near_depth + (double)depths_of(t)->depth[place];
    return depth == INFINITY ? NULL : outside ? "has a depth, but lies outside the face"
         : depth < f->near_depth - rounding ? "has a depth in front of the casters"
         : depth > f->far_depth + rounding ? "has a depth behind the casters" : NULL;
  }
  visibility v = tile_visibility(t, place);
  if (outside && (v.count || tile_is_marked(t, place)))
    return "stores something, but lies outside the face";
  if (v.count && !(t->near_depth >= f->near_depth - rounding))
    return "has a depth in front of the casters";
  pixel->count = 0;
  if (read_vertices(&v, 0, pixel) != DSM_OK)
    return "takes more memory than there is";
  return wrong_with(pixel, f->far_depth - t->near_depth + rounding + (t->tolerance > 0 ? moved : 0));
}

static void check_tile(tally *sum, const map_grid *grid, const tile_key *key, const tile *t)
{
  tile_extent extent = tile_extent_of(grid, key);
  int wrong = 0;
  const projection *p = &sum->map->header.projection;
  const face *f = &p->faces[key->face];
  double moved = rounding_reach(p, key->face, key->level, f->far_depth);
  sum->pixels += extent.across * extent.up;
  for (uint32_t place = 0; place < TILE_PIXELS; place++) {
    const char *what = wrong_in(&sum->pixel, t, place, &extent, f, moved);
    if (!what)
      continue;
    trouble("%s: pixel %u, %d of face %u, level %u %s.", sum->map->path, (unsigned)(key->x * TILE_SIDE + place % TILE_SIDE),
            (int)grid->height - 1 - (int)(key->y * TILE_SIDE + place / TILE_SIDE), (unsigned)key->face,
            (unsigned)key->level, what);
    wrong = 1;
  }
  sum->tiles_wrong += (uint64_t)wrong;
}

static void check_tiles(tally *sum)
{
  const map_header *header = &sum->map->header;
  tile_key key = {0, 0, 0, 0};
  map_grid grid;
  for (int more = 0; next_tile(&header->projection, &key, &more);) {
    const tile *t;
    sum->tiles++;
    if (open_map_tile(sum->map, &key, &t) != STATUS_FINE) {
      sum->tiles_wrong++;
      continue;
    }
    map_grid_of(&header->projection, key.face, key.level, &grid);
    if (t->kind == TILE_STORED)
      check_tile(sum, &grid, &key, t);
    else
      sum->pixels += (uint64_t)tile_extent_of(&grid, &key).across * tile_extent_of(&grid, &key).up;
    tile_destroy(t);
  }
}

static int check_map(const open_map *map, void *unused)
{
  (void)unused;
  tally sum = {.map = map};
  check_tiles(&sum);
  vertices_free(&sum.pixel);
  if (sum.tiles_wrong)
    return trouble("%s is damaged: %llu of %llu tiles are bad.", map->path, (unsigned long long)sum.tiles_wrong,
                   (unsigned long long)sum.tiles);
  printf("%s is good: %llu tiles, %llu pixels of all levels.\n", map->path, (unsigned long long)sum.tiles,
         (unsigned long long)sum.pixels);
  return STATUS_FINE;
}

int check_run(int argc, char **argv)
{
  static const struct argp parser = {NULL, one_path, "MAP", "Reads every tile of a map, compares it with its checksum, and "
    "checks that every visibility function starts at 1, stays from 0 to 1 and never grows, or that depths are those of "
    "casters. Says what is wrong; the exit status is 0 where nothing is, else 2.", NULL, NULL, NULL};
  const char *path = NULL;
  parse_arguments(&parser, argc, argv, &path);
  return with_open_map(open_map_begin, path, check_map, NULL);
}
