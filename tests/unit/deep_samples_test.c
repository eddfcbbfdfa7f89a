/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/transmittance.h"
#include "random.h"
#include "tool/deep_samples.h"

enum { MOST = 24 };

/* What a reader of OpenEXR sees at depth z, just in front of a step or just behind it: "Interpreting OpenEXR Deep Pixels". */
static double seen(const deep_samples *s, double z, int behind, int c) {
  double light = 1;
  for (size_t i = 0; i < s->count; ++i) {
    double front = (double)s->data[i].z, back = (double)s->data[i].z_back, left = 1 - (double)s->data[i].alpha[c];
    if (front == back) {
      if (behind ? front <= z : front < z) light *= left;
    } else if (z > front) {
      light *= pow(left, fmin(1, (z - front) / (back - front)));
    }
  }
  return light;
}

static double value(const vertex *f, size_t count, double z, int behind, int c) {
  if (!behind) return vertices_at(f, count, z).c[c];
  size_t i = count;
  while (i > 0 && f[i - 1].z > z) --i;
  return i > 0 && f[i - 1].z == z ? f[i - 1].v.c[c] : vertices_at(f, count, z).c[c];
}

/* Sorted, and none begins in front of the end of the one before; a step stands alone at its depth. */
static int is_tidy(const deep_samples *s) {
  for (size_t i = 0; i < s->count; ++i) {
    const deep_sample *b = &s->data[i], *a = b - 1;
    if (!(b->z_back >= b->z)) return 0;
    for (int c = 0; c < 3; ++c)
      if (!(b->alpha[c] >= 0 && b->alpha[c] <= 1)) return 0;
    if (i && !(b->z >= a->z_back)) return 0;
    if (i && a->z == a->z_back && b->z == b->z_back && a->z == b->z) return 0;
  }
  return 1;
}

/* Depths that are floats, unless `fine`. */
static size_t random_function(rng *r, vertex *f, int coloured, int fine) {
  size_t count = rng_below(r, MOST + 1);
  double z = 1 + rng_below(r, 4);
  rgb v = rgb_grey(1);
  for (size_t i = 0; i < count; ++i) {
    if (i < 2 || f[i - 2].z != z || rng_below(r, 3)) z += fine ? rng_scale(r, 1e-9, 0.1) : (1 + rng_below(r, 4096)) * 0x1p-12;
    for (int c = 0; c < 3; ++c)
      if (rng_below(r, 4)) v.c[c] *= rng_below(r, 20) ? rng_unit(r) : rng_below(r, 2) * 1e-9;
    if (!coloured) v = rgb_grey(v.c[0]);
    f[i] = (vertex){z, v};
    if (rng_below(r, 3) == 0 && i + 1 < count) {   /* a step */
      v = rgb_scale(rng_below(r, 8) ? rng_unit(r) : 0, v);
      f[++i] = (vertex){z, v};
      z += 0x1p-12;
    }
  }
  return count;
}

static void the_exponential_stays_near(void **state) {
  (void)state;
  static const double tolerances[] = {0.0005, 0.001, 0.01, 0.1};
  for (uint64_t seed = 1; seed <= most_cases(4000); ++seed) {
    rng r = rng_seeded(seed);
    int coloured = (int)rng_below(&r, 2);
    double tolerance = tolerances[rng_below(&r, 4)];
    vertex f[MOST];
    size_t count = random_function(&r, f, coloured, 0);
    deep_samples s = {0};
    assert_int_equal(deep_samples_of(f, count, coloured ? 3 : 1, tolerance, &s), DSM_OK);
    assert_seeded(&r, is_tidy(&s));
    for (size_t i = 0; i < count; ++i)
      for (int k = 0; k <= 16; ++k) {
        double z = i + 1 < count ? f[i].z + (f[i + 1].z - f[i].z) * k / 16 : f[i].z + k;
        for (int c = 0; c < 3; ++c)
          for (int behind = 0; behind < 2; ++behind)
            assert_seeded(&r, fabs(seen(&s, z, behind, c) - value(f, count, z, behind, c)) <= tolerance + 3e-6);
      }
    deep_samples_free(&s);
  }
}

/* Depths closer than floats can tell: still tidy, and right where all is past. */
static void close_depths_make_one_step(void **state) {
  (void)state;
  for (uint64_t seed = 1; seed <= most_cases(4000); ++seed) {
    rng r = rng_seeded(seed);
    vertex f[MOST];
    size_t count = random_function(&r, f, 1, 1);
    for (size_t i = 0; i < count; ++i) f[i].z += 1000;
    deep_samples s = {0};
    assert_int_equal(deep_samples_of(f, count, 3, 0.001, &s), DSM_OK);
    assert_seeded(&r, is_tidy(&s));
    for (int c = 0; c < 3 && count; ++c)
      assert_seeded(&r, fabs(seen(&s, 2000, 1, c) - f[count - 1].v.c[c]) < 1e-6);
    deep_samples_free(&s);
  }
}

static void sag_in_closed_form(void **state) {
  (void)state;
  for (uint64_t seed = 1; seed <= most_cases(300); ++seed) {
    rng r = rng_seeded(seed);
    double a = rng_unit(&r), b = a * (rng_below(&r, 2) ? rng_unit(&r) : 1 - rng_scale(&r, 1e-9, 1)), most = 0;
    for (int i = 0; i <= 20000; ++i) {
      double t = i / 20000.0;
      most = fmax(most, a + (b - a) * t - a * pow(b / a, t));
    }
    double sag = exponential_sag(a, b);
    assert_seeded(&r, sag >= most - 1e-14 && sag <= most * 1.001 + 1e-14);
  }
  assert_true(exponential_sag(0.5, 0.5) == 0 && exponential_sag(0.25, 0) == 0.25);
}

/* The two ends of a straight fall from 1 to 0 at tolerance t take about sqrt(1 / 2t) samples. */
static void no_more_samples_than_needed(void **state) {
  (void)state;
  vertex f[] = {{1, {{1, 1, 1}}}, {2, {{0, 0, 0}}}};
  deep_samples s = {0};
  assert_int_equal(deep_samples_of(f, 2, 1, 0.001, &s), DSM_OK);
  assert_in_range(s.count, 18, 26);
  s.count = 0;
  vertex step[] = {{1, {{1, 1, 1}}}, {1, {{0.5, 0.5, 0.5}}}, {2, {{0.5, 0.5, 0.5}}}, {2, {{0, 0, 0}}}};
  assert_int_equal(deep_samples_of(step, 4, 1, 0.001, &s), DSM_OK);
  assert_int_equal(s.count, 2);
  assert_true(s.data[0].z == 1 && s.data[0].z_back == 1 && s.data[0].alpha[0] == 0.5f);
  assert_true(s.data[1].z == 2 && s.data[1].z_back == 2 && s.data[1].alpha[2] == 1);
  deep_samples_free(&s);
}

/* Read as import does: samples are events of a ray. */
static void there_and_back(void **state) {
  (void)state;
  const double there = 0.001, back = 0.004;
  for (uint64_t seed = 1; seed <= most_cases(1000); ++seed) {
    rng r = rng_seeded(seed);
    vertex f[MOST];
    size_t count = random_function(&r, f, 1, 0);
    deep_samples s = {0};
    assert_int_equal(deep_samples_of(f, count, 3, there, &s), DSM_OK);
    event *events = calloc(s.count + 1, sizeof *events);
    vertices g = {0};
    for (size_t i = 0; i < s.count; ++i) {
      events[i] = (event){(double)s.data[i].z, (double)s.data[i].z_back, rgb_grey(1), 0};
      for (int c = 0; c < 3; ++c) events[i].transmittance.c[c] = 1 - (double)s.data[i].alpha[c];
    }
    assert_int_equal(transmittance_build(events, s.count, back, &g), DSM_OK);
    for (size_t i = 0; i + 1 < count; ++i)
      for (int k = 1; k < 8; ++k)
        for (int c = 0; c < 3; ++c) {
          double z = f[i].z + (f[i + 1].z - f[i].z) * k / 8;
          if (f[i + 1].z > f[i].z)
            assert_seeded(&r, fabs(value(f, count, z, 0, c) - value(g.data, g.count, z, 0, c)) <= there + back / 4 + 3e-6);
        }
    free(events);
    vertices_free(&g);
    deep_samples_free(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_exponential_stays_near),
    cmocka_unit_test(close_depths_make_one_step),
    cmocka_unit_test(sag_in_closed_form),
    cmocka_unit_test(no_more_samples_than_needed),
    cmocka_unit_test(there_and_back),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
