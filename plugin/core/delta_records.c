/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/delta_records.h"

int delta_starts_with_vertex(const delta_word_shape *s, uint32_t first, uint32_t count)
{
  delta_walk walk = delta_begin(s, first, count);
  return !delta_next(s, &walk) || walk.depth > walk.depth_before;
}

uint32_t delta_vertices(const visibility_codes *codes, uint32_t first, uint32_t count)
{
  if (count == 0)
    return 0;
  delta_word_shape s = delta_shape_of(codes);
  uint32_t vertices = delta_starts_with_vertex(&s, first, count) != 0;
  for (delta_walk walk = delta_begin(&s, first, count); delta_next(&s, &walk);)
    vertices++;
  return vertices;
}

delta_walk delta_vertex(const visibility_codes *codes, uint32_t first, uint32_t count, uint32_t vertex)
{
  delta_word_shape s = delta_shape_of(codes);
  delta_walk walk = delta_begin(&s, first, count);
  for (uint32_t i = delta_starts_with_vertex(&s, first, count) ? 0 : UINT32_MAX; i != vertex; i++)
    delta_next(&s, &walk);
  return walk;
}
