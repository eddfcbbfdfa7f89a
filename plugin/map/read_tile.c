/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/read_tile.h"

dsm_result read_pixel(const tile *t, uint32_t place, vertices *out)
{
  if (t->kind != TILE_STORED)
    return DSM_OK;
  visibility v = tile_visibility(t, place);
  size_t begin = out->count;
  for (uint32_t i = 0; i < v.count; i++) {
    rgb value;
    for (uint32_t c = 0; c < 3; c++)
      value.c[c] = visibility_stored(&v, i, v.channels == 3 ? c : 0) * (1.0 / VALUE_STEPS);
    if (vertices_push(out, t->near_depth + visibility_depth(&v, i), value) != DSM_OK) {
      out->count = begin;
      return DSM_NO_MEMORY;
    }
  }
  return DSM_OK;
}
