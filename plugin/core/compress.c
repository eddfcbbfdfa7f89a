/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * LV 3.3: the longest segment from a fixed origin that passes every target window, again and again.
 *
 *   origin o___      |          A window spans the tolerance above and below a vertex. Where the input steps
 *              ---___|___       by no more than that, its window is what both values' windows share, so that
 *                    |   ---o   the line is right on both sides. A taller step ends the segment and is copied.
 *
 * Departures from the paper: in front of the first vertex the output is 1, so the first segment is level and
 * is not written. A segment that ends at a step or at the end aims at the true value, not the middle. Where
 * light is gone at the end, the output gets there, for one more vertex if need be.
 */
#include "core/compress.h"

#include <stdint.h>

#include "core/compress_tunnel.h"
#include "core/extremes.h"

#define STEEPEST 1e300

typedef struct { double low[3], high[3]; } range;

typedef struct {
  vertices *out;
  int channels;
  bounds within;
  double z;       /* origin of the segment; its value is y */
  rgb y;
  range slopes;   /* what passes all windows so far */
  int level;      /* the first segment */
  int rises[3];   /* the input grows somewhere in this segment */
} wedge;

/* All vertices at one depth: the values on its two sides. */
typedef struct {
  double z;
  rgb before, after;
  int tall;       /* the step must survive */
} spot;

/* Each is made twice, for one channel and for three, which halves the work of grey. */
#define FOR_CHANNELS static inline __attribute__((always_inline))

static double clamp(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

FOR_CHANNELS dsm_result put(const wedge *w, double z, rgb v) {
  return vertices_push(w->out, z, w->channels == 1 ? rgb_grey(v.c[0]) : v);
}

FOR_CHANNELS size_t read_spot(const wedge *w, const vertex *in, size_t count, size_t i, spot *p) {
  size_t last = i;
  while (last + 1 < count && in[last + 1].z == in[i].z) ++last;
  p->z = in[i].z;
  p->tall = 0;
  for (int c = 0; c < w->channels; ++c) {
    p->before.c[c] = i == 0 ? 1 : clamp(in[i].v.c[c], 0, 1);
    p->after.c[c] = clamp(in[last].v.c[c], 0, 1);
    double tall = i > 0 && p->after.c[c] > 0 ? w->within.tall : w->within.tolerance;
    p->tall |= fabs(p->after.c[c] - p->before.c[c]) > tall;
  }
  return last + 1;
}

/* A tall step is met in front only. Windows stay in [0,1], and so does the output. */
FOR_CHANNELS range window(const wedge *w, const spot *p) {
  range r;
  for (int c = 0; c < w->channels; ++c) {
    double a = p->before.c[c], b = p->tall ? a : p->after.c[c];
    r.low[c] = greater(0, greater(a, b) - w->within.tolerance);
    r.high[c] = lesser(1, lesser(a, b) + w->within.tolerance);
  }
  return r;
}

static void begin(wedge *w, double z, rgb y) {
  w->z = z;
  w->y = y;
  w->level = 0;
  for (int c = 0; c < 3; ++c) {
    w->slopes.low[c] = -HUGE_VAL;
    w->slopes.high[c] = HUGE_VAL;
    w->rises[c] = 0;
  }
}

/* Lets the segment pass one more place if it can. */
FOR_CHANNELS int extend(wedge *w, const spot *p) {
  range target = window(w, p), slopes = w->slopes;
  for (int c = 0; c < w->channels; ++c) {
    double y = w->y.c[c], run = p->z - w->z;
    if (w->level) {   /* at 1, which no window lies above */
      if (target.high[c] < y) return 0;
      continue;
    }
    /* Depths can be so close that a slope overflows. Then the segment reaches that one window and no other. */
    if (slopes.low[c] >= STEEPEST || slopes.high[c] <= -STEEPEST) return 0;
    slopes.low[c] = greater(slopes.low[c], clamp((target.low[c] - y) / run, -STEEPEST, STEEPEST));
    slopes.high[c] = lesser(slopes.high[c], clamp((target.high[c] - y) / run, -STEEPEST, STEEPEST));
    if (slopes.low[c] > slopes.high[c]) return 0;
  }
  w->slopes = slopes;
  return 1;
}

/* Where the segment ends at place p, which it passes: through the middle of its slopes, or as near to `aim` as
 * they allow. Where the input does not grow, a level segment passes too, because the origin is within the
 * tolerance of an input value that is not below any later one; so a rise can be cut to that. */
FOR_CHANNELS rgb end_of(const wedge *w, const spot *p, const rgb *aim) {
  if (w->level) return w->y;
  range target = window(w, p);
  rgb end = w->y;
  for (int c = 0; c < w->channels; ++c) {
    double y = w->y.c[c], run = p->z - w->z, low = w->slopes.low[c], high = w->slopes.high[c];
    double slope = aim ? clamp((aim->c[c] - y) / run, low, high) : low + (high - low) / 2;
    end.c[c] = clamp(y + slope * run, target.low[c], target.high[c]);   /* rounding */
    if (!w->rises[c]) end.c[c] = lesser(end.c[c], y);
  }
  return end;
}

/* After the last vertex the output keeps its last value, so a segment that may be level needs no end. Only
 * where all light is gone must it be exactly 0: nothing shines through what is opaque. */
FOR_CHANNELS dsm_result finish(const wedge *w, const spot *last) {
  if (w->level || !(last->z > w->z)) return DSM_OK;
  int level = 1, is_exact = 1;
  for (int c = 0; c < w->channels; ++c)
    level &= w->slopes.low[c] <= 0 && 0 <= w->slopes.high[c] && (last->after.c[c] > 0 || w->y.c[c] == 0);
  if (level) return DSM_OK;
  rgb end = end_of(w, last, &last->after), exact = end;
  for (int c = 0; c < w->channels; ++c) {
    if (last->after.c[c] > 0 || end.c[c] == 0) continue;
    exact.c[c] = 0;
    is_exact = 0;
  }
  dsm_result result = put(w, last->z, end);
  return result || is_exact ? result : put(w, last->z, exact);
}

FOR_CHANNELS dsm_result run(const vertex *in, size_t count, int channels, bounds within, size_t most, vertices *out) {
  size_t start = out->count;
  dsm_result result = DSM_OK;
  wedge w = {.out = out, .channels = channels, .within = within};
  begin(&w, 0, rgb_grey(1));
  w.level = 1;
  spot last = {.before = rgb_grey(1), .after = rgb_grey(1)}, p;

  for (size_t i = 0; !result && i < count && out->count - start < most;) {
    i = read_spot(&w, in, count, i, &p);
    if (!extend(&w, &p)) {
      /* A new segment from the place before reaches this one: its window is not empty and there is no other. */
      rgb end = end_of(&w, &last, NULL);
      result = put(&w, last.z, end);
      begin(&w, last.z, end);
      extend(&w, &p);
    }
    for (int c = 0; c < channels; ++c)
      w.rises[c] |= p.before.c[c] > last.after.c[c] || (!p.tall && p.after.c[c] > p.before.c[c]);
    if (p.tall && !result) {
      rgb end = end_of(&w, &p, &p.before), after = p.after;
      /* Behind the step the true value; but a channel that only comes along must not grow for that. */
      for (int c = 0; c < channels; ++c)
        if (p.after.c[c] <= p.before.c[c]) after.c[c] = lesser(after.c[c], end.c[c]);
      result = put(&w, p.z, end);
      if (!result) result = put(&w, p.z, after);
      begin(&w, p.z, after);
    }
    last = p;
  }
  if (!result) result = finish(&w, &last);
  if (result) out->count = start;
  return result;
}

dsm_result greedy_within(const vertex *in, size_t count, int channels, bounds within, size_t most, vertices *out) {
  return channels == 1 ? run(in, count, 1, within, most, out) : run(in, count, 3, within, most, out);
}

dsm_result compress_greedy(const vertex *in, size_t count, int channels, double tolerance, vertices *out) {
  return greedy_within(in, count, channels, (bounds){tolerance, tolerance}, SIZE_MAX, out);
}
