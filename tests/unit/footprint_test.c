/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/footprint.h"
#include "random.h"

static const double PIXEL = 1.0 / 12;

/* Variance of what a look-up averages over, across the probes and along them. */
static double across(const footprint *f) {
  double here = ldexp(1, 2 * (int)f->level);
  return 0.25 * ((1 - f->coarser) * here + f->coarser * 4 * here);
}

static double along(const footprint *f) {
  double n = f->probes, h2 = f->step_x * f->step_x + f->step_y * f->step_y;
  return across(f) + (n * n - 1) * h2 / 12;
}

static spread parallelogram(const double a[2], const double b[2]) {
  return (spread){(a[0] * a[0] + b[0] * b[0]) / 12, (a[0] * a[1] + b[0] * b[1]) / 12, (a[1] * a[1] + b[1] * b[1]) / 12};
}

static void up_to_a_pixel_nothing_changes(void **state) {
  (void)state;
  const double sides[] = {0, 1e-9, 0.3, 0.7};
  for (int i = 0; i < 4; ++i) {
    spread s = spread_of_square(sides[i]);
    footprint f = footprint_of(&s, 10, FOOTPRINT_PROBES);
    assert_true(f.level == 0 && f.coarser == 0 && f.probes == 1 && f.step_x == 0 && f.step_y == 0);
  }
}

/* The look-up's variance is that of the region and of the bilinear look-up at the finest level, along both axes. */
static void variances_match(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(20000); ++seed) {
    rng r = rng_seeded(seed);
    double size = rng_scale(&r, 0.5, 200), ratio = rng_scale(&r, 1, 4), angle = rng_between(&r, 0, 6.3);
    double a[2] = {size * ratio * cos(angle), size * ratio * sin(angle)}, b[2] = {-size * sin(angle), size * cos(angle)};
    spread s = parallelogram(a, b);
    footprint f = footprint_of(&s, 15, FOOTPRINT_PROBES);
    double shorter = fmax(size * size / 12, PIXEL), longer = fmax(size * ratio * size * ratio / 12, PIXEL);
    assert_seeded(&r, fabs(across(&f) - (0.25 + shorter - PIXEL)) < 1e-9 * across(&f));
    /* what less than half a pixel would add is left out; the largest step leaves the rest */
    double want = 0.25 + longer - PIXEL, lost = across(&f) / 12 * 4;
    assert_seeded(&r, along(&f) <= want * (1 + 1e-9) && along(&f) >= want - lost);
    assert_seeded(&r, f.probes >= 1 && f.probes <= FOOTPRINT_PROBES);
    if (f.probes > 1)   /* they lie along the longer side */
      assert_seeded(&r, fabs(f.step_x * b[0] + f.step_y * b[1]) < 1e-6 * size * hypot(f.step_x, f.step_y));
  }
}

/* Two rows have the variance of the two levels whose place they take, along both axes, and leave no gaps. */
static void rows_match(void **state) {
  (void)state;
  int in_rows = 0;
  for (uint64_t seed = 0; seed < most_cases(20000); ++seed) {
    rng r = rng_seeded(seed);
    double size = rng_scale(&r, 0.5, 200), ratio = rng_scale(&r, 1, 20), angle = rng_between(&r, 0, 6.3);
    spread s = parallelogram((double[]){size * ratio * cos(angle), size * ratio * sin(angle)}, (double[]){-size * sin(angle), size * cos(angle)});
    footprint f = footprint_of(&s, 6, FOOTPRINT_PROBES), two = footprint_in_rows(f);
    double pixel = ldexp(1, (int)f.level), step = hypot(two.step_x, two.step_y), side = hypot(two.side_x, two.side_y);
    assert_seeded(&r, two.level == f.level && step <= 2 * sqrt(4 * across(&f)) * (1 + 1e-9));
    if (two.coarser > 0 || f.coarser == 0) {   /* as it was */
      assert_seeded(&r, two.coarser == f.coarser && two.probes == f.probes && two.step_x == f.step_x && two.step_y == f.step_y && side == 0);
      continue;
    }
    in_rows++;
    assert_seeded(&r, step <= 2 * pixel && two.probes >= 2 && two.probes <= FOOTPRINT_PROBES);
    assert_seeded(&r, fabs(across(&two) + side * side - across(&f)) < 1e-9 * across(&f) && fabs(along(&two) - along(&f)) < 1e-9 * along(&f));
    assert_seeded(&r, fabs(two.step_x * two.side_x + two.step_y * two.side_y) < 1e-9 * step * side);
    assert_seeded(&r, fabs(two.step_x * f.step_y - two.step_y * f.step_x) <= 1e-9 * step * hypot(f.step_x, f.step_y));
  }
  assert_true(in_rows > (int)most_cases(20000) / 4);
}

static double reach_of(const footprint *f) {
  double along = 0.5 * (f->probes - 1);
  return (f->coarser > 0 ? 2 : 1) * ldexp(1.5, (int)f->level) + along * hypot(f->step_x, f->step_y) + hypot(f->side_x, f->side_y);
}

/* What is never read is never said to be read; and not much more. */
static void reach_is_bounded(void **state) {
  (void)state;
  double closest = 1e9;
  for (uint64_t seed = 0; seed < most_cases(20000); ++seed) {
    rng r = rng_seeded(seed);
    double size = rng_scale(&r, 0.01, 200), ratio = rng_scale(&r, 1, 50);
    spread s = parallelogram((double[]){size * ratio, 0}, (double[]){0, size});
    footprint f = footprint_of(&s, rng_below(&r, 8), FOOTPRINT_PROBES), two = footprint_in_rows(f);
    double reach = fmax(reach_of(&f), reach_of(&two)), bound = sqrt(28 + 170 * (s.xx + s.yy));
    assert_seeded(&r, footprint_may_reach(&s, reach) && footprint_may_reach(&s, -1e9) && !footprint_may_reach(&s, 1.001 * bound));
    closest = fmin(closest, bound / reach);
  }
  assert_true(closest < UNLESS_SLOW(3, 6));   /* few cases come less close */
  spread odd = {NAN, 0, 1};
  assert_true(footprint_may_reach(&odd, 1e300));
}

/* Longer regions than the probes can cover are read coarser; without probes the longer side decides. */
static void limits(void **state) {
  (void)state;
  spread needle = parallelogram((double[]){400, 0}, (double[]){0, 1});
  footprint f = footprint_of(&needle, 15, FOOTPRINT_PROBES);
  assert_true(f.probes == FOOTPRINT_PROBES || f.probes == FOOTPRINT_PROBES - 1);
  assert_true(fabs(f.step_x) <= 2 * sqrt(4 * across(&f)) && along(&f) > 0.9 * 400 * 400 / 12);
  f = footprint_of(&needle, 15, 1);
  assert_true(f.probes == 1 && fabs(across(&f) - (0.25 + 400.0 * 400 / 12 - PIXEL)) < 1);
  for (uint32_t most = 0; most < MAX_LEVELS; ++most)
    for (int stretched = 0; stretched < 2; ++stretched)
      for (double size = 0.1; size < 1e300; size *= 7.3) {
        spread s = parallelogram((double[]){size, 0.2 * size}, (double[]){0.3, 0.1 * size});
        f = footprint_of(&s, most, stretched ? FOOTPRINT_PROBES : 1);
        assert_true(f.level + (f.coarser > 0) <= most);
        double reach = (f.coarser > 0 ? 2 : 1) * ldexp(1.5, (int)f.level)
                     + 0.5 * (f.probes - 1) * fmax(fabs(f.step_x), fabs(f.step_y));
        assert_true(reach <= footprint_reach(most, stretched) + 1e-9);
        f = footprint_in_rows(f);
        reach = (f.coarser > 0 ? 2 : 1) * ldexp(1.5, (int)f.level)
              + 0.5 * (f.probes - 1) * fmax(fabs(f.step_x), fabs(f.step_y)) + fmax(fabs(f.side_x), fabs(f.side_y));
        assert_true(reach <= footprint_reach(most, 1) + 1e-9);
      }
  const double odd[] = {NAN, INFINITY};
  for (int i = 0; i < 2; ++i) {
    spread s = {odd[i], odd[i], 1};
    f = footprint_of(&s, 7, FOOTPRINT_PROBES);
    assert_true(f.level <= 7 && f.coarser >= 0 && f.coarser < 1 && f.probes >= 1 && isfinite(f.step_x) && isfinite(f.step_y));
  }
}

/* A little more region is a little more variance: no jump between levels, nor where probes come in. */
static void continuous(void **state) {
  (void)state;
  double before_across = 0, before_along = 0;
  for (double size = 0.2; size < 300; size *= 1.001) {
    spread s = parallelogram((double[]){2.3 * size, 0}, (double[]){0, size});
    footprint f = footprint_of(&s, 15, FOOTPRINT_PROBES);
    if (before_across > 0) {
      assert_true(across(&f) >= before_across * (1 - 1e-12) && across(&f) <= before_across * 1.01);
      assert_true(fabs(along(&f) - before_along) <= 0.35 * across(&f));
    }
    before_across = across(&f);
    before_along = along(&f);
  }
}

/* The derivative of the projection, against the difference of two points. */
static void sides_are_projected(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(5000); ++seed) {
    rng r = rng_seeded(seed);
    projection p = {.perspective = (int)(seed % 2), .count = 1};
    double forward[3] = {rng_between(&r, -1, 1), rng_between(&r, -1, 1), rng_between(&r, 0.1, 1)}, length = 0;
    for (int i = 0; i < 3; ++i) length += forward[i] * forward[i];
    for (int i = 0; i < 3; ++i) forward[i] /= sqrt(length);
    p.axes = p.faces[0].axes = frame_along(forward);
    face *f = &p.faces[0];
    *f = (face){.axes = f->axes, .u0 = -20, .v0 = -20, .pixel_u = 0.01, .pixel_v = 0.02, .per_u = 100, .per_v = 50,
                .far_depth = 1e9, .width = 4000, .height = 2000};
    double x[3] = {rng_between(&r, -1, 1), rng_between(&r, -1, 1), 5}, point[3], side[2][3], d[2][2];
    for (int i = 0; i < 3; ++i) point[i] = x[0] * f->axes.right[i] + x[1] * f->axes.up[i] + x[2] * f->axes.forward[i];
    projected at[3];
    assert_int_equal(projection_find(&p, point, 0.5, at), 1);
    for (int k = 0; k < 2; ++k) {
      for (int i = 0; i < 3; ++i) side[k][i] = 1e-3 * rng_between(&r, -1, 1);
      double near[3], far[3];
      projected a[3], b[3];
      for (int i = 0; i < 3; ++i) {
        near[i] = point[i] - 0.5 * side[k][i];
        far[i] = point[i] + 0.5 * side[k][i];
      }
      assert_int_equal(projection_find(&p, near, 0.5, a) + projection_find(&p, far, 0.5, b), 2);
      d[k][0] = b[0].x - a[0].x;
      d[k][1] = b[0].y - a[0].y;
    }
    spread want = parallelogram(d[0], d[1]), got = {0, 0, 0};
    spread_add(&got, &p, &at[0], (const double (*)[3])side);
    double scale = want.xx + want.yy + 1e-12;
    assert_seeded(&r, fabs(got.xx - want.xx) < 1e-5 * scale && fabs(got.xy - want.xy) < 1e-5 * scale
                      && fabs(got.yy - want.yy) < 1e-5 * scale);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(up_to_a_pixel_nothing_changes),
    cmocka_unit_test(variances_match),
    cmocka_unit_test(rows_match),
    cmocka_unit_test(reach_is_bounded),
    cmocka_unit_test(limits),
    cmocka_unit_test(continuous),
    cmocka_unit_test(sides_are_projected),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
