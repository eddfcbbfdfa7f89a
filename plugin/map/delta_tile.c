/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/delta_tile.h"

#include <stdlib.h>
#include <string.h>

/* Look-ups are slow where records are no vertices, so such a record is as bad as this many. */
enum { ADDING_COSTS = 2 };

enum { LENGTHS = 33 };   /* bits of a number: 0 to 32 */

typedef struct { uint32_t deeper, fall; } delta;

/* A tile's pixels: their starts, and the deltas of all, one pixel's after the other's. */
typedef struct {
  uint32_t start[TILE_PIXELS], count[TILE_PIXELS];   /* count: of deltas; NONE: the pixel is empty */
  delta *deltas;
} tile_deltas;

static const uint32_t NONE = UINT32_MAX;

/* How many numbers have so many bits. */
typedef struct { uint32_t starts[LENGTHS], depths[LENGTHS], falls[LENGTHS]; } lengths;

/* Bits of a record, and those of them that are the depth's. */
typedef struct { uint32_t bits, depth_bits; } delta_shape;

static uint32_t length_of(uint32_t number)
{
  return number ? 32 - (uint32_t)__builtin_clz(number) : 0;
}

/* Its deltas, behind `to`, exact, as the tile has been found to be told by these codes; NONE: it has none that tell it. */
static uint32_t read_deltas(const visibility *v, const visibility_codes *codes, uint32_t *start, delta *to)
{
  uint32_t most = codes->value_mask, depth = 0, value = most, n = 0;
  for (uint32_t i = 0; i < v->count; i++) {
    uint32_t next = (uint32_t)(visibility_depth(v, i) * codes->per_quantum), code = code_of_value(visibility_stored(v, i, 0), most);
    if (i == 0)
      *start = depth = next;
    if (next < depth || code > value || (i == 1 && n == 0 && next == depth))
      return NONE;
    if (i > 0 || code < most)
      to[n++] = (delta){next - depth, value - code};
    depth = next;
    value = code;
  }
  return n;
}

static int read_tile(const tile *t, const visibility_codes *codes, tile_deltas *out)
{
  delta *to = out->deltas;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    visibility v = tile_visibility(t, i);
    out->count[i] = NONE;
    if (v.count == 0)
      continue;
    out->count[i] = read_deltas(&v, codes, &out->start[i], to);
    if (out->count[i] == NONE)
      return 0;
    to += out->count[i];
  }
  return 1;
}

static lengths lengths_of(const tile_deltas *all)
{
  lengths n = {{0}, {0}, {0}};
  const delta *d = all->deltas;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    if (all->count[i] == NONE)
      continue;
    n.starts[length_of(all->start[i])]++;
    for (uint32_t k = 0; k < all->count[i]; k++, d++) {
      n.depths[length_of(d->deeper + 1)]++;
      n.falls[length_of(d->fall)]++;
    }
  }
  return n;
}

/* What is left for the number in a record that only adds. */
static uint32_t most_added(delta_shape shape)
{
  return (1u << (shape.bits - shape.depth_bits - 1)) - 1;
}

static uint32_t divided_up(uint32_t a, uint32_t b)
{
  return (a + b - 1) / b;
}

/* What all records take, in bits, or UINT64_MAX where they cannot tell a number. */
static uint64_t bits_taken(const lengths *n, delta_shape shape)
{
  uint32_t most = most_added(shape), fall_bits = shape.bits - shape.depth_bits;
  uint64_t records = 0;
  for (uint32_t length = 0; length < LENGTHS; length++) {
    uint32_t deeper = length > shape.depth_bits, darker = length > fall_bits;
    if (n->starts[length] && length > 2 * shape.bits - 1)
      return UINT64_MAX;
    if (most == 0 && ((deeper && n->depths[length]) || (darker && n->falls[length])))
      return UINT64_MAX;
    records += (uint64_t)n->starts[length] * (length < shape.bits ? 1 : 2) + n->depths[length];
    if (deeper && n->depths[length])
      records += ADDING_COSTS * (uint64_t)n->depths[length] * divided_up(1u << (length - shape.depth_bits), most);
    if (darker && n->falls[length])
      records += ADDING_COSTS * (uint64_t)n->falls[length] * divided_up(1u << (length - fall_bits), most);
  }
  return records * shape.bits;
}

static delta_shape best_shape(const lengths *n)
{
  delta_shape best = {0, 0};
  uint64_t least = UINT64_MAX;
  for (uint32_t bits = LEAST_DELTA_BITS; bits <= MOST_DELTA_BITS; bits++)
    for (uint32_t depth_bits = LEAST_DEEPER_BITS; depth_bits + LEAST_FALL_BITS <= bits; depth_bits++) {
      uint64_t taken = bits_taken(n, (delta_shape){bits, depth_bits});
      if (taken < least) {
        least = taken;
        best = (delta_shape){bits, depth_bits};
      }
    }
  return best;
}

/* Where records go; NULL: they are only counted. */
typedef struct {
  unsigned char *bytes;
  delta_shape shape;
  uint32_t count;
} record_sink;

static void put(record_sink *s, uint32_t record)
{
  uint64_t at = (uint64_t)s->count++ * s->shape.bits, word = (uint64_t)record << at % 8;
  for (unsigned char *byte = s->bytes ? s->bytes + at / 8 : NULL; byte && word; word >>= 8)
    *byte++ |= (unsigned char)word;
}

/* Adds `units` to the depth (kind 0) or to the fall (1). */
static void put_more(record_sink *s, uint32_t units, uint32_t kind)
{
  uint32_t all = (1u << s->shape.depth_bits) - 1, most = most_added(s->shape);
  for (; units > 0; units -= units < most ? units : most)
    put(s, (units < most ? units : most) << (s->shape.depth_bits + 1) | kind << s->shape.depth_bits | all);
}

static void put_pixel(record_sink *s, uint32_t start, const delta *d, uint32_t count)
{
  uint32_t bits = s->shape.bits, depth_bits = s->shape.depth_bits, all = (1u << depth_bits) - 1, fall_bits = bits - depth_bits;
  uint32_t more = start >> (bits - 1);
  put(s, (start << 1 & ((1u << bits) - 1)) | (more > 0));
  if (more)
    put(s, more);
  for (uint32_t k = 0; k < count; k++) {
    put_more(s, d[k].deeper / all, 0);
    put_more(s, d[k].fall >> fall_bits, 1);
    put(s, (d[k].fall & ((1u << fall_bits) - 1)) << depth_bits | d[k].deeper % all);
  }
}

/* 0: a pixel is too long. */
static int plan_tile(const tile *from, const tile_deltas *all, delta_shape shape, tile_plan *plan)
{
  const delta *d = all->deltas;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    record_sink counted = {NULL, shape, 0};
    plan->coloured[i] = 0;
    plan->marked[i] = tile_is_marked(from, i) != 0;
    plan->need[i] = (unsigned char)tile_need_at(from, i);
    if (all->count[i] != NONE) {
      put_pixel(&counted, all->start[i], d, all->count[i]);
      d += all->count[i];
    }
    plan->count[i] = counted.count;
    if (counted.count > MOST_DELTAS)
      return 0;
  }
  return 1;
}

static tile *build(const tile *from, const visibility_codes *codes, const tile_deltas *all, size_t most)
{
  tile_plan plan;
  lengths n = lengths_of(all);
  delta_shape shape = best_shape(&n);
  if (shape.bits == 0 || !plan_tile(from, all, shape, &plan))
    return NULL;
  tile *t = tile_create_empty(&plan, shape.bits, DELTA_PADDING);
  if (!t || t->size >= most) {
    tile_destroy(t);
    return NULL;
  }
  t->codes.per_quantum = codes->per_quantum;
  codes_set_deltas(&t->codes, shape.bits, shape.depth_bits, codes->value_bits);
  t->near_depth = from->near_depth;
  t->tolerance = from->tolerance;
  t->volume = from->volume;
  record_sink s = {(unsigned char *)t + t->codes.records, shape, 0};
  const delta *d = all->deltas;
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    if (all->count[i] != NONE) {
      put_pixel(&s, all->start[i], d, all->count[i]);
      d += all->count[i];
    }
  return t;
}

tile *delta_tile_of(const tile *from, const visibility_codes *codes, size_t most)
{
  size_t vertices = 1;
  if (from->layout & TILE_COLOURED || !codes_are_whole(codes))
    return NULL;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    uint32_t count = tile_visibility(from, i).count;
    if (count > MOST_DELTAS)
      return NULL;
    vertices += count;
  }
  tile_deltas *all = malloc(sizeof *all + vertices * sizeof(delta));
  if (!all)
    return NULL;
  all->deltas = (delta *)(all + 1);
  tile *t = read_tile(from, codes, all) ? build(from, codes, all, most) : NULL;
  free(all);
  return t;
}
