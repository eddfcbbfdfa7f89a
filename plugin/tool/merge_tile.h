/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* One tile of a motion-blurred map: the average of the same tile at several times (LV 5.5). */
#ifndef DSM_TOOL_MERGE_TILE_H
#define DSM_TOOL_MERGE_TILE_H

#include "core/average.h"
#include "map/baked_pixel.h"
#include "map/tile.h"

typedef struct {
  const tile *const *tiles;   /* `count` of them, stored or lit */
  const double *weights;      /* > 0, they add up to 1 */
  uint32_t count;
  double error;               /* of visibility, that each tile is known to be within; negative: as each tile says */
  double tolerance;           /* of compression, that is added; negative: half of `error`, or less where tiles say theirs, as
                                 averages have less noise */
} merge_input;

/* Kept between calls; zero-initialise. */
typedef struct {
  vertices parts, average, stored;
  average_scratch heap;
  size_t *first;
  uint32_t room;              /* of `first` */
  baked_pixel pixels[TILE_PIXELS];
} merge_scratch;

/* *out: a new tile, or &tile_lit. A pixel that is marked in any of the tiles is marked. If every tile is within its error of
 * some exact function, a pixel of the result is within error + tolerance of their average, which the tile records. */
dsm_result merge_tiles(const merge_input *in, merge_scratch *scratch, const tile **out);
void merge_scratch_free(merge_scratch *scratch);

#endif
