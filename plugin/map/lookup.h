/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* How much light reaches a receiver. By a deep map: the four pixels around it, each read at its own biased depth (LV 3.4). By
 * a map of depths: see depth_lookup.h. */
#ifndef DSM_MAP_LOOKUP_H
#define DSM_MAP_LOOKUP_H

#include "map/worker.h"

/* Whether all its numbers are finite, and it has no more planes than there is room for. */
int receiver_is_sound(const dsm_receiver *receiver);

/* Published; see dsm.h. No lock and no allocation once the tiles are there. */
dsm_result map_lookup(dsm_worker *worker, const dsm_receiver *receiver, double out[3]);

#endif
