/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/tile.h"

#include <stdlib.h>

const tile tile_lit = {0, 0, sizeof(tile), TILE_LIT, 0};
const tile tile_failed = {0, 0, sizeof(tile), TILE_FAILED, 0};

tile *tile_create(uint32_t floats)
{
  size_t size = sizeof(tile) + TILE_PIXELS * sizeof(tile_pixel) + floats * sizeof(float);
  tile *t = calloc(1, size);
  if (t) {
    t->size = size;
    t->kind = TILE_STORED;
    t->floats = floats;
  }
  return t;
}

void tile_destroy(const tile *t)
{
  if (t && t->kind == TILE_STORED)
    free((void *)(size_t)t);
}
