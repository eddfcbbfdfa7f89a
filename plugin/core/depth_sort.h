/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Things in order of depth. */
#ifndef DSM_CORE_DEPTH_SORT_H
#define DSM_CORE_DEPTH_SORT_H

#include <stddef.h>
#include <stdint.h>

typedef struct depth_key { double z; size_t index; } depth_key;   /* index: of the thing at depth z */

/* A stable merge sort: O(n log n), and O(n) where the keys are in order already. `scratch` is as long as `keys`. */
void depth_sort(depth_key *keys, size_t count, depth_key *scratch);

#endif
