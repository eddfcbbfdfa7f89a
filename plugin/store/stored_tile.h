/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A tile as a file keeps it: its pixels as deep samples, and a record of what belongs to the whole of it. */
#ifndef DSM_STORE_STORED_TILE_H
#define DSM_STORE_STORED_TILE_H

#include "dsm.h"
#include "map/tile.h"
#include "store/deep_exr.h"

#define MARKED_VALUE (-1.0f)   /* the one sample of a pixel where light can grow */

/* Part "tiles" has one for each tile that is stored. */
typedef struct {
  double near_depth;    /* as in the tile */
  float tolerance;      /* as in the tile; < 0: the tile is lit */
  uint32_t checksum;    /* of all of the tile, and of its number */
} tile_record;

extern const tile_record record_of_lit;

/* Channels of the parts with pixels: Z, of a map of depths; Z and V; or Z, VR, VG, VB. */
enum { DEPTH_CHANNELS = 1, GREY_CHANNELS = 2, COLOURED_CHANNELS = 4 };
extern const char *const grey_channels[GREY_CHANNELS], *const coloured_channels[COLOURED_CHANNELS];

/* Mixes `size` bytes into a checksum that was `sum` before; begin with 0. Any few bits that differ change the low 32. */
uint64_t checksum_add(uint64_t sum, const void *bytes, size_t size);

tile_record tile_record_of(const tile *t, uint64_t number);

/* Fills `deep`. A map of depths has a sample in every pixel, INFINITY where there is no surface, also of tile_lit. DSM_INVALID:
 * a pixel is coloured but there are only two channels, or it is packed as coloured although its channels agree
 * everywhere; DSM_NO_MEMORY. */
dsm_result tile_to_deep(const tile *t, uint32_t channels, deep_tile *deep);

/* A new tile. DSM_REFUSED: the samples do not make a tile, or are not those of the record; DSM_NO_MEMORY. */
dsm_result tile_from_deep(const deep_tile *deep, uint32_t channels, const tile_record *record, uint64_t number,
                          const tile **out);

#endif
