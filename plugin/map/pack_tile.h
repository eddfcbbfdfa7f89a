/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A tile's compressed pixels, in double, packed into what look-ups read. */
#ifndef DSM_MAP_PACK_TILE_H
#define DSM_MAP_PACK_TILE_H

#include "core/rounding.h"
#include "core/vertices.h"
#include "map/baked_pixel.h"
#include "map/tile.h"

/* *out: a new compact tile, or &tile_lit if no pixel stores, is marked or wants a finer level. The near depth is that of the nearest vertex. Drops
 * vertices that coincide, once rounded, with one before and one behind, and colours that rounding has made grey; lowers the
 * pixels' counts and flags to match. */
dsm_result pack_tile(baked_pixel pixels[TILE_PIXELS], const vertices *stored, const rounding *rule, const tile **out);

#endif
