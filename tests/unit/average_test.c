/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "average_direct.h"
#include "core/average.h"
#include "noise_direct.h"
#include "random.h"

/* A set of functions that owns its memory. */
typedef struct {
  vertices all;
  size_t *first;
  double *weights;
  average_input in;
} set;

static void set_begin(set *s, uint32_t count) {
  *s = (set){.first = malloc((count + 1) * sizeof(size_t)), .weights = malloc(count * sizeof(double) + 1)};
  s->first[0] = 0;
  for (uint32_t i = 0; i < count; ++i) s->weights[i] = 1.0 / count;
}

static void set_push(set *s, double z, rgb v) { assert_int_equal(vertices_push(&s->all, z, v), DSM_OK); }

static void set_next(set *s) {
  s->first[++s->in.count] = s->all.count;
  s->in = (average_input){s->all.data, s->first, s->weights, s->in.count};
}

static void set_free(set *s) {
  vertices_free(&s->all);
  free(s->first);
  free(s->weights);
}

/* One function just in front of z or just behind it, in long double. */
static long double one(const vertex *f, size_t count, double z, int behind, int c) {
  size_t low = 0, high = count;
  while (low < high) {
    size_t middle = (low + high) / 2;
    if (behind ? f[middle].z <= z : f[middle].z < z) low = middle + 1;
    else high = middle;
  }
  if (low == 0) return 1;
  long double a = (long double)f[low - 1].v.c[c];
  if (low == count) return a;
  long double run = (long double)f[low].z - (long double)f[low - 1].z;
  return a + ((long double)f[low].v.c[c] - a) * ((long double)z - (long double)f[low - 1].z) / run;
}

static double truth(const average_input *in, double z, int behind, int c) {
  long double sum = 0;
  for (uint32_t i = 0; i < in->count; ++i)
    sum += (long double)in->weights[i]
           * one(in->all + in->first[i], in->first[i + 1] - in->first[i], z, behind, c);
  return (double)sum;
}

static double error_at(const average_input *in, const vertices *out, double z) {
  double worst = 0;
  for (int c = 0; c < 3; ++c)
    for (int behind = 0; behind < 2; ++behind)
      worst = fmax(worst, fabs(truth(in, z, behind, c) - (double)one(out->data, out->count, z, behind, c)));
  return worst;
}

/* In [0,1], depths in order, at most two vertices at one, and falling if `falls`. */
static int is_tidy(const vertices *f, int falls) {
  for (size_t i = 0; i < f->count; ++i) {
    const vertex *b = &f->data[i], *a = b - 1;
    for (int c = 0; c < 3; ++c) {
      if (!(b->v.c[c] >= 0 && b->v.c[c] <= 1)) return 0;
      if (i && falls && b->v.c[c] > a->v.c[c]) return 0;
    }
    if (i && b->z < a->z) return 0;
    if (i > 1 && b->z == a[-1].z) return 0;
  }
  return f->count == 0 || (f->data[0].v.c[0] == 1 && f->data[0].v.c[1] == 1 && f->data[0].v.c[2] == 1);
}

static void sweep(const set *s, average_scratch *scratch, vertices *out) {
  out->count = 0;
  assert_int_equal(average_sweep(&s->in, scratch, out), DSM_OK);
}

/* Equal hairs at depths 1…n: light falls by 1/n at each, exactly 0 at the end. */
static void opaque_hair_is_a_staircase(void **state) {
  (void)state;
  enum { n = 1000 };
  set s;
  set_begin(&s, n);
  for (int i = 0; i < n; ++i) {
    double z = 1 + (i * 617) % n;
    set_push(&s, z, rgb_grey(1));
    set_push(&s, z, rgb_grey(0));
    set_next(&s);
  }
  average_scratch scratch = {0};
  vertices out = {0};
  sweep(&s, &scratch, &out);
  assert_int_equal(out.count, 2 * n);
  for (int i = 0; i < n; ++i) {
    assert_true(out.data[2 * i].z == i + 1 && out.data[2 * i + 1].z == i + 1);
    assert_true(fabs(out.data[2 * i].v.c[1] - (1 - i / (double)n)) < 1e-15);
  }
  assert_true(rgb_max(out.data[2 * n - 1].v) == 0);
  vertices_free(&out);
  average_free(&scratch);
  set_free(&s);
}

static void steps_at_one_depth_become_one(void **state) {
  (void)state;
  set s;
  set_begin(&s, 64);
  for (int i = 0; i < 64; ++i) {
    if (i % 4) {
      set_push(&s, 5, rgb_grey(1));
      set_push(&s, 5, rgb_grey(0.5));
    }
    set_next(&s);   /* every fourth is empty: all lit */
  }
  average_scratch scratch = {0};
  vertices out = {0};
  sweep(&s, &scratch, &out);
  assert_int_equal(out.count, 2);
  assert_true(out.data[0].z == 5 && out.data[0].v.c[0] == 1);
  assert_true(out.data[1].z == 5 && out.data[1].v.c[0] == 0.625);
  vertices_free(&out);
  average_free(&scratch);
  set_free(&s);
}

/* Vertices that change nothing are left out: level ones, and the kinks of two functions that cancel. */
static void idle_vertices_vanish(void **state) {
  (void)state;
  set s;
  set_begin(&s, 2);
  const double z[] = {0, 1, 2, 4, 7}, up[] = {1, 1, 0.75, 0.75, 0.75}, down[] = {1, 1, 1, 0.5, 0.5};
  for (int i = 0; i < 5; ++i) set_push(&s, z[i], rgb_grey(up[i]));
  set_next(&s);
  for (int i = 0; i < 5; ++i) set_push(&s, z[i], rgb_grey(down[i]));
  set_next(&s);
  average_scratch scratch = {0};
  vertices out = {0};
  sweep(&s, &scratch, &out);
  assert_int_equal(out.count, 2);   /* slope -1/8 from 1 to 4 */
  assert_true(out.data[0].z == 1 && out.data[1].z == 4 && fabs(out.data[1].v.c[0] - 0.625) < 1e-16);
  vertices_free(&out);
  average_free(&scratch);
  set_free(&s);
}

static void nothing_in_nothing_out(void **state) {
  (void)state;
  set s;
  set_begin(&s, 3);
  average_scratch scratch = {0};
  vertices out = {0};
  sweep(&s, &scratch, &out);
  for (int i = 0; i < 3; ++i) set_next(&s);
  sweep(&s, &scratch, &out);
  assert_int_equal(out.count, 0);
  assert_int_equal(average_direct(&s.in, &out), DSM_OK);
  assert_int_equal(out.count, 0);
  average_free(&scratch);
  set_free(&s);
}

/* Steps, plateaus, ramps, near-vertical ramps, on depths that often coincide. */
static void random_function(set *s, rng *r, double scale, int may_grow) {
  double z = rng_below(r, 4);
  rgb v = rgb_grey(1);
  if (rng_below(r, 8)) set_push(s, z * scale, v);   /* else: a step from 1, left unsaid */
  for (uint32_t n = rng_below(r, 12); n-- > 0;) {
    uint32_t kind = rng_below(r, 5);
    if (kind == 1) z = floor(z) + 1 + rng_below(r, 3);
    if (kind == 2) z += rng_scale(r, 1e-14, 1e-3);
    if (kind == 3) z += rng_unit(r);
    for (int c = 0; c < 3; ++c) {
      if (kind == 4 || rng_below(r, 4) == 0) continue;
      v.c[c] = may_grow ? rng_unit(r) : v.c[c] * (rng_below(r, 6) ? rng_unit(r) : 0);
    }
    set_push(s, z * scale, v);
  }
  set_next(s);
}

static void random_functions_match_the_direct_sum(void **state) {
  (void)state;
  average_scratch scratch = {0};
  vertices out = {0}, direct = {0};
  for (uint64_t seed = 0; seed < most_cases(1500); ++seed) {
    rng r = rng_seeded(seed);
    uint32_t count = 1 + rng_below(&r, 24);
    int may_grow = rng_below(&r, 3) == 0;
    double scale = rng_scale(&r, 1e-6, 1e6), sum = 0;
    set s;
    set_begin(&s, count);
    for (uint32_t i = 0; i < count; ++i) {
      random_function(&s, &r, scale, may_grow);
      sum += s.weights[i] = rng_below(&r, 5) ? rng_unit(&r) : 0;
    }
    for (uint32_t i = 0; i < count; ++i) s.weights[i] = sum > 0 ? s.weights[i] / sum : 1.0 / count;
    sweep(&s, &scratch, &out);
    assert_seeded(&r, is_tidy(&out, !may_grow));
    direct.count = 0;
    assert_int_equal(average_direct(&s.in, &direct), DSM_OK);
    assert_seeded(&r, is_tidy(&direct, 0));
    for (size_t i = 0; i < s.all.count; ++i) {
      const double z[] = {s.all.data[i].z, nextafter(s.all.data[i].z, 1e9), s.all.data[i].z * 1.01};
      for (int k = 0; k < 3; ++k) {
        assert_seeded(&r, error_at(&s.in, &out, z[k]) < 1e-13);
        assert_seeded(&r, error_at(&s.in, &direct, z[k]) < 1e-13);
      }
    }
    set_free(&s);
  }
  vertices_free(&out);
  vertices_free(&direct);
  average_free(&scratch);
}

/* Has a function a vertex between two vertices of the average, because there it made no difference? */
static int is_idle_between(const set *s, const vertices *out, size_t i) {
  double from = out->data[i].z, to = i + 1 < out->count ? out->data[i + 1].z : HUGE_VAL;
  for (size_t k = 0; k < s->all.count; ++k)
    if (s->all.data[k].z > from && s->all.data[k].z < to) return 1;
  return 0;
}

/* The noise, against that of each pair of neighbours by itself. */
static void noise_is_that_of_the_pairs(void **state) {
  (void)state;
  average_scratch scratch = {0};
  noise_profile profile = {0};
  vertices out = {0};
  size_t noisy = 0;
  for (uint64_t seed = 0; seed < most_cases(1500); ++seed) {
    rng r = rng_seeded(seed);
    uint32_t count = 1 + rng_below(&r, 24);
    int may_grow = rng_below(&r, 3) == 0, grey = rng_below(&r, 2) == 0;
    set s;
    set_begin(&s, count);
    for (uint32_t i = 0; i < count; ++i) random_function(&s, &r, 1, may_grow);
    for (size_t i = 0; i < s.all.count && grey; ++i) s.all.data[i].v = rgb_grey(s.all.data[i].v.c[0]);
    out.count = 0;
    assert_int_equal(average_and_noise(&s.in, &scratch, &profile, &out), DSM_OK);
    double *want = malloc((out.count + 1) * sizeof *want);
    noise_direct(&s.in, &out, want);
    for (size_t i = 0; i < out.count; ++i) {
      if (i + 1 < out.count && out.data[i + 1].z == out.data[i].z) continue;
      if (is_idle_between(&s, &out, i)) continue;
      assert_seeded(&r, fabs(profile.allowed[i] - want[i]) < 1e-7);
      noisy += profile.allowed[i] > 0;
    }
    free(want);
    set_free(&s);
  }
  assert_true(noisy > 6 * most_cases(1500));
  noise_free(&profile);
  vertices_free(&out);
  average_free(&scratch);
}

/* Ramps as steep as 10^13 beside ramps as flat as 10^-7, a million vertices in all. */
static void a_million_vertices_do_not_drift(void **state) {
  (void)state;
  enum { functions = 500, each = 2000 };
  for (int may_grow = 0; may_grow < 2; ++may_grow) {
    rng r = rng_seeded(11 + (uint64_t)may_grow);
    set s;
    set_begin(&s, functions);
    for (int i = 0; i < functions; ++i) {
      double z = rng_unit(&r), v = 1;
      for (int k = 0; k < each; ++k) {
        set_push(&s, z, (rgb){{v, v * v, 1}});
        z += k % 2 ? rng_scale(&r, 1e-9, 1e-3) * (i % 3 ? 1 : 1e-4) : rng_scale(&r, 1e-3, 1e3);
        v = may_grow ? rng_unit(&r) : v * rng_between(&r, 0.99, 1);
      }
      set_next(&s);
    }
    average_scratch scratch = {0};
    vertices out = {0};
    sweep(&s, &scratch, &out);
    assert_seeded(&r, is_tidy(&out, !may_grow));
    assert_seeded(&r, out.count > functions * each * 0.99);
    for (size_t i = 0; i < out.count; i += 1999) {
      assert_seeded(&r, error_at(&s.in, &out, out.data[i].z) < 1e-12);
      if (i) assert_seeded(&r, error_at(&s.in, &out, (out.data[i].z + out.data[i - 1].z) / 2) < 1e-12);
    }
    assert_seeded(&r, error_at(&s.in, &out, out.data[out.count - 1].z * 2) < 1e-15);
    vertices_free(&out);
    average_free(&scratch);
    set_free(&s);
  }
}

/* A million steps, each a function of its own. */
static void a_million_functions_do_not_drift(void **state) {
  (void)state;
  enum { n = 1000000 };
  rng r = rng_seeded(5);
  set s;
  set_begin(&s, n);
  double level = 0.3;   /* what each function lets through */
  for (int i = 0; i < n; ++i) {
    double z = i + 0.5;
    set_push(&s, z, rgb_grey(1));
    set_push(&s, z, rgb_grey(level));
    set_next(&s);
  }
  average_scratch scratch = {0};
  vertices out = {0};
  sweep(&s, &scratch, &out);
  for (int i = 0; i < n; i += 1009) {
    double expected = (double)(1 - 0.7L * i / n);
    assert_seeded(&r, fabs(vertices_at(out.data, out.count, i + 0.5).c[0] - expected) < 1e-13);
  }
  vertices_free(&out);
  average_free(&scratch);
  set_free(&s);
}

/* Weights that add up to 1 only nearly must not leave a glimmer behind opaque things. */
static void what_is_dark_is_exactly_zero(void **state) {
  (void)state;
  average_scratch scratch = {0};
  vertices out = {0};
  for (uint64_t seed = 0; seed < most_cases(300); ++seed) {
    rng r = rng_seeded(seed);
    uint32_t count = 1 + rng_below(&r, 100);
    double sum = 0;
    set s;
    set_begin(&s, count);
    for (uint32_t i = 0; i < count; ++i) {
      double z = rng_unit(&r);
      set_push(&s, z, rgb_grey(1));
      set_push(&s, z + (rng_below(&r, 2) ? rng_unit(&r) : 0), rgb_grey(0));
      set_next(&s);
      sum += s.weights[i] = rng_unit(&r);
    }
    for (uint32_t i = 0; i < count; ++i) s.weights[i] /= sum;
    sweep(&s, &scratch, &out);
    assert_seeded(&r, out.data[0].v.c[0] == 1 && rgb_max(out.data[out.count - 1].v) == 0);
    out.count = 0;
    assert_int_equal(average_direct(&s.in, &out), DSM_OK);
    assert_seeded(&r, out.data[0].v.c[0] == 1 && rgb_max(out.data[out.count - 1].v) == 0);
    set_free(&s);
  }
  vertices_free(&out);
  average_free(&scratch);
}

/* A rate of change that no double holds is a step. */
static void steepest_ramps_stay_finite(void **state) {
  (void)state;
  for (int coloured = 0; coloured < 2; ++coloured) {
    set s;
    set_begin(&s, 2);
    set_push(&s, 0, rgb_grey(1));
    set_push(&s, 5e-324, coloured ? (rgb){{0.5, 0.25, 1}} : rgb_grey(0.5));
    set_push(&s, 1, rgb_grey(0));
    set_next(&s);
    set_push(&s, 0, rgb_grey(1));
    set_push(&s, 2, rgb_grey(0));
    set_next(&s);
    average_scratch scratch = {0};
    vertices out = {0};
    sweep(&s, &scratch, &out);
    assert_true(is_tidy(&out, 1));
    for (double z = 0.25; z < 3; z += 0.25) assert_true(error_at(&s.in, &out, z) < 1e-15);
    vertices_free(&out);
    average_free(&scratch);
    set_free(&s);
  }
}

static void appends_and_undoes(void **state) {
  (void)state;
  set s;
  set_begin(&s, 1);
  set_push(&s, 1, rgb_grey(1));
  set_push(&s, 1, rgb_grey(0.5));
  set_next(&s);
  average_scratch scratch = {0};
  vertices out = {0};
  assert_int_equal(vertices_push(&out, 9, rgb_grey(0)), DSM_OK);
  assert_int_equal(average_sweep(&s.in, &scratch, &out), DSM_OK);
  assert_int_equal(average_direct(&s.in, &out), DSM_OK);
  assert_int_equal(out.count, 5);
  assert_true(out.data[0].z == 9 && out.data[1].v.c[0] == 1 && out.data[2].v.c[0] == 0.5);
  assert_true(out.data[3].v.c[0] == 1 && out.data[4].v.c[0] == 0.5);
  vertices_free(&out);

  size_t full = SIZE_MAX / sizeof(vertex);
  out = (vertices){NULL, full, full};
  assert_int_equal(average_sweep(&s.in, &scratch, &out), DSM_NO_MEMORY);
  assert_int_equal(average_direct(&s.in, &out), DSM_NO_MEMORY);
  assert_true(out.count == full);
  average_free(&scratch);
  assert_true(scratch.keys == NULL && scratch.room_vertices == 0);
  set_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(opaque_hair_is_a_staircase),
    cmocka_unit_test(steps_at_one_depth_become_one),
    cmocka_unit_test(idle_vertices_vanish),
    cmocka_unit_test(nothing_in_nothing_out),
    cmocka_unit_test(random_functions_match_the_direct_sum),
    cmocka_unit_test(noise_is_that_of_the_pairs),
    cmocka_unit_test(a_million_vertices_do_not_drift),
    cmocka_unit_test(a_million_functions_do_not_drift),
    cmocka_unit_test(what_is_dark_is_exactly_zero),
    cmocka_unit_test(steepest_ramps_stay_finite),
    cmocka_unit_test(appends_and_undoes),
  };
  return cmocka_run_group_tests_name("average", tests, NULL, NULL);
}
