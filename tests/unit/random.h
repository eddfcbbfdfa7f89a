/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Seeded random numbers for tests (splitmix64), and an assertion that prints the seed. Include after
 * cmocka.h. */
#ifndef TESTS_RANDOM_H
#define TESTS_RANDOM_H

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

typedef struct { uint64_t seed, state; } rng;

static inline rng rng_seeded(uint64_t seed) { return (rng){seed, seed}; }

static inline uint64_t rng_bits(rng *r) {
  uint64_t x = r->state += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/* In [0,1). */
static inline double rng_unit(rng *r) { return (double)(rng_bits(r) >> 11) * 0x1p-53; }
static inline double rng_between(rng *r, double low, double high) { return low + (high - low) * rng_unit(r); }
/* Every order of magnitude alike; 0 < low < high. */
static inline double rng_scale(rng *r, double low, double high) {
  return exp(rng_between(r, log(low), log(high)));
}
/* In 0…n-1. */
static inline uint32_t rng_below(rng *r, uint32_t n) { return (uint32_t)((rng_bits(r) >> 32) * n >> 32); }

/* How many of n random cases are tried: all, or DSM_MOST_CASES where the environment asks for fewer, as under slow tools. */
static inline uint64_t most_cases(uint64_t n) {
  const char *text = getenv("DSM_MOST_CASES");
  uint64_t asked = text ? strtoull(text, NULL, 10) : n;
  return asked < n ? asked : n;
}

/* What is asked of each test where not random cases take the time but maps: a smaller one where fewer cases are asked for. */
#define UNLESS_SLOW(usual, smaller) (most_cases(1000) < 1000 ? (smaller) : (usual))

#define assert_seeded(r, condition) \
  do { \
    if (!(condition)) { \
      print_error("seed %llu: %s is false\n", (unsigned long long)(r)->seed, #condition); \
      fail(); \
    } \
  } while (0)

#endif
