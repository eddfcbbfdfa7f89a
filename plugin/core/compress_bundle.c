/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/compress_bundle.h"
#include "core/extremes.h"

#include <assert.h>
#include <math.h>

void bundle_begin(bundle *b, int level) {
  b->level = level;
  b->floor = (chain){b->floor_room, b->floor_room};
  b->roof = (chain){b->roof_room, b->roof_room};
  /* So that they are infinitely high and low at every depth. */
  b->rise.line = (line){{-HUGE_VAL, 0}, HUGE_VAL};
  b->fall.line = (line){{-HUGE_VAL, 0}, -HUGE_VAL};
  b->start = b->end = -HUGE_VAL;
}

void bundle_begin_at(bundle *b, double z, double low, double high) {
  point bottom = {z, low}, top = {z, high};
  bundle_begin(b, 0);
  b->start = b->end = z;
  if (high < HUGE_VAL) {
    b->rise.support = top;
    *b->roof.end++ = top;
  }
  if (low > -HUGE_VAL) {
    b->fall.support = bottom;
    *b->floor.end++ = bottom;
  }
}

/* Below, `side` is 1 for the rise, the floor and all that is seen from above, and -1 for their mirror images. */

/* Turns a line inwards, to pass p; `chain` is what supports it on the left. */
static inline void turn(tangent *t, chain *chain, point p, int side, int level) {
  t->support = p;
  if (level) {
    t->line = (line){p, 0};
    return;
  }
  point *a = chain->first, *end = chain->end;
  if (a == end) return;
  /* The next support is tighter if the line through it is flatter. */
  while (a + 1 < end && a[1].z < p.z &&
         side * (p.y - a[1].y) * (p.z - a->z) <= side * (p.y - a->y) * (p.z - a[1].z))
    ++a;
  chain->first = a;
  if (p.z > a->z) t->line = (line){*a, (p.y - a->y) / (p.z - a->z)};   /* else nothing holds it still */
}

static inline void push(chain *chain, point p, int side) {
  point *end = chain->end;
  while (end - chain->first > 1) {
    const point *b = end - 1, *a = b - 1;
    if (side * (b->y - a->y) * (p.z - a->z) > side * (p.y - a->y) * (b->z - a->z)) break;
    --end;
  }
  *end = p;
  chain->end = end + 1;
}

int bundle_narrow(bundle *b, double z, double low, double high, double fall, double rise) {
  if (low > rise || high < fall) return 0;
  point bottom = {z, low}, top = {z, high};
  int lowers = high < rise, raises = low > fall;
  if (lowers) turn(&b->rise, &b->floor, top, 1, b->level);
  if (raises) turn(&b->fall, &b->roof, bottom, -1, b->level);
  /* An end that touches no line now touches none later. */
  if (lowers && !b->level) push(&b->roof, top, -1);
  if (raises && !b->level) push(&b->floor, bottom, 1);
  if (b->start == -HUGE_VAL) b->start = z;
  return 1;
}

void bundle_heights(const bundle *b, double slope, double z, double *low, double *high) {
  double bottom = -HUGE_VAL, top = HUGE_VAL;
  for (const point *p = b->floor.first; p < b->floor.end; ++p) bottom = greater(bottom, p->y + slope * (z - p->z));
  for (const point *p = b->roof.first; p < b->roof.end; ++p) top = lesser(top, p->y + slope * (z - p->z));
  *low = bottom;
  *high = top;
}

line bundle_middle(const bundle *b, double steepest) {
  assert(b->floor.first < b->floor.end && b->roof.first < b->roof.end);
  double low = b->fall.line.slope, high = lesser(b->rise.line.slope, steepest);
  /* Where nothing holds one side, a turn by the whole range of values is far enough. */
  double far = b->end > b->start ? 1 / (b->end - b->start) : 1;
  if (low == -HUGE_VAL) low = (high == HUGE_VAL ? 0 : high) - far;
  if (high == HUGE_VAL) high = low + far;
  double slope = lesser(low + (high - low) / 2, high), z = b->floor.first->z, bottom, top;
  bundle_heights(b, slope, z, &bottom, &top);
  return (line){{z, bottom + (top - bottom) / 2}, slope};
}
