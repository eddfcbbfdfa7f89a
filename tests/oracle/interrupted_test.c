/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Look-ups that stop at a tile: the host cancels at any of those that one look-up has baked, or has no memory for it. Asked again, a
 * look-up that was cancelled gives what it would have given at once. One whose tile has failed gives that, too, or advises to trace. In a
 * cache that holds next to nothing, nearly every look-up bakes all its tiles.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "oracle.h"

enum { SHAPES = 8, RECEIVERS = 300 };

typedef struct {
  world w;               /* first: trace_world is handed this */
  double marked;         /* rays above this x mark their pixels */
  long left;             /* calls until one stops; negative: none does */
  dsm_result stop_with;
  int stopped;
} stopping_host;

static dsm_result trace_or_stop(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  stopping_host *host = data;
  if (host->left >= 0 && host->left-- == 0) {
    host->stopped = 1;
    return host->stop_with;
  }
  for (uint32_t r = 0; r < count; ++r)
    if (rays[r].origin[0] + 4 * rays[r].direction[0] > host->marked) dsm_api.sink_mark(sink, r);
  return trace_world(data, rays, count, tolerance, sink);
}

/* Glass of two colours, fog, hair and a wall on one side; each way of storing pixels has some of its own. */
static void make_scene(shape out[SHAPES]) {
  out[0] = sheet_at(3, 1.4, 0.9, 0.5, 0.4);
  out[0].box.high[0] = 0.1;
  out[1] = fog_in((dsm_box){{-1.2, -1.4, 3.3}, {0.5, 0.2, 4}}, 0.6, 0.6, 0.6, 0.5);
  out[2] = sheet_at(4.5, 1.4, 0, 0, 0);
  out[2].box.high[1] = -0.3;
  for (int i = 3; i < SHAPES; ++i) out[i] = sphere_at(0.3 * i - 1.6, 0.9 - 0.1 * i, 3.5 + 0.1 * i, 0.12, i % 2 ? 0 : 0.6);
}

typedef struct {
  const char *name;
  int cube;
  double marked;
  const char *words[6], *small[7];   /* the same with next to no cache */
} setup;

#define SETUP(name, cube, marked, ...) {name, cube, marked, {__VA_ARGS__}, {"cache 0.0001", __VA_ARGS__}}
static const setup setups[] = {
  SETUP("plain", 0, 0.9, "resolution 70", "samples 4"),
  SETUP("deltas", 0, 9, "resolution 70", "samples 4", "tolerance 0.05"),
  SETUP("blurred", 0, 0.9, "resolution 40", "samples 1", "blur 0.1"),
  SETUP("cube", 1, 9, "resolution 30", "samples 1"),
  SETUP("accurate", 0, 9, "accuracy 0.02", "resolution 1000", "samples 9"),
  SETUP("accurate and marked", 0, 0.7, "accuracy 0.02", "resolution 1000", "samples 9"),
  SETUP("accurate cube", 1, 0.9, "accuracy 0.05", "resolution 500", "samples 4"),
};

static dsm_map *map_with(stopping_host *host, const setup *s, const shape *shapes, dsm_box *boxes, const char *const *words) {
  *host = (stopping_host){.w = {.shapes = shapes, .count = SHAPES}, .marked = s->marked, .left = -1};
  for (int i = 0; i < SHAPES; ++i) boxes[i] = shapes[i].box;
  dsm_light light = s->cube ? point_at(0.1, 0, 3.6) : spot_at(0, 0, 0, 0, 0, 1, 24);
  light.casters = boxes;
  light.caster_count = SHAPES;
  dsm_host calls = host_of(&host->w);
  calls.trace = trace_or_stop;
  dsm_settings *settings = settings_of(words);
  dsm_map *map = NULL;
  assert_int_equal(dsm_api.map_create(&calls, &light, settings, &map), DSM_OK);
  dsm_api.settings_destroy(settings);
  return map;
}

/* Near and far, on surfaces and in air, with no footprint and with some up to larger than the map. */
static dsm_receiver any_receiver(rng *r) {
  double z = rng_between(r, 2, 7), x = rng_between(r, -0.5, 0.5) * z, y = rng_between(r, -0.5, 0.5) * z;
  dsm_receiver at = rng_below(r, 3) ? on_plane(x, y, z, rng_between(r, -1, 1), rng_between(r, -1, 1), -1) : in_air(x, y, z);
  if (rng_below(r, 3)) {
    double size = rng_scale(r, 0.003, 1);
    at.has_footprint = 1;
    for (int i = 0; i < 2; ++i)
      for (int k = 0; k < 2; ++k) at.footprint[i][k] = size * rng_between(r, -1, 1);
  }
  if (at.plane_count && rng_below(r, 4) == 0) {
    at.plane_count = 2;
    at.planes[1] = (dsm_plane){.normal = {rng_between(r, -1, 1), rng_between(r, -1, 1), -1}};
  }
  return at;
}

typedef struct { dsm_result result; double light[3]; } answer;

static answer ask(dsm_worker *worker, const dsm_receiver *at) {
  answer a = {DSM_OK, {-1, -1, -1}};
  a.result = dsm_api.lookup(worker, at, a.light);
  return a;
}

static int same(const answer *a, const answer *b) {
  int answered = a->result == DSM_OK || a->result == DSM_OUTSIDE;
  return a->result == b->result && (!answered || memcmp(a->light, b->light, sizeof a->light) == 0);
}

/* Cancelled at the first tile that it bakes, at the second, and so on until it gets through. */
static int cancel_each(stopping_host *host, dsm_worker *worker, rng *r, const dsm_receiver *at, const answer *truth) {
  int cancelled = 0;
  for (long n = 0;; ++n) {
    host->left = n;
    host->stop_with = DSM_CANCELLED;
    host->stopped = 0;
    answer a = ask(worker, at);
    host->left = -1;
    if (!host->stopped) {
      assert_seeded(r, same(&a, truth));
      return cancelled;
    }
    ++cancelled;
    assert_seeded(r, a.result == DSM_CANCELLED && a.light[0] == -1);
    if (n % 3 == 2) {   /* the tiles before it may be kept or not: then it bakes them all once more */
      a = ask(worker, at);
      assert_seeded(r, same(&a, truth));
    }
    assert_seeded(r, n < 10000);
  }
}

static void cancelled(void **state) {
  (void)state;
  shape shapes[SHAPES];
  dsm_box boxes[2][SHAPES];
  make_scene(shapes);
  for (size_t k = 0; k < sizeof setups / sizeof *setups; ++k) {
    stopping_host plain, stopped;
    dsm_worker *sure, *worker;
    dsm_map *whole = map_with(&plain, &setups[k], shapes, boxes[0], setups[k].words);
    dsm_map *small = map_with(&stopped, &setups[k], shapes, boxes[1], setups[k].small);
    assert_int_equal(dsm_api.worker_create(whole, &plain, &sure), DSM_OK);
    assert_int_equal(dsm_api.worker_create(small, &stopped, &worker), DSM_OK);
    int stops = 0, traced = 0;
    rng r = rng_seeded(100 + k);
    for (int i = 0; i < UNLESS_SLOW(RECEIVERS, 40); ++i) {
      dsm_receiver at = any_receiver(&r);
      answer truth = ask(sure, &at);
      traced += truth.result == DSM_TRACE;
      stops += cancel_each(&stopped, worker, &r, &at, &truth);
    }
    print_message("%s: %d times cancelled, %d look-ups to trace\n", setups[k].name, stops, traced);
    assert_true(stops > 10);
    dsm_api.worker_destroy(sure);
    dsm_api.worker_destroy(worker);
    dsm_api.map_destroy(whole);
    dsm_api.map_destroy(small);
  }
}

/* Asks for one place on one level. Elsewhere a finer level answers for a tile that has failed: with the same shadow, but sharper. */
static int is_narrow(const setup *s, const dsm_receiver *at) {
  return !at->has_footprint && strncmp(s->words[0], "resolution", 10) == 0 && !(s->words[2] && strncmp(s->words[2], "blur", 4) == 0);
}

/* What answers beside tiles that have failed is as right as ever. */
static void without_memory(void **state) {
  (void)state;
  shape shapes[SHAPES];
  dsm_box boxes[2][SHAPES];
  make_scene(shapes);
  for (size_t k = 0; k < sizeof setups / sizeof *setups; ++k) {
    stopping_host plain, failing;
    dsm_worker *sure, *worker;
    dsm_map *whole = map_with(&plain, &setups[k], shapes, boxes[0], setups[k].words);
    assert_int_equal(dsm_api.worker_create(whole, &plain, &sure), DSM_OK);
    rng r = rng_seeded(200 + k);
    int failed = 0, traced = 0, exact = 0;
    for (int life = 0; life < UNLESS_SLOW(6, 1); ++life) {
      dsm_map *map = map_with(&failing, &setups[k], shapes, boxes[1], setups[k].words);
      assert_int_equal(dsm_api.worker_create(map, &failing, &worker), DSM_OK);
      for (int i = 0; i < RECEIVERS / 2; ++i) {
        dsm_receiver at = any_receiver(&r);
        answer truth = ask(sure, &at);
        if (failing.left < 0) failing.left = (long)rng_below(&r, 5);
        failing.stop_with = DSM_NO_MEMORY;
        failing.stopped = 0;
        answer a = ask(worker, &at);
        failed += failing.stopped;
        if (a.result == DSM_TRACE || truth.result == DSM_TRACE) {
          ++traced;
          continue;
        }
        assert_seeded(&r, a.result == truth.result);
        for (int c = 0; c < 3; ++c) assert_seeded(&r, a.light[c] >= 0 && a.light[c] <= 1);
        if (!is_narrow(&setups[k], &at)) continue;
        assert_seeded(&r, memcmp(a.light, truth.light, sizeof a.light) == 0);
        ++exact;
      }
      dsm_api.worker_destroy(worker);
      dsm_api.map_destroy(map);
    }
    print_message("%s: %d tiles failed, %d look-ups to trace, %d the same to the last bit\n", setups[k].name, failed, traced, exact);
    assert_true(failed > 0 && traced > 0);
    dsm_api.worker_destroy(sure);
    dsm_api.map_destroy(whole);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(cancelled),
    cmocka_unit_test(without_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
