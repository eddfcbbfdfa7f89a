/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/vertices.h"

#include <stdint.h>
#include <stdlib.h>

dsm_result vertices_push(vertices *list, double z, rgb v) {
  if (list->count == list->capacity) {
    /* Rays have a handful of vertices or hundreds, hence half as much again from a small start. */
    size_t capacity = list->capacity + list->capacity / 2 + 16;
    if (capacity < list->capacity || capacity > SIZE_MAX / sizeof(vertex)) return DSM_NO_MEMORY;
    vertex *data = realloc(list->data, capacity * sizeof(vertex));
    if (!data) return DSM_NO_MEMORY;
    list->data = data;
    list->capacity = capacity;
  }
  list->data[list->count++] = (vertex){z, v};
  return DSM_OK;
}

dsm_result vertices_append(vertices *list, const vertex *from, size_t count) {
  dsm_result result = DSM_OK;
  for (size_t i = 0; i < count && result == DSM_OK; ++i) result = vertices_push(list, from[i].z, from[i].v);
  return result;
}

void vertices_free(vertices *list) {
  free(list->data);
  *list = (vertices){0};
}

rgb vertices_at(const vertex *data, size_t count, double z) {
  /* The first vertex that is not in front of z; of a step's two vertices it finds the value in front. */
  size_t low = 0, high = count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (data[middle].z < z) low = middle + 1;
    else high = middle;
  }
  if (low == 0) return rgb_grey(1);
  if (low == count) return data[count - 1].v;
  const vertex *a = &data[low - 1], *b = &data[low];
  if (b->z == z) return b->v;
  return rgb_lerp(a->v, b->v, (z - a->z) / (b->z - a->z));
}
