/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Which casters light of a tile may meet, by their boxes: what meets no box need not be traced.
 *
 *   light  \   |   /     A box takes more than its caster, so a ray beside all of them arrives, and a pixel whose rays all do
 *           \ .---.      is lit: what tracing would have told as well.
 *            \|box|
 */
#ifndef DSM_BAKE_TILE_BOXES_H
#define DSM_BAKE_TILE_BOXES_H

#include "bake/bake_pixel.h"
#include "map/tile.h"

/* More boxes than that take longer to look at than they spare. */
enum { MOST_TILE_BOXES = 64 };

typedef struct {
  uint32_t count;   /* MOST_TILE_BOXES + 1: there are more, or nobody knows */
  const dsm_box *box[MOST_TILE_BOXES];
} tile_boxes;

/* Finds all whose outline reaches into what the tile's pixels are filtered from. */
void tile_boxes_find(const bake_job *job, const tile_key *key, tile_boxes *out);

/* Whether one of some rays of the tile may meet a caster. */
int tile_boxes_may_meet(const tile_boxes *boxes, const dsm_ray *rays, uint32_t count);

/* Makes pixels want a finer level always where a caster is too small for this one to be sure to find it: `width` of a pixel at depth z is
 * width * z + width_at_least. Large sheets are found, however thin. */
void tile_boxes_want_finer(const tile_boxes *boxes, const bake_job *job, const tile_key *key, double width, double width_at_least,
                           baked_pixel pixels[TILE_PIXELS]);

#endif
