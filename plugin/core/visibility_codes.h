/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* In what numbers a tile says its vertices, and how wide its records are: see visibility.h. */
#ifndef DSM_CORE_VISIBILITY_CODES_H
#define DSM_CORE_VISIBILITY_CODES_H

#include <stdint.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "records are read as words from any byte on");

/* A value is this many times the visibility, a whole number, before it becomes a code; rounding takes up to VALUE_ROUNDING of it. */
#define VALUE_STEPS 65535
#define VALUE_ROUNDING (0.5 / VALUE_STEPS)

enum { VALUE_BITS = 16, FLOAT_BITS = 32, MOST_CODE_BITS = 24, MOST_RECORD_BITS = FLOAT_BITS + VALUE_BITS };

/* Instead of a shift, of which absolute records have more: records are deltas. */
enum { DELTA_SHIFT = 1 };

/* How a tile's records are to be read. They lie behind this, in the same block of memory. */
typedef struct {
  double per_quantum;   /* 1 / the quantum of the depths' codes, scene units; 0: they are floats */
  double unit;          /* what 1 in the code of a value stands for */
  uint16_t records;     /* where they begin: bytes from here; what reads the first touches up to seven in front */
  uint16_t value_mask;
  uint8_t record_bits, value_bits;
  uint8_t depth_shift;  /* to the right, of a word as record_word gives it; or DELTA_SHIFT */
  uint8_t value_shift;  /* of such a word; of a delta: how many bits of it are the depth's */
} visibility_codes;

/* A depth as records can be compared with it. */
typedef struct {
  uint64_t word;   /* records in front of the depth are less, or their depths shifted by DELTA_SHIFT; 0: nothing is in front */
  double z;        /* in units of codes */
} visibility_key;

/* Where a depth lies in a function: between two vertices, at the share t of the way. */
typedef struct {
  uint32_t a, b;            /* the two; deltas do not count them */
  uint32_t front, behind;   /* codes of their values, in the first channel */
  double t;
} visibility_place;

static inline void codes_set_values(visibility_codes *codes, uint32_t record_bits, uint32_t value_bits)
{
  codes->record_bits = (uint8_t)record_bits;
  codes->value_bits = (uint8_t)value_bits;
  codes->value_mask = (uint16_t)((1u << value_bits) - 1);
  codes->unit = 1.0 / codes->value_mask;
}

/* Absolute records, of whole bytes. */
static inline void codes_set(visibility_codes *codes, uint32_t record_bits, uint32_t value_bits)
{
  codes_set_values(codes, record_bits, value_bits);
  codes->depth_shift = (uint8_t)(64 - (record_bits - value_bits));
  codes->value_shift = (uint8_t)(64 - record_bits);
}

/* Deltas; the depth has `depth_bits` of a record. */
static inline void codes_set_deltas(visibility_codes *codes, uint32_t record_bits, uint32_t depth_bits, uint32_t value_bits)
{
  codes_set_values(codes, record_bits, value_bits);
  codes->depth_shift = DELTA_SHIFT;
  codes->value_shift = (uint8_t)depth_bits;
}

static inline int codes_are_deltas(const visibility_codes *codes)
{
  return codes->depth_shift == DELTA_SHIFT;
}

/* Whether codes of depths are whole numbers, and no floats. */
static inline int codes_are_whole(const visibility_codes *codes)
{
  return codes->per_quantum > 0;
}

static inline const unsigned char *codes_records(const visibility_codes *codes)
{
  return (const unsigned char *)codes + codes->records;
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

/* The code next to a value in VALUE_STEPS, `most` being that for 1; whether it stands for exactly that is another matter. */
static inline uint32_t code_of_value(uint32_t value, uint32_t most)
{
  return (value * most + VALUE_STEPS / 2) / VALUE_STEPS;
}

/* What a code stands for, in VALUE_STEPS; `most` is the largest code. */
static inline uint32_t value_of_code(uint32_t code, uint32_t most)
{
  return (code * VALUE_STEPS + most / 2) / most;
}

#endif
