/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/thin.h"
#include "random.h"

enum { MOST = 300 };

/* Smooth stretches, steps and kinks, in colour or not. */
static void random_function(rng *r, vertices *f) {
  double z = rng_unit(r), run = rng_scale(r, 1e-4, 1), rate = rng_scale(r, 1e-3, 1);
  int grey = rng_below(r, 2) == 0;
  rgb v = rgb_grey(1);
  f->count = 0;
  for (uint32_t n = rng_below(r, MOST); n-- > 0;) {
    assert_int_equal(vertices_push(f, z, v), DSM_OK);
    if (rng_below(r, 20)) z += run * rng_scale(r, 1e-3, 1);
    for (int c = 0; c < 3; ++c) v.c[c] = c && grey ? v.c[0] : v.c[c] * exp(-rate * 0.02 * (1 + rng_unit(r)));
    if (rng_below(r, 40) == 0) rate = rng_scale(r, 1e-3, 1);
  }
}

static rgb behind(const vertices *f, double z) { return vertices_at(f->data, f->count, nextafter(z, HUGE_VAL)); }

static void stays_within_the_slack(void **state) {
  (void)state;
  vertices f = {0}, thin = {0};
  size_t all = 0, left = 0;
  for (uint64_t seed = 0; seed < most_cases(5000); ++seed) {
    rng r = rng_seeded(seed);
    double slack = rng_scale(&r, 1e-6, 1e-2), noise[MOST], level = 0, thinned[MOST];
    random_function(&r, &f);
    thin.count = 0;
    for (size_t i = 0; i < f.count; ++i) {
      assert_int_equal(vertices_push(&thin, f.data[i].z, f.data[i].v), DSM_OK);
      if (rng_below(&r, 30) == 0) level = rng_below(&r, 3) ? rng_unit(&r) : 0;
      thinned[i] = noise[i] = level * rng_between(&r, 0.9, 1);
    }
    thin_vertices(&thin, thinned, slack);
    all += f.count;
    left += thin.count;
    for (size_t i = 0, k = 0; i < f.count; ++i) {
      double z = f.data[i].z;
      rgb a = vertices_at(f.data, f.count, z), b = vertices_at(thin.data, thin.count, z);
      for (int c = 0; c < 3; ++c) {
        assert_seeded(&r, fabs(a.c[c] - b.c[c]) <= slack + 1e-14);
        assert_seeded(&r, fabs(behind(&f, z).c[c] - behind(&thin, z).c[c]) <= slack + 1e-9);
      }
      while (k + 1 < thin.count && thin.data[k + 1].z <= z) ++k;
      int last = i + 1 == f.count || f.data[i + 1].z > z;
      assert_seeded(&r, !last || (thinned[k] >= noise[i] && thinned[k] <= 2 * noise[i]));
    }
    for (size_t i = 0, k = 0; k < thin.count; ++k, ++i) {   /* a part of the vertices, in order */
      while (i < f.count && !(f.data[i].z == thin.data[k].z && f.data[i].v.c[0] == thin.data[k].v.c[0])) ++i;
      assert_seeded(&r, i < f.count);
    }
    assert_seeded(&r, f.count == 0 || thin.data[thin.count - 1].z == f.data[f.count - 1].z);
  }
  print_message("%zu of %zu\n", left, all);
  assert_true(left < all / 4 * 3);
  vertices_free(&f);
  vertices_free(&thin);
}

/* Two thousand vertices on a parabola: about as many stay as chords need, half the length of the longest. */
static void smooth_curves_need_few(void **state) {
  (void)state;
  vertices f = {0};
  for (int i = 0; i <= 2000; ++i) {
    double z = i / 2000.0;
    assert_int_equal(vertices_push(&f, z, rgb_grey(1 - z * z)), DSM_OK);
  }
  thin_vertices(&f, NULL, 0);
  assert_int_equal(f.count, 2001);
  thin_vertices(&f, NULL, 1e-4);   /* a chord of length h is off by h^2 / 4 */
  assert_true(f.count <= 1 + 52 && f.data[0].z == 0 && f.data[f.count - 1].z == 1);
  vertices_free(&f);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(stays_within_the_slack),
    cmocka_unit_test(smooth_curves_need_few),
  };
  return cmocka_run_group_tests_name("thin", tests, NULL, NULL);
}
