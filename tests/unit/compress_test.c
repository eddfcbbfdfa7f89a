/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/compress.h"
#include "random.h"

enum { MOST = 64 };

/* Where two functions are walked side by side: `i` is the first vertex at or behind z. */
typedef struct { const vertex *data; size_t count, i; } walker;

/* The value in front of z; z must not fall from call to call. */
static rgb walk_front(walker *w, double z) {
  while (w->i < w->count && w->data[w->i].z < z) ++w->i;
  if (w->i == 0) return rgb_grey(1);
  const vertex *a = &w->data[w->i - 1], *b = a + 1;
  if (w->i == w->count) return a->v;
  return b->z == z ? b->v : rgb_lerp(a->v, b->v, (z - a->z) / (b->z - a->z));
}

static rgb walk_behind(walker *w, double z) {
  rgb v = walk_front(w, z);
  for (size_t i = w->i; i < w->count && w->data[i].z == z; ++i) v = w->data[i].v;
  return v;
}

static double distance(rgb a, rgb b, int channels) {
  double worst = 0;
  for (int c = 0; c < 3; ++c) worst = fmax(worst, fabs(a.c[channels == 1 ? 0 : c] - b.c[c]));
  return worst;
}

/* The largest distance over all depths. Between two depths of the input both functions are linear, so their
 * ends, just inside, tell all; the middles are measured for good measure. */
static double largest_error(const vertex *in, size_t n, const vertices *out, int channels) {
  walker a = {in, n, 0}, b = {out->data, out->count, 0};
  double worst = 0, before = n ? in[0].z - 1 : 0;
  for (size_t i = 0; i < n; ++i) {
    double z = in[i].z, middle = before + (z - before) / 2;
    if (z > before) worst = fmax(worst, distance(walk_front(&a, middle), walk_front(&b, middle), channels));
    worst = fmax(worst, distance(walk_front(&a, z), walk_front(&b, z), channels));
    worst = fmax(worst, distance(walk_behind(&a, z), walk_behind(&b, z), channels));
    before = z;
  }
  return fmax(worst, distance(walk_front(&a, HUGE_VAL), walk_front(&b, HUGE_VAL), channels));
}

/* In [0,1], falling if `falls`, at depths of the input, two vertices at each at most. */
static int is_tidy(const vertex *in, size_t n, const vertices *out, int falls) {
  size_t k = 0;
  for (size_t i = 0; i < out->count; ++i) {
    const vertex *b = &out->data[i], *a = b - 1;
    while (k < n && in[k].z < b->z) ++k;
    if (k == n || in[k].z != b->z) return 0;
    if (i > 1 && a[-1].z == b->z) return 0;
    for (int c = 0; c < 3; ++c) {
      if (!(b->v.c[c] >= 0 && b->v.c[c] <= 1)) return 0;
      if (i == 0 && b->v.c[c] != 1) return 0;
      if (i && falls && b->v.c[c] > a->v.c[c]) return 0;
    }
  }
  return 1;
}

/* Each step of the input that is taller than the tolerance is a step of the output, behind it exactly as
 * high. */
static int keeps_tall_steps(const vertex *in, size_t n, const vertices *out, int channels, double tolerance) {
  size_t k = 0;
  for (size_t i = 0, last; i < n; i = last + 1) {
    for (last = i; last + 1 < n && in[last + 1].z == in[i].z;) ++last;
    for (int c = 0; c < channels; ++c) {
      double before = i ? in[i].v.c[c] : 1, after = in[last].v.c[c];
      if (fabs(before - after) <= tolerance) continue;
      while (k < out->count && out->data[k].z < in[i].z) ++k;
      if (k + 1 >= out->count || out->data[k + 1].z != in[i].z) return 0;
      if (out->data[k + 1].v.c[c] != after) return 0;
    }
  }
  return 1;
}

static void compress(const vertex *in, size_t n, int channels, double tolerance, vertices *out) {
  out->count = 0;
  assert_int_equal(compress_greedy(in, n, channels, tolerance, out), DSM_OK);
}

static vertex grey(double z, double v) { return (vertex){z, rgb_grey(v)}; }

static void clear_functions_vanish(void **state) {
  (void)state;
  vertex level[] = {grey(1, 1), grey(2, 1), grey(3, 1)}, hardly[] = {grey(1, 1), grey(2, 0.995), grey(9, 0.99)};
  vertices out = {0};
  compress(NULL, 0, 3, 0.01, &out);
  assert_int_equal(out.count, 0);
  compress(level, 3, 3, 0, &out);
  assert_int_equal(out.count, 0);
  compress(hardly, 3, 1, 0.0101, &out);
  assert_int_equal(out.count, 0);
  compress(hardly, 3, 1, 0.009, &out);
  assert_true(out.count > 0);
  vertices_free(&out);
}

static void opaque_surface_stays_exact(void **state) {
  (void)state;
  vertex e[] = {grey(3, 1), grey(3, 0)}, unsaid[] = {grey(3, 0)};
  vertices out = {0};
  for (int i = 0; i < 2; ++i) {
    compress(i ? unsaid : e, i ? 1 : 2, 1, 0.3, &out);
    assert_int_equal(out.count, 2);
    assert_true(out.data[0].z == 3 && out.data[0].v.c[2] == 1 && out.data[1].z == 3 && out.data[1].v.c[2] == 0);
  }
  vertices_free(&out);
}

/* Panes of glass far apart: all steps tall, nothing to gain, nothing lost. */
static void tall_slabs_stay_exact(void **state) {
  (void)state;
  vertex e[12];
  double v = 1;
  for (int k = 0; k < 6; ++k) {
    e[2 * k] = grey(1 + k, v);
    v *= 0.7;
    e[2 * k + 1] = grey(1 + k, v);
  }
  vertices out = {0};
  compress(e, 12, 1, 0.02, &out);
  assert_int_equal(out.count, 12);
  for (int i = 0; i < 12; ++i) assert_true(out.data[i].z == e[i].z && out.data[i].v.c[0] == e[i].v.c[0]);
  vertices_free(&out);
}

/* A straight fall in 4096 exact steps of depth is two vertices, at tolerance 0 too. */
static void straight_line_is_two_vertices(void **state) {
  (void)state;
  enum { n = 4097 };
  vertex e[n];
  for (int i = 0; i < n; ++i) e[i] = grey(i, 1 - i / 4096.0);
  vertices out = {0};
  compress(e, n, 1, 0, &out);
  assert_int_equal(out.count, 2);
  assert_true(out.data[1].z == 4096 && out.data[1].v.c[0] == 0);
  compress(e, n, 1, 0.01, &out);
  assert_int_equal(out.count, 2);
  vertices_free(&out);
}

/* Hairs: 1/256 of the light at each of 256 depths. Steps shorter than the tolerance make one straight line. */
static void fine_staircase_is_a_line(void **state) {
  (void)state;
  enum { n = 256 };
  vertex e[2 * n];
  for (int i = 0; i < n; ++i) {
    e[2 * i] = grey(1 + i, 1 - i / 256.0);
    e[2 * i + 1] = grey(1 + i, 1 - (i + 1) / 256.0);
  }
  vertices out = {0};
  compress(e, 2 * n, 1, 1 / 64.0, &out);
  assert_true(out.count <= 4);
  assert_true(largest_error(e, 2 * n, &out, 1) <= 1 / 64.0 + 1e-14);
  assert_true(out.data[out.count - 1].v.c[0] == 0);
  vertices_free(&out);
}

/* exp(-z) has chords of length 4 sqrt(t exp(z)) within +-t; the greedy wedge may need up to twice their
 * number. */
static void fog_needs_few_vertices(void **state) {
  (void)state;
  enum { n = 20000 };
  vertex *e = malloc(n * sizeof *e);
  for (int i = 0; i < n; ++i) e[i] = grey(i * 1e-3, exp(-i * 1e-3));
  vertices out = {0};
  for (double t = 1e-4; t < 0.1; t *= 2) {
    compress(e, n, 1, t, &out);
    assert_true(largest_error(e, n, &out, 1) <= t + 1e-14);
    assert_true((double)out.count <= 3 + 2 / (2 * sqrt(t)));
  }
  vertices_free(&out);
  free(e);
}

static void ends_at_exactly_zero(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(3000); ++seed) {
    rng r = rng_seeded(seed);
    vertex e[MOST];
    int n = 2 + (int)rng_below(&r, MOST - 2);
    double z = 0, v = 1;
    for (int i = 0; i < n; ++i) {
      e[i] = grey(z, i + 1 < n ? v : 0);
      z += rng_below(&r, 3) ? rng_unit(&r) : 0;
      v *= rng_between(&r, 0.5, 1);
    }
    e[0].v = rgb_grey(1);
    vertices out = {0};
    compress(e, (size_t)n, 1, rng_scale(&r, 1e-3, 0.3), &out);
    assert_seeded(&r, out.count > 0 && out.data[out.count - 1].v.c[0] == 0);
    vertices_free(&out);
  }
}

/* Three channels, each within the tolerance; one channel, green and blue not read. */
static void channels_share_depths(void **state) {
  (void)state;
  enum { n = 1000 };
  vertex e[n];
  for (int i = 0; i < n; ++i) {
    double z = i * 0.01;
    e[i] = (vertex){z, {{exp(-z), 1 / (1 + z), fmax(0, 1 - z / 7)}}};
  }
  vertices out = {0};
  compress(e, n, 3, 0.005, &out);
  assert_true(largest_error(e, n, &out, 3) <= 0.005 + 1e-14 && out.count < 30);
  for (int i = 0; i < n; ++i) e[i].v.c[1] = e[i].v.c[2] = (double)NAN;
  compress(e, n, 1, 0.005, &out);
  assert_true(largest_error(e, n, &out, 1) <= 0.005 + 1e-14);
  for (size_t i = 0; i < out.count; ++i) assert_true(rgb_is_grey(out.data[i].v));
  vertices_free(&out);
}

/* A function is a random walk of plateaus, steps, ramps and near-vertical ramps. */
static size_t random_function(rng *r, vertex *e, int may_grow) {
  size_t n = rng_below(r, MOST);
  double scale = rng_scale(r, 1e-6, 1e6), z = rng_unit(r), gentle = rng_between(r, 0.3, 1);
  rgb v = rgb_grey(1);
  for (size_t i = 0; i < n; ++i) {
    if (i || rng_below(r, 4) == 0)
      for (int c = 0; c < 3; ++c) {
        if (rng_below(r, 3) == 0) continue;
        v.c[c] = may_grow ? fmin(1, v.c[c] * rng_between(r, 0.5, 1.6)) : v.c[c] * rng_between(r, gentle, 1);
        if (rng_below(r, 200) == 0) v.c[c] = 0;
      }
    e[i] = (vertex){z * scale, v};
    switch (rng_below(r, 5)) {
      case 0: break;
      case 1: z = nextafter(z, HUGE_VAL); break;
      case 2: z += rng_scale(r, 1e-12, 1e-2); break;
      default: z += rng_unit(r); break;
    }
  }
  return n;
}

static void random_functions_stay_within_the_tolerance(void **state) {
  (void)state;
  vertices out = {0};
  for (uint64_t seed = 0; seed < most_cases(100000); ++seed) {
    rng r = rng_seeded(seed);
    vertex e[MOST];
    int may_grow = rng_below(&r, 4) == 0, channels = rng_below(&r, 2) ? 3 : 1;
    size_t n = random_function(&r, e, may_grow);
    double tolerance = rng_below(&r, 10) ? rng_scale(&r, 1e-5, 0.49) : 0;
    compress(e, n, channels, tolerance, &out);
    assert_seeded(&r, is_tidy(e, n, &out, !may_grow));
    assert_seeded(&r, out.count <= n + 2);
    assert_seeded(&r, largest_error(e, n, &out, channels) <= tolerance + 2e-15);
    assert_seeded(&r, keeps_tall_steps(e, n, &out, channels, tolerance));
  }
  vertices_free(&out);
}

static void a_million_vertices(void **state) {
  (void)state;
  enum { n = 1000000 };
  rng r = rng_seeded(42);
  vertex *e = malloc(n * sizeof *e);
  vertices out = {0};
  double z = 1e-6, v = 1;
  for (int i = 0; i < n; ++i) {
    e[i] = grey(z, v);
    if (rng_below(&r, 3)) z += rng_scale(&r, 1e-9, 10);
    if (rng_below(&r, 2)) v *= 1 - 1e-5 * rng_unit(&r);
  }
  const double tolerances[] = {0, 1e-6, 0.002, 0.05};
  for (int t = 0; t < 4; ++t) {
    compress(e, n, 1, tolerances[t], &out);
    assert_seeded(&r, is_tidy(e, n, &out, 1));
    assert_seeded(&r, largest_error(e, n, &out, 1) <= tolerances[t] + 2e-15);
    /* Each vertex but the first two, and a pair at each step, pays with a fall by the tolerance. */
    if (t > 1) assert_seeded(&r, (double)out.count < 4 + 2 / tolerances[t]);
  }
  vertices_free(&out);
  free(e);
}

/* A step, a million vertices at one height, and a step. */
static void a_plateau_of_a_million_vertices(void **state) {
  (void)state;
  enum { n = 1000000 };
  vertex *e = malloc(n * sizeof *e);
  vertices out = {0};
  for (int i = 0; i < n; ++i) e[i] = grey(1 + i * 1e-4, 0.7);
  e[n - 1].v = rgb_grey(0);
  e[n - 1].z = e[n - 2].z;
  const double tolerances[] = {0, 0.002, 0.25}, corners[] = {1, 0.7, 0.7, 0};
  for (int t = 0; t < 3; ++t) {
    compress(e, n, 1, tolerances[t], &out);
    assert_int_equal(out.count, 4);
    for (int i = 0; i < 4; ++i)
      assert_true(out.data[i].z == e[i < 2 ? 0 : n - 1].z && out.data[i].v.c[0] == corners[i]);
    out.count = 0;
    assert_int_equal(compress_minimal(e, n, 1, tolerances[t], &out), DSM_OK);
    assert_int_equal(out.count, t > 0 ? 3 : 4);   /* without tolerance it is the greedy one */
    assert_true(out.data[out.count - 1].v.c[0] == 0);
  }
  vertices_free(&out);
  free(e);
}

/* A level end that begins a billionth in front of a step: of the line that leads there two points are known that nearly coincide. */
static void a_goal_of_no_length(void **state) {
  (void)state;
  const double z0 = 2.8626751370184044e-06, z1 = 2.8723391659009704e-06, z2 = 3.3136797312525759e-06, z3 = 4.3821951980896363e-06;
  const vertex e[] = {grey(z0, 1), grey(z1, 1), grey(z2, 0.85547637924347697), grey(z3, 0.77429085451455593),
                      grey(z3, 0.73389531635635608), grey(4.3821951980934928e-06, 0.73389531635635608),
                      grey(4.382195213535327e-06, 0.73389531635635608)};
  double tolerance = 0.047066195689308171, spent = 0.021319474472671695;
  vertices out = {0};
  assert_int_equal(compress_minimal_after(e, 7, 1, tolerance, spent, &out), DSM_OK);
  assert_true(largest_error(e, 7, &out, 1) <= tolerance - spent + 2e-15);
  vertices_free(&out);
}

/* Depths so close that slopes overflow. */
static void closest_depths_stay_finite(void **state) {
  (void)state;
  vertex e[] = {grey(0, 1), grey(5e-324, 0.6), grey(1e-323, 0.55),
                grey(1e-300, 0.5), grey(1, 0.45), grey(2, 0)};
  vertices out = {0};
  for (double t = 0; t < 0.4; t += 0.03) {
    compress(e, 6, 1, t, &out);
    assert_true(is_tidy(e, 6, &out, 1));
    for (int i = 0; i < 6; ++i)
      assert_true(fabs(vertices_at(out.data, out.count, e[i].z).c[0] - e[i].v.c[0]) <= t + 1e-15);
  }
  vertices_free(&out);
}

/* A steep rise overflows as well as a steep fall. */
static void closest_depths_may_rise(void **state) {
  (void)state;
  vertex e[] = {grey(0, 1), grey(0, 0.1), grey(5e-324, 0.9), grey(1e-323, 0.2), grey(1.5e-323, 0.8), grey(1, 0.7)};
  vertices out = {0};
  for (double t = 0; t < 0.4; t += 0.03) {
    compress(e, 6, 1, t, &out);
    assert_true(is_tidy(e, 6, &out, 0));
    for (int i = 1; i < 6; ++i)
      assert_true(fabs(vertices_at(out.data, out.count, nextafter(e[i].z, 2)).c[0] - vertices_at(e, 6, nextafter(e[i].z, 2)).c[0]) <= t + 1e-15);
  }
  vertices_free(&out);
}

/* Values that rounding has led out of [0,1], or worse, are taken for 0 and 1; depths may be relative to anything. */
static void odd_inputs(void **state) {
  (void)state;
  vertices out = {0};
  for (uint64_t seed = 0; seed < 2000; ++seed) {
    rng r = rng_seeded(seed);
    vertex in[MOST], cut[MOST];
    size_t n = 1 + rng_below(&r, MOST - 1);
    int channels = rng_below(&r, 2) ? 3 : 1;
    double z = -20, tolerance = rng_between(&r, 0.001, 0.3), most = rng_below(&r, 2) ? 1e-15 : 0.4;
    for (size_t i = 0; i < n; ++i) {
      for (int c = 0; c < 3; ++c) in[i].v.c[c] = rng_below(&r, 3) ? rng_between(&r, -most, 1 + most) : rng_below(&r, 2) ? -most : 1 + most;
      in[i].z = cut[i].z = z;
      for (int c = 0; c < 3; ++c) cut[i].v.c[c] = fmin(1, fmax(0, in[i].v.c[c]));
      z += rng_below(&r, 3) ? 2 * rng_unit(&r) : 0;
    }
    compress(in, n, channels, tolerance, &out);
    assert_seeded(&r, is_tidy(in, n, &out, 0));
    assert_seeded(&r, largest_error(cut, n, &out, channels) <= tolerance + 2e-15);
    size_t greedy = out.count;
    out.count = 0;
    assert_int_equal(compress_minimal(in, n, channels, tolerance, &out), DSM_OK);
    for (size_t i = 0; i < out.count; ++i)
      for (int c = 0; c < 3; ++c) assert_seeded(&r, out.data[i].v.c[c] >= 0 && out.data[i].v.c[c] <= 1);
    assert_seeded(&r, out.count <= greedy && largest_error(cut, n, &out, channels) <= tolerance + 2e-15);
  }
  vertices_free(&out);
}

static void appends_and_undoes(void **state) {
  (void)state;
  vertex e[] = {grey(3, 1), grey(3, 0)};
  vertices out = {0};
  assert_int_equal(vertices_push(&out, 9, rgb_grey(0.5)), DSM_OK);
  assert_int_equal(compress_greedy(e, 2, 1, 0.01, &out), DSM_OK);
  assert_int_equal(out.count, 3);
  assert_true(out.data[0].z == 9 && out.data[1].v.c[0] == 1 && out.data[2].v.c[0] == 0);
  vertices_free(&out);
  size_t full = SIZE_MAX / sizeof(vertex);
  out = (vertices){NULL, full, full};
  assert_int_equal(compress_greedy(e, 2, 1, 0.01, &out), DSM_NO_MEMORY);
  assert_true(out.count == full);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(clear_functions_vanish),
    cmocka_unit_test(opaque_surface_stays_exact),
    cmocka_unit_test(tall_slabs_stay_exact),
    cmocka_unit_test(straight_line_is_two_vertices),
    cmocka_unit_test(fine_staircase_is_a_line),
    cmocka_unit_test(fog_needs_few_vertices),
    cmocka_unit_test(ends_at_exactly_zero),
    cmocka_unit_test(channels_share_depths),
    cmocka_unit_test(random_functions_stay_within_the_tolerance),
    cmocka_unit_test(a_million_vertices),
    cmocka_unit_test(a_plateau_of_a_million_vertices),
    cmocka_unit_test(a_goal_of_no_length),
    cmocka_unit_test(closest_depths_stay_finite),
    cmocka_unit_test(closest_depths_may_rise),
    cmocka_unit_test(odd_inputs),
    cmocka_unit_test(appends_and_undoes),
  };
  return cmocka_run_group_tests_name("compress", tests, NULL, NULL);
}
