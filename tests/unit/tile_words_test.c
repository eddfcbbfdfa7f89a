/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What is written is read, bit for bit; and what no tile gives is refused: rule by rule here, by chance in damaged_words_test.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "made_tile.h"

/* ---- Rule by rule ----------------------------------------------------------------------------------------------- */

enum { MOST_RECORDS = 600, MOST_WORDS = 2000 };

/* What the words are to say. Builds them as the format is described, and not as the program does. */
typedef struct {
  uint32_t layout, record_bits, value_bits, depth_bits, quantum;
  uint32_t count[TILE_PIXELS];
  unsigned char coloured[TILE_PIXELS], marked[TILE_PIXELS], need[TILE_PIXELS];
  uint64_t records[MOST_RECORDS];   /* of all pixels, one after the other */
  uint32_t rest;                    /* added to the last word's top bit */
  int words_more;
} told;

static size_t words_of(const told *s, uint32_t words[MOST_WORDS]) {
  size_t n = 2, records = 0;
  memset(words, 0, MOST_WORDS * sizeof *words);
  words[0] = s->layout | s->record_bits << 8 | s->value_bits << 16 | s->depth_bits << 24;
  words[1] = s->quantum;
  for (int i = 0; i < TILE_PIXELS; ++i) {
    records += s->count[i];
    if (s->layout & TILE_WIDE) words[n + (size_t)i] = s->count[i];
    else words[n + (size_t)i / 4] |= s->count[i] << 8 * (i % 4);
  }
  n += s->layout & TILE_WIDE ? 256 : 64;
  if (s->layout & TILE_COLOURED) {
    for (int i = 0; i < TILE_PIXELS; ++i) words[n + (size_t)i / 32] |= (uint32_t)s->coloured[i] << i % 32;
    n += 8;
  }
  if (s->layout & TILE_MARKED) {
    for (int i = 0; i < TILE_PIXELS; ++i) words[n + (size_t)i / 32] |= (uint32_t)s->marked[i] << i % 32;
    n += 8;
  }
  if (s->layout & TILE_REFINED) {
    for (int i = 0; i < TILE_PIXELS; ++i) words[n + (size_t)i / 4] |= (uint32_t)s->need[i] << 8 * (i % 4);
    n += 64;
  }
  for (size_t i = 0; i < records * s->record_bits; ++i)
    words[n + i / 32] |= (uint32_t)(s->records[i / s->record_bits] >> i % s->record_bits & 1) << i % 32;
  n += (records * s->record_bits + 31) / 32;
  words[n - 1] |= s->rest << 31;
  return n + (size_t)s->words_more;
}

static dsm_result read_told(const told *s) {
  static uint32_t words[MOST_WORDS];
  size_t count = words_of(s, words);
  const tile *t;
  uint32_t *exact = malloc(count * sizeof *words + 1);   /* a sanitizer sees reading behind it */
  memcpy(exact, words, count * sizeof *words);
  dsm_result result = tile_from_words(exact, count, 1.5, 0.25f, &t);
  free(exact);
  if (result == DSM_OK) {
    rng r = rng_seeded(count);
    walk_tile(&r, t);
    assert_true(t->near_depth == 1.5 && t->tolerance == 0.25f);
  }
  else assert_null(t);
  tile_destroy(t);
  return result;
}

/* Depths of 12 bits and values of 4 in pixel 3, in colour in pixel 9, a mark, and need. */
static told absolute_told(void) {
  told s = {.layout = TILE_COLOURED | TILE_MARKED | TILE_REFINED, .record_bits = 16, .value_bits = 4, .quantum = 150,
            .count = {[3] = 3, [9] = 4}, .coloured = {[9] = 1}, .marked = {[11] = 1}, .need = {[5] = 7},
            .records = {0 << 4 | 15, 2 << 4 | 9, 2 << 4 | 3, 1 << 4 | 14, 4 << 4 | 10, 13 << 4 | 14, 5 << 4 | 10}};
  return s;
}

/* One pixel of 33 bits for depth and 7 for value. */
static told floats_told(void) {
  told s = {.record_bits = 40, .value_bits = 7, .count = {[200] = 2}, .records = {0x3f800000ull << 7 | 100, 0x7f7fffffull << 7 | 0}};
  return s;
}

/* Depths of 6 bits and falls of 4; a start, a vertex, a record that adds to the depth, one that adds to the fall, and a vertex; and a
 * start of two records. Values have 5 bits. */
static told deltas_told(void) {
  told s = {.record_bits = 10, .value_bits = 5, .depth_bits = 6, .quantum = 150, .count = {[3] = 5, [200] = 2},
            .records = {5 << 1, 2 << 6 | 3, 1 << 7 | 63, 1 << 7 | 1 << 6 | 63, 4 << 6 | 1, 5 << 1 | 1, 1}};
  return s;
}

#define EXPECT(result, change) \
  do { \
    told s = start; \
    change; \
    if (read_told(&s) != (result)) fail_msg("line %d: %s", __LINE__, #change); \
  } while (0)
#define REFUSED(change) EXPECT(DSM_REFUSED, change)
#define READ(change) EXPECT(DSM_OK, change)

static void the_layout_is_known_and_needed(void **state) {
  (void)state;
  told start = absolute_told();
  READ((void)0);
  static const uint32_t unknown[] = {TILE_DEPTHS, 32, 64, 128};
  for (int i = 0; i < 4; ++i) REFUSED(s.layout |= unknown[i]);
  REFUSED(s.layout |= TILE_WIDE);                /* nothing asks for it */
  start.coloured[9] = 0;
  start.count[9] = 2;
  REFUSED((void)0);
  READ(s.layout ^= TILE_COLOURED);
  start = absolute_told();
  REFUSED(s.marked[11] = 0);
  READ(s.marked[11] = 0; s.layout ^= TILE_MARKED);
  REFUSED(s.need[5] = 0);
  READ(s.need[5] = 0; s.layout ^= TILE_REFINED);
  READ(for (int i = 0; i < TILE_PIXELS; ++i) s.need[i] = (unsigned char)i);
  told wide = {.layout = TILE_WIDE, .record_bits = 16, .value_bits = 4, .quantum = 1, .count = {[255] = 256}};
  start = wide;
  READ((void)0);
  REFUSED(s.count[255] = 255);
  REFUSED(s.layout = 0);
}

static void the_size_follows(void **state) {
  (void)state;
  told start = absolute_told();
  REFUSED(s.words_more = 1);
  REFUSED(s.words_more = -1);
  REFUSED(s.rest = 1);   /* 7 times 16 bits */
  told wide = {.layout = TILE_WIDE, .record_bits = 32, .value_bits = 4, .quantum = 1, .count = {[255] = 256}};
  start = wide;
  static const uint32_t counts[] = {0, 255, 257, 0x7fffffff, 0x80000000, 0x80000100, 0xffffffff};
  for (int i = 0; i < 7; ++i) {
    static uint32_t words[MOST_WORDS];
    const tile *t;
    size_t count = words_of(&start, words);
    words[2 + 255] = counts[i];
    assert_int_equal(tile_from_words(words, count, 1, 0, &t), DSM_REFUSED);
    words[2 + 254] = 256 - counts[i];   /* the sum fits, in 32 bits */
    if (counts[i] > 256) assert_int_equal(tile_from_words(words, count, 1, 0, &t), DSM_REFUSED);
  }
  static uint32_t words[MOST_WORDS];
  size_t count = words_of(&start, words);
  const tile *t;
  for (size_t n = 0; n < count; ++n) {
    uint32_t *exact = malloc(n * sizeof *words + 1);
    memcpy(exact, words, n * sizeof *words);
    assert_int_equal(tile_from_words(exact, n, 1, 0, &t), DSM_REFUSED);
    free(exact);
  }
}

static void codes_are_possible(void **state) {
  (void)state;
  told start = {.record_bits = 24, .value_bits = 4, .quantum = 150};   /* nothing but codes */
  READ((void)0);
  for (uint32_t bits = 0; bits < 256; ++bits) {
    dsm_result whole = bits % 8 == 0 && bits > 4 && bits <= 40 ? DSM_OK : DSM_REFUSED;
    dsm_result floats = bits == 40 || bits == 48 ? DSM_OK : DSM_REFUSED;
    EXPECT(whole, s.record_bits = bits);
    EXPECT(floats, s.record_bits = bits; s.quantum = 0);
    EXPECT(bits >= 1 && bits <= 16 ? DSM_OK : DSM_REFUSED, s.value_bits = bits);
    EXPECT(bits >= 1 && bits <= 7 ? DSM_OK : DSM_REFUSED, s.record_bits = 8; s.value_bits = bits);
    EXPECT(bits >= 1 && bits <= 8 ? DSM_OK : DSM_REFUSED, s.record_bits = 40; s.quantum = 0; s.value_bits = bits);
    EXPECT(bits >= 5 && bits <= 19 ? DSM_OK : DSM_REFUSED, s.record_bits = bits; s.depth_bits = 2);
    dsm_result deltas = bits == 0 || (bits >= 2 && bits <= 13) ? DSM_OK : DSM_REFUSED;
    EXPECT(deltas, s.record_bits = 16; s.depth_bits = bits);
    EXPECT(bits >= 1 && bits <= 16 ? DSM_OK : DSM_REFUSED, s.depth_bits = 2; s.record_bits = 5; s.value_bits = bits);
    EXPECT(bits >= 1 && bits <= 254 ? DSM_OK : DSM_REFUSED, s.quantum = bits);   /* 24 bits are no float */
  }
  static const uint32_t large[] = {256, 0x7fffffff, 0x80000000, 0xffffffff};
  for (int i = 0; i < 4; ++i) REFUSED(s.quantum = large[i]);
  REFUSED(s.depth_bits = 2; s.record_bits = 8; s.quantum = 0);
}

static void pixels_do_not_contradict(void **state) {
  (void)state;
  told start = absolute_told();
  REFUSED(s.marked[3] = 1);
  REFUSED(s.marked[9] = 1);
  REFUSED(s.coloured[20] = 1);                   /* of none */
  REFUSED(s.records[5] = 14 << 4 | 14; s.records[6] = 10 << 4 | 10);   /* in grey */
  READ(s.records[5] = 14 << 4 | 13; s.records[6] = 10 << 4 | 10);
  READ(s.records[5] = 14 << 4 | 14; s.records[6] = 9 << 4 | 10);
  told wide = {.layout = TILE_COLOURED, .record_bits = 16, .value_bits = 8, .quantum = 9, .count = {[9] = 2}, .coloured = {[9] = 1},
               .records = {1 << 8 | 4, 3 << 8 | 2}};
  start = wide;
  READ((void)0);
  REFUSED(s.count[9] = 3);                       /* half a vertex more */
  REFUSED(s.value_bits = 9; s.records[0] = 1 << 9 | 4; s.records[1] = 3 << 9 | 2);   /* the third channel could say less than the others */
}

static void functions_are_functions(void **state) {
  (void)state;
  told start = absolute_told();
  REFUSED(s.records[1] = 3 << 4 | 9);            /* and falls to 2 */
  REFUSED(s.records[0] = 3 << 4 | 15);
  REFUSED(s.records[2] = 2 << 4 | 10);           /* a value grows */
  READ(s.records[2] = 2 << 4 | 9);
  READ(s.records[2] = 4094 << 4 | 3);
  REFUSED(s.records[2] = 4095 << 4 | 3);         /* left over, behind all depths */
  REFUSED(s.records[6] = 5 << 4 | 15);           /* the second channel grows */
  REFUSED(s.records[6] = 14 << 4 | 10);          /* the third one */
  REFUSED(s.records[5] = 16 << 4 | 14);          /* and is more than 1 */
  READ(s.records[5] = 15 << 4 | 14);
  start.record_bits = 32;
  READ(s.records[2] = 0xfffffeull << 4 | 3);
  REFUSED(s.records[2] = 0xffffffull << 4 | 3);
  REFUSED(s.records[2] = 0xfffffffull << 4 | 3);
}

static void floats_are_finite(void **state) {
  (void)state;
  told start = floats_told();
  READ((void)0);
  static const uint64_t bad[] = {0x7f800000, 0x7f800001, 0x7fc00000, 0xbf800000, 0x80000000, 0xffffffff, 0x100000000, 0x13f800000};
  for (int i = 0; i < 8; ++i) {
    REFUSED(s.records[1] = bad[i] << 7);
    REFUSED(s.records[0] = bad[i] << 7 | 100);
  }
  REFUSED(s.records[1] = 0x3f7fffffull << 7);
  READ(s.records[1] = 0x3f800000ull << 7);
  REFUSED(s.records[1] |= 101);
}

static void deltas_are_deltas(void **state) {
  (void)state;
  told start = deltas_told();
  READ((void)0);
  REFUSED(s.layout = TILE_COLOURED; s.coloured[200] = 1);
  REFUSED(s.rest = 1);
  REFUSED(s.records[6] = 0);                     /* more of the start, which is nothing */
  REFUSED(s.count[200] = 1);                     /* more, which is not there */
  REFUSED(s.count[3] = 1; s.records[0] = 5 << 1 | 1; s.records[1] = 5 << 1 | 1; s.records[2] = 1);   /* but another pixel's */
  REFUSED(s.count[3] = 4; s.records[4] = s.records[5]; s.records[5] = s.records[6]);   /* a fall that no vertex has */
  REFUSED(s.count[3] = 3; s.records[3] = s.records[5]; s.records[4] = s.records[6]);   /* a depth */
  REFUSED(s.records[2] = 63);                    /* adds nothing to the depth */
  REFUSED(s.records[3] = 1 << 6 | 63);           /* to the fall */
  READ(s.records[4] = 13 << 6 | 1);              /* 31: all of it, as 2 and 16 are gone already */
  REFUSED(s.records[4] = 14 << 6 | 1);
  start.record_bits = 19;
  start.depth_bits = 2;
  start.value_bits = 16;
  start.count[3] = 0;
  start.records[0] = 1;                          /* pixel 200: 19 bits more, of which 6 are one code's */
  READ(s.records[1] = 63);
  REFUSED(s.records[1] = 64);
  REFUSED(s.records[1] = 1 << 14);               /* nothing of it within 32 bits */
  start.count[200] = 3;
  start.records[1] = 63;
  READ(s.records[0] = 0x3fffe << 1 | 1; s.records[2] = 0);
  REFUSED(s.records[0] = 0x3fffe << 1 | 1; s.records[2] = 1);
  start.records[0] = 0;
  start.records[1] = 1 << 4 | 1 << 2 | 3;        /* 2^17 to a fall of 16 bits; 2^33 below */
  start.records[2] = 0;
  REFUSED((void)0);
  REFUSED(s.records[1] = 0x8000ull << 3 | 1 << 2 | 3);
  told wide = {.layout = TILE_WIDE, .record_bits = 5, .value_bits = 1, .depth_bits = 2, .quantum = 150, .count = {[0] = 500}};
  start = wide;
  READ((void)0);
  REFUSED(s.count[0] = 501);
  READ(s.count[0] = 500; s.count[1] = 99);
}

/* ---- By chance -------------------------------------------------------------------------------------------------- */

static void what_is_written_is_read(void **state) {
  (void)state;
  uint32_t seen = 0, kinds[3] = {0};
  for (uint64_t seed = 0; seed < most_cases(800); ++seed) {
    rng r = rng_seeded(seed);
    tile *t = any_tile(&r);
    size_t count = tile_words_count(t);
    uint32_t *words = malloc(count * sizeof *words);
    tile_to_words(t, words);
    const tile *back;
    assert_seeded(&r, tile_from_words(words, count, t->near_depth, t->tolerance, &back) == DSM_OK);
    assert_seeded(&r, same_tiles(t, back) && tile_words_count(back) == count);
    assert_seeded(&r, count * sizeof *words <= t->size - sizeof *t + 8);   /* a file's codes take 8 bytes */
    walk_tile(&r, back);
    same_answers(&r, t, back);
    seen |= t->layout;
    ++kinds[codes_are_deltas(&t->codes) ? 0 : codes_are_whole(&t->codes) ? 1 : 2];
    free(words);
    tile_destroy(back);
    tile_destroy(t);
  }
  assert_int_equal(seen, TILE_WIDE | TILE_COLOURED | TILE_MARKED | TILE_REFINED);
  for (int i = 0; i < 3; ++i) assert_true(kinds[i] > most_cases(800) / 20);
}

/* Where a pixel is grey it has one value a vertex, in memory and in a file; no tile of a scene without colour has room for three. */
static void grey_takes_one_channel(void **state) {
  (void)state;
  size_t words[2];
  for (int coloured = 0; coloured < 2; ++coloured) {
    tile_plan plan = {.count = {[4] = 80, [5] = 80}, .coloured = {[4] = (unsigned char)coloured}};
    tile *t = tile_create(&plan);
    for (uint32_t i = 0; i < 80; ++i) {
      float z = 0.1f * (float)i;
      tile_put(t, 5, i, 0, z, 9);
      for (uint32_t c = 0; c < (coloured ? 3 : 1); ++c) tile_put(t, 4, i, c, z, (uint16_t)((80 - i) * 700 + c));
    }
    words[coloured] = tile_words_count(t);
    tile_destroy(t);
  }
  assert_int_equal(words[0], 2 + 64 + 160 * 48 / 32);
  assert_int_equal(words[1], 2 + 64 + 8 + 240 * 48 / 32);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_layout_is_known_and_needed),
    cmocka_unit_test(the_size_follows),
    cmocka_unit_test(codes_are_possible),
    cmocka_unit_test(pixels_do_not_contradict),
    cmocka_unit_test(functions_are_functions),
    cmocka_unit_test(floats_are_finite),
    cmocka_unit_test(deltas_are_deltas),
    cmocka_unit_test(what_is_written_is_read),
    cmocka_unit_test(grey_takes_one_channel),
  };
  return cmocka_run_group_tests_name("tile words", tests, NULL, NULL);
}
