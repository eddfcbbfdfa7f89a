/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "bake/step_sweep.h"
#include "core/transmittance.h"
#include "average_direct.h"
#include "noise_direct.h"
#include "random.h"

/* A batch of surfaces that owns its memory. */
typedef struct {
  dsm_ray *rays;
  dsm_sink sink;
  step_input in;
} batch;

static void batch_begin(batch *b, uint32_t rays, int channels) {
  *b = (batch){.rays = malloc(rays * sizeof(dsm_ray))};
  for (uint32_t i = 0; i < rays; ++i) b->rays[i] = (dsm_ray){{0, 0, 0}, {0, 0, 1}, 0, 1e9};
  assert_int_equal(sink_begin(&b->sink, b->rays, rays), DSM_OK);
  b->in = (step_input){NULL, 0, 0, rays, channels};
}

static void batch_push(batch *b, uint32_t ray, double z, double red, double green, double blue) {
  assert_int_equal(sink_surface(&b->sink, ray, z, (double[3]){red, green, blue}), DSM_OK);
}

/* Only `rays` of them, from `first` on, are the pixel. */
static void batch_end(batch *b, uint32_t first, uint32_t rays) {
  assert_int_equal(sink_order(&b->sink), DSM_OK);
  size_t begin = b->sink.first[first];
  b->in = (step_input){b->sink.ordered + begin, b->sink.first[first + rays] - begin, first, rays, b->in.channels};
}

static void batch_free(batch *b) {
  sink_free(&b->sink);
  free(b->rays);
}

/* What it replaces: a function a ray. */
typedef struct {
  vertices all;
  size_t *first;
  double *weights;
  average_input in;
} functions;

static void build(const batch *b, functions *f) {
  uint32_t n = b->in.rays;
  *f = (functions){.first = malloc((n + 1) * sizeof(size_t)), .weights = malloc(n * sizeof(double))};
  for (uint32_t i = 0; i < n; ++i) {
    size_t begin = b->sink.first[b->in.first_ray + i], end = b->sink.first[b->in.first_ray + i + 1];
    f->first[i] = f->all.count;
    f->weights[i] = 1.0 / n;
    assert_int_equal(transmittance_build(b->sink.ordered + begin, end - begin, 0, &f->all), DSM_OK);
  }
  f->first[n] = f->all.count;
  f->in = (average_input){f->all.data, f->first, f->weights, n};
}

static void functions_free(functions *f) {
  vertices_free(&f->all);
  free(f->first);
  free(f->weights);
}

/* Steps only, from exactly 1, never growing, no two steps at one depth. */
static int is_staircase(const vertices *v) {
  if (v->count % 2) return 0;
  for (size_t i = 0; i < v->count; ++i)
    for (int c = 0; c < 3; ++c) {
      double before = i ? v->data[i - 1].v.c[c] : 1, here = v->data[i].v.c[c];
      if (!(here >= 0 && (i % 2 ? here <= before : here == before))) return 0;
    }
  for (size_t i = 1; i < v->count; ++i)
    if (i % 2 ? v->data[i].z != v->data[i - 1].z : !(v->data[i].z > v->data[i - 1].z)) return 0;
  return 1;
}

/* Depths on a few planes or anywhere; black, clear, faint and coloured surfaces; rays that meet none. */
static void random_batch(batch *b, rng *r) {
  uint32_t rays = 1 + rng_below(r, 40), channels = rng_below(r, 2) ? 3 : 1, most = rng_below(r, 12);
  double clear = rng_below(r, 3) ? 1 : 0;
  batch_begin(b, rays, (int)channels);
  for (uint32_t i = 0; i < rays; ++i)
    for (uint32_t k = rng_below(r, most + 1); k-- > 0;) {
      double pass[3], z = rng_below(r, 2) ? 1 + rng_below(r, 5) : rng_between(r, 0, 6);
      for (uint32_t c = 0; c < 3; ++c)
        pass[c] = c >= channels ? pass[0] : rng_below(r, 5) == 0 ? clear : rng_below(r, 5) == 0 ? rng_scale(r, 1e-9, 1) : rng_unit(r);
      batch_push(b, i, z, pass[0], pass[1], pass[2]);
    }
  uint32_t first = rng_below(r, rays);
  batch_end(b, first, 1 + rng_below(r, rays - first));
}

static void the_average_is_the_direct_sum(void **state) {
  (void)state;
  step_scratch scratch = {0};
  vertices mean = {0}, direct = {0};
  for (uint64_t seed = 0; seed < most_cases(3000); ++seed) {
    rng r = rng_seeded(seed);
    batch b;
    functions f;
    random_batch(&b, &r);
    build(&b, &f);
    mean.count = direct.count = 0;
    assert_int_equal(step_sweep(&b.in, &scratch, NULL, &mean), DSM_OK);
    assert_int_equal(average_direct(&f.in, &direct), DSM_OK);
    assert_seeded(&r, is_staircase(&mean));
    for (size_t i = 0; i < direct.count; ++i) {
      const double z[] = {direct.data[i].z, nextafter(direct.data[i].z, 1e9)};
      for (int k = 0; k < 2; ++k) {
        rgb got = vertices_at(mean.data, mean.count, z[k]), want = vertices_at(direct.data, direct.count, z[k]);
        for (int c = 0; c < 3; ++c) assert_seeded(&r, fabs(got.c[c] - want.c[c]) < 1e-14);
      }
    }
    functions_free(&f);
    batch_free(&b);
  }
  vertices_free(&mean);
  vertices_free(&direct);
  step_free(&scratch);
}

/* The same noise as measured from the rays' functions, at each place's last vertex. */
static void the_noise_is_the_measured_noise(void **state) {
  (void)state;
  step_scratch scratch = {0};
  noise_profile got = {0};
  vertices mean = {0};
  size_t noisy = 0;
  for (uint64_t seed = 0; seed < most_cases(3000); ++seed) {
    rng r = rng_seeded(seed);
    batch b;
    functions f;
    random_batch(&b, &r);
    build(&b, &f);
    mean.count = 0;
    assert_int_equal(step_sweep(&b.in, &scratch, &got, &mean), DSM_OK);
    double *want = malloc((mean.count + 1) * sizeof *want);
    noise_direct(&f.in, &mean, want);
    for (size_t i = 1; i < mean.count; i += 2) {
      assert_seeded(&r, fabs(got.allowed[i] - want[i]) < 1e-7);   /* the root of what has rounded */
      assert_seeded(&r, got.allowed[i - 1] == (i > 1 ? got.allowed[i - 2] : 0));
      noisy += got.allowed[i] > 0;
    }
    free(want);
    functions_free(&f);
    batch_free(&b);
  }
  assert_true(noisy > 3 * most_cases(3000));
  noise_free(&got);
  vertices_free(&mean);
  step_free(&scratch);
}

/* Opaque hairs: every value is a whole number of rays, exactly. */
static void opaque_hair_is_exact(void **state) {
  (void)state;
  enum { n = 1009 };
  batch b;
  step_scratch scratch = {0};
  vertices mean = {0};
  batch_begin(&b, n, 1);
  for (uint32_t i = 0; i < n; ++i) batch_push(&b, i, 1 + (i * 617) % n, 0, 0, 0);
  batch_end(&b, 0, n);
  assert_int_equal(step_sweep(&b.in, &scratch, NULL, &mean), DSM_OK);
  assert_int_equal(mean.count, 2 * n);
  for (int i = 0; i < n; ++i) {
    assert_true(mean.data[2 * i].z == i + 1 && mean.data[2 * i + 1].z == i + 1);
    assert_true(mean.data[2 * i + 1].v.c[0] == (double)(n - 1 - i) / n && rgb_is_grey(mean.data[2 * i + 1].v));
  }
  vertices_free(&mean);
  step_free(&scratch);
  batch_free(&b);
}

/* A million surfaces, against products and sums in long double: faint and dense ones in red and green, in blue so faint
 * that every step is rounded alike. */
static void a_million_surfaces_do_not_drift(void **state) {
  (void)state;
  enum { rays = 1000, each = 1000 };
  rng r = rng_seeded(3);
  batch b;
  step_scratch scratch = {0};
  noise_profile noise = {0};
  vertices mean = {0};
  batch_begin(&b, rays, 3);
  for (uint32_t i = 0; i < rays; ++i)
    for (int k = 0; k < each; ++k) {
      double pass = rng_below(&r, 200) ? rng_between(&r, 0.999, 1) : rng_between(&r, 0.3, 1);
      batch_push(&b, i, k + rng_unit(&r), pass, sqrt(pass), k + 1 < each ? 1 - 1e-9 : 0);
    }
  batch_end(&b, 0, rays);
  assert_int_equal(step_sweep(&b.in, &scratch, &noise, &mean), DSM_OK);
  assert_true(is_staircase(&mean) && mean.count > 1999900);
  for (int probe = 0; probe < 60; ++probe) {
    double z = rng_between(&r, 0, each);
    long double sum[3] = {0};
    for (uint32_t i = 0; i < rays; ++i) {
      long double left[3] = {1, 1, 1};
      for (size_t k = b.sink.first[i]; k < b.sink.first[i + 1] && b.sink.ordered[k].front < z; ++k)
        for (int c = 0; c < 3; ++c) left[c] *= (long double)b.sink.ordered[k].transmittance.c[c];
      for (int c = 0; c < 3; ++c) sum[c] += left[c] / rays;
    }
    rgb got = vertices_at(mean.data, mean.count, z);
    for (int c = 0; c < 3; ++c) assert_seeded(&r, fabs(got.c[c] - (double)sum[c]) < 1e-12);
  }
  assert_true(mean.data[mean.count - 1].v.c[2] == 0 && mean.data[mean.count - 1].v.c[0] > 0);
  noise_free(&noise);
  vertices_free(&mean);
  step_free(&scratch);
  batch_free(&b);
}

/* Faint remains of what has rounded must not shine behind opaque things. */
static void what_is_dark_is_exactly_zero(void **state) {
  (void)state;
  step_scratch scratch = {0};
  vertices mean = {0};
  for (uint64_t seed = 0; seed < most_cases(300); ++seed) {
    rng r = rng_seeded(seed);
    uint32_t rays = 1 + rng_below(&r, 100);
    batch b;
    batch_begin(&b, rays, 1);
    for (uint32_t i = 0; i < rays; ++i) {
      double pass = rng_scale(&r, 1e-3, 1);
      batch_push(&b, i, rng_unit(&r), pass, pass, pass);
      batch_push(&b, i, 1 + rng_unit(&r), 0, 0, 0);
    }
    batch_end(&b, 0, rays);
    mean.count = 0;
    assert_int_equal(step_sweep(&b.in, &scratch, NULL, &mean), DSM_OK);
    assert_seeded(&r, is_staircase(&mean) && rgb_max(mean.data[mean.count - 1].v) == 0);
    batch_free(&b);
  }
  vertices_free(&mean);
  step_free(&scratch);
}

static void nothing_in_nothing_out(void **state) {
  (void)state;
  batch b;
  step_scratch scratch = {0};
  noise_profile noise = {0};
  vertices mean = {0};
  batch_begin(&b, 3, 1);
  batch_end(&b, 0, 3);
  assert_int_equal(step_sweep(&b.in, &scratch, &noise, &mean), DSM_OK);
  batch_push(&b, 1, 5, 1, 1, 1);   /* clear */
  batch_end(&b, 0, 3);
  assert_int_equal(step_sweep(&b.in, &scratch, &noise, &mean), DSM_OK);
  assert_int_equal(mean.count, 0);
  vertices_free(&mean);   /* it may have been given room */
  noise_free(&noise);
  step_free(&scratch);
  batch_free(&b);
}

static void appends_until_memory_ends(void **state) {
  (void)state;
  batch b;
  step_scratch scratch = {0};
  vertices mean = {0};
  batch_begin(&b, 2, 1);
  batch_push(&b, 0, 5, 0, 0, 0);
  batch_end(&b, 0, 2);
  assert_int_equal(vertices_push(&mean, 9, rgb_grey(0)), DSM_OK);
  assert_int_equal(step_sweep(&b.in, &scratch, NULL, &mean), DSM_OK);
  assert_int_equal(mean.count, 3);
  assert_true(mean.data[0].z == 9 && mean.data[1].v.c[0] == 1 && mean.data[2].v.c[0] == 0.5);
  vertices_free(&mean);

  size_t full = SIZE_MAX / sizeof(vertex);
  mean = (vertices){NULL, full, full};
  assert_int_equal(step_sweep(&b.in, &scratch, NULL, &mean), DSM_NO_MEMORY);
  assert_true(mean.count == full);
  step_free(&scratch);
  assert_true(scratch.keys == NULL && scratch.numbers == NULL);
  batch_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_average_is_the_direct_sum),
    cmocka_unit_test(the_noise_is_the_measured_noise),
    cmocka_unit_test(opaque_hair_is_exact),
    cmocka_unit_test(a_million_surfaces_do_not_drift),
    cmocka_unit_test(what_is_dark_is_exactly_zero),
    cmocka_unit_test(nothing_in_nothing_out),
    cmocka_unit_test(appends_until_memory_ends),
  };
  return cmocka_run_group_tests_name("step_sweep", tests, NULL, NULL);
}
