/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A worker that can bake: a thread's bake scratch behind the face that the map knows (map/worker.h). */
#ifndef DSM_BAKE_BAKER_H
#define DSM_BAKE_BAKER_H

#include "map/worker.h"

/* Published as worker_create; see dsm.h. */
dsm_result baker_worker_create(dsm_map *map, void *host_data, dsm_worker **worker);

#endif
