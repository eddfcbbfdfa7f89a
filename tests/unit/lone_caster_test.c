/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Which tiles a lit surface does without, and that it stays as dark as it is. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "map/map.h"

static const double FLOOR = 10, BALL = 8, RADIUS = 0.7, PIXEL = 10.0 / 96;

static uint64_t tiles_of(const stage *s) { return s->map->tiles_baked; }

/* Seen from the light; pixels near the outline are neither. */
enum { LIT, DARK, EDGE };

static int place_of(const shape *ball, double x, double y) {
  double to_x = x - ball->box.low[0] - RADIUS, to_y = y - ball->box.low[1] - RADIUS, away = sqrt(to_x * to_x + to_y * to_y);
  return away > RADIUS + 3 * PIXEL ? LIT : away < RADIUS - 3 * PIXEL ? DARK : EDGE;
}

static void open_floor(stage *s, shape shapes[2], int ball, double x, double y) {
  shapes[!ball] = sheet_at(FLOOR, 5, 0, 0, 0);
  shapes[ball] = sphere_at(x, y, BALL, RADIUS, 0);
  stage_open(s, shapes, 2, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 96", "samples 4"));
}

/* Most of a floor needs no tile; what the ball hides is dark all the same, wherever tiles begin. */
static void a_floor_under_a_ball(void **state) {
  (void)state;
  rng r = rng_seeded(5);
  for (int n = 0; n < 40; ++n) {
    shape shapes[2];
    stage s;
    open_floor(&s, shapes, n % 2, rng_between(&r, -4, 4), rng_between(&r, -4, 4));
    int seen[3] = {0, 0, 0};
    for (int k = 0; k < 1500; ++k) {
      double x = rng_between(&r, -5, 5), y = rng_between(&r, -5, 5), light = light_of(&s, on_plane(x, y, FLOOR, 0, 0, -1), 0);
      int place = place_of(&shapes[n % 2], x, y);
      ++seen[place];
      if (place != EDGE) assert_seeded(&r, light == (place == LIT));
    }
    assert_true(seen[LIT] > 1000 && seen[DARK] > 0);
    assert_true(tiles_of(&s) > 0 && tiles_of(&s) <= 4);
    stage_close(&s);
  }
}

/* Behind the floor, in the air in front of it and on a slope that the floor stands out of, the tile is asked. */
static void who_asks_for_more(void **state) {
  (void)state;
  shape shapes[2];
  stage s;
  open_floor(&s, shapes, 1, 1, -1);
  double tilt = sqrt(0.5);
  assert_true(light_of(&s, on_plane(-4, -4, FLOOR, 0, 0, -1), 0) == 1 && tiles_of(&s) == 0);
  assert_true(light_of(&s, on_plane(-4, -4, FLOOR - 1, tilt, 0, -tilt), 0) == 1 && tiles_of(&s) == 1);
  assert_true(light_of(&s, in_air(4, 4, FLOOR + 1), 0) == 0 && tiles_of(&s) == 2);
  assert_true(light_of(&s, on_plane(-4, 4, FLOOR + 1, 0, 0, -1), 0) == 0 && tiles_of(&s) == 3);
  assert_true(light_of(&s, in_air(1, 4, FLOOR - 1), 0) == 1 && tiles_of(&s) == 4);
  stage_close(&s);
}

/* A single caster in front of the surface is none behind it, from all kinds of light. */
static void a_ball_alone(void **state) {
  (void)state;
  shape ball = sphere_at(0, 0, BALL, RADIUS, 0);
  dsm_light lights[3] = {parallel_at(0, 0, 0, 0, 0, 1), spot_at(0, 0, 0, 0, 0, 1, 20), point_at(0, 0, 0)};
  for (int i = 0; i < 3; ++i) {
    stage s;
    stage_open(&s, &ball, 1, lights[i], WORDS("resolution 96", "samples 4"));
    rng r = rng_seeded(6);
    for (int k = 0; k < 500; ++k) {
      double x = rng_between(&r, -0.5, 0.5), y = rng_between(&r, -0.4, 0.4);
      assert_true(light_of(&s, on_plane(x, y, FLOOR, 0, 0, -1), 0) == 0);
    }
    stage_close(&s);
  }
}

/* A box of floats stands out of its own surface, as hosts round it outwards. */
static void a_rounded_box(void **state) {
  (void)state;
  for (double scale = 1e-3; scale < 1e6; scale *= 100) {
    shape floor = sheet_at(FLOOR * scale, 5 * scale, 0, 0, 0);
    floor.box.low[2] -= 1e-6 * FLOOR * scale + 1e-9;
    floor.box.high[2] += 1e-6 * FLOOR * scale + 1e-9;
    stage s;
    stage_open(&s, &floor, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 32"));
    assert_true(light_of(&s, on_plane(scale, scale, FLOOR * scale, 0, 0, -1), 0) == 1 && tiles_of(&s) == 0);
    stage_close(&s);
  }
}

/* Nothing is known of many casters, and a map that makes levels of its own asks for them. */
static void where_nobody_looks(void **state) {
  (void)state;
  enum { MANY = 2001 };
  static shape shapes[MANY];
  for (int i = 0; i < MANY; ++i) shapes[i] = sheet_at(FLOOR, 5, 0, 0, 0);
  stage s;
  stage_open(&s, shapes, MANY, parallel_at(0, 0, 0, 0, 0, 1), WORDS("resolution 16", "samples 1"));
  assert_null(s.map->lone_casters);
  stage_close(&s);
  stage_open(&s, shapes, 1, parallel_at(0, 0, 0, 0, 0, 1), WORDS("accuracy 0.1"));
  assert_null(s.map->lone_casters);
  stage_close(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_floor_under_a_ball), cmocka_unit_test(who_asks_for_more), cmocka_unit_test(a_ball_alone),
    cmocka_unit_test(a_rounded_box), cmocka_unit_test(where_nobody_looks),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
