/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* How much light reaches a receiver, by a depth map: percentage closer filtering (RSC 2, 3.2, figure 4). */
#ifndef DSM_MAP_DEPTH_LOOKUP_H
#define DSM_MAP_DEPTH_LOOKUP_H

#include "map/worker.h"

/* As map_lookup, within worker_enter and worker_leave, for a map that holds depths. All numbers of the receiver are finite. */
dsm_result depth_look_up(dsm_worker *worker, const dsm_receiver *receiver, double out[3]);

#endif
