/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/depth_tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

dsm_result depth_tile_unpack(double near_depth, const float depth[TILE_PIXELS], const tile **out)
{
  depth_tile *t = calloc(1, sizeof *t);
  *out = NULL;
  if (!t)
    return DSM_NO_MEMORY;
  t->head.near_depth = near_depth;
  t->head.size = sizeof *t;
  t->head.codes.records = offsetof(depth_tile, depth);
  t->head.kind = TILE_STORED;
  t->head.layout = TILE_DEPTHS;
  memcpy(t->depth, depth, sizeof t->depth);
  for (int i = 0; i < TILE_PIXELS; i++)
    t->most = fmaxf(t->most, depth[i]);
  *out = &t->head;
  return DSM_OK;
}

dsm_result depth_tile_pack(const double depth[TILE_PIXELS], const tile **out)
{
  double near_depth = INFINITY;
  for (int i = 0; i < TILE_PIXELS; i++)
    near_depth = fmin(near_depth, depth[i]);
  if (!(near_depth < INFINITY)) {
    *out = &tile_lit;
    return DSM_OK;
  }
  float relative[TILE_PIXELS];
  for (int i = 0; i < TILE_PIXELS; i++)
    relative[i] = (float)(depth[i] - near_depth);
  return depth_tile_unpack(near_depth, relative, out);
}
