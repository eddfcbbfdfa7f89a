/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Which pixels of which levels a look-up reads (LV 5.3).
 *
 * The light is wanted as the average over a region around the point: what a camera ray stands for, widened by `blur`. A
 * bilinear look-up is itself an average, of variance 4^level / 4 in pixels of the finest level (1/6 for the tent between
 * pixels, 1/12 for a pixel itself). So variances are matched:
 *
 *    .-------------------.        shorter side --> level: 4^level = 1 + 4 (variance - 1/12), between two levels
 *   /  o    o    o    o /         longer side  --> so many probes (o) along it, a pixel of that level apart
 *  '-------------------'
 *
 * A region no larger than a pixel of the finest level asks for nothing but the bilinear look-up there, which is the
 * usual case and costs nothing. The answer depends continuously on the region, but for the number of probes.
 */
#ifndef DSM_CORE_FOOTPRINT_H
#define DSM_CORE_FOOTPRINT_H

#include "core/projection.h"

#define FOOTPRINT_PROBES 8   /* at most: longer regions are read coarser */

/* Second moments of a region in pixels of the finest level. */
typedef struct { double xx, xy, yy; } spread;

typedef struct {
  uint32_t level;          /* the finer of the two levels */
  double coarser;          /* weight of level + 1, from 0 to below 1 */
  uint32_t probes;
  double step_x, step_y;   /* from one probe to the next, pixels of the finest level */
  double side_x, side_y;   /* from the middle to each of two rows of probes; 0: there is one row */
} footprint;

/* Of a square of this side. */
static inline spread spread_of_square(double side)
{
  double v = side * side / 12;
  return (spread){v, 0, v};
}

/* Adds the parallelogram with these two sides (scene units) around a point, as one face sees it there. */
void spread_add(spread *sum, const projection *p, const projected *at, const double sides[2][3]);

/* `most` is the coarsest level that may be read, `probes` how many of them there may be. */
footprint footprint_of(const spread *region, uint32_t most, uint32_t probes);

/* The same region with pixels of so many times the area. Two levels are blended only over a quarter of the way from one to the next: where
 * levels are baked for themselves, both cost. */
footprint footprint_scaled(footprint f, double times, uint32_t most);

/* The same region read at the finer of its two levels alone, by two rows of probes side by side:
 *
 *    .-------------------.      To make the coarser level of the finest costs far more than these reads, unless each of its pixels
 *   /  o    o    o    o /       is read dozens of times. A region that is too long for its probes stays as it is.
 *  /  o    o    o    o /
 * '-------------------'
 */
footprint footprint_in_rows(footprint f);

/* How many times the area the pixels that are read may have where the error aimed at is so large, 0 < accuracy < 0.5. */
double footprint_coarser(double accuracy);

/* Whether what a region asks for may be read so far away from it, pixels of the finest level. Costs next to nothing, and says so too often:
 *
 *   a footprint's pixels   1.5 * 2^(level + 1) or (1.5 + 1.3 + 0.9) * 2^level with its rows, and 4^level <= 1 + 4 * (xx + yy)
 *   its probes             half of sqrt(12 * (xx + yy)) */
static inline int footprint_may_reach(const spread *region, double distance)
{
  return !(distance > 0 && distance * distance > 28 + 170 * (region->xx + region->yy));   /* true for NaN */
}

/* Pixels of the finest level beyond which a footprint with these limits reads nothing. */
static inline double footprint_reach(uint32_t most, int stretched)
{
  return (1u << most) * (1.5 + (stretched ? FOOTPRINT_PROBES - 1 : 0));
}

#endif
