/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Whether what a tile from elsewhere says can be said. Look-ups trust a tile: they read without a look at where its block ends, divide
 * by its quantum, and take a pixel's values for a function. What passes here gives them no more than tiles that were packed do:
 * no reading outside the block, depths that are finite and never fall, values in [0,1] that never grow.
 */
#ifndef DSM_MAP_CHECK_TILE_H
#define DSM_MAP_CHECK_TILE_H

#include "map/tile.h"

enum { LARGEST_QUANTUM = 104 };   /* its exponent: 2^24 of it are a float still */

/* What the code of a whole depth can be at most; one is left over. */
enum { MOST_DEPTH_CODE = (1 << MOST_CODE_BITS) - 2 };

/* Of codes that codes_set, or codes_set_deltas, has set, and with the quantum of a file: whether a tile can have them. */
int records_are_possible(const visibility_codes *codes);
int deltas_are_possible(const visibility_codes *codes);

/* Of a tile that tile_create_empty has laid out, with such codes, and with its records. In time that grows with their number. */
int tile_is_sound(const tile *t);

#endif
