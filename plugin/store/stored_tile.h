/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A tile as a file keeps it: the words of its block, or its depths, and a record of what belongs to the whole of it. */
#ifndef DSM_STORE_STORED_TILE_H
#define DSM_STORE_STORED_TILE_H

#include "dsm.h"
#include "map/tile.h"
#include "store/deep_exr.h"

/* Part "tiles" has one for each tile that is stored. */
typedef struct {
  double near_depth;    /* as in the tile */
  float tolerance;      /* as in the tile; < 0: the tile is lit */
  uint32_t checksum;    /* of all of the tile, and of its number */
} tile_record;

extern const tile_record record_of_lit;

/* What the map of a tile is. */
typedef enum { STORED_DEPTHS, STORED_GREY, STORED_COLOURED } stored_kind;

/* Mixes `size` bytes into a checksum that was `sum` before; begin with 0. Any few bits that differ change the low 32. */
uint64_t checksum_add(uint64_t sum, const void *bytes, size_t size);

/* Of a stored tile with this number, from what store_tile has made of it. */
tile_record tile_record_of(const tile *t, const deep_tile *deep, uint64_t number);

/* Fills `deep`. In a map of depths each pixel has a sample, INFINITY where there is no surface, also of tile_lit; in a deep one the first
 * pixel has all words of the tile (map/tile_words.h), of tile_lit none. DSM_INVALID: what nobody could read again, or colour
 * in a map of none; DSM_NO_MEMORY. */
dsm_result store_tile(const tile *t, stored_kind kind, deep_tile *deep);

/* A new tile. DSM_REFUSED: the samples do not make a tile of this kind, or are not those of the record; DSM_NO_MEMORY. */
dsm_result restore_tile(const deep_tile *deep, stored_kind kind, const tile_record *record, uint64_t number, const tile **out);

#endif
