/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 *  1 ----.                      Most rays meet surfaces only, or a chain of short spans that do not overlap:
 *        |                      one pass, no memory of its own. Where events overlap, a sweep over fronts and
 *        '---._                 backs adds the spans' rates of extinction.
 *              '--.____
 *  0                   ------   LV figure 4.
 */
#include "core/transmittance.h"

#include <stdlib.h>

#define BLACK_DEPTH 745.0  /* a span of transmittance 0: the gentlest exponential that doubles take for 0 */
#define SHORTEST 1e-290    /* a span shorter than this is a step: its rate of extinction would overflow */

typedef struct {
  vertices *out;
  size_t start;   /* of this function in `out` */
  double error;   /* the most that a chord may lie above the exponential */
  rgb v;          /* transmittance so far */
} builder;

static int same(rgb a, rgb b) { return a.c[0] == b.c[0] && a.c[1] == b.c[1] && a.c[2] == b.c[2]; }
static int is_step(const event *e) { return !(e->back - e->front > SHORTEST); }

static rgb without_traces(rgb v) {
  for (int c = 0; c < 3; ++c)
    if (v.c[c] < TRANSMITTANCE_GONE) v.c[c] = 0;
  return v;
}

/* Never two equal vertices, never three at one depth. */
static dsm_result put(builder *b, double z, rgb v) {
  size_t count = b->out->count - b->start;
  if (count > 0) {
    vertex *last = &b->out->data[b->out->count - 1];
    if (last->z == z && same(last->v, v)) return DSM_OK;
    if (last->z == z && count > 1 && last[-1].z == z) {
      last->v = v;
      return DSM_OK;
    }
  }
  return vertices_push(b->out, z, v);
}

static dsm_result step(builder *b, double z, rgb transmittance) {
  rgb before = b->v;
  for (int c = 0; c < 3; ++c) b->v.c[c] = transmittance_behind(before.c[c], transmittance.c[c]);
  if (same(before, b->v)) return DSM_OK;
  dsm_result result = put(b, z, before);
  return result ? result : put(b, z, b->v);
}

/* How far the chord over optical depth 0…x lies above exp(-x) at most, and the derivative of that in x. The
 * gap is widest where the curve runs parallel to the chord, whose slope is -g. */
static double chord_gap(double x, double *derivative) {
  if (x < 1e-4) {
    *derivative = x / 4;
    return x * x / 8;
  }
  double fallen = -expm1(-x), g = fallen / x, log_g = log(g);
  *derivative = (1 - fallen - g) / x * log_g;
  return 1 - g + g * log_g;
}

/* The longest optical depth whose chord stays within `gap`, 0 < gap < 1. The gap is below x*x/8, which gives
 * a safe start; Newton's method takes what the bound leaves. Steps so grow as light fades: fewest vertices
 * on the curve. */
static double longest_chord(double gap) {
  double safe = sqrt(8 * gap), x = safe, derivative, found;
  for (int i = 0; i < 4; ++i) {
    found = chord_gap(x, &derivative);
    x += (gap - found) / derivative;
    if (!(x > safe)) return safe;
  }
  return chord_gap(x, &derivative) <= gap * (1 + 1e-6) ? x : safe;
}

/* The share of a fall by `depth` that one chord from `v` may take; above 1 if the end will do. */
static double stride(const builder *b, rgb v, rgb depth) {
  double shortest = HUGE_VAL, derivative;
  for (int c = 0; c < 3; ++c) {
    if (!(v.c[c] > b->error && depth.c[c] > 0)) continue;   /* a chord from below `error` is never off by it */
    double gap = b->error / v.c[c], x = depth.c[c];
    if (x * x <= 8 * gap || chord_gap(x, &derivative) <= gap) continue;
    shortest = fmin(shortest, longest_chord(gap) / x);
  }
  return shortest;
}

/* Where the last light goes: the share of the way from z0 to z1 after which no channel has any. */
static double end_of_light(rgb from, rgb depth) {
  double end = 0;
  for (int c = 0; c < 3; ++c)
    if (from.c[c] > TRANSMITTANCE_GONE) end = fmax(end, log(from.c[c] / TRANSMITTANCE_GONE) / depth.c[c]);
  return fmin(end, 1);
}

/* Light falls exponentially from z0 to z1, by optical depth `depth`, to the value `to`. The values are those
 * at the depths that doubles can hold, which matters where a dense sheet is a few of them thick. */
static dsm_result fall(builder *b, double z0, double z1, rgb depth, rgb to) {
  rgb from = b->v, v = from;
  double length = z1 - z0, z = z0, s = 0, end = 1;   /* s, end: shares of the length */
  dsm_result result = put(b, z0, from);
  to = without_traces(to);
  if (rgb_max(to) == 0) {
    end = end_of_light(from, depth);
    z1 = fmin(z1, nextafter(z0 + end * length, HUGE_VAL));
  }
  while (!result) {
    s += stride(b, v, rgb_scale(end - s, depth)) * (end - s);
    if (!(s < end)) break;
    double next = z0 + s * length;
    if (next - z0 > s * length) next = nextafter(next, z0);   /* rounding must not make the chord longer */
    z = next > z ? next : nextafter(z, HUGE_VAL);
    if (!(z < z1)) break;
    s = (z - z0) / length;
    for (int c = 0; c < 3; ++c) v.c[c] = from.c[c] * exp(-s * depth.c[c]);
    result = put(b, z, v);
  }
  b->v = to;
  return result ? result : put(b, z1, to);
}

static rgb optical_depth(rgb transmittance) {
  rgb depth;
  for (int c = 0; c < 3; ++c) {
    double t = transmittance.c[c];
    depth.c[c] = t > 0 ? fmax(0, -log(t)) : BLACK_DEPTH;
  }
  return depth;
}

/* A span that overlaps nothing. The hot one: a medium gives up to a thousand, too short to need a vertex
 * between. */
static dsm_result lone_span(builder *b, const event *e) {
  rgb t = e->transmittance, to = rgb_mul(b->v, t);
  if (same(to, b->v)) return DSM_OK;
  int brief = 1;   /* no logarithm: -log(t) <= (1 - t) / sqrt(t), and the gap is at most v * log(t)^2 / 8 */
  for (int c = 0; c < 3; ++c) brief &= b->v.c[c] * (1 - t.c[c]) * (1 - t.c[c]) <= 8 * b->error * t.c[c];
  if (!brief) return fall(b, e->front, e->back, optical_depth(t), to);
  dsm_result result = put(b, e->front, b->v);
  b->v = without_traces(to);
  return result ? result : put(b, e->back, b->v);
}

static rgb rate_of(const event *span) {
  return rgb_scale(1 / (span->back - span->front), optical_depth(span->transmittance));
}

typedef struct { double z; size_t leaf; } span_end;

static int by_depth(const void *a, const void *b) {
  double x = ((const span_end *)a)->z, y = ((const span_end *)b)->z;
  return (x > y) - (x < y);
}

/* rates[1] is the sum of the leaves rates[spans…]. A running sum would keep the rounding of a dense short
 * span after it has ended, which can outweigh a thin long one; a tree of sums forgets it. */
static void set_rate(rgb *rates, size_t leaf, rgb rate) {
  rates[leaf] = rate;
  for (leaf /= 2; leaf >= 1; leaf /= 2) rates[leaf] = rgb_add(rates[2 * leaf], rates[2 * leaf + 1]);
}

static dsm_result sweep(builder *b, const event *events, size_t count, const span_end *ends, rgb *rates,
                        size_t spans) {
  size_t begun = 0, i = 0, k = 0;
  double z = events[0].front;
  dsm_result result = DSM_OK;
  while (!result && rgb_max(b->v) > 0 && (i < count || k < spans)) {
    double next = i < count && !(k < spans && ends[k].z < events[i].front) ? events[i].front : ends[k].z;
    rgb depth = spans ? rgb_scale(next - z, rates[1]) : rgb_grey(0), to = b->v;
    if (rgb_max(depth) > 0) {
      for (int c = 0; c < 3; ++c) to.c[c] *= exp(-depth.c[c]);
      result = fall(b, z, next, depth, to);
    }
    z = next;
    for (; k < spans && ends[k].z == z; ++k) set_rate(rates, ends[k].leaf, rgb_grey(0));
    for (; !result && i < count && events[i].front == z; ++i) {
      const event *e = &events[i];
      if (is_step(e)) result = step(b, z, e->transmittance);
      else set_rate(rates, spans + begun++, rate_of(e));
    }
  }
  return result;
}

static dsm_result overlapping(builder *b, const event *events, size_t count) {
  enum { FEW = 16 };   /* nested media are few: no allocation for them */
  span_end few_ends[FEW], *ends = few_ends;
  rgb few_rates[2 * FEW], *rates = few_rates;
  size_t spans = 0, k = 0;
  for (size_t i = 0; i < count; ++i) spans += !is_step(&events[i]);
  if (spans > FEW) {
    ends = malloc(spans * sizeof *ends);
    rates = malloc(2 * spans * sizeof *rates);
  }
  dsm_result result = ends && rates ? DSM_OK : DSM_NO_MEMORY;
  if (!result) {
    for (size_t i = 0; i < 2 * spans; ++i) rates[i] = rgb_grey(0);
    for (size_t i = 0; i < count; ++i)
      if (!is_step(&events[i])) ends[k] = (span_end){events[i].back, spans + k}, ++k;
    qsort(ends, spans, sizeof *ends, by_depth);
    result = sweep(b, events, count, ends, rates, spans);
  }
  if (spans > FEW) {
    free(ends);
    free(rates);
  }
  return result;
}

dsm_result transmittance_build(const event *events, size_t count, double tolerance, vertices *out) {
  builder b = {out, out->count, fmax(tolerance / 4, 1e-6), {{1, 1, 1}}};
  dsm_result result = DSM_OK;
  for (size_t i = 0, n; !result && i < count && rgb_max(b.v) > 0; i += n) {
    double back = events[i].back;
    for (n = 1; i + n < count && events[i + n].front < back; ++n) back = fmax(back, events[i + n].back);
    if (n > 1) result = overlapping(&b, events + i, n);
    else if (is_step(&events[i])) result = step(&b, events[i].front, events[i].transmittance);
    else result = lone_span(&b, &events[i]);
  }
  if (result) out->count = b.start;
  return result;
}
