/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/transmittance.h"
#include "random.h"

enum { MOST = 400 };

static event span(double front, double back, double depth) {
  return (event){front, back, rgb_grey(exp(-depth)), 0};
}

static event surface(double z, double t) { return (event){z, z, rgb_grey(t), 0}; }

static int by_front(const void *a, const void *b) {
  double x = ((const event *)a)->front, y = ((const event *)b)->front;
  return (x > y) - (x < y);
}

/* The value just behind z, or in front of it: every event's own share, multiplied. */
static double truth(const event *e, size_t count, double z, int behind, int c) {
  long double v = 1;
  for (size_t i = 0; i < count; ++i) {
    long double t = (long double)e[i].transmittance.c[c], depth = t > 0 ? -logl(t) : 745.0L;
    if (e[i].front == e[i].back) {
      if (e[i].front < z || (behind && e[i].front == z)) v *= t;
    } else if (e[i].back <= z) {
      v *= expl(-depth);
    } else if (e[i].front < z) {
      v *= expl(-depth * ((long double)z - (long double)e[i].front)
                / ((long double)e[i].back - (long double)e[i].front));
    }
  }
  return (double)v;
}

static double error_at(const event *e, size_t n, const vertices *f, double z) {
  rgb v = vertices_at(f->data, f->count, z);
  double worst = 0;
  for (int c = 0; c < 3; ++c) worst = fmax(worst, fabs(v.c[c] - truth(e, n, z, 0, c)));
  return worst;
}

static int is_tidy(const vertices *f) {
  for (size_t i = 0; i < f->count; ++i) {
    const vertex *b = &f->data[i], *a = b - 1;
    for (int c = 0; c < 3; ++c) {
      if (!(b->v.c[c] >= 0 && b->v.c[c] <= 1)) return 0;
      if (i && b->v.c[c] > a->v.c[c]) return 0;
    }
    if (i == 0 && rgb_max(rgb_sub(rgb_grey(1), b->v)) > 0) return 0;
    if (i && b->z < a->z) return 0;
    if (i > 1 && b->z == a[-1].z) return 0;
    if (i && b->z == a->z && rgb_max(rgb_sub(a->v, b->v)) == 0) return 0;
  }
  return 1;
}

static vertices build(const event *e, size_t n, double tolerance) {
  vertices f = {0};
  assert_int_equal(transmittance_build(e, n, tolerance, &f), DSM_OK);
  assert_true(is_tidy(&f));
  return f;
}

/* Within the promise at every end of an event, beside it, and between any two neighbours. */
static double worst_error(const event *e, size_t n, const vertices *f) {
  double worst = 0, places[2 * MOST];
  size_t count = 0;
  for (size_t i = 0; i < n; ++i) {
    places[count++] = e[i].front;
    places[count++] = e[i].back;
  }
  for (size_t i = 0; i < count; ++i) {
    worst = fmax(worst, error_at(e, n, f, places[i]));
    worst = fmax(worst, error_at(e, n, f, nextafter(places[i], HUGE_VAL)));
    worst = fmax(worst, error_at(e, n, f, places[i] * 1.1));
  }
  for (size_t i = 1; i < f->count; ++i)
    for (int k = 1; k < 6; ++k)
      worst = fmax(worst, error_at(e, n, f, f->data[i - 1].z + (f->data[i].z - f->data[i - 1].z) * k / 6));
  return worst;
}

static void no_events_are_all_lit(void **state) {
  (void)state;
  event clear[] = {surface(1, 1), span(2, 3, 0), surface(4, 1)};
  vertices f = build(NULL, 0, 0.01);
  assert_int_equal(f.count, 0);
  f = build(clear, 3, 0.01);
  assert_int_equal(f.count, 0);
  vertices_free(&f);
}

static void opaque_surface_is_two_vertices(void **state) {
  (void)state;
  event e[] = {surface(3, 0), surface(4, 0.5), span(5, 6, 1)};
  vertices f = build(e, 3, 0.01);
  assert_int_equal(f.count, 2);
  assert_true(f.data[0].z == 3 && f.data[0].v.c[0] == 1 && f.data[1].z == 3 && f.data[1].v.c[0] == 0);
  vertices_free(&f);
}

/* Behind slab k of n, light is t^k, exactly at every depth. */
static void glass_slabs(void **state) {
  (void)state;
  event e[40];
  for (int k = 0; k < 40; ++k) e[k] = (event){1 + k, 1 + k, {{0.5, 0.75, 1}}, 0};
  vertices f = build(e, 40, 0.01);
  for (int k = 0; k < 40; ++k) {
    rgb v = vertices_at(f.data, f.count, 1.5 + k);
    double red = ldexp(1, -(k + 1));
    assert_true(v.c[0] == (red < 1e-12 ? 0 : red));
    assert_true(fabs(v.c[1] - pow(0.75, k + 1)) < 1e-15 && v.c[2] == 1);
  }
  assert_int_equal(f.count, 80);
  vertices_free(&f);
}

static void surfaces_at_one_depth_make_one_step(void **state) {
  (void)state;
  event e[5000];
  for (int i = 0; i < 5000; ++i) e[i] = surface(1e7, 0.999);
  vertices f = build(e, 5000, 0.01);
  assert_int_equal(f.count, 2);
  assert_true(fabs(f.data[1].v.c[1] - exp(5000 * log(0.999))) < 1e-14);
  vertices_free(&f);
}

/* Beer and Lambert. A function on the curve with chords of largest error e needs at least sqrt(1/2e)
 * vertices to fall from 1 to 0 in the limit of small e; the last one, where light is below e, comes on top. */
static void homogeneous_fog(void **state) {
  (void)state;
  const double tolerances[] = {0, 0.001, 0.01, 0.1}, scales[] = {1e-6, 1, 1e7};
  for (int t = 0; t < 4; ++t)
    for (int s = 0; s < 3; ++s)
      for (double depth = 1e-9; depth < 2e4; depth *= 10) {
        event e = span(scales[s], 3 * scales[s], fmin(depth, 700));
        double error = fmax(tolerances[t] / 4, 1e-6);
        vertices f = build(&e, 1, tolerances[t]);
        assert_true(worst_error(&e, 1, &f) <= error * (1 + 1e-5) + 1e-12);
        double gone = 1 - sqrt(e.transmittance.c[0]);
        assert_true((double)f.count <= 3 + 1.02 * gone * sqrt(1 / (2 * error)));
        assert_true(f.data[0].z == e.front && (depth > 27 || f.data[f.count - 1].z == e.back));
        vertices_free(&f);
      }
}

/* Ends that suffice get nothing between them: the gap of one chord is known exactly. */
static void no_vertex_without_need(void **state) {
  (void)state;
  for (double depth = 0.01; depth < 20; depth *= 1.3) {
    double g = -expm1(-depth) / depth, gap = 1 - g + g * log(g);
    event e = span(1, 2, depth);
    vertices f = build(&e, 1, 4 * gap * 1.0001);
    assert_int_equal(f.count, 2);
    f.count = 0;
    if (gap > 1e-6) {
      assert_int_equal(transmittance_build(&e, 1, 4 * gap * 0.999, &f), DSM_OK);
      assert_int_equal(f.count, 3);
    }
    vertices_free(&f);
  }
}

/* The fewest vertices on exp(-x) from 0 to `depth`: the longest chord each time, by bisection. */
static size_t fewest(double depth, double error) {
  size_t count = 1;
  for (double x = 0; x < depth; ++count) {
    double low = 0, high = depth - x;
    for (int i = 0; i < 60; ++i) {
      double d = i ? (low + high) / 2 : high, g = -expm1(-d) / d;
      if (exp(-x) * (1 - g + g * log(g)) <= error) low = d;
      else high = d;
    }
    x += low >= depth - x - 1e-9 ? depth : low;
  }
  return count;
}

static void fog_has_the_fewest_vertices_on_the_curve(void **state) {
  (void)state;
  for (double tolerance = 1e-4; tolerance < 0.5; tolerance *= 1.37)
    for (double depth = 0.1; depth < 26; depth *= 2.3) {
      event e = span(5, 7, depth);
      vertices f = build(&e, 1, tolerance);
      assert_int_equal(f.count, fewest(depth, tolerance / 4));
      vertices_free(&f);
    }
}

/* Extinction a*z, that is exp(-a z^2 / 2), in short spans: one chord takes many of them, and every vertex is
 * on the curve. A curve whose second derivative is f needs about the integral of sqrt(|f| / 8e) chords. */
static void linear_fog(void **state) {
  (void)state;
  enum { n = 300 };
  event e[n];
  double a = 3, far = 2, chords = 0;
  const double tolerances[] = {0.2, 0.02, 0.002};
  for (int i = 0; i < n; ++i) {
    double z0 = far * i / n, z1 = far * (i + 1) / n;
    e[i] = span(z0, z1, a * (z1 * z1 - z0 * z0) / 2);
    chords += far / n * sqrt(fabs(a * a * z0 * z0 - a) * exp(-a * z0 * z0 / 2) / 8);
  }
  for (int t = 0; t < 3; ++t) {
    double error = tolerances[t] / 4;
    vertices f = build(e, n, tolerances[t]);
    assert_true(worst_error(e, n, &f) <= error * (1 + 1e-5));
    assert_true((double)f.count <= 3 + 1.2 * chords / sqrt(error));
    for (size_t i = 0; i < f.count; ++i)
      assert_true(fabs(f.data[i].v.c[0] - exp(-a * f.data[i].z * f.data[i].z / 2)) < 1e-13);
    assert_true(f.data[f.count - 1].z == far);
    vertices_free(&f);
  }
}

/* What varies less than the error, in colour, with gaps between spans and a pane in the middle. */
static void thin_chains_are_merged(void **state) {
  (void)state;
  enum { n = 100 };
  event e[n];
  for (uint64_t seed = 0; seed < 30; ++seed) {
    rng r = rng_seeded(seed);
    double z = 1, tolerance = rng_scale(&r, 1e-3, 0.3), scale = rng_scale(&r, 1e-4, 1e4);
    int gaps = rng_below(&r, 2) == 0, grey = rng_below(&r, 2) == 0;
    for (int i = 0; i < n; ++i) {
      double back = z + rng_unit(&r);
      e[i] = (event){z * scale, back * scale, rgb_grey(1), 0};
      for (int c = 0; c < 3; ++c)
        e[i].transmittance.c[c] = c && grey ? e[i].transmittance.c[0] : exp(-rng_scale(&r, 1e-5, 0.02));
      if (i == n / 2) e[i] = (event){z * scale, z * scale, {{0.5, 0.5, grey ? 0.5 : 1}}, 0};
      else z = back + (gaps && i % 7 == 0 ? rng_unit(&r) : 0);
    }
    vertices f = build(e, n, tolerance);
    assert_seeded(&r, worst_error(e, n, &f) <= tolerance / 4 * (1 + 1e-5) + 1e-12);
    assert_seeded(&r, tolerance < 0.05 || f.count < n / 2);
    vertices_free(&f);
  }
}

/* Fog, a second fog inside it, a glass pane inside both: each stretch in closed form. */
static void glass_in_fog_in_fog(void **state) {
  (void)state;
  event e[] = {span(0, 10, 2), span(4, 8, 1), surface(6, 0.5)};
  vertices f = build(e, 3, 0.001);
  const double z[] = {2, 4, 5, 6, 7, 8, 9, 10, 11};
  const double v[] = {exp(-0.4), exp(-0.8), exp(-1.25), exp(-1.7), 0.5 * exp(-2.15), 0.5 * exp(-2.6),
                      0.5 * exp(-2.8), 0.5 * exp(-3), 0.5 * exp(-3)};
  for (int i = 0; i < 9; ++i)
    assert_true(fabs(vertices_at(f.data, f.count, z[i]).c[2] - v[i]) <= 0.00025 + 1e-12);
  const double exact[] = {4, 6, 8, 10};
  for (int i = 0; i < 4; ++i) assert_true(error_at(e, 3, &f, exact[i]) < 1e-14);
  assert_true(error_at(e, 3, &f, nextafter(6, 7)) < 1e-12);
  vertices_free(&f);
}

/* A sheet of extinction 1e10 inside a haze of 1e-7: what follows it must not inherit its rounding. */
static void dense_sheet_leaves_no_trace(void **state) {
  (void)state;
  event e[] = {span(0, 1e7, 1), span(1000, 1000 + 1e-10, 1), span(2000, 2000 + 1e-7, 0.5)};
  vertices f = build(e, 3, 0.001);
  double back = vertices_at(f.data, f.count, 1e7).c[0];
  assert_true(fabs(back - truth(e, 3, 1e7, 0, 0)) < 1e-13);
  vertices_free(&f);
}

static void span_of_transmittance_zero_ends_dark(void **state) {
  (void)state;
  event e[] = {span(1, 2, 0), surface(9, 0.5)};
  e[0].transmittance = rgb_grey(0);
  vertices f = build(e, 2, 0.01);
  const vertex *last = &f.data[f.count - 1];
  assert_true(rgb_max(last->v) == 0 && last->z > 1 && last->z < 1.05 && f.data[0].z == 1);
  assert_true(worst_error(e, 2, &f) <= 0.0025 * (1 + 1e-5));
  f.count = 0;

  e[0].transmittance = (rgb){{0, 0.5, 1}};   /* the other channels go on */
  assert_int_equal(transmittance_build(e, 2, 0.01, &f), DSM_OK);
  rgb v = vertices_at(f.data, f.count, 10);
  assert_true(v.c[0] == 0 && fabs(v.c[1] - 0.25) < 1e-15 && v.c[2] == 0.5);
  vertices_free(&f);
}

static void span_too_short_for_a_rate_is_a_step(void **state) {
  (void)state;
  event e[] = {{0, 5e-324, {{0.5, 0.5, 0.5}}, 0}, {0, 1, {{0.5, 0.5, 0.5}}, 0}};
  vertices f = build(e, 2, 0.01);
  assert_true(fabs(vertices_at(f.data, f.count, 2).c[0] - 0.25) < 1e-15);
  vertices_free(&f);
}

/* Overlapping spans of which each is a step by itself. */
static void spans_too_short_that_overlap(void **state) {
  (void)state;
  event e[] = {span(0, 3e-300, 0.1), span(1e-300, 4e-300, 0.2), span(2e-300, 2.5e-300, 0.4), span(1, 2, 0.5)};
  vertices f = {0};
  assert_int_equal(transmittance_build(e, 4, 0.01, &f), DSM_OK);
  assert_true(fabs(vertices_at(f.data, f.count, 0.5).c[0] - exp(-0.7)) < 1e-15);
  assert_true(fabs(vertices_at(f.data, f.count, 3).c[0] - exp(-1.2)) < 1e-15);
  assert_true(f.data[0].v.c[0] == 1);
  vertices_free(&f);
}

static void nested_thousands(void **state) {
  (void)state;
  enum { n = 20000 };
  event *e = malloc(n * sizeof *e);
  for (int i = 0; i < n; ++i) e[i] = span(i, 2 * n - i, 1e-4);
  vertices f = build(e, n, 0.01);
  for (double z = 1.5; z < 2 * n; z += 999) assert_true(error_at(e, n, &f, z) <= 0.0025 * (1 + 1e-5));
  assert_true(fabs(f.data[f.count - 1].v.c[0] - exp(-n * 1e-4)) < 1e-12);
  vertices_free(&f);
  free(e);
}

static void random_event(rng *r, event *e, double scale, uint32_t cells) {
  double z0 = rng_below(r, cells), z1 = z0;
  switch (rng_below(r, 5)) {
    case 0: break;                                               /* surface */
    case 1: z1 += rng_below(r, cells); break;                    /* ends coincide with others' */
    case 2: z1 += rng_scale(r, 1e-9, 1); break;                  /* nearly a surface */
    case 3: z0 += rng_unit(r), z1 = z0 + rng_unit(r); break;
    default: z1 = z0 + 1; break;                                 /* a chain */
  }
  *e = (event){z0 * scale, z1 * scale, rgb_grey(1), 0};
  int grey = rng_below(r, 2) == 0;
  for (int c = 0; c < 3; ++c) {
    double depth = rng_scale(r, 1e-9, rng_below(r, 9) ? 1 : 1e4);
    e->transmittance.c[c] = c && grey ? e->transmittance.c[0] : exp(-depth);
    if (rng_below(r, 100) == 0) e->transmittance.c[c] = 0;
  }
}

static void random_events_match_the_product(void **state) {
  (void)state;
  event e[MOST];
  vertices f = {0};
  for (uint64_t seed = 0; seed < most_cases(400); ++seed) {
    rng r = rng_seeded(seed);
    size_t n = rng_below(&r, seed % 100 ? 20 : MOST);
    double scale = rng_scale(&r, 1e-6, 1e5), tolerance = rng_below(&r, 8) ? rng_scale(&r, 1e-4, 0.4) : 0;
    for (size_t i = 0; i < n; ++i) random_event(&r, &e[i], scale, 1 + rng_below(&r, 20));
    qsort(e, n, sizeof *e, by_front);
    f.count = 0;
    assert_int_equal(transmittance_build(e, n, tolerance, &f), DSM_OK);
    assert_seeded(&r, is_tidy(&f));
    assert_seeded(&r, worst_error(e, n, &f) <= fmax(tolerance / 4, 1e-6) * (1 + 1e-5) + 1e-11);
    /* Exact, not only within the tolerance, behind everything. */
    assert_seeded(&r, n == 0 || error_at(e, n, &f, 100 * scale) < 2e-12);
  }
  vertices_free(&f);
}

static void appends_and_undoes(void **state) {
  (void)state;
  event e = surface(1, 0.5);
  vertices f = {0};
  assert_int_equal(vertices_push(&f, 1, rgb_grey(0.25)), DSM_OK);
  assert_int_equal(transmittance_build(&e, 1, 0.01, &f), DSM_OK);
  assert_int_equal(f.count, 3);
  assert_true(f.data[0].v.c[0] == 0.25 && f.data[1].v.c[0] == 1 && f.data[2].v.c[0] == 0.5);
  vertices_free(&f);

  size_t full = SIZE_MAX / sizeof(vertex);
  f = (vertices){NULL, full, full};
  event many[40];
  for (int i = 0; i < 40; ++i) many[i] = span(i, 50, 0.1);
  assert_int_equal(transmittance_build(&e, 1, 0.01, &f), DSM_NO_MEMORY);
  assert_int_equal(transmittance_build(many, 1, 0.01, &f), DSM_NO_MEMORY);
  assert_int_equal(transmittance_build(many, 40, 0.01, &f), DSM_NO_MEMORY);
  assert_true(f.count == full);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(no_events_are_all_lit),
    cmocka_unit_test(opaque_surface_is_two_vertices),
    cmocka_unit_test(glass_slabs),
    cmocka_unit_test(surfaces_at_one_depth_make_one_step),
    cmocka_unit_test(homogeneous_fog),
    cmocka_unit_test(no_vertex_without_need),
    cmocka_unit_test(fog_has_the_fewest_vertices_on_the_curve),
    cmocka_unit_test(linear_fog),
    cmocka_unit_test(thin_chains_are_merged),
    cmocka_unit_test(glass_in_fog_in_fog),
    cmocka_unit_test(dense_sheet_leaves_no_trace),
    cmocka_unit_test(span_of_transmittance_zero_ends_dark),
    cmocka_unit_test(span_too_short_for_a_rate_is_a_step),
    cmocka_unit_test(spans_too_short_that_overlap),
    cmocka_unit_test(nested_thousands),
    cmocka_unit_test(random_events_match_the_product),
    cmocka_unit_test(appends_and_undoes),
  };
  return cmocka_run_group_tests_name("transmittance", tests, NULL, NULL);
}
