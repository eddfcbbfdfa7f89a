/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * How coarse a map with `accuracy` may be read, told by a few places of the picture.
 *
 *   `accuracy` is a root mean square over the picture, so what edges may be off by depends on how much of it they take. The first level
 *   tells that, at places that are spread over the picture: with pixels of a share C of the footprint's width, the squared error of all
 *   goes with C where they are wider than an image pixel, and with C^3 where they are not, as an image pixel then averages several. So C
 *   follows from the aim.
 */
#ifndef DSM_MAP_EXPLORE_H
#define DSM_MAP_EXPLORE_H

#include "map/worker.h"

/* Published; see dsm.h. */
dsm_result map_explore(dsm_worker *worker, const dsm_receiver *receiver);
void map_explored(dsm_map *map, uint64_t camera_rays, double rays_across);

#endif
