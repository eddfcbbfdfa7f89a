/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Some pixels of a tile, all from the same number of rays, in shares that several threads may make:
 *
 *   pixels --> rays --> host->trace --> events --> bake_pixel
 *              a batch of whole pixels at a time
 */
#ifndef DSM_BAKE_BAKE_PASS_H
#define DSM_BAKE_BAKE_PASS_H

#include "bake/bake_pixel.h"
#include "bake/tile_boxes.h"
#include "core/pixel_sample.h"
#include "map/tile.h"
#include "map/tile_shares.h"
#include "map/worker.h"

/* What has become of a share. */
typedef struct {
  vertices stored;
  tile_tally tally;
} baked_share;

/* Memory that a worker keeps from tile to tile. Zero-initialise. */
typedef struct {
  dsm_ray *rays;
  pixel_point *path;
  uint32_t room_rays, room_path, path_samples;
  dsm_sink sink;
  pixel_scratch pixel;
  vertices stored;
  vertices near_by;   /* of sparse_tile.c: the functions that one is averaged from */
  baked_pixel pixels[TILE_PIXELS];   /* vertices in `stored` */
  tile_boxes boxes;   /* of this thread's tile, with `accuracy` */
  baked_share shares[MOST_SHARES];   /* of this thread's tile, whoever makes them */
} bake_scratch;

/* A thread that bakes, behind the face that the map knows. All makers of a map that bakes deep tiles begin with it. */
typedef struct {
  tile_maker maker;
  bake_job job;
  bake_scratch scratch;
} pixel_baker;

/* Which pixels: places as in tile.h. */
typedef struct { uint8_t place[TILE_PIXELS]; uint32_t count; } place_list;
_Static_assert(TILE_PIXELS <= 256, "a place is a byte");

/* Bakes these pixels of a tile from `samples` rays each into scratch->pixels. With `accuracy`, pixels whose rays meet none of
 * scratch->boxes are lit, and none of their rays is traced. With job->store, together with those who wait for the tile. DSM_OK, DSM_CANCELLED if
 * `pause` asked for it, DSM_NO_MEMORY, or what `trace` returned. Adds to `tally`. */
dsm_result bake_pass(const bake_job *job, bake_scratch *scratch, const tile_key *key, uint32_t samples,
                     const place_list *places, tile_tally *tally);
void bake_scratch_free(bake_scratch *scratch);

#endif
