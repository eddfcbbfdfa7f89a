/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/compress.h"
#include "random.h"
#include "made_function.h"

/* ---- The fewest, by brute force ------------------------------------------------------------------------------
 *
 * A slow twin that shares no code and no data structure with the library, walks the other way (forwards), and
 * computes with long doubles: all lines through some gates, from all pairs of their ends. A slope b passes if
 *
 *     (floor_i - roof_j) / (z_i - z_j) <= b    for roof j in front of floor i, and
 *     (roof_j - floor_i) / (z_j - z_i) >= b    for floor i in front of roof j.
 *
 * The tightest pair of the first kind is the flattest line, that of the second kind the steepest. Functions where a
 * decision hangs by less than `close` are not judged.
 */
typedef long double real;

static const real close = 1e-9L, none = 1e30L;

typedef struct { real z, low, high; } bar;                 /* a gate */
typedef struct { real z, before, after; int tall; } spot;  /* all vertices at one depth */
typedef struct { real z[2], y[2]; int up; } opening;       /* near and far end; leaves upwards */

typedef struct {
  spot s[MOST];
  int count, falls, ambiguous;
  real tolerance, clear, cap;   /* level 1 ends at `clear`; nothing may be above `cap` */
  bar bars[4 * MOST];
  int bar_count;
  real slope[2], z[2], y[2];    /* the flattest line and the steepest: slope and right support */
} brute;

static real least_of(real a, real b) { return a < b ? a : b; }
static real most_of(real a, real b) { return a > b ? a : b; }

static void read_spots(brute *f, const vertex *in, size_t n, double tolerance, double tall_from) {
  *f = (brute){.tolerance = tolerance, .falls = 1, .clear = none, .cap = 1};
  real v = 1, z = 0;
  for (size_t i = 0, last; i < n; i = last + 1) {
    for (last = i; last + 1 < n && in[last + 1].z == in[i].z;) ++last;
    spot s = {in[i].z, i ? in[i].v.c[0] : 1, in[last].v.c[0], 0};
    real tall = i && s.after > 0 ? tall_from : tolerance;
    s.tall = s.before - s.after > tall || s.after - s.before > tall;
    f->falls &= s.before <= v && s.after <= s.before;
    if (f->clear == none && s.before < 1 - f->tolerance)
      f->clear = z + (s.z - z) * (v - (1 - f->tolerance)) / (v - s.before);
    if (f->clear == none && s.after < 1 - f->tolerance) f->clear = s.z;
    if (fabsl(s.before - 1 + f->tolerance) < close || fabsl(s.after - 1 + f->tolerance) < close) f->ambiguous = 1;
    if (fabsl(fabsl(s.before - s.after) - tall) < close) f->ambiguous = 1;
    f->s[f->count++] = s;
    v = s.after;
    z = s.z;
  }
}

/* Adds a gate; 0 if no line passes, which leaves all as it was. */
static int bar_added(brute *f, bar added) {
  real z = added.z, low = added.low, high = added.high;
  real slope[2] = {f->slope[0], f->slope[1]};
  int support[2] = {-1, -1};
  for (int i = 0; i < f->bar_count; ++i) {
    bar b = f->bars[i];
    if (z == b.z) {
      if (low > b.high || high < b.low) return 0;
      continue;
    }
    real up = (low - b.high) / (z - b.z), down = (high - b.low) / (z - b.z);
    if (low > -none && b.high < none && up > slope[0]) slope[0] = up, support[0] = 1;
    if (high < none && b.low > -none && down < slope[1]) slope[1] = down, support[1] = 1;
  }
  real width = f->bar_count ? z - f->bars[0].z : 0;
  if (f->bar_count && fabsl(slope[1] - slope[0]) * width < close) f->ambiguous = 1;
  if (f->bar_count && slope[0] > slope[1]) return 0;
  for (int i = 0; i < 2; ++i)
    if (support[i] > 0) f->slope[i] = slope[i], f->z[i] = z, f->y[i] = i ? high : low;
  f->bars[f->bar_count++] = added;
  return 1;
}

static void no_bars(brute *f) {
  f->bar_count = 0;
  f->slope[0] = -none;
  f->slope[1] = none;
}

static bar bar_at(const brute *f, int k, int before, int after) {
  const spot *s = &f->s[k];
  real a = before ? s->before : s->after, b = after ? s->after : s->before;
  return (bar){s->z, most_of(most_of(a, b) - f->tolerance, 0), least_of(least_of(a, b) + f->tolerance, f->cap)};
}

/* The flattest or the steepest line leaves between spots k - 1 and k. */
static opening exit_before(const brute *f, int k, int up) {
  const spot *a = &f->s[k - 1], *b = &f->s[k];
  int i = up ? 0 : 1;
  opening o = {.z = {f->z[i], 0}, .y = {f->y[i], 0}, .up = up};
  real from = most_of(a->z, -none), best = b->z, wall = up ? f->tolerance : -f->tolerance;
  real va = a->after + wall, vb = b->before + wall, limit = up ? f->cap : 0, sign = up ? 1 : -1;
  real ya = o.y[0] + f->slope[i] * (from - o.z[0]), yb = o.y[0] + f->slope[i] * (b->z - o.z[0]);
  if (sign * (vb - yb) < 0) best = least_of(best, from + (b->z - from) * most_of(0, sign * (va - ya)) /
                                            (most_of(0, sign * (va - ya)) - sign * (vb - yb)));
  if (sign * (limit - yb) < 0) best = least_of(best, from + (b->z - from) * most_of(0, sign * (limit - ya)) /
                                               (most_of(0, sign * (limit - ya)) - sign * (limit - yb)));
  o.z[1] = best;
  o.y[1] = o.y[0] + f->slope[i] * (best - o.z[0]);
  return o;
}

/* What a line has to pass at spot k if it has come through opening `o` before, or comes through it later. */
static bar beyond(bar b, const opening *o, real z) {
  if (z <= least_of(o->z[0], o->z[1]) || z >= most_of(o->z[0], o->z[1])) return b;
  return (bar){b.z, o->up ? b.low : -none, o->up ? none : b.high};
}

static bar near_bar(const opening *o) { return (bar){o->z[0], o->up ? o->y[0] : -none, o->up ? none : o->y[0]}; }
static bar far_bar(const opening *o) { return (bar){o->z[1], o->up ? -none : o->y[1], o->up ? o->y[1] : none}; }

/* All lines through an opening, up to its end. */
static void through(brute *f, const opening *o, const opening *end) {
  int to_end = end && end->z[1] > o->z[0] && end->z[1] < o->z[1];
  no_bars(f);
  bar_added(f, near_bar(o));
  for (int k = 0; k < f->count; ++k) {
    if (f->s[k].z <= o->z[0] || f->s[k].z >= o->z[1]) continue;
    if (to_end && f->s[k].z > end->z[1]) {
      bar_added(f, far_bar(end));
      to_end = 0;
    }
    bar b = beyond(bar_at(f, k, 1, 1), o, f->s[k].z);
    bar_added(f, end ? beyond(b, end, f->s[k].z) : b);
  }
  if (to_end) bar_added(f, far_bar(end));
  bar_added(f, far_bar(o));
}

/* The opening to the level lines that stay to the end, and the spot behind its left end. -1: there is one from the
 * step at `left` on. */
static int level_end(brute *f, int left, opening *o) {
  int last = f->count - 1;
  real low = -none, high = none, low_z = 0, high_z = 0;
  for (int k = last; k >= left; --k) {
    bar b = bar_at(f, k, k > left || !f->s[k].tall, 1);
    b.high = least_of(1, least_of(f->s[k].after, k > left || !f->s[k].tall ? f->s[k].before : 1) + f->tolerance);
    if (k == last && f->s[k].after == 0) b.high = 0;
    if (fabsl(b.low - high) < close || fabsl(b.high - low) < close) f->ambiguous |= !(b.low == 0 && high == 0);
    if (b.low > high || b.high < low || (k == 0 && !f->s[0].tall)) {
      int down = b.low > high || b.high >= low;   /* the path comes from above */
      real y = down ? high : low, wall = down ? -f->tolerance : f->tolerance, z = f->s[k].z;
      real v = f->s[k].after + wall, w = f->s[k + 1].before + wall;
      if ((v - y) * (w - y) < 0) z = z + (f->s[k + 1].z - z) * (y - v) / (w - v);
      else if (k == 0) z = f->s[0].z;
      *o = (opening){{down ? high_z : low_z, z}, {y, y}, !down};
      return k + 1;
    }
    if (b.low > low) low = b.low, low_z = b.z;
    if (b.high < high) high = b.high, high_z = b.z;
  }
  return -1;
}

/* Segments from the step at `left`, or else from `o`, to the step at `right`, or to `end` if it is not NULL. */
static int segments(brute *f, opening o, int from_step, int left, int right, const opening *end) {
  int n = 1, k = left + 1, at_end = 0, tries = 0;
  no_bars(f);
  if (from_step) {
    bar_added(f, bar_at(f, left, 0, 1));
  } else {
    through(f, &o, end);
    for (k = left; f->s[k].z < o.z[1]; ++k) continue;
  }
  for (;;) {
    enum { SPOT, LEFT_END, RIGHT_END } next = SPOT;
    real z = k <= right ? f->s[k].z : none;
    if (end && !at_end && z > end->z[1]) next = LEFT_END;
    else if (end && z >= end->z[0]) next = RIGHT_END;
    bar b = next == LEFT_END ? far_bar(end) : next == RIGHT_END ? near_bar(end)
                                                                : bar_at(f, k, 1, !(f->s[k].tall && k == right));
    if (end && next == SPOT) b = beyond(b, end, z);
    /* Who starts behind the left end is on the right side of it. */
    if ((next == LEFT_END && b.z <= f->bars[f->bar_count - 1].z) || bar_added(f, b)) {
      if (next == RIGHT_END || (next == SPOT && k == right && !end)) return n;
      at_end |= next == LEFT_END;
      k += next == SPOT;
      tries = 0;
      continue;
    }
    if (++tries > 1) {
      f->ambiguous = 1;
      return n;
    }
    int up = f->y[0] + f->slope[0] * (b.z - f->z[0]) > b.high, behind = k;
    while (f->s[behind].z > b.z || behind > right) --behind;
    if (f->s[behind].z < b.z) ++behind;
    opening from = exit_before(f, behind, up);
    if (from.z[1] > b.z) from.y[1] += f->slope[!up] * (b.z - from.z[1]), from.z[1] = b.z;
    through(f, &from, end);
    for (k = left; k < f->count && f->s[k].z < from.z[1]; ++k) continue;
    at_end |= end && end->z[1] < from.z[1];
    ++n;
  }
}

/* The fewest vertices, or -1 if that hangs by a hair. */
static int fewest(brute *f) {
  int n = 0, left = 0, from_step = 0;
  if (f->clear == none) return f->ambiguous ? -1 : 0;
  opening o = {{f->s[0].z, f->clear}, {1, 1}, 1};
  for (int k = 0; k < f->count; ++k)
    if (f->s[k].tall && f->s[k].z == f->clear && f->s[k].before > 1 - f->tolerance) left = k, from_step = 1, n = 1;
  for (;;) {
    int right = left + 1;
    while (right < f->count && !f->s[right].tall) ++right;
    if (!from_step && left == 0 && f->s[0].tall) return -1;
    if (right < f->count) {
      n += segments(f, o, from_step, left, right, NULL) - from_step + 2;
      if (f->falls) {
        real z = f->s[right].z;
        f->cap = least_of(bar_at(f, right, 1, 0).high, f->y[1] + f->slope[1] * (z - f->z[1]));
      }
      left = right;
      from_step = 1;
      continue;
    }
    opening end;
    if (level_end(f, left, &end) >= 0) n += segments(f, o, from_step, left, right - 1, &end) - from_step + 1;
    return f->ambiguous ? -1 : n;
  }
}

/* Small functions of few different depths and values: stairs, ramps, plateaus, steps tall and short. */
static size_t small_function(rng *r, vertex *e, int may_grow) {
  size_t n = 1 + rng_below(r, 24);
  double z = 1, v = 1, fall = rng_scale(r, 0.02, 0.5);
  int kind = (int)rng_below(r, 4);
  for (size_t i = 0; i < n; ++i) {
    e[i] = grey(z, v);
    if (kind == 0 ? i % 2 : rng_below(r, 3)) z += kind == 1 ? 1 + rng_below(r, 4) : rng_between(r, 0.1, 4);
    if (kind == 0 ? i % 2 == 0 : rng_below(r, 4)) v -= kind == 2 ? fall / 2 : rng_between(r, 0, fall);
    if (may_grow && rng_below(r, 3) == 0) v += rng_between(r, 0, 2 * fall);
    v = fmax(0, fmin(1, v));
  }
  return n;
}

/* ---- What the result must be -------------------------------------------------------------------------------- */

typedef struct { vertices minimal, greedy; size_t total, greedy_total; } pair;

static void compress(pair *p, const vertex *in, size_t n, int channels, double tolerance) {
  p->minimal.count = p->greedy.count = 0;
  assert_int_equal(compress_minimal(in, n, channels, tolerance, &p->minimal), DSM_OK);
  assert_int_equal(compress_greedy(in, n, channels, tolerance, &p->greedy), DSM_OK);
  p->total += p->minimal.count;
  p->greedy_total += p->greedy.count;
}

static void check(const rng *r, pair *p, const vertex *in, size_t n, double tolerance, int falls) {
  compress(p, in, n, 1, tolerance);
  assert_seeded(r, p->minimal.count <= p->greedy.count);
  assert_seeded(r, largest_error(in, n, &p->minimal) <= tolerance + 1e-15);
  assert_seeded(r, is_tidy(in, n, &p->minimal, falls, tolerance));
  assert_seeded(r, keeps_the_essential(in, n, &p->minimal, tolerance));
}

static void free_pair(pair *p) {
  vertices_free(&p->minimal);
  vertices_free(&p->greedy);
}

static void count_is_the_fewest(void **state) {
  (void)state;
  pair p = {0};
  int judged = 0;
  enum { seeds = 100000 };
  for (uint64_t seed = 0; seed < most_cases(seeds); ++seed) {
    rng r = rng_seeded(seed);
    vertex e[MOST];
    int may_grow = rng_below(&r, 4) == 0;
    size_t n = small_function(&r, e, may_grow);
    double tolerance = rng_scale(&r, 0.01, 0.4);
    static brute f;
    read_spots(&f, e, n, tolerance, tolerance);
    int most = fewest(&f);
    check(&r, &p, e, n, tolerance, f.falls);
    if (most < 0) continue;
    ++judged;
    assert_seeded(&r, p.minimal.count == (size_t)most);
  }
  assert_true(judged >= (int)(most_cases(seeds) / 10 * 9));
  free_pair(&p);
}

/* Of the tolerance some has been spent: the tunnel shrinks, and what is a tall step does not. */
static void spending_makes_no_step_tall(void **state) {
  (void)state;
  vertices out = {0};
  int judged = 0, merged = 0;
  enum { seeds = 30000 };
  for (uint64_t seed = 0; seed < most_cases(seeds); ++seed) {
    rng r = rng_seeded(seed);
    vertex e[MOST];
    int may_grow = rng_below(&r, 4) == 0;
    size_t n = small_function(&r, e, may_grow);
    double tolerance = rng_scale(&r, 0.01, 0.4), rest = tolerance * rng_between(&r, 0.55, 1);
    static brute f;
    read_spots(&f, e, n, rest, tolerance);
    int most = fewest(&f);
    out.count = 0;
    assert_int_equal(compress_minimal_after(e, n, 1, tolerance, tolerance - rest, &out), DSM_OK);
    assert_seeded(&r, largest_error(e, n, &out) <= rest + 2e-15);
    for (int i = 1; i < f.count; ++i) merged += !f.s[i].tall && fabsl(f.s[i].before - f.s[i].after) > rest;
    if (most < 0) continue;
    ++judged;
    assert_seeded(&r, out.count == (size_t)most);
  }
  assert_true(judged >= (int)(most_cases(seeds) / 10 * 9) && merged >= (int)(most_cases(seeds) / 30));
  vertices_free(&out);
}

/* Rays of 16 and a tolerance of one of them, less what storing rounds: only a first step is worth a step. So too where
 * the share of a ray is no binary number, and where channels differ. */
static void steps_of_one_ray_merge(void **state) {
  (void)state;
  vertices out = {0};
  for (int rays = 4; rays < 40; ++rays)
    for (int channels = 1; channels <= 3; channels += 2) {
      vertex e[80];
      for (int i = 0; i < rays; ++i) {
        e[2 * i] = grey(5 + i + 0.3 * (i % 3), (double)(rays - i) / rays);
        e[2 * i + 1] = grey(e[2 * i].z, (double)(rays - i - 1) / rays);
        if (channels == 3) e[2 * i].v.c[2] = e[2 * i + 1].v.c[2] = 1;
      }
      out.count = 0;
      assert_int_equal(compress_minimal_after(e, 2 * (size_t)rays, channels, 1.0 / rays, 1e-5, &out), DSM_OK);
      assert_true(out.count < (size_t)rays / 2 + 3);
      out.count = 0;
      assert_int_equal(compress_minimal_after(e, 2 * (size_t)rays, channels, 0.99 / rays, 1e-5, &out), DSM_OK);
      assert_true(out.count == 2 * (size_t)rays - 1);
    }
  vertices_free(&out);
}

static void hard_functions_stay_within_the_tolerance(void **state) {
  (void)state;
  pair p = {0};
  for (uint64_t seed = 0; seed < most_cases(100000); ++seed) {
    rng r = rng_seeded(seed);
    vertex e[MOST];
    int may_grow = rng_below(&r, 4) == 0;
    size_t n = hard_function(&r, e, may_grow);
    double tolerance = rng_below(&r, 10) ? rng_scale(&r, rng_below(&r, 5) ? 1e-5 : 1e-9, 0.499) : 0;
    check(&r, &p, e, n, tolerance, !may_grow);
  }
  free_pair(&p);
}

static void hair_needs_fewer(void **state) {
  (void)state;
  static vertex e[2048];
  for (int clusters = 0; clusters < 2; ++clusters)
    for (int n = 16; n <= 1024; n *= 4) {
      pair p = {0};
      for (uint64_t seed = 0; seed < most_cases(300); ++seed) {
        rng r = rng_seeded(seed);
        size_t count = hair(&r, e, n, clusters);
        check(&r, &p, e, count, 0.0156, 1);
      }
      print_message("hair, %4d hits%s: %.2f vertices, greedy %.2f, ratio %.3f\n", n, clusters ? " in clusters" : "",
                    (double)p.total / 300, (double)p.greedy_total / 300, (double)p.total / (double)p.greedy_total);
      if (n >= 256) assert_true((double)p.total < 0.7 * (double)p.greedy_total);
      free_pair(&p);
    }
}

static void a_million_vertices(void **state) {
  (void)state;
  enum { n = 1000000 };
  rng r = rng_seeded(42);
  vertex *e = malloc(n * sizeof *e);
  pair p = {0};
  double z = 1e-6, v = 1;
  for (int i = 0; i < n; ++i) {
    e[i] = grey(z, v);
    if (rng_below(&r, 3)) z += rng_scale(&r, 1e-9, 10);
    if (rng_below(&r, 2)) v *= 1 - 1e-5 * rng_unit(&r);
  }
  const double tolerances[] = {0, 1e-9, 1e-6, 0.002, 0.05, 0.499};
  for (int t = 0; t < 6; ++t) check(&r, &p, e, n, tolerances[t], 1);
  free_pair(&p);
  free(e);
}

/* What can be said without a computer. */
static void known_counts(void **state) {
  (void)state;
  rng r = rng_seeded(0);
  pair p = {0};
  vertex opaque[] = {grey(3, 1), grey(3, 0)}, hardly[] = {grey(1, 1), grey(2, 0.995), grey(9, 0.99)};
  check(&r, &p, opaque, 2, 0.3, 1);
  assert_true(p.minimal.count == 1 && p.minimal.data[0].z == 3 && p.minimal.data[0].v.c[2] == 0);
  check(&r, &p, hardly, 3, 0.0101, 1);
  assert_int_equal(p.minimal.count, 0);
  check(&r, &p, hardly, 3, 0.009, 1);
  assert_int_equal(p.minimal.count, 2);
  vertex panes[12];
  for (int k = 0; k < 12; ++k) panes[k] = grey(1 + k / 2, pow(0.7, (k + 1) / 2));
  check(&r, &p, panes, 12, 0.02, 1);
  assert_int_equal(p.minimal.count, 11);
  for (size_t i = 0; i < 11; ++i)
    assert_true(p.minimal.data[i].z == panes[i + 1].z && p.minimal.data[i].v.c[0] == panes[i + 1].v.c[0]);
  /* Within 1/32, a fall by 1/2, a level and a fall by 1/2: four corners, and none of them can go. */
  vertex z[] = {grey(1, 1), grey(2, 0.5), grey(4, 0.5), grey(5, 0)};
  check(&r, &p, z, 4, 1 / 32.0, 1);
  assert_int_equal(p.minimal.count, 4);
  free_pair(&p);
}

/* Colours: never more than the greedy's, never fewer than the most that one channel needs. */
static void colours_share_depths(void **state) {
  (void)state;
  pair p = {0};
  size_t bound = 0;
  for (uint64_t seed = 0; seed < most_cases(3000); ++seed) {
    rng r = rng_seeded(seed);
    static vertex e[512], one[512];
    size_t n = hair(&r, e, 256, 0), most = 0;
    if (seed % 2) n = hard_function(&r, e, 0);
    double power[3] = {1, rng_between(&r, 0.5, 2), rng_between(&r, 0.5, 2)}, tolerance = 0.0156;
    for (size_t i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c) e[i].v.c[c] = pow(e[i].v.c[c], power[c]);
    for (int c = 0; c < 3; ++c) {
      for (size_t i = 0; i < n; ++i) one[i] = grey(e[i].z, e[i].v.c[c]);
      p.minimal.count = 0;
      assert_int_equal(compress_minimal(one, n, 1, tolerance, &p.minimal), DSM_OK);
      most = p.minimal.count > most ? p.minimal.count : most;
    }
    bound += most;
    compress(&p, e, n, 3, tolerance);
    assert_seeded(&r, p.minimal.count <= p.greedy.count);
    for (int c = 0; c < 3; ++c) {
      static vertex data[1024];
      vertices got = {data, p.minimal.count, 1024};
      for (size_t i = 0; i < n; ++i) one[i] = grey(e[i].z, e[i].v.c[c]);
      for (size_t i = 0; i < got.count; ++i) data[i] = grey(p.minimal.data[i].z, p.minimal.data[i].v.c[c]);
      assert_seeded(&r, largest_error(one, n, &got) <= tolerance + 2e-15);
      for (size_t i = 0; i < got.count; ++i) {
        assert_seeded(&r, data[i].v.c[0] >= 0 && data[i].v.c[0] <= (i ? data[i - 1].v.c[0] : 1));
        assert_seeded(&r, i < 2 || data[i].z > data[i - 2].z);
        assert_seeded(&r, i == 0 || data[i].z >= data[i - 1].z);
      }
    }
  }
  print_message("colour: %zu vertices, greedy %zu, the largest channel alone %zu\n", p.total, p.greedy_total,
                bound);
  free_pair(&p);
}

static void appends_and_undoes(void **state) {
  (void)state;
  vertex e[] = {grey(3, 1), grey(3, 0)};
  vertices out = {0};
  assert_int_equal(vertices_push(&out, 9, rgb_grey(0.5)), DSM_OK);
  assert_int_equal(compress_minimal(e, 2, 1, 0.01, &out), DSM_OK);
  assert_int_equal(out.count, 2);
  assert_true(out.data[0].z == 9 && out.data[1].v.c[0] == 0);
  vertices_free(&out);
  size_t full = SIZE_MAX / sizeof(vertex);
  out = (vertices){NULL, full, full};
  assert_int_equal(compress_minimal(e, 2, 1, 0.01, &out), DSM_NO_MEMORY);
  assert_true(out.count == full);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(known_counts),
    cmocka_unit_test(count_is_the_fewest),
    cmocka_unit_test(spending_makes_no_step_tall),
    cmocka_unit_test(steps_of_one_ray_merge),
    cmocka_unit_test(hard_functions_stay_within_the_tolerance),
    cmocka_unit_test(hair_needs_fewer),
    cmocka_unit_test(a_million_vertices),
    cmocka_unit_test(colours_share_depths),
    cmocka_unit_test(appends_and_undoes),
  };
  return cmocka_run_group_tests_name("compress_minimal", tests, NULL, NULL);
}
