/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A tile as words, for files: what its block of memory holds, bit for bit, but for what follows from the rest. Low bits are to the left,
 * low bytes of a word come first.
 *
 *   +--------------+-------------+------------+----------------+------------------------+--------+----------+---------------+
 *   | layout       | record bits | value bits | bits of depths | quantum                | counts | bitmaps  | need | records |
 *   +--------------+-------------+------------+----------------+------------------------+--------+----------+---------------+
 *     8 bits         8             8            8: of a delta,   32: its exponent + 150,  64 words, 8 words,  64 w.  as tile.h
 *     TILE_WIDE, …                              0: absolute      or 0: floats             or 256    or 16     if any says
 *
 * Counts are how many records each pixel has, in bytes, or in words in a wide tile. Bitmaps, of coloured and of marked pixels, and need
 * are there where the layout says so. What is left of the last word is zeros. Near depth and tolerance are not among the words.
 */
#ifndef DSM_MAP_TILE_WORDS_H
#define DSM_MAP_TILE_WORDS_H

#include "dsm.h"
#include "map/tile.h"

/* Words that a tile takes that is stored, and no tile of depths. */
size_t tile_words_count(const tile *t);
void tile_to_words(const tile *t, uint32_t *words);

/* *out: a new tile, with the bytes of the one that was written but `used` and `volume`. DSM_REFUSED: words that no tile gives, so
 * that whatever is done with a tile that was read is safe (check_tile.h); DSM_NO_MEMORY. Takes no more memory than the words do, and some 2 KB,
 * and time that grows with their number. */
dsm_result tile_from_words(const uint32_t *words, size_t count, double near_depth, float tolerance, const tile **out);

#endif
