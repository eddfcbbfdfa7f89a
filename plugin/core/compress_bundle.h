/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * All straight lines that pass a row of gates: the line stabbing of Imai & Iri (1986) and Guibas et al. (1991).
 *
 *     roof     o . . _____---o              rise   the steepest line that passes: it leans on the floor first,
 *            _ o----'    o                         then on the roof
 *      o----'                 x             fall   the other way round
 *            x            x                 roof   upper ends of gates (o); the lines see their lower hull
 *     floor       x                         floor  lower ends (x); the lines see their upper hull
 *
 * A new gate turns the two lines inwards. Their left supports only ever move on along the hulls, so a row of n
 * gates costs O(n), and a gate that neither line touches is never looked at again.
 */
#ifndef DSM_CORE_COMPRESS_BUNDLE_H
#define DSM_CORE_COMPRESS_BUNDLE_H

#include <stddef.h>

typedef struct { double z, y; } point;   /* a depth, or minus a depth in a row that runs backwards */

/* A line; an infinite slope stands for one that nothing holds yet. */
typedef struct { point at; double slope; } line;

static inline double line_at(const line *l, double z) { return l->at.y + l->slope * (z - l->at.z); }

typedef struct {
  line line;      /* through its left support */
  point support;  /* the right one */
} tangent;

/* A hull, `first` to in front of `end`; what is left of `first` no line touches any more. */
typedef struct { point *first, *end; } chain;

typedef struct {
  tangent rise, fall;
  chain floor, roof;
  point *floor_room, *roof_room;   /* for them: two points a gate, the caller's */
  int level;           /* level lines only */
  double start, end;   /* of the row */
} bundle;

void bundle_begin(bundle *b, int level);
/* With a first gate that any line of the bundle passes. */
void bundle_begin_at(bundle *b, double z, double low, double high);

/* Adds a gate, not left of the one before; an end may be infinite. 0: no line passes, and nothing changed. */
static inline int bundle_pass(bundle *b, double z, double low, double high);

/* Where one of the two lines does not pass: at z they are this high. */
int bundle_narrow(bundle *b, double z, double low, double high, double fall, double rise);

static inline int bundle_pass(bundle *b, double z, double low, double high) {
  double fall = line_at(&b->fall.line, z), rise = line_at(&b->rise.line, z);
  b->end = z;
  if (low <= fall && rise <= high) return 1;
  return bundle_narrow(b, z, low, high, fall, rise);
}

/* How high the lines of one slope are at depth z. */
void bundle_heights(const bundle *b, double slope, double z, double *low, double *high);

/* A line in the middle, no steeper upwards than `steepest`, of a bundle that gates bound from below and from above. */
line bundle_middle(const bundle *b, double steepest);

#endif
