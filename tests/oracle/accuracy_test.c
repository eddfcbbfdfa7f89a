/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A map with `accuracy`: look-ups are as near to the closed form as it says, from fewer rays than an even map takes; no seam shows where
 * levels meet; the answer does not depend on what was asked before; no look-up comes where nothing was baked. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../unit/random.h"
#include "oracle.h"

/* A light along z, casters between z = 1 and 4, and a floor at z = 6 which is in no map. */
static const double FLOOR = 6, SIDE = 0.03;   /* of an image pixel on it */
enum { RAYS = 3 };

static double through(const shape *s, double x, double y, int c) {
  if (s->kind == SPHERE) {
    double r = 0.5 * (s->box.high[0] - s->box.low[0]), dx = x - 0.5 * (s->box.low[0] + s->box.high[0]),
           dy = y - 0.5 * (s->box.low[1] + s->box.high[1]);
    return dx * dx + dy * dy > r * r ? 1 : s->pass[c] * s->pass[c];
  }
  int inside = x >= s->box.low[0] && x <= s->box.high[0] && y >= s->box.low[1] && y <= s->box.high[1];
  if (s->kind == SHEET) return inside ? s->pass[c] : 1;
  dsm_ray ray = {.origin = {x, y, 0}, .direction = {0, 0, 1}};
  return inside ? exp(-s->density[c] * fog_integral(s, &ray, s->box.low[2], s->box.high[2])) : 1;
}

/* The mean over the image pixel around a point. */
static double truth(const shape *shapes, int count, double x, double y, int c) {
  enum { ACROSS = 16 };
  double sum = 0;
  for (int k = 0; k < ACROSS * ACROSS; ++k) {
    double px = x + SIDE * ((k % ACROSS + 0.5) / ACROSS - 0.5), py = y + SIDE * ((k / ACROSS + 0.5) / ACROSS - 0.5), light = 1;
    for (int i = 0; i < count; ++i) light *= through(&shapes[i], px, py, c);
    sum += light;
  }
  return sum / (ACROSS * ACROSS);
}

/* For one of RAYS x RAYS camera rays an image pixel. */
static dsm_receiver receiver_at(double x, double y) {
  double side = SIDE / RAYS;
  return (dsm_receiver){.point = {x, y, FLOOR}, .has_footprint = 1, .footprint = {{side, 0, 0}, {0, side, 0}}};
}

static shape fog_between(double low, double high, double density) {
  return fog_in((dsm_box){{low, low, 1}, {high, high, 4}}, density, density, density, 0);
}

enum { SCENES = 4, MOST = 60, POINTS = 4000 };

static int make_scene(int k, shape *out) {
  rng r = rng_seeded(77);
  int n = 0;
  out[n++] = sphere_at(-1.9, -1.9, 2, 0.1, 0);   /* so that all frames are as large */
  out[n++] = sphere_at(1.9, 1.9, 2, 0.1, 0);
  if (k == 0) out[n++] = sphere_at(0.3, 0.2, 3, 1, 0);
  if (k == 1) {
    out[n++] = sheet_at(2, 1, 0.5, 0.2, 0.6);
    out[n++] = sphere_at(0.5, 0.5, 3, 0.7, 0.8);
  }
  if (k == 2) out[n++] = fog_between(-1.5, 1.2, 0.3);
  if (k == 3)
    for (; n < MOST; ++n) out[n] = sphere_at(rng_between(&r, -1.5, 1.5), rng_between(&r, -1.5, 1.5), rng_between(&r, 1.5, 3.5), 0.08, n % 2 ? 0 : 0.7);
  return n;
}

static dsm_light sun(void) { return parallel_at(0, 0, 0, 0, 0, 1); }

static double pixel_of(stage *s, double x, double y, int c) {
  double sum = 0;
  for (int k = 0; k < RAYS * RAYS; ++k)
    sum += light_of(s, receiver_at(x + SIDE * ((k % RAYS + 0.5) / RAYS - 0.5), y + SIDE * ((k / RAYS + 0.5) / RAYS - 0.5)), c);
  return sum / (RAYS * RAYS);
}

/* Root mean square over random image pixels, and the rays that it took. The frame of a parallel light looks along z; a shadow lies
 * below its caster. */
static double error_after(const shape *shapes, int count, const char *const *words, int explored, uint64_t *rays) {
  enum { PLACES = 600 };
  stage s;
  stage_open(&s, shapes, count, sun(), words);
  rng places = rng_seeded(4321);
  for (int i = 0; i < PLACES && explored; ++i) {
    dsm_receiver at = receiver_at(rng_between(&places, -2, 2), rng_between(&places, -2, 2));
    assert_int_equal(dsm_api.explore(s.worker, &at), DSM_OK);
  }
  if (explored) dsm_api.explored(s.map, PLACES, RAYS);
  rng r = rng_seeded(1234);
  const int points = UNLESS_SLOW(POINTS, 300);
  double squares = 0;
  for (int i = 0; i < points; ++i) {
    double x = rng_between(&r, -2, 2), y = rng_between(&r, -2, 2);
    for (int c = 0; c < 3; c += 2) {
      double e = pixel_of(&s, x, y, c) - truth(shapes, count, x, y, c);
      squares += e * e / 2;
    }
  }
  dsm_statistics got = {.size = sizeof got};
  dsm_api.statistics(s.map, &got);
  stage_close(&s);
  *rays = got.rays;
  return sqrt(squares / points);
}

static double error_of(const shape *shapes, int count, const char *const *words, uint64_t *rays) {
  return error_after(shapes, count, words, 0, rays);
}

static void it_is_as_accurate_as_it_says(void **state) {
  (void)state;
  static const struct { double aim; const char *word; } aims[] = {{0.02, "accuracy 0.02"}, {0.01, "accuracy 0.01"}, {0.005, "accuracy 0.005"}};
  for (int k = 0; k < SCENES; ++k) {
    shape shapes[MOST];
    uint64_t even, rays;
    int count = make_scene(k, shapes);
    double error = error_of(shapes, count, WORDS("resolution 512", "samples 4"), &even);
    print_message("scene %d: 512 x 4 %.5f from %llu rays\n", k, error, (unsigned long long)even);
    for (int i = 0; i < UNLESS_SLOW(3, 1); ++i) {
      error = error_of(shapes, count, WORDS(aims[i].word), &rays);
      print_message("  %s: %.5f from %llu rays\n", aims[i].word, error, (unsigned long long)rays);
      assert_true(error <= aims[i].aim);
      assert_true(4 * rays < even);
    }
  }
}

/* A map that has seen a few places of the picture keeps to the aim with fewer rays, and never takes more. */
static void seen_pictures_cost_less(void **state) {
  (void)state;
  uint64_t total[2] = {0, 0};
  int few = UNLESS_SLOW(0, 1);   /* points, which do not pay for the places that are looked at before them */
  for (int k = 0; k < SCENES; ++k) {
    shape shapes[MOST];
    int count = make_scene(k, shapes);
    uint64_t rays[2];
    double error[2];
    for (int explored = 0; explored < 2; ++explored) error[explored] = error_after(shapes, count, WORDS("accuracy 0.01"), explored, &rays[explored]);
    print_message("scene %d: %.5f from %llu rays, explored %.5f from %llu\n", k, error[0], (unsigned long long)rays[0], error[1], (unsigned long long)rays[1]);
    assert_true(error[1] <= 0.01);
    assert_true(few || rays[1] <= rays[0]);
    total[0] += rays[0];
    total[1] += rays[1];
  }
  assert_true(few || total[1] < total[0]);
}

/* Two points that are next to each other see nearly the same, wherever levels meet: across 0.004 of an image pixel light changes
 * by no more than across a sharp edge that is one such pixel wide. */
static void no_seams(void **state) {
  (void)state;
  for (int k = 0; k < SCENES; ++k) {
    shape shapes[MOST];
    int count = make_scene(k, shapes);
    stage s;
    stage_open(&s, shapes, count, sun(), WORDS("accuracy 0.01"));
    rng r = rng_seeded(5);
    double step = 0.004 * SIDE, most = 0;
    for (int line = 0; line < UNLESS_SLOW(12, 2); ++line) {
      double x = rng_between(&r, -1.8, 1), y = rng_between(&r, -1.8, 1.8), before = -1;
      for (int i = 0; i < 3000; ++i, x += step) {
        double now = light_of(&s, receiver_at(x, y), 0);
        if (i > 0 && fabs(now - before) > most) most = fabs(now - before);
        before = now;
      }
    }
    print_message("scene %d: largest change %.6f\n", k, most);
    assert_true(most < 0.02);
    stage_close(&s);
  }
}

static void order_does_not_matter(void **state) {
  (void)state;
  enum { ASKED = 300 };
  shape shapes[MOST];
  int count = make_scene(3, shapes);
  stage there, back;
  stage_open(&there, shapes, count, sun(), WORDS("accuracy 0.01"));
  stage_open(&back, shapes, count, sun(), WORDS("accuracy 0.01", "cache 0.2"));
  static double first[ASKED][3], second[ASKED][3];
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < ASKED; ++i) {
      int n = pass ? ASKED - 1 - i : i;
      dsm_receiver at = receiver_at(-1.9 + 3.8 * (n * 61 % ASKED) / ASKED, -1.9 + 3.8 * (n * 97 % ASKED) / ASKED);
      assert_int_equal(dsm_api.lookup(pass ? back.worker : there.worker, &at, pass ? second[n] : first[n]), DSM_OK);
    }
  }
  assert_memory_equal(first, second, sizeof first);
  stage_close(&there);
  stage_close(&back);
}

/* With and without footprints, on all kinds of frames: a pixel that was not baked would answer DSM_TRACE. */
static void nothing_is_missing(void **state) {
  (void)state;
  shape shapes[MOST];
  int count = make_scene(3, shapes);
  dsm_light lights[] = {sun(), point_at(0, 0, -8), point_at(0.1, 0.2, 2.6), spot_at(0, 0, -4, 0, 0, 1, 30)};
  for (int k = 0; k < 4; ++k) {
    stage s;
    stage_open(&s, shapes, count, lights[k], WORDS("accuracy 0.03", "resolution 1000"));
    rng r = rng_seeded((uint64_t)k);
    for (int i = 0; i < (int)most_cases(3000); ++i) {
      double x = rng_between(&r, -3, 3), y = rng_between(&r, -3, 3), z = rng_between(&r, 1, 9), rgb[3];
      dsm_receiver at = in_air(x, y, z);
      at.has_footprint = i % 2;
      double side = 0.2 * rng_unit(&r) * rng_unit(&r);
      at.footprint[0][0] = side;
      at.footprint[1][1] = side;
      dsm_result result = dsm_api.lookup(s.worker, &at, rgb);
      if (result != DSM_OK && result != DSM_OUTSIDE) fail_msg("light %d, point %d: %d", k, i, (int)result);
    }
    stage_close(&s);
  }
}

/* A lone bead that is far smaller than a pixel of the first level, so that no ray of its tile may meet it, and the shadow in its middle. */
static void beads_are_found(void **state) {
  (void)state;
  rng r = rng_seeded(6);
  for (int i = 0; i < (int)most_cases(60); ++i) {
    double x = rng_between(&r, -1.5, 1.5), y = rng_between(&r, -1.5, 1.5), radius = rng_scale(&r, 0.0015, 0.02), side = radius / 8;
    shape shapes[] = {sphere_at(-1.9, -1.9, 1.1, 0.1, 0), sphere_at(1.9, 1.9, 1.1, 0.1, 0), sphere_at(x, y, 3, radius, 0)};
    int far_light = i % 2;   /* one whose rays are as good as parallel */
    stage s;
    stage_open(&s, shapes, 3, far_light ? point_at(x, y, -1e4) : sun(), WORDS("accuracy 0.01"));
    dsm_receiver at = {.point = {x, y, FLOOR}, .has_footprint = 1, .footprint = {{side, 0, 0}, {0, side, 0}}};
    assert_true(light_of(&s, at, 0) < 0.1);
    stage_close(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(it_is_as_accurate_as_it_says),
    cmocka_unit_test(seen_pictures_cost_less),
    cmocka_unit_test(no_seams),
    cmocka_unit_test(order_does_not_matter),
    cmocka_unit_test(nothing_is_missing),
    cmocka_unit_test(beads_are_found),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
