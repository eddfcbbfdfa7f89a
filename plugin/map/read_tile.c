/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/read_tile.h"

static rgb grey_of(uint32_t code, uint32_t most)
{
  double value = value_of_code(code, most) * (1.0 / VALUE_STEPS);
  return (rgb){{value, value, value}};
}

static rgb value_of(const visibility *v, uint32_t vertex)
{
  if (v->channels == 1)
    return grey_of(visibility_code(v, vertex, 0), v->codes->value_mask);
  rgb value;
  for (uint32_t c = 0; c < 3; c++)
    value.c[c] = visibility_stored(v, vertex, c) * (1.0 / VALUE_STEPS);
  return value;
}

static dsm_result push_delta(const visibility_codes *codes, const delta_walk *walk, double near_depth, vertices *out)
{
  return vertices_push(out, near_depth + walk->depth / codes->per_quantum, grey_of(codes->value_mask - walk->fall, codes->value_mask));
}

static dsm_result push_deltas(const visibility *v, double near_depth, vertices *out)
{
  delta_word_shape shape = delta_shape_of(v->codes);
  delta_walk walk = delta_begin(&shape, v->first, v->records);
  dsm_result result = delta_starts_with_vertex(&shape, v->first, v->records) ? push_delta(v->codes, &walk, near_depth, out) : DSM_OK;
  while (result == DSM_OK && delta_next(&shape, &walk))
    result = push_delta(v->codes, &walk, near_depth, out);
  return result;
}

static dsm_result push_records(const visibility *v, double near_depth, vertices *out)
{
  dsm_result result = DSM_OK;
  for (uint32_t i = 0; i < v->count && result == DSM_OK; i++)
    result = vertices_push(out, near_depth + visibility_depth(v, i), value_of(v, i));
  return result;
}

dsm_result read_vertices(const visibility *v, double near_depth, vertices *out)
{
  if (v->count == 0)
    return DSM_OK;
  size_t begin = out->count;
  dsm_result result = codes_are_deltas(v->codes) ? push_deltas(v, near_depth, out) : push_records(v, near_depth, out);
  if (result != DSM_OK)
    out->count = begin;
  return result;
}

dsm_result read_pixel(const tile *t, uint32_t place, vertices *out)
{
  if (t->kind != TILE_STORED)
    return DSM_OK;
  visibility v = tile_visibility(t, place);
  return read_vertices(&v, t->near_depth, out);
}
