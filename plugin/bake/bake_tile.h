/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * One tile, from rays to what look-ups read. Without `accuracy` each pixel gets the same number of rays. With it:
 *
 *   few rays a pixel --> noise there and around --> more rays, where the mean is not certain enough
 *                                                         |
 *                        tile_need: what a finer level would tell <--'
 */
#ifndef DSM_BAKE_BAKE_TILE_H
#define DSM_BAKE_BAKE_TILE_H

#include "bake/bake_pass.h"
#include "map/wanted_pixels.h"

/* Bakes the wanted pixels of a tile of any level, by themselves. DSM_OK: *out is the new tile, or &tile_lit if nothing dims it. Other results leave *out
 * NULL: those of `trace`, DSM_CANCELLED if `pause` asked for it, DSM_NO_MEMORY. Adds to `tally`. */
dsm_result bake_tile(const bake_job *job, bake_scratch *scratch, const tile_key *key, const wanted_pixels *wanted,
                     const tile **out, tile_tally *tally);

#endif
