/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A piecewise linear function of depth, as a growing list of vertices.
 *
 * Depths never fall. Two vertices at one depth make a step: the first holds the value in front of it, the
 * second the value behind it. Before the first vertex the function is 1 in every channel; after the last it
 * keeps the last value. No vertices at all: 1 everywhere. A first vertex that is not 1 is thus the far side
 * of a step from 1.
 */
#ifndef DSM_CORE_VERTICES_H
#define DSM_CORE_VERTICES_H

#include <stddef.h>

#include "core/rgb.h"
#include "dsm.h"

typedef struct { double z; rgb v; } vertex;

typedef struct {
  vertex *data;
  size_t count, capacity;
} vertices;

/* Room for so many more. DSM_NO_MEMORY leaves the list as it was. */
dsm_result vertices_reserve(vertices *list, size_t more);

/* Appends one vertex. DSM_NO_MEMORY leaves the list as it was. */
static inline dsm_result vertices_push(vertices *list, double z, rgb v) {
  if (list->count == list->capacity && vertices_reserve(list, 1) != DSM_OK) return DSM_NO_MEMORY;
  list->data[list->count++] = (vertex){z, v};
  return DSM_OK;
}

/* Appends those of another list, likewise. */
dsm_result vertices_append(vertices *list, const vertex *from, size_t count);
void vertices_free(vertices *list);   /* gives the memory back; the list is empty and may be used again */

/* The value at depth z; at a step, the value in front of it (a surface does not shadow itself). Binary
 * search. */
rgb vertices_at(const vertex *data, size_t count, double z);

#endif
