/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Grey pixels whose records tell how much deeper and how much darker a vertex is than the one before.
 *
 *   R bits        R bits               +---------------+--------------+
 *   +-----------+ +- - - - - - - - -+  | depth (D bits)| fall of the  |  one of these a vertex, packed bit by bit
 *   | start | 0 | | more of start   |  | + how much    | value        |
 *   +-----------+ +- - - - - - - - -+  +---------------+--------------+
 *              1: there is                                             (Low bits are to the left.)
 *
 * A pixel begins at `start` with 1, and that is its first vertex, unless the next is as deep: then that one is. R and D are the
 * tile's own, chosen so that it takes the fewest bytes: see delta_tile.c. What does not fit is told by records in front of the
 * vertex's own, in which all bits of the depth are set. They only add to its depth or its fall:
 *
 *   +----------------+---+---------+   k: 0: n * (2^D - 1) to the depth
 *   | 1 1 1 1 … (D)  | k |    n    |      1: n * 2^(R - D) to the fall
 *   +----------------+---+---------+
 *
 */
#ifndef DSM_CORE_DELTA_RECORDS_H
#define DSM_CORE_DELTA_RECORDS_H

#include "core/visibility_codes.h"

/* Records are narrow enough for a few in a word, and either number has room for the sum of those; DELTA_PADDING bytes behind the last
 * record may be read. */
enum { LEAST_DELTA_BITS = 5, MOST_DELTA_BITS = 19, LEAST_DEEPER_BITS = 2, LEAST_FALL_BITS = 3, DELTA_PADDING = 8 };

/* How to read a few records at once: what is the same for all pixels of a tile. */
typedef struct {
  const unsigned char *records;
  uint64_t ones;              /* 1 in each record of a word: in a product with it each has the sum of it and all in front of it */
  uint64_t deeper, darker;    /* the depths of all records, and their falls where these are moved down */
  uint32_t bits, depth_bits;  /* of a record, and of its depth */
  uint32_t last;              /* where the last one begins */
} delta_word_shape;

/* A walk from vertex to vertex. */
typedef struct {
  uint32_t at, end;               /* bits behind the tile's first record: of the next record, and behind the pixel's last */
  uint32_t depth, fall;           /* of a vertex: its code, and how much less than 1 its value's code is */
  uint32_t depth_before, fall_before;   /* of the one before it; the same ones if there is none, or none behind */
} delta_walk;

static inline __attribute__((always_inline)) delta_word_shape delta_shape_of(const visibility_codes *codes)
{
  uint32_t bits = codes->record_bits, depth_bits = codes->value_shift;
  uint64_t ones = 1 | 1ull << bits | 1ull << 2 * bits;
  if (bits <= 14)
    ones |= 1ull << 3 * bits;
  return (delta_word_shape){codes_records(codes), ones, ones * ((1u << depth_bits) - 1), ones * ((1u << (bits - depth_bits)) - 1), bits,
                            depth_bits, bits <= 14 ? 3 * bits : 2 * bits};
}

/* What begins at a bit, at least 57 bits of it. */
static inline uint64_t delta_word(const unsigned char *records, uint32_t at)
{
  uint64_t word;
  memcpy(&word, records + at / 8, sizeof word);
  return word >> at % 8;
}

/* To the start of a pixel that has `count` records from the `first` on, at least one. */
static inline __attribute__((always_inline)) delta_walk delta_begin(const delta_word_shape *s, uint32_t first, uint32_t count)
{
  uint32_t at = first * s->bits, one = (1u << s->bits) - 1;
  uint64_t word = delta_word(s->records, at);
  uint32_t more = -(uint32_t)(word & 1);
  uint32_t start = ((uint32_t)word & one) >> 1 | ((uint32_t)(word >> s->bits) & one & more) << (s->bits - 1);
  return (delta_walk){at + s->bits + (s->bits & more), at + count * s->bits, start, 0, start, 0};
}

/* A vertex, or the start of a pixel: where a later search in the same pixel may begin. */
typedef struct { uint32_t at, depth, fall; } delta_mark;

/* Whether some of the records whose depths these are are no vertices. */
static inline int delta_adds(const delta_word_shape *s, uint64_t depths)
{
  return ((depths + s->ones) & s->ones << s->depth_bits) != 0;
}

/* To a mark in the pixel or, if that is as deep as `code`, from there toward the light until it is not: a search for the code ends as if
 * it came from the pixel's start. As many records are taken back as delta_seek takes at once, so that what it made its way over is made
 * whole again; where some of them are no vertices, it had another way, and this does begin at the start. */
static inline __attribute__((always_inline)) delta_walk delta_resume(const delta_word_shape *s, uint32_t first, uint32_t count,
                                                                     const delta_mark *mark, uint64_t code)
{
  uint32_t all = s->last + s->bits, at = mark->at, depth = mark->depth, fall = mark->fall;
  uint64_t one = (1ull << s->bits) - 1;
  uint32_t begin = (first + 1) * s->bits;   /* or one record behind, where no search gets by whole words */
  while (__builtin_expect(depth >= code, 0)) {
    if (at < begin + all)
      return delta_begin(s, first, count);
    uint64_t word = delta_word(s->records, at - all) & ((1ull << all) - 1), depths = word & s->deeper;
    if (delta_adds(s, depths))
      return delta_begin(s, first, count);
    at -= all;
    depth -= (uint32_t)(depths * s->ones >> s->last & one);
    fall -= (uint32_t)((word >> s->depth_bits & s->darker) * s->ones >> s->last & one);
  }
  return (delta_walk){at, (first + count) * s->bits, depth, fall, depth, fall};
}

/* To the next vertex; 0: there is none. */
static inline int delta_next(const delta_word_shape *s, delta_walk *walk)
{
  uint32_t all = (1u << s->depth_bits) - 1;
  walk->depth_before = walk->depth;
  walk->fall_before = walk->fall;
  while (walk->at < walk->end) {
    uint32_t record = (uint32_t)delta_word(s->records, walk->at) & ((1u << s->bits) - 1);
    uint32_t deeper = record & all, rest = record >> s->depth_bits;
    walk->at += s->bits;
    if (deeper != all) {
      walk->depth += deeper;
      walk->fall += rest;
      return 1;
    }
    if (rest & 1)
      walk->fall += rest >> 1 << (s->bits - s->depth_bits);
    else
      walk->depth += (rest >> 1) * all;
  }
  return 0;
}

/* To the first vertex from here on that is as deep as `code`, or else to the last. Adds up a few records at once, and looks for the vertex
 * among those that get there. Only where one of them is no vertex it goes one by one. The mark is a place some records in front of it. */
static inline __attribute__((always_inline)) void delta_seek(const delta_word_shape *s, delta_walk *walk, uint64_t code, delta_mark *mark)
{
  uint32_t all = s->last + s->bits;
  uint64_t one = (1ull << s->bits) - 1;
  *mark = (delta_mark){walk->at, walk->depth, walk->fall};
  while (walk->depth < code && walk->at < walk->end) {
    *mark = (delta_mark){walk->at, walk->depth, walk->fall};
    uint32_t left = walk->end - walk->at, taken = left < all ? left : all;
    uint64_t word = delta_word(s->records, walk->at) & ((1ull << taken) - 1);   /* behind the pixel's last: zeros, which change nothing */
    uint64_t depths = word & s->deeper;
    if (__builtin_expect(delta_adds(s, depths), 0)) {
      uint32_t behind = walk->at + s->last;
      while (delta_next(s, walk) && walk->depth < code && walk->at <= behind)
        continue;
      continue;
    }
    uint64_t falls = (word >> s->depth_bits & s->darker) * s->ones, sum = (depths *= s->ones) >> s->last & one;
    if (walk->depth + sum >= code) {
      uint64_t tops = s->ones << (s->bits - 1), reach = ((depths | tops) - (code - walk->depth) * s->ones) & tops;
      uint32_t shift = (uint32_t)__builtin_ctzll(reach) - (s->bits - 1), record = (uint32_t)(word >> shift & one);
      walk->at += shift + s->bits;
      walk->depth += (uint32_t)(depths >> shift & one);
      walk->fall += (uint32_t)(falls >> shift & one);
      walk->depth_before = walk->depth - (record & ((1u << s->depth_bits) - 1));
      walk->fall_before = walk->fall - (record >> s->depth_bits);
      return;
    }
    walk->depth_before = walk->depth += (uint32_t)sum;
    walk->fall_before = walk->fall += (uint32_t)(falls >> s->last & one);
    walk->at += taken;
  }
}

/* As visibility_find, from where the last call with the same walk and a key that is no deeper has ended. Leaves a mark that is in front
 * of the key, if it finds a place. */
static inline __attribute__((always_inline)) int delta_find(const visibility_codes *codes, const delta_word_shape *s, delta_walk *walk,
                                                            visibility_key key, visibility_place *place, delta_mark *mark)
{
  uint64_t code = key.word >> DELTA_SHIFT;
  if (code <= walk->depth_before)
    return 0;
  delta_seek(s, walk, code, mark);
  uint32_t width = walk->depth < code ? 0 : walk->depth - walk->depth_before;
  place->a = place->b = 0;
  place->front = codes->value_mask - (width ? walk->fall_before : walk->fall);
  place->behind = codes->value_mask - walk->fall;
  place->t = width ? (key.z - walk->depth_before) / width : 1;
  return 1;
}

/* Whether the start of a pixel, which has records, is a vertex. */
int delta_starts_with_vertex(const delta_word_shape *s, uint32_t first, uint32_t count);
/* Vertices of a pixel with so many records. */
uint32_t delta_vertices(const visibility_codes *codes, uint32_t first, uint32_t count);
/* To one of them, in time that grows with its number. */
delta_walk delta_vertex(const visibility_codes *codes, uint32_t first, uint32_t count, uint32_t vertex);

#endif
