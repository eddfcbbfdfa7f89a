/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include <math.h>

#include "plain_tile.h"
#include "random.h"

/* A tile twice: as it was made, and compact. */
typedef struct { tile *made, *compact; } pair;

/* What its numbers are multiples of. */
typedef struct {
  double quantum;       /* a power of two; 0: floats of any digits */
  uint32_t depth_bits;  /* the largest multiple takes all of them */
  uint32_t value_bits;
} kind;

static kind any_kind(rng *r) {
  kind k = {0, FLOAT_BITS, 1 + rng_below(r, VALUE_BITS)};
  if (rng_below(r, 4)) {
    k.depth_bits = 2 + rng_below(r, MOST_CODE_BITS - 1);
    k.quantum = ldexp(1, (int)rng_below(r, 100) - 60);
  }
  return k;
}

static uint16_t value_of(const kind *k, uint32_t code) {
  return (uint16_t)lround((double)code * VALUE_STEPS / ((1u << k->value_bits) - 1));
}

/* Depths that never fall, values that never grow; in one pixel numbers that need all the bits. */
static pair any_pair(rng *r, const kind *k, uint32_t most) {
  tile_plan plan = {.count = {0}};
  for (int i = 0; i < TILE_PIXELS; ++i) {
    plan.count[i] = rng_below(r, most);
    plan.coloured[i] = most > 12 && rng_below(r, 5) == 0;
    plan.marked[i] = most > 12 && plan.count[i] == 0 && rng_below(r, 5) == 0;
  }
  plan.count[77] = 4;
  plan.coloured[77] = 0;
  pair p = {tile_create(&plan), tile_create(&plan)};
  assert_true(p.made && p.compact);
  uint32_t top = (1u << k->value_bits) - 1, farthest = k->quantum > 0 ? (1u << k->depth_bits) - 2 : 0;   /* one code is behind all */
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    uint32_t step = 0, code = top;
    float z = 0;
    for (uint32_t n = 0; n < plan.count[i]; ++n) {
      if (i == 77) {
        step = n < 2 ? n : farthest - (n == 2 && farthest > 1);
        code = n == 0 ? top : n == 3 ? 0 : 1;
      }
      else {
        step += rng_below(r, 3) * rng_below(r, 1 + (farthest - step) / 4);
        code -= rng_below(r, code + 1) / 2;
      }
      float more = (float)(rng_below(r, 3) * rng_unit(r));
      z = k->quantum > 0 ? (float)(step * k->quantum) : z + more;
      for (uint32_t c = 0; c < (plan.coloured[i] ? 3u : 1u); ++c) {
        tile_put(p.made, i, n, c, z, value_of(k, code >> c));
        tile_put(p.compact, i, n, c, z, value_of(k, code >> c));
      }
    }
  }
  p.compact = tile_compact(p.compact);
  return p;
}

static void pair_free(pair *p) {
  tile_destroy(p->made);
  tile_destroy(p->compact);
}

static void the_same_numbers_in_the_fewest_bits(void **state) {
  (void)state;
  int deltas = 0;
  for (uint64_t seed = 0; seed < 600; ++seed) {
    rng r = rng_seeded(seed);
    kind k = any_kind(&r);
    pair p = any_pair(&r, &k, seed % 8 ? 12 : 600);
    const visibility_codes *codes = &p.compact->codes;
    for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
      visibility a = tile_visibility(p.made, i), b = tile_visibility(p.compact, i);
      assert_seeded(&r, a.count == b.count && a.channels == b.channels);
      assert_seeded(&r, !tile_is_marked(p.made, i) == !tile_is_marked(p.compact, i));
      for (uint32_t n = 0; n < a.count; ++n) {
        assert_seeded(&r, visibility_depth(&a, n) == visibility_depth(&b, n));
        for (uint32_t c = 0; c < a.channels; ++c)
          assert_seeded(&r, visibility_stored(&a, n, c) == visibility_stored(&b, n, c));
      }
    }
    assert_seeded(&r, codes->value_bits <= k.value_bits || (k.quantum == 0 && codes->record_bits == MOST_RECORD_BITS));
    uint32_t bits = codes->record_bits;
    if (k.quantum > 0) {
      uint32_t depth_bits = p.made->layout & TILE_COLOURED && k.depth_bits < codes->value_bits ? codes->value_bits : k.depth_bits;
      bits = (depth_bits + codes->value_bits + 7) / 8 * 8;
      assert_seeded(&r, codes->per_quantum == 1 / k.quantum && (codes->record_bits == bits || codes_are_deltas(codes)));
    }
    uint64_t records = (uint64_t)tile_first(p.made, TILE_PIXELS - 1) + tile_records(p.made, TILE_PIXELS - 1);
    uint64_t absolute = p.made->codes.records + records * bits / 8;
    deltas += codes_are_deltas(codes);
    assert_seeded(&r, codes_are_deltas(codes) ? p.compact->size < 0.8 * (double)absolute : p.compact->size == absolute);
    pair_free(&p);
  }
  assert_true(deltas > 0 && deltas < 500);
}

/* The search compares codes: the answer is that of comparing depths, to the last bit, beside vertices too. */
static void codes_are_found_as_depths_are(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < 500; ++seed) {
    rng r = rng_seeded(seed);
    kind k = any_kind(&r);
    pair p = any_pair(&r, &k, 12);
    for (int n = 0; n < 2000; ++n) {
      uint32_t place = rng_below(&r, TILE_PIXELS), hint = rng_below(&r, 14), other = rng_below(&r, 14);
      visibility a = tile_visibility(p.made, place), b = tile_visibility(p.compact, place);
      if (!a.count) continue;
      double z = visibility_depth(&a, rng_below(&r, a.count));
      switch (rng_below(&r, 5)) {
        case 0: z = fmax(nextafter(z, HUGE_VAL), 1e-290); break;   /* less could vanish among quanta of 2^39 */
        case 1: z = nextafter(z, -HUGE_VAL); break;
        case 2: z *= rng_between(&r, 0.5, 1.5); break;
        case 3: z = rng_below(&r, 9) ? z + rng_between(&r, -1, 1) * k.quantum : rng_below(&r, 2) ? HUGE_VAL : -HUGE_VAL; break;
        default: break;
      }
      uint32_t behind = 0;
      while (behind < a.count && visibility_depth(&a, behind) < z) ++behind;
      visibility_place at = {0, 0, 0, 0, 0}, same = {0, 0, 0, 0, 0};
      int found = visibility_find(&a, visibility_key_of(a.codes, z), &hint, &at);
      assert_seeded(&r, found == visibility_find(&b, visibility_key_of(b.codes, z), &other, &same) && hint == behind);
      int counted = !codes_are_deltas(b.codes);
      if (counted) assert_seeded(&r, hint == other);
      assert_seeded(&r, !found == (behind == 0));
      if (found) assert_seeded(&r, at.t == same.t || z == HUGE_VAL);
      if (found && counted) assert_seeded(&r, at.a == same.a && at.b == same.b);
      for (uint32_t c = 0; found && c < a.channels && z < HUGE_VAL; ++c)
        assert_seeded(&r, fabs(visibility_value(&a, &at, c) - visibility_value(&b, &same, c)) <= VALUE_ROUNDING);
    }
    pair_free(&p);
  }
}

/* Depths that have too little in common stay floats; all stay as they are to the last bit. */
static void odd_depths_stay_floats(void **state) {
  (void)state;
  const float depths[][3] = {{0, 1, 0x1.000002p0f}, {0, 1, 0x1.fffffep0f}, {0, 0x1p-149f, 1}, {0, 1, 3.4e38f}, {0.1f, 1, 100.3f}, {0, 0x1p-140f, 0x1p-139f}};
  for (size_t k = 0; k < sizeof depths / sizeof depths[0]; ++k) {
    tile_plan plan = {.count = {3}};
    tile *t = tile_create(&plan);
    for (uint32_t i = 0; i < 3; ++i) tile_put(t, 0, i, 0, depths[k][i], 0);
    t = tile_compact(t);
    visibility v = tile_visibility(t, 0);
    for (uint32_t i = 0; i < 3; ++i) assert_true(visibility_depth(&v, i) == (double)depths[k][i]);
    assert_true(t->codes.per_quantum == (k == 0 ? 0x1p23 : k == 5 ? 0x1p140 : 0));
    tile_destroy(t);
  }
}

static void all_zeros(void **state) {
  (void)state;
  tile_plan plan = {.count = {1, 2}, .marked = {[9] = 1}};
  tile *t = tile_compact(tile_create(&plan));
  visibility v = tile_visibility(t, 1);
  assert_true(t->codes.record_bits == 8 && v.count == 2 && visibility_depth(&v, 1) == 0 && visibility_stored(&v, 1, 0) == 0);
  tile_destroy(t);
}

/* 0 and 1 are exact in any number of bits. */
static void all_and_nothing_are_exact(void **state) {
  (void)state;
  for (uint32_t bits = 1; bits <= VALUE_BITS; ++bits) {
    visibility_codes codes = {0};
    codes_set(&codes, 4, bits);
    assert_true(codes.value_mask * codes.unit == 1 && codes.value_mask == (1u << bits) - 1);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_same_numbers_in_the_fewest_bits),
    cmocka_unit_test(codes_are_found_as_depths_are),
    cmocka_unit_test(odd_depths_stay_floats),
    cmocka_unit_test(all_zeros),
    cmocka_unit_test(all_and_nothing_are_exact),
  };
  return cmocka_run_group_tests_name("compact tile", tests, NULL, NULL);
}
