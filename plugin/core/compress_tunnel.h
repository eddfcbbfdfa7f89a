/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What compressors may do: the tunnel of a function of one channel, and where a line hits its walls. */
#ifndef DSM_CORE_COMPRESS_TUNNEL_H
#define DSM_CORE_COMPRESS_TUNNEL_H

#include "core/compress_bundle.h"
#include "core/vertices.h"

/* All vertices at one depth: the values on its two sides. */
typedef struct { double z, before, after; } place;

/* How far the output may be off, and how tall a step must be to stay one: not less than the tolerance, and less than
 * twice that, so that a line can pass whatever is not tall. */
typedef struct { double tolerance, tall; } bounds;

typedef struct {
  place *places;
  size_t count;
  double tolerance, tall;
  size_t clear;   /* the level line at 1 passes all places in front of this one, and reaches its depth */
  int falls;      /* the input never grows */
} tunnel;

typedef struct { double low, high; } gate;

enum { BEFORE = 1, AFTER = 2 };   /* sides of a place that a line has to pass */

/* Fills `t`; t->places has room for count + 1 places. `split`: a place is put where level 1 leaves the tunnel. 0:
 * level 1 is within the tolerance everywhere. */
int tunnel_read(tunnel *t, const vertex *in, size_t count, int channel, bounds within, int split);

static inline int tunnel_steps(const tunnel *t, size_t k) {
  double step = t->places[k].after - t->places[k].before;
  /* No line but the level one comes to the first place, and none to darkness if it may not end there. */
  double tall = k > 0 && t->places[k].after > 0 ? t->tall : t->tolerance;
  return step > tall || -step > tall;
}

/* What may pass place k, `margin` from the walls and not below `least`. In front of t->clear a line may leave
 * the tunnel upwards: there it has crossed 1 already, where the output turns level. */
static inline gate tunnel_gate(const tunnel *t, size_t k, int sides, double margin, double least) {
  const place *p = &t->places[k];
  double a = sides & BEFORE ? p->before : p->after, b = sides & AFTER ? p->after : p->before;
  double reach = t->tolerance - margin;
  gate g = {(a > b ? a : b) - reach, (a < b ? a : b) + reach};
  if (g.low < least) g.low = least;
  if (g.high > 1) g.high = 1;
  if (k < t->clear) g.high = HUGE_VAL;
  return g;
}

/* Where a line leaves the tunnel, which the input crosses from a to b, upwards (side 1) or downwards (-1). The
 * line passes a; at b at the latest it has left. */
point tunnel_exit(const tunnel *t, const line *l, point a, point b, int side, double margin, double least);

/* The most that a value shifts where its depth does by a share of one: of slopes times depths, the largest. */
double tunnel_steepness(const tunnel *t);

/* compress_greedy within bounds; but it stops where it has `most` vertices. */
dsm_result greedy_within(const vertex *in, size_t count, int channels, bounds within, size_t most, vertices *out);

/* Is the output within the tolerance, to rounding, at every depth? */
int tunnel_holds(const tunnel *t, const vertex *out, size_t count);

#endif
