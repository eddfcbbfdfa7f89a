/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "tool/info_depths.h"

#include <math.h>
#include <stdio.h>

#include "map/depth_tile.h"

typedef struct {
  uint64_t pixels, with_depth, stored, lit, bytes;
  double least, most;   /* of the finite depths */
} depth_sum;

static void add_tile(void *data, const map_grid *grid, const tile_key *key, const tile *t)
{
  depth_sum *sum = data;
  tile_extent extent = tile_extent_of(grid, key);
  sum->pixels += extent.across * extent.up;
  sum->bytes += sizeof(tile *);
  if (t->kind != TILE_STORED) {
    sum->lit++;
    return;
  }
  sum->stored++;
  sum->bytes += t->size;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    double depth = t->near_depth + (double)depths_of(t)->depth[i];
    if (!(depth < INFINITY))
      continue;
    sum->with_depth++;
    sum->least = fmin(sum->least, depth);
    sum->most = fmax(sum->most, depth);
  }
}

int info_depths(const open_map *map)
{
  depth_sum sum = {.least = INFINITY};
  if (open_map_visit(map, add_tile, &sum) != STATUS_FINE)
    return STATUS_TROUBLE;
  printf("%-12s %llu of %llu have a depth\n", "pixels", (unsigned long long)sum.with_depth, (unsigned long long)sum.pixels);
  if (sum.with_depth)
    printf("%-12s from %.10g to %.10g\n", "depths", sum.least, sum.most);
  printf("%-12s %llu stored, %llu lit, %llu bytes in memory\n", "tiles", (unsigned long long)sum.stored,
         (unsigned long long)sum.lit, (unsigned long long)sum.bytes);
  return STATUS_FINE;
}
