/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Coarser levels (LV 5.3): each pixel is the average of four of the next finer level, compressed again.
 *
 *   level 0   t            Each level may add half the error of the one before, so that the sum stays below twice
 *   level 1   t + t/2      that of the finest, whatever the number of levels. Averaging four halves the noise, too:
 *   level 2   t + t/2 + …  vertices a pixel grow by about the square root of two a level, and all coarser levels
 *                          together take about half of what the finest takes. (What a level adds is no less than the
 *                          rounding of stored values, 1.5e-5.)
 */
#ifndef DSM_MAP_PYRAMID_H
#define DSM_MAP_PYRAMID_H

#include "map/worker.h"

/* Makes a tile of level 1 or more, getting (or baking) the up to four that it covers first. DSM_OK: *out is a new tile,
 * &tile_lit, or &tile_failed if one of the four failed. A pixel of which a part is marked is marked. */
dsm_result pyramid_make(dsm_worker *worker, const tile_key *key, const tile **out);

#endif
