/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* How a map knows its scene again. */
#ifndef DSM_STORE_FINGERPRINT_H
#define DSM_STORE_FINGERPRINT_H

#include "map/worker.h"
#include "store/map_header.h"

/* Prints the scene as it is now: the boxes of its casters, and what 1,024 fixed light rays meet, depths rounded to 1e-6 of
 * each ray's range of depths and transmittances to 1e-6. What no probe ray meets and no box shows is not seen. DSM_REFUSED, with
 * a reason: the library for files is missing; what host->trace returned; DSM_CANCELLED; DSM_NO_MEMORY. */
dsm_result fingerprint_take(dsm_worker *worker, scene_print *print, map_reason *why);

#endif
