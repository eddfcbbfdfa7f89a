/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/box_outline.h"
#include "random.h"

typedef struct { double n[3], d; } half_space;   /* n·p >= d */
typedef struct { double origin[3]; frame axes; rectangle window; } view;

static view random_view(rng *r) {
  view v;
  double forward[3], length = 0;
  for (int i = 0; i < 3; ++i) {
    v.origin[i] = rng_between(r, -4, 4);
    forward[i] = rng_between(r, -1, 1);
    length += forward[i] * forward[i];
  }
  for (int i = 0; i < 3; ++i) forward[i] /= sqrt(length);
  v.axes = frame_along(forward);
  v.window.u0 = rng_between(r, -2, 1);
  v.window.v0 = rng_between(r, -2, 1);
  v.window.u1 = v.window.u0 + rng_between(r, 0.1, 3);
  v.window.v1 = v.window.v0 + rng_between(r, 0.1, 3);
  return v;
}

/* Flat ones too, and some that touch or hold the light. */
static dsm_box random_box(rng *r, const double origin[3]) {
  dsm_box box;
  int at_light = rng_below(r, 6) == 0;
  for (int i = 0; i < 3; ++i) {
    box.low[i] = at_light ? origin[i] - (double)rng_below(r, 3) : rng_between(r, -4, 3);
    box.high[i] = box.low[i] + (at_light ? 2 : rng_below(r, 5) ? rng_between(r, 0, 4) : 0);
  }
  return box;
}

static void seen_from(const view *v, const double point[3], double q[3]) {
  const double *axis[3] = {v->axes.right, v->axes.up, v->axes.forward};
  for (int a = 0; a < 3; ++a) {
    q[a] = 0;
    for (int i = 0; i < 3; ++i) q[a] += axis[a][i] * (point[i] - v->origin[i]);
  }
}

static void include(rectangle *a, double u, double v) {
  *a = (rectangle){fmin(a->u0, u), fmin(a->v0, v), fmax(a->u1, u), fmax(a->v1, v)};
}

/* All points where three of the ten planes of box and pyramid meet, on the right side of the others: the
 * corners of what the window shows of the box. The box does not touch the light. */
static rectangle area_by_corners(const view *v, const dsm_box *box) {
  const rectangle *w = &v->window;
  half_space h[10] = {{{1, 0, -w->u0}, 0}, {{-1, 0, w->u1}, 0}, {{0, 1, -w->v0}, 0}, {{0, -1, w->v1}, 0}};
  for (int i = 0; i < 3; ++i) {
    h[4 + i] = (half_space){{v->axes.right[i], v->axes.up[i], v->axes.forward[i]}, box->low[i] - v->origin[i]};
    h[7 + i] = (half_space){{-h[4 + i].n[0], -h[4 + i].n[1], -h[4 + i].n[2]}, v->origin[i] - box->high[i]};
  }
  rectangle area = OUTLINE_EMPTY.area;
  for (int code = 0; code < 1000; ++code) {
    const half_space *t[3] = {&h[code / 100], &h[code / 10 % 10], &h[code % 10]};
    if (!(t[0] < t[1] && t[1] < t[2])) continue;
    double p[3] = {0, 0, 0}, det = 0;
    for (int a = 0; a < 3; ++a) {
      const double *m = t[(a + 1) % 3]->n, *n = t[(a + 2) % 3]->n;
      double x[3] = {m[1] * n[2] - m[2] * n[1], m[2] * n[0] - m[0] * n[2], m[0] * n[1] - m[1] * n[0]};
      for (int i = 0; i < 3; ++i) p[i] += t[a]->d * x[i];
      if (a == 0) det = t[0]->n[0] * x[0] + t[0]->n[1] * x[1] + t[0]->n[2] * x[2];
    }
    if (fabs(det) < 1e-9) continue;
    int inside = 1;
    for (int i = 0; i < 3; ++i) p[i] /= det;
    for (int k = 0; k < 10; ++k)
      inside &= h[k].n[0] * p[0] + h[k].n[1] * p[1] + h[k].n[2] * p[2] >= h[k].d - 1e-10;
    if (inside) include(&area, p[0] / p[2], p[1] / p[2]);
  }
  return area;
}

static double distance(const dsm_box *box, const double origin[3], int far_end) {
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    double low = box->low[i] - origin[i], high = box->high[i] - origin[i];
    double d = far_end ? fmax(fabs(low), fabs(high)) : low > 0 ? low : high < 0 ? high : 0;
    square += d * d;
  }
  return sqrt(square);
}

static int same_area(const rectangle *a, const rectangle *b, double slack) {
  if (a->u0 > a->u1 || b->u0 > b->u1) return a->u0 > a->u1 && b->u0 > b->u1;
  return fabs(a->u0 - b->u0) <= slack && fabs(a->u1 - b->u1) <= slack && fabs(a->v0 - b->v0) <= slack
      && fabs(a->v1 - b->v1) <= slack;
}

/* No larger and no smaller than what the window shows of the box, and as deep as the whole box. */
static void perspective_is_exact(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(10000); ++seed) {
    rng r = rng_seeded(seed);
    view v = random_view(&r);
    dsm_box box = random_box(&r, v.origin);
    outline sum = OUTLINE_EMPTY;
    outline_add(&sum, v.origin, &v.axes, 1, &v.window, &box);
    double nearest = distance(&box, v.origin, 0);
    int seen = sum.area.u0 <= sum.area.u1;
    if (nearest > 0.01) {
      rectangle truth = area_by_corners(&v, &box);
      assert_seeded(&r, same_area(&sum.area, &truth, 1e-6));
    }
    else if (seen && nearest == 0) assert_seeded(&r, same_area(&sum.area, &v.window, 0));
    if (!seen) assert_seeded(&r, sum.near_depth == INFINITY && sum.far_depth == -INFINITY);
    else assert_seeded(&r, fabs(sum.near_depth - nearest) < 1e-12
                             && fabs(sum.far_depth - distance(&box, v.origin, 1)) < 1e-12);
  }
}

/* A light that a box nearly touches sees it in all directions on that side, up to a right angle. */
static void a_box_that_nearly_touches(void **state) {
  (void)state;
  const double origin[3] = {0, 0, 0};
  const rectangle window = {-3, -2, 4, 5};
  for (int axis = 0; axis < 3; ++axis) {
    double forward[3] = {0, 0, 0};
    forward[(axis + 1) % 3] = 1;
    frame axes = frame_along(forward);
    for (double gap = 1e-17; gap < 1e-9; gap *= 10) {
      dsm_box box = {{-1, -1, -1}, {1, 1, 1}};
      box.low[axis] = gap;
      outline sum = OUTLINE_EMPTY;
      outline_add(&sum, origin, &axes, 1, &window, &box);
      assert_true(fabs(sum.near_depth - gap) < 1e-15 * gap && fabs(sum.far_depth - sqrt(3)) < 1e-15);
      /* the box lies where right * u + up * v points to its side */
      for (double u = -2.9; u < 4; u += 0.1)
        for (double v = -1.9; v < 5; v += 0.1)
          if (u * axes.right[axis] + v * axes.up[axis] > 1e-6)
            assert_true(sum.area.u0 <= u && u <= sum.area.u1 && sum.area.v0 <= v && v <= sum.area.v1);
    }
  }
}

/* Whatever point of any of some boxes the light and the window see, the sum of them holds. */
static void random_points_are_inside(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(4000); ++seed) {
    rng r = rng_seeded(seed);
    view v = random_view(&r);
    int perspective = (int)rng_below(&r, 2);
    dsm_box box[3];
    outline sum = OUTLINE_EMPTY;
    for (int k = 0; k < 3; ++k) {
      box[k] = random_box(&r, v.origin);
      outline_add(&sum, v.origin, &v.axes, perspective, &v.window, &box[k]);
    }
    for (int k = 0; k < 60; ++k) {
      double point[3], q[3];
      for (int i = 0; i < 3; ++i) {
        double t = rng_below(&r, 2) ? rng_unit(&r) : rng_below(&r, 2);   /* corners and edges often */
        point[i] = box[k % 3].low[i] + t * (box[k % 3].high[i] - box[k % 3].low[i]);
      }
      seen_from(&v, point, q);
      if (!(q[2] > 0)) continue;
      double x = perspective ? q[0] / q[2] : q[0], y = perspective ? q[1] / q[2] : q[1];
      double depth = perspective ? sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) : q[2];
      if (x < v.window.u0 || x > v.window.u1 || y < v.window.v0 || y > v.window.v1) continue;
      assert_seeded(&r, x >= sum.area.u0 - 1e-9 && x <= sum.area.u1 + 1e-9);
      assert_seeded(&r, y >= sum.area.v0 - 1e-9 && y <= sum.area.v1 + 1e-9);
      assert_seeded(&r, depth >= sum.near_depth - 1e-12 && depth <= sum.far_depth + 1e-12);
    }
  }
}

/* In a window without borders a parallel light sees the span of the corners, unless all are behind it. */
static void orthographic_spans_the_corners(void **state) {
  (void)state;
  const rectangle everything = {-INFINITY, -INFINITY, INFINITY, INFINITY};
  for (uint64_t seed = 0; seed < most_cases(2000); ++seed) {
    rng r = rng_seeded(seed);
    view v = random_view(&r);
    dsm_box box = random_box(&r, v.origin);
    outline sum = OUTLINE_EMPTY, truth = OUTLINE_EMPTY;
    for (int k = 0; k < 8; ++k) {
      double q[3];
      seen_from(&v, (double[]){k & 1 ? box.high[0] : box.low[0], k & 2 ? box.high[1] : box.low[1],
                               k & 4 ? box.high[2] : box.low[2]}, q);
      include(&truth.area, q[0], q[1]);
      truth.near_depth = fmin(truth.near_depth, q[2]);
      truth.far_depth = fmax(truth.far_depth, q[2]);
    }
    outline_add(&sum, v.origin, &v.axes, 0, &everything, &box);
    if (truth.far_depth < -1e-9) assert_seeded(&r, sum.area.u0 > sum.area.u1);
    else if (truth.far_depth > 1e-9)
      assert_seeded(&r, same_area(&sum.area, &truth.area, 1e-12)
                          && fabs(sum.far_depth - truth.far_depth) < 1e-12
                          && fabs(sum.near_depth - fmax(0, truth.near_depth)) < 1e-12);
  }
}

static int same(const outline *a, const outline *b) {
  return same_area(&a->area, &b->area, 0) && a->near_depth == b->near_depth && a->far_depth == b->far_depth;
}

/* Of many boxes most lie inside what has been seen and are passed over: the sum is the same to the last bit, from near and
 * from far. */
static void many_are_the_sum_of_each(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < most_cases(2000); ++seed) {
    rng r = rng_seeded(seed);
    view v = random_view(&r);
    int perspective = (int)rng_below(&r, 2);
    double away = pow(10, rng_between(&r, 0, 6));
    for (int i = 0; i < 3; ++i) v.origin[i] = rng_between(&r, -1, 1) - away * v.axes.forward[i];
    if (rng_below(&r, 2)) v.window = (rectangle){-1e3, -1e3, 1e3, 1e3};
    outline sum = OUTLINE_EMPTY, truth = OUTLINE_EMPTY;
    for (int k = 0; k < 60; ++k) {
      dsm_box box;
      outline one = OUTLINE_EMPTY;
      for (int i = 0; i < 3; ++i) {   /* on a coarse grid, so that many sides lie in one plane */
        box.low[i] = (double)rng_below(&r, 9) / 4 - 1;
        box.high[i] = box.low[i] + (double)rng_below(&r, 3) / 4;
      }
      outline_add(&sum, v.origin, &v.axes, perspective, &v.window, &box);
      outline_add(&one, v.origin, &v.axes, perspective, &v.window, &box);
      if (!(one.near_depth <= one.far_depth)) continue;
      include(&truth.area, one.area.u0, one.area.v0);
      include(&truth.area, one.area.u1, one.area.v1);
      truth.near_depth = fmin(truth.near_depth, one.near_depth);
      truth.far_depth = fmax(truth.far_depth, one.far_depth);
    }
    assert_seeded(&r, same(&sum, &truth));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(perspective_is_exact),
    cmocka_unit_test(a_box_that_nearly_touches),
    cmocka_unit_test(random_points_are_inside),
    cmocka_unit_test(orthographic_spans_the_corners),
    cmocka_unit_test(many_are_the_sum_of_each),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
