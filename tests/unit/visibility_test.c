/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/vertices.h"
#include "core/visibility.h"
#include "random.h"

enum { MOST = 70 };

/* Records as in a tile, of floats and values of 16 bits. */
typedef struct {
  visibility_codes codes;
  unsigned char bytes[3 * MOST * 6];
} block;

static visibility plain(block *b, const float *depth, const uint16_t *value, uint32_t count, uint32_t channels) {
  memset(b, 0, sizeof *b);
  codes_set(&b->codes, MOST_RECORD_BITS, VALUE_BITS);
  b->codes.records = offsetof(block, bytes);
  for (uint32_t i = 0; i < count; ++i) {
    unsigned char *record = b->bytes + 6 * (size_t)i, *second = record + 6 * (size_t)count;
    memcpy(record, &value[i * channels], sizeof *value);
    memcpy(record + sizeof *value, &depth[i], sizeof *depth);
    if (channels == 3) memcpy(second, &value[i * channels + 1], 2 * sizeof *value);
  }
  return (visibility){&b->codes, 0, count, count, channels};
}

/* A function twice: as stored, and as vertices with the same numbers. */
typedef struct {
  float depth[MOST];
  uint16_t value[3 * MOST];
  vertex same[MOST];
  visibility function;
  block store;
} both;

static void make(both *b, rng *r, uint32_t count, uint32_t channels) {
  float z = (float)rng_between(r, 0, 2), scale = (float)rng_scale(r, 1e-6, 1e6);
  for (uint32_t i = 0; i < count; ++i) {
    b->depth[i] = z * scale;
    b->same[i].z = (double)b->depth[i];
    for (uint32_t c = 0; c < 3; ++c) {
      uint16_t *v = &b->value[channels == 3 ? 3 * i + c : i];
      if (c < channels) *v = rng_below(r, 8) ? (uint16_t)rng_below(r, VALUE_STEPS + 1) : rng_below(r, 2) ? VALUE_STEPS : 0;
      b->same[i].v.c[c] = *v / 65535.0;
    }
    z += (float)rng_below(r, 3);   /* steps, and more than two vertices at a depth */
  }
  b->function = plain(&b->store, b->depth, b->value, count, channels);
}

static int close_to(rgb a, rgb b) { return rgb_max(rgb_sub(a, b)) < 1e-13 && rgb_max(rgb_sub(b, a)) < 1e-13; }

static uint32_t any_hint(rng *r, uint32_t count) {
  switch (rng_below(r, 4)) {
    case 0: return (uint32_t)rng_bits(r);
    case 1: return UINT32_MAX - rng_below(r, 3);
    case 2: return count + rng_below(r, 3);
    default: return rng_below(r, count + 1);
  }
}

static void any_hint_gives_the_same_value(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(20000); ++seed) {
    rng r = rng_seeded(seed);
    both b;
    uint32_t count = rng_below(&r, MOST + 1);
    make(&b, &r, count, rng_below(&r, 2) ? 3 : 1);
    for (int i = 0; i < 60; ++i) {
      /* On vertices, a double beside them, between them, and outside. */
      double z = count ? b.same[rng_below(&r, count)].z : 1;
      uint32_t where = rng_below(&r, 4), hint = any_hint(&r, count);
      if (where == 1) z = nextafter(z, HUGE_VAL);
      if (where == 2) z = nextafter(z, -HUGE_VAL);
      if (where == 3) z = count ? rng_between(&r, -1, 1.2) * b.same[count - 1].z : -z;
      rgb expected = vertices_at(b.same, count, z);
      assert_seeded(&r, close_to(visibility_at(&b.function, z, &hint), expected));
      uint32_t end = hint;
      assert_seeded(&r, end <= count);
      assert_seeded(&r, close_to(visibility_at(&b.function, z, &hint), expected) && hint == end);
    }
  }
}

static void one_hint_serves_a_walk(void **state) {
  (void)state;
  rng r = rng_seeded(7);
  both b;
  make(&b, &r, MOST, 1);
  uint32_t hint = 12345;
  double far = b.same[MOST - 1].z * 1.1;
  for (int i = 0; i < 5000; ++i) {
    double z = far * (0.5 + 0.5 * sin(i * 0.01));
    assert_true(close_to(visibility_at(&b.function, z, &hint), vertices_at(b.same, MOST, z)));
  }
}

static void every_pair_of_place_and_hint(void **state) {
  (void)state;
  float depth[MOST];
  uint16_t value[MOST];
  for (uint32_t count = 0; count <= MOST; ++count) {
    for (uint32_t i = 0; i < count; ++i) depth[i] = (float)i, value[i] = (uint16_t)(VALUE_STEPS / (1 + i));
    block store;
  visibility f = plain(&store, depth, value, count, 1);
    for (uint32_t place = 0; place <= count; ++place)
      for (uint32_t start = 0; start <= count + 1; ++start) {
        uint32_t hint = start;
        double v = visibility_at(&f, place - 0.5, &hint).c[0];
        assert_int_equal(hint, place);
        double expected = place == 0 ? 1 : value[place - 1] / 65535.0;
        if (place > 0 && place < count) expected = (expected + value[place] / 65535.0) / 2;
        assert_true(fabs(v - expected) < 1e-14);
      }
  }
}

static void nothing_is_all_lit(void **state) {
  (void)state;
  uint32_t hint = 99;
  block store;
  visibility none = plain(&store, NULL, NULL, 0, 3);
  rgb v = visibility_at(&none, 5, &hint);
  assert_true(v.c[0] == 1 && v.c[1] == 1 && v.c[2] == 1 && hint == 0);
}

static void surface_does_not_shadow_itself(void **state) {
  (void)state;
  const float depth[] = {3, 3};
  const uint16_t value[] = {VALUE_STEPS, 0};
  block store;
  visibility opaque = plain(&store, depth, value, 2, 1);
  uint32_t hint = 0;
  assert_true(visibility_at(&opaque, 3, &hint).c[0] == 1);
  assert_true(visibility_at(&opaque, nextafter(3, 4), &hint).c[0] == 0);
  assert_true(visibility_at(&opaque, HUGE_VAL, &hint).c[0] == 0);
  assert_true(visibility_at(&opaque, -HUGE_VAL, &hint).c[0] == 1);
}

static void not_a_number_stays_in_bounds(void **state) {
  (void)state;
  rng r = rng_seeded(3);
  both b;
  make(&b, &r, 9, 3);
  uint32_t hint = 4;
  assert_true(visibility_at(&b.function, (double)NAN, &hint).c[0] == 1);
}

/* Both ends of the stored range are light and dark exactly, in any channel, and so is what lies between two of them. */
static void all_and_nothing_are_exact(void **state) {
  (void)state;
  const float depth[] = {1, 2, 3, 4};
  const uint16_t value[] = {65535, 65535, 0, 65535, 0, 65535, 65535, 0, 65535, 0, 0, 0};
  block store;
  visibility f = plain(&store, depth, value, 4, 3);
  for (int i = 0; i <= 40; ++i) {
    uint32_t hint = 0;
    double z = 1 + i * 0.1;
    rgb v = visibility_at(&f, z, &hint);
    assert_true(v.c[0] <= 1 && v.c[1] <= 1 && v.c[2] <= 1 && v.c[0] >= 0 && v.c[1] >= 0 && v.c[2] >= 0);
    if (z <= 1) assert_true(v.c[2] == 1);
    if (z > 1 && z <= 3) assert_true(v.c[0] == 1);
    if (z > 4) assert_true(v.c[0] == 0 && v.c[1] == 0 && v.c[2] == 0);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(any_hint_gives_the_same_value),
    cmocka_unit_test(one_hint_serves_a_walk),
    cmocka_unit_test(every_pair_of_place_and_hint),
    cmocka_unit_test(nothing_is_all_lit),
    cmocka_unit_test(surface_does_not_shadow_itself),
    cmocka_unit_test(not_a_number_stays_in_bounds),
    cmocka_unit_test(all_and_nothing_are_exact),
  };
  return cmocka_run_group_tests_name("visibility", tests, NULL, NULL);
}
