/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A tile of which few pixels are baked, and the others lie between them.
 *
 *   x . . . . x . . . . x . . . . x      Smooth volumes tell little from pixel to pixel. Where lines of baked pixels (x) run nearly
 *   . . . . . . . . . . . . . . . .      straight at all depths, those between (.) become the weighted average of the four around
 *   . . . . . . . . . . . . . . . .      them: what a look-up in a coarser map would read. The tile is stored like any other.
 */
#ifndef DSM_BAKE_SPARSE_TILE_H
#define DSM_BAKE_SPARSE_TILE_H

#include "bake/bake_pass.h"
#include "bake/tile_need.h"

/* The most for which a tile may be sparse: a volume, and the ground under it. */
enum { SPARSE_CASTERS = 2 };

typedef enum {
  SPARSE_NEVER,   /* there are surfaces, or nothing */
  SPARSE_BENT,    /* volumes alone, but too much lies between the pixels */
  SPARSE_DONE     /* all pixels are made */
} sparse_outcome;

/* Bakes some of the pixels from one ray each, more of them if those are not enough, and makes the others. Nothing is kept unless all is done.
 * To be tried where there is one caster: what is thin is missed. `whole` are all pixels that lie on the face. */
dsm_result bake_sparsely(const bake_job *job, bake_scratch *scratch, const tile_key *key, const place_list *whole, uint32_t casters,
                         const need_limits *limits, sparse_outcome *outcome, tile_tally *tally);

#endif
