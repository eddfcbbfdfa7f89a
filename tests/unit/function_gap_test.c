/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "random.h"
#include "tool/function_gap.h"

static vertex grey(double z, double v) { return (vertex){z, rgb_grey(v)}; }

static void same_functions(void **state) {
  (void)state;
  vertex f[] = {grey(1, 1), grey(2, 0.5), grey(2, 0.25), grey(3, 0)};
  function_gap gap = function_gap_of(f, 4, f, 4, 0, 5);
  assert_true(gap.largest == 0 && gap.squares == 0);
  gap = function_gap_of(NULL, 0, NULL, 0, 0, 5);
  assert_true(gap.largest == 0 && gap.squares == 0);
  vertex more[] = {grey(1, 1), grey(1.5, 0.75), grey(2, 0.5), grey(2, 0.25), grey(2.5, 0.125), grey(3, 0)};
  gap = function_gap_of(f, 4, more, 6, 0, 5);
  assert_true(gap.largest < 1e-15 && gap.squares < 1e-30);
}

/* Steps of height h at two depths: h^2 times the distance. */
static void shifted_steps(void **state) {
  (void)state;
  vertex a[] = {grey(1, 1), grey(1, 0.25)}, b[] = {grey(3, 0.25)};   /* the second starts behind its step */
  function_gap gap = function_gap_of(a, 2, b, 1, 0, 10);
  assert_true(fabs(gap.largest - 0.75) < 1e-15 && fabs(gap.squares - 2 * 0.75 * 0.75) < 1e-14);
  gap = function_gap_of(b, 1, a, 2, 1.5, 2.5);   /* cut on both sides */
  assert_true(fabs(gap.largest - 0.75) < 1e-15 && fabs(gap.squares - 0.75 * 0.75) < 1e-14);
  gap = function_gap_of(a, 2, NULL, 0, 0, 0.5);   /* all of it behind */
  assert_true(fabs(gap.largest - 0.75) < 1e-15 && gap.squares == 0);
}

/* A triangle of height h over a base: h^2 base / 3; cut in its middle, half of that. */
static void a_ramp(void **state) {
  (void)state;
  vertex a[] = {grey(1, 1), grey(4, 0)}, b[] = {grey(1, 1), grey(4, 1), grey(4, 0)};
  function_gap gap = function_gap_of(a, 2, b, 3, 0, 10);
  assert_true(fabs(gap.largest - 1) < 1e-15 && fabs(gap.squares - 1) < 1e-14);
  gap = function_gap_of(a, 2, b, 3, 0, 2.5);
  assert_true(fabs(gap.squares - 0.125) < 1e-14);
  gap = function_gap_of(a, 2, b, 3, 2.5, 9);
  assert_true(fabs(gap.squares - 0.875) < 1e-14);
}

static void one_channel_counts_a_third(void **state) {
  (void)state;
  vertex a[] = {{1, {{1, 1, 1}}}, {1, {{0.5, 1, 1}}}};
  function_gap gap = function_gap_of(a, 2, NULL, 0, 0, 3);
  assert_true(fabs(gap.largest - 0.5) < 1e-15 && fabs(gap.squares - 2 * 0.25 / 3) < 1e-14);
}

static uint32_t random_function(rng *r, vertex *f, uint32_t most) {
  uint32_t count = rng_below(r, most + 1);
  double z = 0, v = 1;
  for (uint32_t i = 0; i < count; ++i) {
    if (rng_below(r, 3)) z += rng_between(r, 0, 0.3);
    if (rng_below(r, 4)) v *= rng_unit(r);
    f[i] = grey(z, v);
    if (rng_below(r, 2)) f[i].v.c[1] = 0.5 * v;
  }
  return count;
}

static void against_dense_sums(void **state) {
  (void)state;
  enum { MOST = 12, STEPS = 200000 };
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    rng r = rng_seeded(seed);
    vertex a[MOST], b[MOST];
    uint32_t na = random_function(&r, a, MOST), nb = random_function(&r, b, MOST);
    double low = 0.2, high = 2.2, largest = 0, squares = 0;
    for (int i = 0; i < STEPS; ++i) {
      rgb d = rgb_sub(vertices_at(a, na, low + (high - low) * (i + 0.5) / STEPS),
                      vertices_at(b, nb, low + (high - low) * (i + 0.5) / STEPS));
      for (int c = 0; c < 3; ++c) squares += d.c[c] * d.c[c] / 3 * (high - low) / STEPS;
    }
    for (int i = 0; i < 4 * STEPS; ++i) {
      rgb d = rgb_sub(vertices_at(a, na, 4.0 * i / STEPS), vertices_at(b, nb, 4.0 * i / STEPS));
      for (int c = 0; c < 3; ++c) largest = fmax(largest, fabs(d.c[c]));
    }
    function_gap gap = function_gap_of(a, na, b, nb, low, high);
    assert_seeded(&r, fabs(gap.squares - squares) < 1e-4);
    assert_seeded(&r, gap.largest >= largest - 1e-12);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(same_functions),
    cmocka_unit_test(shifted_steps),
    cmocka_unit_test(a_ramp),
    cmocka_unit_test(one_channel_counts_a_third),
    cmocka_unit_test(against_dense_sums),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
