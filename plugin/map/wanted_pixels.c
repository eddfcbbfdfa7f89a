/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/wanted_pixels.h"

#include <string.h>

#include "map/worker.h"

enum { HALF = TILE_SIDE / 2, AROUND = HALF + 2 };   /* pixels of the coarser level that a tile covers, and one more on each side */

/* Whether pixel (x, y) of a level wants a finer one. */
static dsm_result wants(dsm_worker *worker, uint32_t face, uint32_t level, uint32_t x, uint32_t y, unsigned char *out)
{
  const tile_grid *grid = &worker->map->store.grids[face][level];
  tile_key key = {face, level, x / TILE_SIDE, y / TILE_SIDE};
  const tile *t;
  *out = 0;
  if (key.x >= grid->across || key.y >= grid->up)   /* also left of 0 and below, which wraps */
    return DSM_OK;
  dsm_result result = worker_tile(worker, &key, &t);
  if (result == DSM_OK)
    *out = tile_need_at(t, y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE) > 0;
  return result;
}

/* A look-up at a point reads the pixels whose centres are less than one pixel away in x and in y. Those of a level and of the next
 * coarser one that meet in this way are (x, y) and what is around (x/2, y/2). */
dsm_result wanted_pixels_of(dsm_worker *worker, const tile_key *key, wanted_pixels *out)
{
  unsigned char coarse[AROUND][AROUND];
  for (uint32_t j = 0; j < AROUND; j++)
    for (uint32_t i = 0; i < AROUND; i++) {
      dsm_result result = wants(worker, key->face, key->level + 1, key->x * HALF + i - 1, key->y * HALF + j - 1, &coarse[j][i]);
      if (result != DSM_OK)
        return result;
    }
  memset(out, 0, sizeof *out);
  for (uint32_t place = 0; place < TILE_PIXELS; place++) {
    uint32_t x = place % TILE_SIDE / 2, y = place / TILE_SIDE / 2;
    for (uint32_t j = y; j <= y + 2; j++)
      for (uint32_t i = x; i <= x + 2; i++)
        out->pixel[place] |= coarse[j][i];
  }
  return DSM_OK;
}
