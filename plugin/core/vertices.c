/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/vertices.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

dsm_result vertices_reserve(vertices *list, size_t more) {
  if (more <= list->capacity - list->count) return DSM_OK;
  /* Rays have a handful of vertices or hundreds, hence half as much again from a small start. */
  size_t capacity = list->capacity + list->capacity / 2 + 16, most = SIZE_MAX / sizeof(vertex);
  if (more > most - list->count || capacity > most) return DSM_NO_MEMORY;
  if (capacity < list->count + more) capacity = list->count + more;
  vertex *data = realloc(list->data, capacity * sizeof(vertex));
  if (!data) return DSM_NO_MEMORY;
  list->data = data;
  list->capacity = capacity;
  return DSM_OK;
}

dsm_result vertices_append(vertices *list, const vertex *from, size_t count) {
  dsm_result result = vertices_reserve(list, count);
  if (result != DSM_OK || count == 0) return result;
  memcpy(list->data + list->count, from, count * sizeof(vertex));
  list->count += count;
  return DSM_OK;
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
