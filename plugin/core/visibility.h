/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A pixel's stored visibility function and its evaluation (LV 3.4). The inner loop of every look-up. */
#ifndef DSM_CORE_VISIBILITY_H
#define DSM_CORE_VISIBILITY_H

#include <stddef.h>
#include <stdint.h>

#include "core/rgb.h"

/* As in vertices.h, with float depths relative to the tile's near depth. */
typedef struct {
  const float *depth;   /* `count` of them, never falling */
  const float *value;   /* `channels` for each vertex */
  uint32_t count;
  uint32_t channels;    /* 1 or 3 */
} visibility;

/* The value at relative depth z; at a step, the value in front of it. `hint` is where the caller's last
 * search in this pixel ended, any number at first; the search starts there and leaves its end there. */
rgb visibility_at(const visibility *function, double z, uint32_t *hint);

#endif
