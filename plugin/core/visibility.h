/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A pixel's stored visibility function and its evaluation (LV 3.4). The inner loop of every look-up.
 *
 *   +-------+-----------------+-------+-----------------+-----+     A vertex is a record of a few whole bytes, as many
 *   | value | code of a depth | value | code of a depth | ... |     for all of a tile.
 *   +-------+-----------------+-------+-----------------+-----+     (Low bits are to the left.)
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
#include <stdint.h>
#include <string.h>

#include "core/rgb.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "records are read as words from any byte on");

/* A value is this many times the visibility, a whole number, before it becomes a code; rounding takes up to VALUE_ROUNDING of it. */
#define VALUE_STEPS 65535
#define VALUE_ROUNDING (0.5 / VALUE_STEPS)

enum { VALUE_BITS = 16, FLOAT_BITS = 32, MOST_CODE_BITS = 24, MOST_RECORD_BYTES = (FLOAT_BITS + VALUE_BITS) / 8 };

/* How a tile's records are to be read. They lie behind this, in the same block of memory. */
typedef struct {
  double per_quantum;   /* 1 / the quantum of the depths' codes, scene units; 0: they are floats */
  double unit;          /* what 1 in the code of a value stands for */
  uint16_t records;     /* where they begin: bytes from here; what reads the first touches up to six in front */
  uint16_t value_mask;
  uint8_t record_bytes, value_bits;
  uint8_t depth_shift, value_shift;   /* to the right, of a word as record_word gives it */
} visibility_codes;

/* As in vertices.h, with depths relative to the tile's near depth: finite, from 0 on. */
typedef struct {
  const visibility_codes *codes;
  const unsigned char *word;   /* of the first record: see record_word */
  uint32_t count;       /* of vertices, whose depths never fall */
  uint32_t channels;    /* 1 or 3 */
} visibility;

/* A depth as records can be compared with it. */
typedef struct {
  uint64_t word;   /* records in front of the depth are less; 0: nothing is in front */
  double z;        /* in units of codes */
} visibility_key;

/* Where a depth lies in a function: between vertices a and b, at the share t of the way. */
typedef struct {
  uint32_t a, b;
  double t;
  uint64_t front, behind;   /* the words of a and b */
} visibility_place;

static inline void codes_set(visibility_codes *codes, uint32_t record_bytes, uint32_t value_bits)
{
  codes->record_bytes = (uint8_t)record_bytes;
  codes->value_bits = (uint8_t)value_bits;
  codes->depth_shift = (uint8_t)(64 - (8 * record_bytes - value_bits));
  codes->value_shift = (uint8_t)(64 - 8 * record_bytes);
  codes->value_mask = (uint16_t)((1u << value_bits) - 1);
  codes->unit = 1.0 / codes->value_mask;
}

/* The eight bytes of which a record is the last ones, and so the top. */
static inline uint64_t record_word(const unsigned char *at)
{
  uint64_t word;
  memcpy(&word, at, sizeof word);
  return word;
}

static inline const unsigned char *codes_word(const visibility_codes *codes, size_t record)
{
  return (const unsigned char *)codes + codes->records + (record + 1) * codes->record_bytes - sizeof(uint64_t);
}

static inline uint64_t visibility_word(const visibility *function, size_t record)
{
  return record_word(function->word + record * function->codes->record_bytes);
}

/* Relative depth in units of codes. */
static inline double codes_depth(const visibility_codes *codes, uint64_t word, int whole)
{
  union { uint32_t bits; float value; } f = {(uint32_t)(word >> codes->depth_shift)};
  return whole ? (double)(int64_t)(word >> codes->depth_shift) : (double)f.value;
}

/* Whether codes of depths are whole numbers, and no floats. */
static inline int codes_are_whole(const visibility_codes *codes)
{
  return codes->per_quantum > 0;
}

static inline uint32_t codes_value(const visibility_codes *codes, uint64_t word)
{
  return (uint32_t)(word >> codes->value_shift) & codes->value_mask;
}

/* Relative depth of a vertex, scene units. */
static inline double visibility_depth(const visibility *function, uint32_t vertex)
{
  int whole = codes_are_whole(function->codes);
  double z = codes_depth(function->codes, visibility_word(function, vertex), whole);
  return whole ? z / function->codes->per_quantum : z;
}

/* The code of a value. Channel 0 of a grey function stands for all. */
static inline uint32_t visibility_code(const visibility *function, uint32_t vertex, uint32_t channel)
{
  uint64_t word = visibility_word(function, vertex + (size_t)(channel ? function->count : 0));
  return channel == 2 ? (uint32_t)(word >> function->codes->depth_shift) : codes_value(function->codes, word);
}

/* What a code stands for, in VALUE_STEPS; `most` is the largest code. */
static inline uint32_t value_of_code(uint32_t code, uint32_t most)
{
  return (code * VALUE_STEPS + most / 2) / most;
}

/* In VALUE_STEPS. */
static inline uint32_t visibility_stored(const visibility *function, uint32_t vertex, uint32_t channel)
{
  return value_of_code(visibility_code(function, vertex, channel), function->codes->value_mask);
}

static inline __attribute__((always_inline)) visibility_key visibility_key_as(const visibility_codes *codes, double z, int are_whole)
{
  visibility_key key = {0, z};
  if (!(z > 0))
    return key;
  uint64_t code;
  if (are_whole) {
    key.z = z * codes->per_quantum;
    double k = key.z < 0x1p30 ? key.z : 0x1p30;
    int64_t whole = (int64_t)k, most = (int64_t)(~0ull >> codes->depth_shift);   /* which no depth has */
    whole += (double)whole < k;
    code = (uint64_t)(whole < most ? whole : most);
  }
  else {
    union { float value; uint32_t bits; } f = {(float)z};
    code = (uint64_t)f.bits + ((double)f.value < z);
  }
  key.word = code << codes->depth_shift;
  return key;
}

static inline visibility_key visibility_key_of(const visibility_codes *codes, double z)
{
  return visibility_key_as(codes, z, codes_are_whole(codes));
}

/* The first vertex that is not in front of the key, `count` if there is none: a binary search without branches, as none of
 * them could be predicted. */
static inline __attribute__((always_inline)) uint32_t visibility_search(const visibility *function, uint64_t key, size_t bytes)
{
  const unsigned char *from = function->word;
  size_t n = function->count;
  while (n > 1) {
    size_t half = n / 2, less = -(size_t)(record_word(from + half * bytes - bytes) < key) & half;
    from += less * bytes;
    n -= half;
  }
  return (uint32_t)((size_t)(from - function->word) / bytes) + (record_word(from) < key);
}

/* As visibility_find, with the bytes of a record and the kind of codes as constants that the compiler knows. */
static inline __attribute__((always_inline)) int visibility_find_as(const visibility *function, visibility_key key, uint32_t *hint,
                                                                    visibility_place *place, size_t bytes, int whole)
{
  const visibility_codes *codes = function->codes;
  uint32_t i = *hint;
  const unsigned char *at = function->word + i * bytes;
  if (i - 1 >= function->count || record_word(at - bytes) >= key.word || (i < function->count && record_word(at) < key.word)) {
    *hint = i = visibility_search(function, key.word, bytes);
    at = function->word + i * bytes;
  }
  if (i == 0)
    return 0;

  /* Behind the last vertex both ends are that vertex, and a zero width never divides. */
  place->a = i - 1;
  place->b = i - (i == function->count);
  place->front = record_word(at - bytes);
  place->behind = i < function->count ? record_word(at) : place->front;
  double near_end = codes_depth(codes, place->front, whole), width = codes_depth(codes, place->behind, whole) - near_end;
  place->t = width > 0 ? (key.z - near_end) / width : 1;
  return 1;
}

/* Finds a depth in a function that has vertices; at a step, the place in front of it. 0: in front of all
 * vertices, where the value is 1. `hint` is where the caller's last search in this pixel ended, any number at first:
 * neighbouring look-ups mostly end where the last one did (LV 3.4). The search leaves its end there. */
static inline int visibility_find(const visibility *function, visibility_key key, uint32_t *hint, visibility_place *place)
{
  const visibility_codes *codes = function->codes;
  return visibility_find_as(function, key, hint, place, codes->record_bytes, codes_are_whole(codes));
}

static inline double visibility_value(const visibility *function, const visibility_place *place, uint32_t channel)
{
  const visibility_codes *codes = function->codes;
  double a = (int32_t)(channel ? visibility_code(function, place->a, channel) : codes_value(codes, place->front));
  double b = (int32_t)(channel ? visibility_code(function, place->b, channel) : codes_value(codes, place->behind));
  return codes->unit * (a + place->t * (b - a));
}

/* The value at relative depth z, of any function. */
rgb visibility_at(const visibility *function, double z, uint32_t *hint);

#endif
