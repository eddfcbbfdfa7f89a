/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/compress.h"
#include "core/compress_lattice.h"
#include "core/rounding.h"
#include "random.h"
#include "made_function.h"

/* What compress_rounded gives, as it is stored, and the fewest vertices that any rounding leaves right. */
typedef struct { vertices out, stored, plain; size_t total, plain_total, tried, met; } results;

static void free_results(results *p) {
  vertices_free(&p->out);
  vertices_free(&p->stored);
  vertices_free(&p->plain);
}

static void compress(results *p, const vertex *in, size_t n, double tolerance, double spent, uint32_t bits) {
  uint32_t most = (1u << bits) - 1;
  int on_lattice = 1;
  p->out.count = p->stored.count = p->plain.count = 0;
  assert_int_equal(compress_rounded(in, n, 1, tolerance, spent, bits, &p->out), DSM_OK);
  assert_int_equal(compress_minimal_after(in, n, 1, tolerance, spent + rounding_of_bits(bits), &p->plain), DSM_OK);
  for (size_t i = 0; i < p->out.count; ++i) {
    double y = p->out.data[i].v.c[0], code = floor(y * most + 0.5);
    assert_int_equal(vertices_push(&p->stored, p->out.data[i].z, rgb_grey(code / most)), DSM_OK);
    on_lattice &= fabs(y * most - code) < 1e-9;
  }
  p->total += p->out.count;
  p->plain_total += p->plain.count;
  p->tried++;
  p->met += on_lattice != 0;
}

/* A value is told in 65535ths, too, where a file or a coarser level reads it. */
static void tell(vertices *v, uint32_t bits) {
  uint32_t most = (1u << bits) - 1;
  for (size_t i = 0; i < v->count; ++i)
    v->data[i].v = rgb_grey(value_of_code((uint32_t)(v->data[i].v.c[0] * most + 0.5), most) / (double)VALUE_STEPS);
}

static void check(const rng *r, results *p, const vertex *in, size_t n, double tolerance, double spent, uint32_t bits, int falls) {
  double rest = tolerance - spent - rounding_of_bits(bits);
  compress(p, in, n, tolerance, spent, bits);
  assert_seeded(r, largest_error(in, n, &p->stored) <= tolerance - spent + 1e-15);
  assert_seeded(r, is_tidy(in, n, &p->out, falls, rest));
  assert_seeded(r, keeps_the_essential(in, n, &p->out, tolerance));
  assert_seeded(r, keeps_the_essential(in, n, &p->stored, tolerance));
  tell(&p->stored, bits);
  assert_seeded(r, largest_error(in, n, &p->stored) <= tolerance - spent + 1e-15);
}

/* Whatever the tolerance, and what of it is spent, as long as rounding takes less than a half of the rest. */
static void hard_functions_stay_within_the_tolerance(void **state) {
  (void)state;
  results p = {0};
  for (uint64_t seed = 0; seed < most_cases(100000); ++seed) {
    rng r = rng_seeded(seed);
    vertex e[MOST];
    int may_grow = rng_below(&r, 4) == 0;
    size_t n = hard_function(&r, e, may_grow);
    double tolerance = rng_scale(&r, 1e-3, 0.499), spent = rng_below(&r, 2) ? 0 : rng_between(&r, 0, 0.3) * tolerance;
    uint32_t bits = 1;
    while (rounding_of_bits(bits) > 0.5 * (tolerance - spent)) ++bits;
    bits += rng_below(&r, 3);
    check(&r, &p, e, n, tolerance, spent, bits < VALUE_BITS ? bits : VALUE_BITS, !may_grow);
  }
  assert_true(most_cases(100000) < 1000 || p.met > p.tried / 2);
  free_results(&p);
}

/* Of hair nearly all functions find a way, and half of what rounding costs in vertices is spared. */
static void hair_uses_the_whole_tolerance(void **state) {
  (void)state;
  static vertex e[2048];
  results p = {0};
  vertices ideal = {0};
  size_t least = 0;
  for (uint64_t seed = 0; seed < most_cases(600); ++seed) {
    rng r = rng_seeded(seed);
    size_t count = hair(&r, e, 1024, seed % 2 == 0);
    check(&r, &p, e, count, 0.0078, 0, 8, 1);
    assert_seeded(&r, p.out.count <= p.plain.count);
    ideal.count = 0;
    assert_int_equal(compress_minimal(e, count, 1, 0.0078, &ideal), DSM_OK);
    least += ideal.count;
    assert_seeded(&r, ideal.count <= p.out.count);
  }
  print_message("%.2f vertices; %.2f with room for any rounding, %.2f without rounding; %.3f have values that can be stored\n",
                (double)p.total / (double)p.tried, (double)p.plain_total / (double)p.tried, (double)least / (double)p.tried,
                (double)p.met / (double)p.tried);
  assert_true(2 * p.total < p.plain_total + least && p.met > 0.8 * (double)p.tried);
  vertices_free(&ideal);
  free_results(&p);
}

/* Values of all bits, a tolerance that rounding alone takes, and colours are as they are without a lattice. */
static void without_a_lattice(void **state) {
  (void)state;
  static vertex e[2048];
  rng r = rng_seeded(5);
  size_t count = hair(&r, e, 256, 1);
  vertices a = {0}, b = {0};
  const struct { int channels; double tolerance; uint32_t bits; } cases[] = {{1, 0.01, VALUE_BITS}, {1, 0.01, 5}, {3, 0.05, 6}, {1, 0, 6}};
  for (int k = 0; k < 4; ++k) {
    a.count = b.count = 0;
    double rounds = rounding_of_bits(cases[k].bits);
    assert_int_equal(compress_rounded(e, count, cases[k].channels, cases[k].tolerance, 0, cases[k].bits, &a), DSM_OK);
    assert_int_equal(compress_minimal_after(e, count, cases[k].channels, cases[k].tolerance, rounds, &b), DSM_OK);
    assert_true(a.count == b.count && a.count > 0);
    for (size_t i = 0; i < a.count; ++i) assert_true(a.data[i].z == b.data[i].z && a.data[i].v.c[0] == b.data[i].v.c[0]);
  }
  vertices_free(&a);
  vertices_free(&b);
}

/* What stood in the list stays, and nothing comes of nothing. */
static void appends(void **state) {
  (void)state;
  vertex e[] = {grey(1, 1), grey(2, 0.3), grey(3, 0.3), grey(3, 0)};
  vertices out = {0};
  assert_int_equal(vertices_push(&out, 7, rgb_grey(0.25)), DSM_OK);
  assert_int_equal(compress_rounded(NULL, 0, 1, 0.1, 0, 6, &out), DSM_OK);
  assert_int_equal(out.count, 1);
  assert_int_equal(compress_rounded(e, 4, 1, 0.1, 0, 6, &out), DSM_OK);
  assert_true(out.count > 2 && out.data[0].z == 7 && out.data[0].v.c[0] == 0.25);
  assert_true(out.data[out.count - 1].z == 3 && out.data[out.count - 1].v.c[0] == 0);
  vertices_free(&out);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(hard_functions_stay_within_the_tolerance),
    cmocka_unit_test(hair_uses_the_whole_tolerance),
    cmocka_unit_test(without_a_lattice),
    cmocka_unit_test(appends),
  };
  return cmocka_run_group_tests_name("compression to values that can be stored", tests, NULL, NULL);
}
