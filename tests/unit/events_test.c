/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/events.h"
#include "random.h"

static const double half[3] = {0.5, 0.5, 0.5};

static dsm_ray ray(double near_depth, double far_depth) {
  return (dsm_ray){{0, 0, 0}, {0, 0, 1}, near_depth, far_depth};
}

static void outside_moves_to_the_nearer_end(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(2, 10)};
  dsm_sink sink = {0};
  assert_int_equal(sink_begin(&sink, rays, 1), DSM_OK);
  sink_surface(&sink, 0, 1, half);
  sink_surface(&sink, 0, 11, half);
  sink_surface(&sink, 0, -5, half);
  sink_span(&sink, 0, 1, 3, half);
  sink_span(&sink, 0, 20, 30, half);
  sink_span(&sink, 0, 2, 10, half);
  const double expected[][2] = {{2, 2}, {10, 10}, {2, 2}, {2, 3}, {10, 10}, {2, 10}};
  assert_int_equal(sink.count, 6);
  for (size_t i = 0; i < 6; ++i) {
    assert_true(sink.events[i].front == expected[i][0] && sink.events[i].back == expected[i][1]);
    assert_true(sink.events[i].transmittance.c[1] == 0.5);
  }
  assert_int_equal(sink.clamped, 5);
  assert_int_equal(sink.dropped, 0);
  sink_free(&sink);
}

static void rounding_is_not_an_error(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(2, 1e7)};
  const double clear[3] = {1 + 1e-7, 1, 1};
  dsm_sink sink = {0};
  assert_int_equal(sink_begin(&sink, rays, 1), DSM_OK);
  sink_surface(&sink, 0, nextafter(2, 0), clear);
  sink_surface(&sink, 0, nextafter(1e7, 1e8), half);
  assert_true(sink.events[0].front == 2 && sink.events[1].front == 1e7);
  assert_true(sink.events[0].transmittance.c[0] == 1);
  assert_int_equal(sink.clamped, 0);
  assert_int_equal(sink.marked[0], 0);
  sink_free(&sink);
}

static void not_finite_is_dropped(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(0, 10)};
  dsm_sink sink = {0};
  assert_int_equal(sink_begin(&sink, rays, 1), DSM_OK);
  const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
  for (int i = 0; i < 3; ++i) {
    assert_int_equal(sink_surface(&sink, 0, bad[i], half), DSM_OK);
    assert_int_equal(sink_span(&sink, 0, bad[i], 2, half), DSM_OK);
    assert_int_equal(sink_span(&sink, 0, 2, bad[i], half), DSM_OK);
    for (int c = 0; c < 3; ++c) {
      double t[3] = {1, 1, 1};
      t[c] = bad[i];
      assert_int_equal(sink_surface(&sink, 0, 5, t), DSM_OK);
    }
  }
  assert_int_equal(sink_span(&sink, 0, -(double)INFINITY, (double)INFINITY, half), DSM_OK);
  assert_int_equal(sink.dropped, 19);
  assert_int_equal(sink.count, 0);
  assert_int_equal(sink.marked[0], 0);
  sink_free(&sink);
}

static void transmittance_is_brought_into_range(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(0, 10), ray(0, 10), ray(0, 10)};
  const double negative[3] = {-0.5, 0.25, -0.0}, bright[3] = {0.5, 1.5, 1};
  dsm_sink sink = {0};
  assert_int_equal(sink_begin(&sink, rays, 3), DSM_OK);
  sink_surface(&sink, 0, 1, negative);
  sink_span(&sink, 1, 1, 2, bright);
  sink_surface(&sink, 2, 1, half);
  rgb *t = &sink.events[0].transmittance;
  assert_true(t->c[0] == 0 && t->c[1] == 0.25 && t->c[2] == 0 && !signbit(t->c[2]));
  t = &sink.events[1].transmittance;
  assert_true(t->c[0] == 0.5 && t->c[1] == 1 && t->c[2] == 1);
  assert_int_equal(sink.clamped, 1);
  assert_true(!sink.marked[0] && sink.marked[1] && !sink.marked[2]);
  assert_int_equal(sink_mark(&sink, 2), DSM_OK);
  assert_true(sink.marked[2]);
  sink_free(&sink);
}

static void reversed_span_is_turned_round(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(0, 10)};
  dsm_sink sink = {0};
  assert_int_equal(sink_begin(&sink, rays, 1), DSM_OK);
  sink_span(&sink, 0, 7, 3, half);
  assert_true(sink.events[0].front == 3 && sink.events[0].back == 7);
  assert_int_equal(sink.clamped, 1);
  sink_free(&sink);
}

static void foreign_ray_is_refused(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(0, 10)};
  dsm_sink sink = {0};
  assert_int_equal(sink_begin(&sink, rays, 1), DSM_OK);
  assert_int_equal(sink_surface(&sink, 1, 5, half), DSM_INVALID);
  assert_int_equal(sink_span(&sink, UINT32_MAX, 5, 6, half), DSM_INVALID);
  assert_int_equal(sink_mark(&sink, 1), DSM_INVALID);
  assert_int_equal(sink.dropped, 3);
  assert_int_equal(sink.count, 0);
  sink_free(&sink);
}

static void only_rays_of_a_pixel_can_be_spared(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(0, 10), ray(0, 10)};
  dsm_sink sink = {0};
  assert_int_equal(sink_begin(&sink, rays, 2), DSM_OK);
  assert_int_equal(sink_pixel_rays(&sink), 1);
  assert_int_equal(sink_spare(&sink, 1), DSM_INVALID);
  sink.pixel_rays = 2;
  assert_int_equal(sink_pixel_rays(&sink), 2);
  assert_int_equal(sink_spare(&sink, 2), DSM_INVALID);
  assert_int_equal(sink_spare(&sink, 1), DSM_OK);
  assert_true(!sink.spared[0] && sink.spared[1]);
  assert_int_equal(sink.dropped, 2);
  assert_int_equal(sink_begin(&sink, rays, 2), DSM_OK);
  assert_true(sink_pixel_rays(&sink) == 1 && !sink.spared[1]);
  sink_free(&sink);
}

/* Each event carries its number, as a transmittance; coarse depths make many equal. */
static void order_is_by_ray_then_front_and_stable(void **state) {
  (void)state;
  dsm_sink sink = {0};
  for (uint64_t seed = 0; seed < most_cases(600); ++seed) {
    rng r = rng_seeded(seed);
    dsm_ray rays[40];
    uint32_t ray_count = rng_below(&r, 41), n = ray_count ? rng_below(&r, seed % 50 ? 300 : 20000) : 0;
    for (uint32_t i = 0; i < ray_count; ++i) rays[i] = ray(0, 1000);
    assert_int_equal(sink_begin(&sink, rays, ray_count), DSM_OK);
    uint32_t only = rng_below(&r, 2), kinds = 1 + rng_below(&r, 50);
    for (uint32_t i = 0; i < n; ++i) {
      double t[3] = {i / 32768.0, 1, 1}, z = rng_below(&r, 2) ? rng_below(&r, kinds) : kinds * (double)i / n;
      sink_span(&sink, only ? ray_count / 2 : rng_below(&r, ray_count), z, z + rng_below(&r, 2), t);
    }
    for (int again = 0; again < 2; ++again) {
      assert_int_equal(sink_order(&sink), DSM_OK);
      assert_seeded(&r, sink.first[0] == 0 && sink.first[ray_count] == n && sink.count == n);
      double sum = 0;
      for (uint32_t k = 0; k < ray_count; ++k)
        for (size_t i = sink.first[k]; i < sink.first[k + 1]; ++i) {
          const event *b = &sink.ordered[i], *a = b - 1;
          sum += b->transmittance.c[0];
          assert_seeded(&r, b->ray == k);
          if (i == sink.first[k]) continue;
          assert_seeded(&r, a->front <= b->front);
          assert_seeded(&r, a->front < b->front || a->transmittance.c[0] < b->transmittance.c[0]);
        }
      assert_seeded(&r, sum == n * (n - 1.0) / 2 / 32768 || n == 0);
    }
  }
  sink_free(&sink);
}

/* A host that reports in order costs no copy, whatever the last batch was like. */
static void what_is_in_order_stays_where_it_is(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(0, 10), ray(0, 10), ray(0, 10)};
  const struct { uint32_t ray[3]; double z[3]; int in_order; } cases[] = {
    {{0, 0, 2}, {1, 1, 0}, 1}, {{0, 0, 2}, {2, 1, 3}, 0}, {{0, 1, 2}, {3, 2, 1}, 1}, {{0, 2, 1}, {1, 2, 3}, 0},
  };
  dsm_sink sink = {0};
  for (int k = 0; k < 4; ++k) {
    assert_int_equal(sink_begin(&sink, rays, 3), DSM_OK);
    for (int i = 0; i < 3; ++i) sink_surface(&sink, cases[k].ray[i], cases[k].z[i], half);
    assert_int_equal(sink_order(&sink), DSM_OK);
    assert_int_equal(sink.ordered == sink.events, cases[k].in_order);
  }
  sink_free(&sink);
}

static void next_batch_keeps_counters_only(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(0, 10), ray(0, 10)};
  dsm_sink sink = {0};
  assert_int_equal(sink_begin(&sink, rays, 1), DSM_OK);
  sink_surface(&sink, 0, -1, half);
  sink_surface(&sink, 0, (double)NAN, half);
  sink_mark(&sink, 0);
  assert_int_equal(sink_order(&sink), DSM_OK);
  assert_int_equal(sink_begin(&sink, rays, 2), DSM_OK);
  assert_int_equal(sink.count, 0);
  assert_true(!sink.marked[0] && !sink.marked[1]);
  assert_int_equal(sink.clamped, 1);
  assert_int_equal(sink.dropped, 1);
  assert_int_equal(sink_order(&sink), DSM_OK);
  assert_true(sink.first[0] == 0 && sink.first[1] == 0 && sink.first[2] == 0);
  sink_free(&sink);
  assert_true(sink.events == NULL && sink.first == NULL && sink.ordered == NULL && sink.marked == NULL);
}

static void refuses_what_memory_cannot_hold(void **state) {
  (void)state;
  dsm_ray rays[] = {ray(0, 10)};
  dsm_sink sink = {0};
  assert_int_equal(sink_begin(&sink, rays, 1), DSM_OK);
  sink.count = sink.capacity = SIZE_MAX / sizeof(event);
  assert_int_equal(sink_surface(&sink, 0, 1, half), DSM_NO_MEMORY);
  assert_true(sink.events == NULL && sink.count == sink.capacity);
  sink.count = sink.capacity = 0;
  sink_free(&sink);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(outside_moves_to_the_nearer_end),
    cmocka_unit_test(rounding_is_not_an_error),
    cmocka_unit_test(not_finite_is_dropped),
    cmocka_unit_test(transmittance_is_brought_into_range),
    cmocka_unit_test(reversed_span_is_turned_round),
    cmocka_unit_test(foreign_ray_is_refused),
    cmocka_unit_test(only_rays_of_a_pixel_can_be_spared),
    cmocka_unit_test(order_is_by_ray_then_front_and_stable),
    cmocka_unit_test(what_is_in_order_stays_where_it_is),
    cmocka_unit_test(next_batch_keeps_counters_only),
    cmocka_unit_test(refuses_what_memory_cannot_hold),
  };
  return cmocka_run_group_tests_name("events", tests, NULL, NULL);
}
