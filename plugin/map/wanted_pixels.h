/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Which pixels of a tile look-ups can come to: with `accuracy`, those around pixels of the next coarser level that want a finer one.
 * 0: none do; else how much it is wanted there, as tile_need_at says. */
#ifndef DSM_MAP_WANTED_PIXELS_H
#define DSM_MAP_WANTED_PIXELS_H

#include "dsm.h"
#include "map/tile.h"

typedef struct { unsigned char pixel[TILE_PIXELS]; } wanted_pixels;

struct dsm_worker;

/* Gets (or bakes) the tiles of the coarser level. DSM_OK, or why one could not be had. */
dsm_result wanted_pixels_of(struct dsm_worker *worker, const tile_key *key, wanted_pixels *out);

#endif
