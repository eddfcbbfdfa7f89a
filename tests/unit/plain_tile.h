/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Tiles filled vertex by vertex, in records that no numbers have to be rounded for: of 48 bits, with depths that are floats. */
#ifndef DSM_TEST_PLAIN_TILE_H
#define DSM_TEST_PLAIN_TILE_H

#include <stdlib.h>

#include "map/compact_tile.h"

static inline tile *tile_create(const tile_plan *plan) {
  tile *t = tile_create_empty(plan, MOST_RECORD_BITS, 0);
  if (t) codes_set(&t->codes, MOST_RECORD_BITS, VALUE_BITS);
  return t;
}

static inline void tile_put_record(tile *t, size_t index, uint64_t record) {
  uint32_t bytes = MOST_RECORD_BITS / 8;
  memcpy((unsigned char *)t + t->codes.records + index * bytes, &record, bytes);
}

/* One channel of a vertex. Grey pixels have channel 0 alone. */
static inline void tile_put(tile *t, uint32_t place, uint32_t vertex, uint32_t channel, float depth, uint16_t value) {
  visibility v = tile_visibility(t, place);
  union { float value; uint32_t bits; } f = {depth};
  size_t first = tile_first(t, place), second = first + v.count + vertex;
  if (channel == 0) {
    tile_put_record(t, first + vertex, (uint64_t)f.bits << VALUE_BITS | value);
    return;
  }
  uint64_t third = visibility_code(&v, vertex, 2), other = visibility_code(&v, vertex, 1);
  tile_put_record(t, second, channel == 1 ? third << VALUE_BITS | value : (uint64_t)value << VALUE_BITS | other);
}

static inline coded_tile coded_of(const tile *t) {
  coded_tile c = {.depth_bits = FLOAT_BITS, .value_bits = VALUE_BITS, .near_depth = t->near_depth, .tolerance = t->tolerance, .volume = t->volume};
  c.vertices = malloc((tile_first(t, TILE_PIXELS - 1) + tile_records(t, TILE_PIXELS - 1) + 1) * sizeof *c.vertices);
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    visibility v = tile_visibility(t, i);
    c.plan.count[i] = v.count;
    c.plan.coloured[i] = v.channels == 3;
    c.plan.marked[i] = tile_is_marked(t, i) != 0;
    c.plan.need[i] = (unsigned char)tile_need_at(t, i);
    for (uint32_t k = 0; k < v.count; ++k) {
      union { float value; uint32_t bits; } f = {(float)visibility_depth(&v, k)};
      coded_vertex *to = &c.vertices[c.count++];
      to->depth = f.bits;
      for (uint32_t n = 0; n < v.channels; ++n) to->value[n] = (uint16_t)visibility_stored(&v, k, n);
    }
  }
  return c;
}

/* The same in as few bytes as pack_tile takes for it. Takes `t`. */
static inline tile *tile_compact(tile *t) {
  coded_tile c = coded_of(t);
  delta_plan plan;
  coded_tile_shorten(&c);
  tile_destroy(t);
  t = compact_as_deltas(&c, &plan) ? delta_tile(&c, &plan) : absolute_tile(&c);
  free(c.vertices);
  return t;
}

#endif
