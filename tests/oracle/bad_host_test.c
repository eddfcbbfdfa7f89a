/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Hosts that report nonsense, fail, or stop. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "oracle.h"

static double odd_number(rng *r) {
  static const double odd[] = {NAN, INFINITY, -INFINITY, -1, 0, -0.0, 1e300, -1e300, 1e-310, 0.5, 1, 2.5, 3};
  return rng_below(r, 2) ? odd[rng_below(r, sizeof odd / sizeof *odd)] : rng_between(r, -1, 10);
}

static dsm_result trace_nonsense(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  (void)data;
  (void)tolerance;
  uint64_t seed = (uint64_t)(rays[0].origin[0] * 1e6) + (uint64_t)(rays[0].origin[1] * 1e9);
  rng r = rng_seeded(seed);
  for (uint32_t i = 0; i < 4 * count; ++i) {
    double pass[3];
    for (int c = 0; c < 3; ++c) pass[c] = rng_below(&r, 8) ? rng_between(&r, -0.1, 1) : odd_number(&r);
    uint32_t ray = rng_below(&r, 50) ? rng_below(&r, count) : (uint32_t)rng_bits(&r);
    switch (rng_below(&r, 5)) {
      case 0: case 1: dsm_api.sink_surface(sink, ray, odd_number(&r), pass); break;
      case 2: case 3: dsm_api.sink_span(sink, ray, odd_number(&r), odd_number(&r), pass); break;
      case 4: if (rng_below(&r, 40) == 0) dsm_api.sink_mark(sink, ray);
    }
  }
  return DSM_OK;
}

static dsm_map *bad_map(world *w, dsm_result (*trace)(void *, const dsm_ray *, uint32_t, double, dsm_sink *),
                        const char *const *words) {
  dsm_box box = {{-1, -1, 1}, {1, 1, 8}};
  dsm_light light = parallel_at(0, 0, 0, 0, 0, 1);
  light.casters = &box;
  light.caster_count = 1;
  dsm_settings *settings = settings_of(words);
  dsm_host host = host_of(w);
  host.trace = trace;
  dsm_map *map = NULL;
  assert_int_equal(dsm_api.map_create(&host, &light, settings, &map), DSM_OK);
  dsm_api.settings_destroy(settings);
  return map;
}

static void survive_nonsense(const char *tolerance, uint64_t seed) {
  world w = {0};
  dsm_map *map = bad_map(&w, trace_nonsense, WORDS("resolution 64", "samples 4", tolerance));
  dsm_worker *worker;
  assert_int_equal(dsm_api.worker_create(map, &w, &worker), DSM_OK);
  rng r = rng_seeded(seed);
  double last = 1, rgb[3];
  for (int i = 0; i < 20000; ++i) {
    dsm_receiver at = in_air(rng_between(&r, -1.2, 1.2), rng_between(&r, -1.2, 1.2), 0);
    for (double z = 0; z < 10; z += 1.7) {
      at.point[2] = z;
      dsm_result result = dsm_api.lookup(worker, &at, rgb);
      assert_seeded(&r, result == DSM_OK || result == DSM_OUTSIDE || result == DSM_TRACE);
      if (result == DSM_TRACE) break;
      for (int c = 0; c < 3; ++c) assert_seeded(&r, rgb[c] >= 0 && rgb[c] <= 1);
      assert_seeded(&r, z == 0 || rgb[0] <= last + 1e-6);
      last = rgb[0];
    }
  }
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(map, &got);
  assert_true(got.events_dropped > 0 && got.events_clamped > 0 && got.pixels_marked > 0);
  assert_int_equal(w.sentences, 1);
  dsm_api.worker_destroy(worker);
  dsm_api.map_destroy(map);
}

static void nonsense_is_survived_and_counted(void **state) {
  (void)state;
  survive_nonsense("tolerance 0", 8);
  survive_nonsense("tolerance 0.07", 9);
  survive_nonsense("bias 0", 10);
}

static void failing_trace_means_ray_tracing(void **state) {
  (void)state;
  static const dsm_result failures[] = {DSM_NO_MEMORY, DSM_INVALID, 77};
  for (int k = 0; k < 3; ++k) {
    shape ball = sphere_at(0, 0, 5, 1, 0);
    stage s;
    stage_open(&s, &ball, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 64"));
    s.w.fail_with = failures[k];
    double rgb[3];
    dsm_receiver at = in_air(0, 0, 8), corner = in_air(-0.9, -0.9, 8);
    assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_TRACE);
    assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_TRACE);
    assert_int_equal(dsm_api.lookup(s.worker, &corner, rgb), DSM_TRACE);
    assert_int_equal(s.w.sentences, 1);
    dsm_statistics got = {.size = sizeof got};
    dsm_api.statistics(s.map, &got);
    assert_true(got.tiles_failed >= 2 && got.tiles_baked == 0);
    stage_close(&s);
  }
}

static void cancelled_tile_is_baked_later(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  stage s;
  stage_open(&s, &ball, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 64"));
  double rgb[3];
  dsm_receiver at = in_air(0, 0, 8);
  s.w.stop = 1;
  assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_CANCELLED);
  s.w.stop = 0;
  s.w.fail_with = DSM_CANCELLED;
  assert_int_equal(dsm_api.lookup(s.worker, &at, rgb), DSM_CANCELLED);
  s.w.fail_with = DSM_OK;
  assert_true(light_of(&s, at, 0) == 0);
  assert_int_equal(s.w.sentences, 0);
  stage_close(&s);
}

static void host_without_pause_and_report(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  world w = {.shapes = &ball, .count = 1};
  dsm_host host = {sizeof host, &w, trace_world, NULL, NULL};
  dsm_light light = parallel_at(0, 0, 0, 0, 0, 1);
  light.casters = &ball.box;
  light.caster_count = 1;
  dsm_map *map;
  dsm_worker *worker;
  double rgb[3];
  dsm_receiver at = in_air(0, 0, 8);
  assert_int_equal(dsm_api.map_create(&host, &light, NULL, &map), DSM_OK);
  assert_int_equal(dsm_api.worker_create(map, &w, &worker), DSM_OK);
  assert_int_equal(dsm_api.lookup(worker, &at, rgb), DSM_OK);
  assert_true(rgb[1] == 0);
  dsm_api.worker_destroy(worker);
  dsm_api.map_destroy(map);
}

typedef struct { world w; dsm_worker *worker; dsm_result inner; } nested;

static dsm_result trace_and_look_up(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  nested *n = data;
  double rgb[3];
  dsm_receiver at = in_air(0, 0, 7);
  n->inner = dsm_api.lookup(n->worker, &at, rgb);
  return trace_world(&n->w, rays, count, tolerance, sink);
}

static void lookup_within_a_bake_is_told_to_trace(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, 5, 1, 0);
  nested n = {.w = {.shapes = &ball, .count = 1}, .inner = DSM_OK};
  dsm_map *map = bad_map(&n.w, trace_and_look_up, WORDS("resolution 8"));
  assert_int_equal(dsm_api.worker_create(map, &n, &n.worker), DSM_OK);
  double rgb[3];
  dsm_receiver at = in_air(0, 0, 8);
  assert_int_equal(dsm_api.lookup(n.worker, &at, rgb), DSM_OK);
  assert_int_equal(n.inner, DSM_TRACE);
  dsm_api.worker_destroy(n.worker);
  dsm_api.map_destroy(map);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(nonsense_is_survived_and_counted),
    cmocka_unit_test(failing_trace_means_ray_tracing),
    cmocka_unit_test(cancelled_tile_is_baked_later),
    cmocka_unit_test(host_without_pause_and_report),
    cmocka_unit_test(lookup_within_a_bake_is_told_to_trace),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
