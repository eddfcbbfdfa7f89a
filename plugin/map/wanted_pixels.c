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
    *out = (unsigned char)tile_need_at(t, y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE);
  return result;
}

/* Whether look-ups up to half a coarser pixel from a pixel's centre can want it. `around` are the coarser pixels around it; along an axis
 * the largest share of wanting pixels is at one of three places: the two ends, and the middle of a coarser pixel between them.
 *
 *   coarser pixels    |     0     |     1     |     2     |      weights in quarters
 *   an even pixel           <-----|x----->    |           |      3 1 0, 0 4 0, 0 3 1
 *   an odd one              |     |     <-----x|----->           1 3 0, 0 4 0, 0 1 3 */
static unsigned char wish_of(unsigned char around[3][3], uint32_t odd_x, uint32_t odd_y)
{
  static const uint32_t quarters[2][3][3] = {{{3, 1, 0}, {0, 4, 0}, {0, 3, 1}}, {{1, 3, 0}, {0, 4, 0}, {0, 1, 3}}};
  unsigned char most = 0;
  for (uint32_t k = 0; k < 9; k++) {
    const uint32_t *across = quarters[odd_x][k % 3], *up = quarters[odd_y][k / 3];
    uint32_t sixteenths = 0;
    unsigned char here = 0;
    for (uint32_t n = 0; n < 9; n++) {
      uint32_t weight = across[n % 3] * up[n / 3];
      unsigned char need = around[n / 3][n % 3];
      sixteenths += need == NEED_ALWAYS && weight ? 16 : need ? weight : 0;
      if (weight && need > here)
        here = need;
    }
    if (sixteenths > 16 * NEED_SHARE && here > most)
      most = here;
  }
  return most;
}

dsm_result wanted_pixels_of(dsm_worker *worker, const tile_key *key, wanted_pixels *out)
{
  unsigned char coarse[AROUND][AROUND];
  for (uint32_t j = 0; j < AROUND; j++)
    for (uint32_t i = 0; i < AROUND; i++) {
      dsm_result result = wants(worker, key->face, key->level + 1, key->x * HALF + i - 1, key->y * HALF + j - 1, &coarse[j][i]);
      if (result != DSM_OK)
        return result;
    }
  for (uint32_t place = 0; place < TILE_PIXELS; place++) {
    uint32_t x = place % TILE_SIDE, y = place / TILE_SIDE;
    unsigned char around[3][3];
    for (uint32_t j = 0; j < 3; j++)
      memcpy(around[j], &coarse[y / 2 + j][x / 2], 3);
    out->pixel[place] = wish_of(around, x % 2, y % 2);
  }
  return DSM_OK;
}
