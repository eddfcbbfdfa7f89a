/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* All of a map, tile by tile. */
#ifndef DSM_MAP_WHOLE_MAP_H
#define DSM_MAP_WHOLE_MAP_H

#include "map/worker.h"

/* Published; see dsm.h. Tiles are taken in the order of their numbers. `share` is set when a tile was made and when none is
 * left. A tile that was cancelled is taken again by a later call. */
dsm_result map_bake_next(dsm_worker *worker, double *share);

#endif
