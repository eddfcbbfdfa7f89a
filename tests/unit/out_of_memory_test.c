/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * What the core allocates is refused, at each allocation and at each vertex of the output: the result says so, the output is as it was
 * before, nothing leaks, and the next call finds its scratch in order. Linked with --wrap, so that allocations come here.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "core/average.h"
#include "core/compress.h"
#include "core/compress_lattice.h"
#include "core/rounding.h"
#include "core/settings.h"
#include "core/transmittance.h"
#include "random.h"

void *__real_malloc(size_t size);
void *__real_realloc(void *block, size_t size);
char *__real_strdup(const char *text);
void __real_free(void *block);

static struct {
  long left;    /* calls until all fail; negative: none does */
  int failed;
  long live;    /* blocks */
} memory = {.left = -1};

static int fails(void) {
  if (memory.left < 0) return 0;
  if (memory.left > 0) return --memory.left, 0;
  return memory.failed = 1;
}

static void *counted(void *block) { return memory.live += block != NULL, block; }

void *__wrap_malloc(size_t size) { return fails() ? NULL : counted(__real_malloc(size)); }
char *__wrap_strdup(const char *text) { return fails() ? NULL : counted(__real_strdup(text)); }
void *__wrap_realloc(void *block, size_t size) {
  if (fails()) return NULL;
  void *grown = __real_realloc(block, size);
  return block ? grown : counted(grown);
}
void __wrap_free(void *block) {
  memory.live -= block != NULL;
  __real_free(block);
}

enum { RAYS = 6, EACH = 40 };

/* What all the functions below are given. */
typedef struct {
  event events[EACH];
  vertex all[RAYS * EACH];
  size_t first[RAYS + 1];
  double weights[RAYS], tolerance;
  int channels;
  average_scratch sums;
  noise_profile noise;
} input;

static dsm_result make_ray(input *in, vertices *out) { return transmittance_build(in->events, EACH, in->tolerance, out); }
static dsm_result make_average(input *in, vertices *out) {
  return average_and_noise(&(average_input){in->all, in->first, in->weights, RAYS}, &in->sums, &in->noise, out);
}
static dsm_result make_greedy(input *in, vertices *out) { return compress_greedy(in->all, EACH, in->channels, in->tolerance, out); }
static dsm_result make_minimal(input *in, vertices *out) { return compress_minimal(in->all, EACH, in->channels, in->tolerance, out); }
static dsm_result make_rounded(input *in, vertices *out) {
  return compress_rounded(in->all, EACH, in->channels, in->tolerance, 0, rounding_value_bits(in->tolerance), out);
}

static void fill(input *in, rng *r) {
  double front = 0;
  int grey = rng_below(r, 2) == 0, short_spans = rng_below(r, 2) == 0, steep = rng_below(r, 4) == 0;
  in->tolerance = rng_scale(r, 1e-4, 0.1);
  in->channels = grey ? 1 : 3;
  for (int i = 0; i < EACH; ++i) {
    front += rng_below(r, 3) ? rng_unit(r) : 0;
    double length = rng_below(r, 3) == 0 ? 0 : short_spans ? 0.1 * rng_unit(r) : 4 * rng_unit(r);
    in->events[i] = (event){front, front + length, rgb_grey(1), 0};
    for (int c = 0; c < 3; ++c) in->events[i].transmittance.c[c] = c && grey ? in->events[i].transmittance.c[0] : rng_between(r, 0.7, 1);
  }
  if (rng_below(r, 2)) in->events[EACH - 1].transmittance = rgb_grey(0);
  for (int k = 0; k < RAYS; ++k) {
    double z = rng_unit(r);
    rgb v = rgb_grey(1);
    in->first[k] = (size_t)k * EACH;
    in->weights[k] = 1.0 / RAYS;
    for (int i = 0; i < EACH; ++i) {
      for (int c = 0; c < 3; ++c) v.c[c] = c && grey ? v.c[0] : v.c[c] * rng_between(r, 0.7, 1);
      if (i + 1 == EACH && rng_below(r, 2)) v = rgb_grey(0);
      in->all[k * EACH + i] = (vertex){z, v};
      z = steep && i % 5 == 0 ? nextafter(z, 9) : z + (rng_below(r, 3) ? rng_unit(r) : 0);
    }
  }
  in->first[RAYS] = RAYS * EACH;
}

/* An output that holds one vertex already and has room for so many more. */
static vertices output(size_t room) {
  vertices v = {malloc((room + 1) * sizeof(vertex)), 1, room + 1};
  v.data[0] = (vertex){7, {{0.1, 0.2, 0.3}}};
  return v;
}

static int is_untouched(const vertices *v) {
  return v->count == 1 && v->data[0].z == 7 && v->data[0].v.c[0] == 0.1 && v->data[0].v.c[1] == 0.2 && v->data[0].v.c[2] == 0.3;
}

typedef dsm_result maker(input *in, vertices *out);

static void forget_scratch(input *in) {
  average_free(&in->sums);
  noise_free(&in->noise);
}

/* With room for `room` more vertices, and `left` allocations that do not fail. 0: none did. */
static int try(maker *make, input *in, rng *r, size_t room, long left, const vertices *truth) {
  vertices out = output(room);
  memory.failed = 0;
  memory.left = left;
  dsm_result result = make(in, &out);
  memory.left = -1;
  if (memory.failed) {
    assert_seeded(r, result == DSM_NO_MEMORY && is_untouched(&out));
    assert_int_equal(make(in, &out), DSM_OK);
  }
  assert_seeded(r, result == DSM_OK || memory.failed);
  assert_seeded(r, out.count == truth->count && memcmp(out.data, truth->data, out.count * sizeof(vertex)) == 0);
  vertices_free(&out);
  return memory.failed;
}

static void every_vertex_and_every_block(void **state) {
  (void)state;
  static maker *const makers[] = {make_ray, make_average, make_greedy, make_minimal, make_rounded};
  static input in;
  for (uint64_t seed = 0; seed < 60; ++seed)
    for (int k = 0; k < (int)(sizeof makers / sizeof *makers); ++k) {
      rng r = rng_seeded(seed);
      long before = memory.live;
      fill(&in, &r);
      vertices truth = output(0);
      assert_int_equal(makers[k](&in, &truth), DSM_OK);
      /* The scratch is there: only the output has to grow. */
      size_t most = truth.count - 1;
      for (size_t room = 0; room <= most; ++room)
        for (long left = 0; left < 3; ++left) try(makers[k], &in, &r, room, left, &truth);
      for (long left = 0;; ++left) {
        forget_scratch(&in);
        if (!try(makers[k], &in, &r, most, left, &truth)) break;
      }
      forget_scratch(&in);
      vertices_free(&truth);
      assert_seeded(&r, memory.live == before);
    }
}

/* A sink without memory for an event keeps those it has, and takes more when there is some again. */
static void a_sink(void **state) {
  (void)state;
  enum { BATCH = 5, EVENTS = 300 };
  const double half[3] = {0.5, 0.5, 0.5};
  dsm_ray rays[BATCH];
  dsm_sink sink = {0};
  long before = memory.live;
  for (int i = 0; i < BATCH; ++i) rays[i] = (dsm_ray){.direction = {0, 0, 1}, .far_depth = 1000};
  for (long left = 0; left < 2; ++left) {
    memory.left = left;
    assert_int_equal(sink_begin(&sink, rays, BATCH), DSM_NO_MEMORY);
    memory.left = -1;
    sink_free(&sink);
  }
  assert_int_equal(sink_begin(&sink, rays, BATCH), DSM_OK);
  for (int i = 0; i < EVENTS; ++i) {
    memory.left = i % 2 ? -1 : 0;
    dsm_result result = sink_surface(&sink, (uint32_t)i % BATCH, EVENTS - i, half);
    memory.left = -1;
    if (result != DSM_OK) {
      assert_int_equal(result, DSM_NO_MEMORY);
      assert_int_equal(sink.count, i);
      assert_int_equal(sink_surface(&sink, (uint32_t)i % BATCH, EVENTS - i, half), DSM_OK);
    }
  }
  memory.left = 0;
  assert_int_equal(sink_order(&sink), DSM_NO_MEMORY);
  memory.left = -1;
  assert_int_equal(sink_order(&sink), DSM_OK);
  for (uint32_t k = 0; k < BATCH; ++k)
    for (size_t i = sink.first[k]; i < sink.first[k + 1]; ++i) {
      assert_int_equal(sink.ordered[i].ray, k);
      assert_true(i == sink.first[k] || sink.ordered[i].front > sink.ordered[i - 1].front);
    }
  assert_int_equal(sink.first[BATCH], EVENTS);
  sink_free(&sink);
  assert_int_equal(memory.live, before);
}

static void settings(void **state) {
  (void)state;
  char why[100];
  long before = memory.live;
  memory.left = 0;
  assert_null(settings_create(0));
  memory.left = -1;
  dsm_settings *s = settings_create(0);
  assert_int_equal(settings_set(s, WORD_SAVE_FILE, "old", NULL, 0, why, sizeof why), DSM_OK);
  memory.left = 0;
  assert_int_equal(settings_set(s, WORD_SAVE_FILE, "new", NULL, 0, why, sizeof why), DSM_NO_MEMORY);
  memory.left = -1;
  assert_string_equal(why, "There is no memory for the name of a file.");
  assert_string_equal(settings_text(s, WORD_SAVE_FILE), "old");
  settings_destroy(s);
  assert_int_equal(memory.live, before);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_vertex_and_every_block),
    cmocka_unit_test(a_sink),
    cmocka_unit_test(settings),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
