/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What a look-up would cost that nobody has made yet: the tiles it wants, without making them. */
#ifndef DSM_MAP_WANTED_TILES_H
#define DSM_MAP_WANTED_TILES_H

#include "map/worker.h"

/* Published; see dsm.h. */
dsm_result map_tiles_wanted(dsm_worker *worker, const dsm_receiver *receiver,
                            void (*wanted)(void *data, const dsm_tiles *tiles), void *data);
dsm_result map_bake_tile(dsm_worker *worker, uint32_t face, uint32_t x, uint32_t y);

#endif
