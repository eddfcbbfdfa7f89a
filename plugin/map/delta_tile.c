/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/delta_tile.h"

#include <string.h>

/* Look-ups are slow where records are no vertices, so such a record is as bad as this many. */
enum { ADDING_COSTS = 2 };

enum { LENGTHS = MOST_CODE_BITS + 2 };   /* bits of a number; of a depth, that of one more counts */

/* How many numbers have so many bits; none has `end` or more. */
typedef struct { uint32_t starts[LENGTHS], depths[LENGTHS], falls[LENGTHS], end; } lengths;

static uint32_t length_of(uint32_t number)
{
  return number ? 32 - (uint32_t)__builtin_clz(number) : 0;
}

/* A pixel's vertices that take records: all but a first one that is 1. What is in front of them is as deep as the first, and 1. */
typedef struct {
  const coded_vertex *next, *end;
  uint32_t depth, value;
} pixel_walk;

static inline pixel_walk begin(const coded_vertex *v, uint32_t count, uint32_t one)
{
  return (pixel_walk){v + (v->value[0] == one), v + count, v->depth, one};
}

typedef struct { uint32_t deeper, fall; } delta;

static inline delta step(pixel_walk *w)
{
  const coded_vertex *v = w->next++;
  delta d = {v->depth - w->depth, w->value - v->value[0]};
  w->depth = v->depth;
  w->value = v->value[0];
  return d;
}

/* 0: no deltas tell the pixel. */
static int measure_pixel(const coded_vertex *v, uint32_t count, uint32_t one, lengths *n)
{
  pixel_walk w = begin(v, count, one);
  int begins_twice = w.next > v && w.next < w.end && w.next->depth == w.depth;
  n->starts[length_of(w.depth)]++;
  while (w.next < w.end) {
    if (w.next->depth < w.depth || w.next->value[0] > w.value)
      return 0;
    delta d = step(&w);
    n->depths[length_of(d.deeper + 1)]++;
    n->falls[length_of(d.fall)]++;
  }
  return !begins_twice;
}

static int measure(const coded_tile *t, lengths *n)
{
  const coded_vertex *v = t->vertices;
  uint32_t one = (1u << t->value_bits) - 1;
  memset(n, 0, sizeof *n);
  for (uint32_t i = 0; i < TILE_PIXELS; v += t->plan.count[i++])
    if (t->plan.coloured[i] || (t->plan.count[i] && !measure_pixel(v, t->plan.count[i], one, n)))
      return 0;
  for (n->end = LENGTHS; n->end > 0 && !(n->starts[n->end - 1] | n->depths[n->end - 1] | n->falls[n->end - 1]);)
    n->end--;
  return 1;
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

/* What all records take, in bits, or UINT64_MAX where they cannot tell a number or take as much as `least`. One for each of the
 * `numbers`, and more for the long ones. */
static uint64_t bits_taken(const lengths *n, delta_shape shape, uint64_t numbers, uint64_t least)
{
  uint32_t most = most_added(shape), fall_bits = shape.bits - shape.depth_bits;
  uint32_t shorter = shape.depth_bits < fall_bits ? shape.depth_bits : fall_bits;
  uint64_t records = numbers;
  for (uint32_t length = n->end; length-- > shorter + 1 && records * shape.bits < least;) {
    uint32_t deeper = length > shape.depth_bits, darker = length > fall_bits;
    if (n->starts[length] && length > 2 * shape.bits - 1)
      return UINT64_MAX;
    if (most == 0 && ((deeper && n->depths[length]) || (darker && n->falls[length])))
      return UINT64_MAX;
    if (length >= shape.bits)
      records += n->starts[length];
    if (deeper && n->depths[length])
      records += ADDING_COSTS * (uint64_t)n->depths[length] * divided_up(1u << (length - shape.depth_bits), most);
    if (darker && n->falls[length])
      records += ADDING_COSTS * (uint64_t)n->falls[length] * divided_up(1u << (length - fall_bits), most);
  }
  return records * shape.bits < least ? records * shape.bits : UINT64_MAX;
}

/* Longer records are not better once a record for each number takes as much as the best so far. */
static delta_shape best_shape(const lengths *n)
{
  delta_shape best = {0, 0};
  uint64_t least = UINT64_MAX, numbers = 0;
  for (uint32_t length = 0; length < n->end; length++)
    numbers += (uint64_t)n->starts[length] + n->depths[length];
  for (uint32_t bits = LEAST_DELTA_BITS; bits <= MOST_DELTA_BITS && numbers * bits < least; bits++)
    for (uint32_t depth_bits = LEAST_DEEPER_BITS; depth_bits + LEAST_FALL_BITS <= bits; depth_bits++) {
      uint64_t taken = bits_taken(n, (delta_shape){bits, depth_bits}, numbers, least);
      if (taken < least) {
        least = taken;
        best = (delta_shape){bits, depth_bits};
      }
    }
  return best;
}

static uint32_t count_records(const coded_vertex *v, uint32_t count, uint32_t one, delta_shape shape)
{
  pixel_walk w = begin(v, count, one);
  uint32_t all = (1u << shape.depth_bits) - 1, fall_bits = shape.bits - shape.depth_bits, most = most_added(shape);
  uint32_t records = 1 + (w.depth >> (shape.bits - 1) > 0) + (uint32_t)(w.end - w.next);
  while (w.next < w.end) {
    delta d = step(&w);
    if (d.deeper >= all)
      records += divided_up(d.deeper / all, most);
    if (d.fall >> fall_bits)
      records += divided_up(d.fall >> fall_bits, most);
  }
  return records;
}

int delta_tile_plan(const coded_tile *t, uint64_t most, delta_plan *plan)
{
  lengths n;
  if (!(t->per_quantum > 0) || !measure(t, &n))
    return 0;
  delta_shape shape = best_shape(&n);
  if (shape.bits == 0)
    return 0;
  const coded_vertex *v = t->vertices;
  plan->shape = shape;
  plan->records = t->plan;
  for (uint32_t i = 0; i < TILE_PIXELS; v += t->plan.count[i++])
    if (t->plan.count[i]) {
      uint32_t records = count_records(v, t->plan.count[i], (1u << t->value_bits) - 1, shape);
      if (records > MOST_DELTAS)
        return 0;
      plan->records.count[i] = records;
    }
  return tile_bytes(&plan->records, shape.bits, DELTA_PADDING) < most;
}

/* Where records go, bit by bit. */
typedef struct {
  unsigned char *to;
  uint64_t word;       /* of which the lowest bits are not written for good yet: fewer than eight */
  uint32_t held;
  delta_shape shape;
} record_writer;

static inline void put(record_writer *w, uint32_t record)
{
  w->word |= (uint64_t)record << w->held;
  w->held += w->shape.bits;
  memcpy(w->to, &w->word, sizeof w->word);   /* at the end into the padding */
  w->to += w->held / 8;
  w->word >>= w->held / 8 * 8;
  w->held %= 8;
}

/* Adds `units` to the depth (kind 0) or to the fall (1). */
static void put_more(record_writer *w, uint32_t units, uint32_t kind)
{
  uint32_t all = (1u << w->shape.depth_bits) - 1, most = most_added(w->shape);
  for (; units > 0; units -= units < most ? units : most)
    put(w, (units < most ? units : most) << (w->shape.depth_bits + 1) | kind << w->shape.depth_bits | all);
}

static void put_pixel(record_writer *to, const coded_vertex *v, uint32_t count, uint32_t one)
{
  pixel_walk w = begin(v, count, one);
  uint32_t bits = to->shape.bits, depth_bits = to->shape.depth_bits, all = (1u << depth_bits) - 1, fall_bits = bits - depth_bits;
  uint32_t more = w.depth >> (bits - 1);
  put(to, (w.depth << 1 & ((1u << bits) - 1)) | (more > 0));
  if (more)
    put(to, more);
  while (w.next < w.end) {
    delta d = step(&w);
    if (d.deeper >= all) {
      put_more(to, d.deeper / all, 0);
      d.deeper %= all;
    }
    put_more(to, d.fall >> fall_bits, 1);
    put(to, (d.fall & ((1u << fall_bits) - 1)) << depth_bits | d.deeper);
  }
}

tile *delta_tile(const coded_tile *from, const delta_plan *plan)
{
  tile *t = coded_tile_lay_out(from, &plan->records, plan->shape.bits, DELTA_PADDING);
  if (!t)
    return NULL;
  codes_set_deltas(&t->codes, plan->shape.bits, plan->shape.depth_bits, from->value_bits);
  record_writer w = {(unsigned char *)t + t->codes.records, 0, 0, plan->shape};
  const coded_vertex *v = from->vertices;
  for (uint32_t i = 0; i < TILE_PIXELS; v += from->plan.count[i++])
    if (from->plan.count[i])
      put_pixel(&w, v, from->plan.count[i], (1u << from->value_bits) - 1);
  return t;
}
