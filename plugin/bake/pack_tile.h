/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A tile's compressed pixels, in double, packed into the floats that look-ups read. */
#ifndef DSM_BAKE_PACK_TILE_H
#define DSM_BAKE_PACK_TILE_H

#include "bake/baked_pixel.h"
#include "core/vertices.h"
#include "map/tile.h"

/* *out: a new tile, or &tile_lit if no pixel stores or is marked. The near depth is that of the nearest vertex.
 * Drops vertices that coincide as floats with one before and one behind; lowers the pixels' counts to match. */
dsm_result pack_tile(baked_pixel pixels[TILE_PIXELS], const vertices *stored, const tile **out);

#endif
