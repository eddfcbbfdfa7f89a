/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 *  1 ----.                      Most rays meet surfaces only, or a chain of short spans that do not overlap:
 *        |                      one pass, no memory of its own. Where events overlap, a sweep over fronts and
 *        '---._                 backs adds the spans' rates of extinction. A chain of many thin spans is smooth:
 *              '--.____         one chord takes as many of them as it passes within the error.
 *  0                   ------   LV figure 4.
 */
#include "core/transmittance.h"

#include <stdlib.h>

#include "core/extremes.h"

#define BLACK_DEPTH 745.0  /* a span of transmittance 0: the gentlest exponential that doubles take for 0 */
#define SHORTEST 1e-290    /* a span shorter than this is a step: its rate of extinction would overflow */

typedef struct {
  vertices *out;
  size_t start;   /* of this function in `out` */
  double error;   /* the most that the function may be off */
  int channels;   /* 1: all events are grey */
  rgb v;          /* transmittance so far */
  /* A chord in the making, from the last vertex to `end`: */
  int open;
  vertex end;     /* on the curve */
  rgb gap;        /* how far the chord of the last piece, which ends there, lies above the curve at most */
  rgb low, high;  /* slopes that pass all pieces before */
} builder;

static int same(rgb a, rgb b) { return a.c[0] == b.c[0] && a.c[1] == b.c[1] && a.c[2] == b.c[2]; }
static int is_step(const event *e) { return !(e->back - e->front > SHORTEST); }

static int is_lit(const builder *b) {
  int lit = 0;
  for (int c = 0; c < b->channels; ++c) lit |= b->v.c[c] > 0;
  return lit;
}

/* Of a grey function only red is computed. */
static rgb whole(const builder *b, rgb v) { return b->channels == 1 ? rgb_grey(v.c[0]) : v; }

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

/* Ends the chord. */
static dsm_result settle(builder *b) {
  if (!b->open) return DSM_OK;
  b->open = 0;
  return put(b, b->end.z, b->end.v);
}

/* Leads the chord past its end to the point z, v if it can. The line must pass the end within a window: not more
 * than `error` below, and above by no more than leaves room for the gaps on both sides. As all its vertices are
 * on the curve, the function is off only between them. */
static int lengthen(builder *b, double z, rgb v, rgb gap) {
  const vertex *from = &b->out->data[b->out->count - 1];
  double run = b->end.z - from->z, all = z - from->z;
  rgb low = b->low, high = b->high;
  for (int c = 0; c < b->channels; ++c) {
    double y = from->v.c[c], here = b->end.v.c[c], slope = (v.c[c] - y) / all;
    low.c[c] = greater(low.c[c], (here - b->error - y) / run);
    high.c[c] = lesser(high.c[c], (here + b->error - greater(b->gap.c[c], gap.c[c]) - y) / run);
    if (!(low.c[c] <= slope && slope <= high.c[c])) return 0;
  }
  b->low = low;
  b->high = high;
  return 1;
}

/* Goes on to a point of the curve. Between it and the last one the curve falls exponentially, or not at all; the
 * chord of that piece lies above it by at most `gap`, which is not above b->error. */
static dsm_result reach(builder *b, double z, rgb v, rgb gap) {
  v = whole(b, v);
  if (b->open && b->end.z == z) return DSM_OK;
  if (!b->open && (b->out->count == b->start || b->out->data[b->out->count - 1].z == z)) return put(b, z, v);
  dsm_result result = DSM_OK;
  if (!b->open || !lengthen(b, z, v, gap)) {
    result = settle(b);
    b->open = 1;
    b->low = rgb_grey(-HUGE_VAL);
    b->high = rgb_grey(HUGE_VAL);
  }
  b->end = (vertex){z, v};
  b->gap = gap;
  return result;
}

static dsm_result step(builder *b, double z, rgb transmittance) {
  rgb before = b->v;
  for (int c = 0; c < b->channels; ++c) b->v.c[c] = transmittance_behind(before.c[c], transmittance.c[c]);
  b->v = whole(b, b->v);
  if (same(before, b->v)) return DSM_OK;
  dsm_result result = reach(b, z, before, rgb_grey(0));
  if (!result) result = settle(b);
  return result ? result : put(b, z, b->v);
}

/* How far the chord over optical depth 0…x lies above exp(-x) at most, and the derivative of that in x. The
 * gap is widest where the curve runs parallel to the chord, whose slope is -g. */
static double chord_gap(double x, double *derivative) {
  double fallen = -expm1(-x), g = fallen / x, log_g = log(g);
  *derivative = (1 - fallen - g) / x * log_g;
  return 1 - g + g * log_g;
}

/* The longest optical depth whose chord stays within `gap`, 0 < gap < 1: to 1e-7, and never too long by more.
 * Chords so grow as light fades: fewest vertices on the curve. */
static double longest_chord(double gap) {
  double s = sqrt(8 * gap), derivative;   /* a chord so long has less than the gap */
  if (s < 0.9) {   /* the inverse of chord_gap, x = s + s^2/4 + 23/288 s^3 + …, fitted */
    double more = 0.00245103341;
    more = more * s - 0.00227442750;
    more = more * s + 0.00685426360;
    more = more * s + 0.00861390369;
    more = more * s + 0.0281214364;
    more = more * s + 0.0798211089;
    more = more * s + 0.250001770;
    return s * (0.99999994 + more * s);
  }
  double x = s;
  for (int i = 0; i < 4; ++i) {
    double found = chord_gap(x, &derivative);
    x += (gap - found) / derivative;
    if (!(x > s)) return s;
  }
  return chord_gap(x, &derivative) <= gap * (1 + 1e-6) ? x : s;
}

/* The share of a fall by `depth` that one chord from `v` may take; not below 1 if the end will do. */
static double stride(const builder *b, rgb v, rgb depth) {
  double shortest = HUGE_VAL, derivative;
  for (int c = 0; c < b->channels; ++c) {
    double gap = b->error / v.c[c], x = depth.c[c];
    if (!(gap < 1 && x * x > 8 * gap)) continue;   /* a chord from below `error` is never off by it */
    if (gap > 0.1 && chord_gap(x, &derivative) <= gap) continue;
    shortest = lesser(shortest, longest_chord(gap) / x);
  }
  return shortest;
}

/* Where the last light goes: the share of the way from z0 to z1 after which no channel has any. */
static double end_of_light(const builder *b, rgb from, rgb depth) {
  double end = 0;
  for (int c = 0; c < b->channels; ++c)
    if (from.c[c] > TRANSMITTANCE_GONE) end = fmax(end, log(from.c[c] / TRANSMITTANCE_GONE) / depth.c[c]);
  return fmin(end, 1);
}

/* Light falls exponentially from z0 to z1, by optical depth `depth`, to the value `to`; one chord will not do. The
 * values are those at the depths that doubles can hold, which matters where a dense sheet is a few of them thick. */
static dsm_result fall(builder *b, double z0, double z1, rgb depth, rgb to) {
  rgb from = b->v, v = from, gap;
  double length = z1 - z0, z = z0, s = 0, end = 1, last = 0;   /* s, end, last: shares of the length */
  dsm_result result = reach(b, z0, from, rgb_grey(0));
  if (!result) result = settle(b);
  b->v = without_traces(to);
  if (!is_lit(b)) {
    end = end_of_light(b, from, depth);
    z1 = fmin(z1, nextafter(z0 + end * length, HUGE_VAL));
  }
  while (!result) {
    s += stride(b, v, rgb_scale(end - s, depth)) * (end - s);
    if (!(s < end)) break;
    double next = z0 + s * length;
    if (next - z0 > s * length) next = nextafter(next, z0);   /* rounding must not make the chord longer */
    z = next > z ? next : nextafter(z, HUGE_VAL);
    if (!(z < z1)) break;
    s = last = (z - z0) / length;
    for (int c = 0; c < b->channels; ++c) v.c[c] = from.c[c] * exp(-s * depth.c[c]);
    result = put(b, z, whole(b, v));
  }
  for (int c = 0; c < b->channels; ++c) {
    double x = (end - last) * depth.c[c];
    gap.c[c] = lesser(b->error, v.c[c] * x * x / 8);
  }
  return result ? result : reach(b, z1, b->v, gap);
}

/* As fall, where the chords of all channels may lie above the curve by `gap` at most. */
static dsm_result fall_briefly(builder *b, double z0, double z1, rgb gap, rgb to) {
  dsm_result result = reach(b, z0, b->v, rgb_grey(0));
  b->v = without_traces(to);
  return result ? result : reach(b, z1, b->v, gap);
}

static rgb optical_depth(const builder *b, rgb transmittance) {
  rgb depth = rgb_grey(0);
  for (int c = 0; c < b->channels; ++c) {
    double t = transmittance.c[c];
    depth.c[c] = t > 0 ? fmax(0, -log(t)) : BLACK_DEPTH;
  }
  return depth;
}

/* A span that overlaps nothing. The hot one: a medium gives up to a thousand, too short to need a vertex
 * between. */
static dsm_result lone_span(builder *b, const event *e) {
  rgb t = e->transmittance, to = b->v, gap;
  int brief = 1, falls = 0;
  for (int c = 0; c < b->channels; ++c) {
    to.c[c] *= t.c[c];
    falls |= to.c[c] < b->v.c[c];
    /* No logarithm: -log(t) <= (1 - t) / sqrt(t), and the gap is at most v * log(t)^2 / 8. */
    gap.c[c] = b->v.c[c] > 0 ? b->v.c[c] * (1 - t.c[c]) * (1 - t.c[c]) / (8 * t.c[c]) : 0;
    brief &= gap.c[c] <= b->error;
  }
  to = whole(b, to);
  if (!falls) return DSM_OK;
  return brief ? fall_briefly(b, e->front, e->back, gap, to)
               : fall(b, e->front, e->back, optical_depth(b, t), to);
}

static rgb rate_of(const builder *b, const event *span) {
  return rgb_scale(1 / (span->back - span->front), optical_depth(b, span->transmittance));
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

/* Spans that overlap, between two of their ends. */
static dsm_result fall_together(builder *b, double z0, double z1, rgb depth) {
  rgb to = b->v, gap;
  int brief = 1, falls = 0;
  for (int c = 0; c < b->channels; ++c) {
    gap.c[c] = b->v.c[c] * depth.c[c] * depth.c[c] / 8;
    brief &= gap.c[c] <= b->error;
    falls |= depth.c[c] > 0;
    to.c[c] *= exp(-depth.c[c]);
  }
  if (!falls) return DSM_OK;
  to = whole(b, to);
  return brief ? fall_briefly(b, z0, z1, gap, to) : fall(b, z0, z1, depth, to);
}

static dsm_result sweep(builder *b, const event *events, size_t count, const span_end *ends, rgb *rates,
                        size_t spans) {
  size_t begun = 0, i = 0, k = 0;
  double z = events[0].front;
  dsm_result result = DSM_OK;
  while (!result && is_lit(b) && (i < count || k < spans)) {
    double next = i < count && !(k < spans && ends[k].z < events[i].front) ? events[i].front : ends[k].z;
    if (spans) result = fall_together(b, z, next, rgb_scale(next - z, rates[1]));
    z = next;
    for (; k < spans && ends[k].z == z; ++k) set_rate(rates, ends[k].leaf, rgb_grey(0));
    for (; !result && i < count && events[i].front == z; ++i) {
      const event *e = &events[i];
      if (is_step(e)) result = step(b, z, e->transmittance);
      else set_rate(rates, spans + begun++, rate_of(b, e));
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

static int are_grey(const event *events, size_t count) {
  int grey = 1;
  for (size_t i = 0; i < count; ++i) grey &= rgb_is_grey(events[i].transmittance);
  return grey;
}

dsm_result transmittance_build(const event *events, size_t count, double tolerance, vertices *out) {
  builder b = {.out = out, .start = out->count, .error = fmax(tolerance / 4, 1e-6), .v = rgb_grey(1)};
  b.channels = are_grey(events, count) ? 1 : 3;
  dsm_result result = DSM_OK;
  for (size_t i = 0, n; !result && i < count && is_lit(&b); i += n) {
    double back = events[i].back;
    for (n = 1; i + n < count && events[i + n].front < back; ++n) back = greater(back, events[i + n].back);
    if (n > 1) result = overlapping(&b, events + i, n);
    else if (is_step(&events[i])) result = step(&b, events[i].front, events[i].transmittance);
    else result = lone_span(&b, &events[i]);
  }
  if (!result) result = settle(&b);
  if (result) out->count = b.start;
  return result;
}
