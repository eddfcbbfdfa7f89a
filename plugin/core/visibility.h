/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A pixel's stored visibility function and its evaluation (LV 3.4). The inner loop of every look-up.
 *
 *   +-------+-----------------+-------+-----------------+-----+     A vertex is a record: as many bits for all of a tile, of
 *   | value | code of a depth | value | code of a depth | ... |     whole bytes unless records are deltas (delta_records.h),
 *   +-------+-----------------+-------+-----------------+-----+     as in most maps. (Low bits are to the left.)
 *
 * Codes sort as depths do. Read so that its last byte is the top byte of a word, a record is less than another one if its
 * depth is, whatever else the word holds below. So a search turns the depth that it looks for into such a word once, and compares
 * words as they come.
 *
 * Codes of 32 bits are floats; those of fewer are multiples of the tile's quantum, a power of two, which a float could hold,
 * too: both ways give the same depths. Values are codes of 1 to 16 bits, the largest of which is 1. A function of three channels has
 * as many records again behind those of its first channel, with the values of the third and the second in place of depth and
 * value; codes of depths have at least the bits of values then.
 */
#ifndef DSM_CORE_VISIBILITY_H
#define DSM_CORE_VISIBILITY_H

#include <stddef.h>

#include "core/delta_records.h"
#include "core/rgb.h"

/* As in vertices.h, with depths relative to the tile's near depth: finite, from 0 on. */
typedef struct {
  const visibility_codes *codes;
  uint32_t first;       /* of the pixel's records */
  uint32_t records;     /* how many */
  uint32_t count;       /* of vertices, whose depths never fall; evaluation does not need to know it of deltas */
  uint32_t channels;    /* 1 or 3 */
} visibility;

/* The eight bytes of which an absolute record is the last ones, and so the top. */
static inline uint64_t record_word(const unsigned char *at)
{
  uint64_t word;
  memcpy(&word, at, sizeof word);
  return word;
}

/* Of the first record, as record_word wants it. */
static inline const unsigned char *visibility_words(const visibility *function, size_t bytes)
{
  return codes_records(function->codes) + ((size_t)function->first + 1) * bytes - sizeof(uint64_t);
}

static inline uint64_t visibility_word(const visibility *function, size_t record)
{
  size_t bytes = function->codes->record_bits / 8;
  return record_word(visibility_words(function, bytes) + record * bytes);
}

/* Relative depth in units of codes. */
static inline double codes_depth(const visibility_codes *codes, uint64_t word, int whole)
{
  union { uint32_t bits; float value; } f = {(uint32_t)(word >> codes->depth_shift)};
  return whole ? (double)(int64_t)(word >> codes->depth_shift) : (double)f.value;
}

static inline uint32_t codes_value(const visibility_codes *codes, uint64_t word)
{
  return (uint32_t)(word >> codes->value_shift) & codes->value_mask;
}

/* Relative depth of a vertex, scene units. Where records are deltas, this and those below walk there. */
static inline double visibility_depth(const visibility *function, uint32_t vertex)
{
  const visibility_codes *codes = function->codes;
  if (codes_are_deltas(codes))
    return delta_vertex(codes, function->first, function->records, vertex).depth / codes->per_quantum;
  int whole = codes_are_whole(codes);
  double z = codes_depth(codes, visibility_word(function, vertex), whole);
  return whole ? z / codes->per_quantum : z;
}

/* The code of a value. Channel 0 of a grey function stands for all. */
static inline uint32_t visibility_code(const visibility *function, uint32_t vertex, uint32_t channel)
{
  const visibility_codes *codes = function->codes;
  if (codes_are_deltas(codes))
    return codes->value_mask - delta_vertex(codes, function->first, function->records, vertex).fall;
  uint64_t word = visibility_word(function, vertex + (size_t)(channel ? function->count : 0));
  return channel == 2 ? (uint32_t)(word >> codes->depth_shift) : codes_value(codes, word);
}

/* In VALUE_STEPS. */
static inline uint32_t visibility_stored(const visibility *function, uint32_t vertex, uint32_t channel)
{
  return value_of_code(visibility_code(function, vertex, channel), function->codes->value_mask);
}

/* The first vertex that is not in front of the key, `count` if there is none: a binary search without branches, as none of
 * them could be predicted. */
static inline __attribute__((always_inline)) uint32_t visibility_search(const visibility *function, uint64_t key, size_t bytes)
{
  const unsigned char *words = visibility_words(function, bytes), *from = words;
  size_t n = function->count;
  while (n > 1) {
    size_t half = n / 2, less = -(size_t)(record_word(from + half * bytes - bytes) < key) & half;
    from += less * bytes;
    n -= half;
  }
  return (uint32_t)((size_t)(from - words) / bytes) + (record_word(from) < key);
}

/* As visibility_find, with the bytes of an absolute record and the kind of codes as constants that the compiler knows. */
static inline __attribute__((always_inline)) int visibility_find_as(const visibility *function, visibility_key key, uint32_t *hint,
                                                                    visibility_place *place, size_t bytes, int whole)
{
  const visibility_codes *codes = function->codes;
  uint32_t i = *hint;
  const unsigned char *words = visibility_words(function, bytes), *at = words + i * bytes;
  if (i - 1 >= function->count || record_word(at - bytes) >= key.word || (i < function->count && record_word(at) < key.word)) {
    *hint = i = visibility_search(function, key.word, bytes);
    at = words + i * bytes;
  }
  if (i == 0)
    return 0;

  /* Behind the last vertex both ends are that vertex, and a zero width never divides. */
  uint64_t front = record_word(at - bytes), behind = i < function->count ? record_word(at) : front;
  double near_end = codes_depth(codes, front, whole), width = codes_depth(codes, behind, whole) - near_end;
  place->a = i - 1;
  place->b = i - (i == function->count);
  place->front = codes_value(codes, front);
  place->behind = codes_value(codes, behind);
  place->t = width > 0 ? (key.z - near_end) / width : 1;
  return 1;
}

/* Finds a depth in a function that has vertices; at a step, the place in front of it. 0: in front of all
 * vertices, where the value is 1. `hint` is where the caller's last search in this pixel ended, any number at first:
 * neighbouring look-ups mostly end where the last one did (LV 3.4). The search leaves its end there; deltas have no use for it. */
static inline int visibility_find(const visibility *function, visibility_key key, uint32_t *hint, visibility_place *place)
{
  const visibility_codes *codes = function->codes;
  if (codes_are_deltas(codes)) {
    delta_word_shape shape = delta_shape_of(codes);
    delta_walk walk = delta_begin(&shape, function->first, function->records);
    delta_mark unused;
    return delta_find(codes, &shape, &walk, key, place, &unused);
  }
  return visibility_find_as(function, key, hint, place, codes->record_bits / 8, codes_are_whole(codes));
}

static inline __attribute__((always_inline)) double visibility_value(const visibility *function, const visibility_place *place,
                                                                      uint32_t channel)
{
  double a = (int32_t)(channel ? visibility_code(function, place->a, channel) : place->front);
  double b = (int32_t)(channel ? visibility_code(function, place->b, channel) : place->behind);
  return function->codes->unit * (a + place->t * (b - a));
}

/* The value at relative depth z, of any function. */
rgb visibility_at(const visibility *function, double z, uint32_t *hint);

#endif
