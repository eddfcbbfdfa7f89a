/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Words of good tiles that are damaged by chance, and words that were never any better: refused, or a tile of which all holds that
 * look-ups take for granted. RUNS says how many, SEED where to begin.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "made_tile.h"

static uint64_t number_from(const char *name, uint64_t usual) {
  const char *text = getenv(name);
  return text ? strtoull(text, NULL, 10) : usual;
}

/* Half of all damage is to the first words, and half of it to single bits. */
static size_t damage(rng *r, uint32_t *words, size_t count) {
  size_t at = rng_below(r, rng_below(r, 2) && count > 70 ? 70 : (uint32_t)count), other = rng_below(r, (uint32_t)count);
  if (rng_below(r, 4) == 0) at = rng_below(r, 2);
  static const uint32_t edges[] = {0, 1, 0x7f, 0xff, 0x100, 0x7fffffff, 0x80000000, 0xffffffff};
  switch (rng_below(r, 10)) {
    case 0: words[at] = edges[rng_below(r, 8)]; break;
    case 1: words[at] = (uint32_t)rng_bits(r); break;
    case 2: words[at] = words[other]; break;
    case 3: ((unsigned char *)words)[4 * at + rng_below(r, 4)] = (unsigned char)rng_bits(r); break;
    case 4: return rng_below(r, 4) ? count : 1 + rng_below(r, (uint32_t)count);
    default: words[at] ^= 1u << rng_below(r, 32); break;
  }
  return count;
}

static void refused_or_sound(void **state) {
  (void)state;
  uint64_t seed = number_from("SEED", 1), runs = number_from("RUNS", most_cases(20000)), read = 0;
  rng r = rng_seeded(seed);
  print_message("seed %llu, %llu runs\n", (unsigned long long)seed, (unsigned long long)runs);   /* a crash says nothing */
  uint32_t *good = NULL;
  size_t size = 0;
  for (uint64_t i = 0; i < runs; ++i) {
    if (i % 50 == 0) {
      tile *t = any_tile(&r);
      size = tile_words_count(t);
      free(good);
      good = malloc(size * sizeof *good);
      tile_to_words(t, good);
      tile_destroy(t);
    }
    uint32_t *bad = malloc(size * sizeof *bad);
    memcpy(bad, good, size * sizeof *bad);
    size_t count = size;
    for (uint32_t n = 1 + rng_below(&r, 3); n > 0; --n) count = damage(&r, bad, count);
    uint32_t *exact = realloc(bad, count * sizeof *bad);   /* what lies behind is nobody's */
    assert_non_null(exact);
    const tile *t;
    dsm_result result = tile_from_words(exact, count, 3, 0.1f, &t);
    free(exact);
    assert_seeded(&r, result == DSM_REFUSED ? !t : result == DSM_OK);
    if (t) walk_tile(&r, t);
    read += t != NULL;
    tile_destroy(t);
  }
  print_message("%llu of them were read\n", (unsigned long long)read);
  assert_true(read > runs / 100 && read < runs);
  free(good);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(refused_or_sound),
  };
  return cmocka_run_group_tests_name("damaged words", tests, NULL, NULL);
}
