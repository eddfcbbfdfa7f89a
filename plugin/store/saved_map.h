/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Maps that come from files and go there; the published functions are described in dsm.h. */
#ifndef DSM_STORE_SAVED_MAP_H
#define DSM_STORE_SAVED_MAP_H

#include "map/worker.h"
#include "store/map_file.h"

/* Published. The map's own header (light, settings, projection, prints of the scene) must equal the file's. */
dsm_result saved_map_load(dsm_worker *worker, const char *path);

/* Published. Between them the scene stays as it is. After the second the map goes on, and reads its tiles from the new file
 * where the cache has given them up. A tile that could not be baked is DSM_REFUSED. */
dsm_result saved_map_begin(dsm_worker *worker, const char *path);
dsm_result saved_map_end(dsm_worker *worker, void (*progress)(void *worker_data, double share));

/* A map for tools that have no scene: its tiles come from the file. Give it a worker without a maker
 * (worker_create with NULL). `header` is the caller's to free. Of the host only `report` and `pause` are used. */
dsm_result saved_map_open(const char *path, const dsm_host *host, map_header *header, dsm_map **map, map_reason *why);

#endif
