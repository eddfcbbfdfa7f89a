/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/footprint.h"

#include <math.h>

static const double PIXEL = 1.0 / 12;   /* variance of a pixel of the finest level, as of any side of length 1 */

/* Of footprint_scaled: the coarser level has taken over when the area has grown by three quarters. */
static const double BLEND = 4;

/* The error that an edge leaves in an image pixel goes with the 3/2 power of a map pixel's width. COARSER is measured, with 3 x 3 camera
 * rays in an image pixel. */
static const double COARSER = 1020, MOST_COARSER = 16;

double footprint_coarser(double accuracy)
{
  return fmin(MOST_COARSER, COARSER * pow(accuracy, 4.0 / 3));
}

/* As fmax, but for NaN: a few instructions in place of a call. */
static double larger(double a, double b)
{
  return a > b ? a : b;
}

/* sqrt(n^2 - 1): n points, 1 apart, have this squared over 12 as their variance. */
static const double EXTENT[FOOTPRINT_PROBES + 1] = {
  0, 0, 1.7320508075688772, 2.8284271247461903, 3.872983346207417, 4.898979485566356, 5.916079783099616, 6.928203230275509, 7.937253933193772
};

void spread_add(spread *sum, const projection *p, const projected *at, const double sides[2][3])
{
  const face *f = &p->faces[at->face];
  for (int i = 0; i < 2; i++) {
    double s[2];
    projection_side(p, at, sides[i], s);
    double x = s[0] * f->per_u, y = s[1] * f->per_v;
    sum->xx += x * x * PIXEL;
    sum->xy += x * y * PIXEL;
    sum->yy += y * y * PIXEL;
  }
}

/* Splits 4^level = `scale` into a level and the share of the next, by variance. */
static void choose_level(footprint *f, double scale, uint32_t most)
{
  double here = 1;
  while (f->level < most && scale >= 4 * here) {
    here *= 4;
    f->level++;
  }
  if (f->level < most && scale > here)
    f->coarser = (scale - here) / (3 * here);
}

footprint footprint_of(const spread *region, uint32_t most, uint32_t probes)
{
  footprint f = {0, 0, 1, 0, 0, 0, 0};
  double trace = region->xx + region->yy;
  if (!(trace > PIXEL))   /* the usual case; false for NaN too */
    return f;
  double half = 0.5 * (region->xx - region->yy), mean = 0.5 * trace;
  double apart = sqrt(half * half + region->xy * region->xy);
  double longer = mean + apart, shorter = larger(mean - apart, PIXEL);
  double scale = 1 + 4 * (shorter - PIXEL), rest = longer - shorter;
  if (!(longer < 1e30)) {   /* as good as infinite */
    choose_level(&f, 1e30, most);
    return f;
  }
  double length = rest > 0 ? sqrt(12 * rest) : 0;
  if (probes == 1)
    scale += 4 * larger(rest, 0);
  else {
    double finest = length / (probes - 1);
    scale = larger(scale, finest * finest);
  }
  choose_level(&f, scale, most);
  if (probes > 1 && length > 0) {
    double coarsest = (double)(1ull << 2 * most), pixel = sqrt(scale < coarsest ? scale : coarsest), pixels = length / pixel + 0.5;
    f.probes = pixels < probes - 1 ? 1 + (uint32_t)pixels : probes;
    double h = f.probes > 1 ? length / EXTENT[f.probes] : 0;
    if (h > 2 * pixel)   /* no farther apart */
      h = 2 * pixel;
    /* the longer axis: the larger of two ways to write the eigenvector */
    double x = half >= 0 ? half + apart : region->xy, y = half >= 0 ? region->xy : apart - half;
    double norm = sqrt(x * x + y * y);
    if (f.probes > 1 && norm > 0) {
      f.step_x = h * x / norm;
      f.step_y = h * y / norm;
    }
  }
  return f;
}

footprint footprint_in_rows(footprint f)
{
  if (!(f.coarser > 0))
    return f;
  /* pixels of the coarser level have three quarters of a finer one's area more variance along each axis */
  double pixel = (double)(1u << f.level), more = 0.75 * f.coarser * pixel * pixel;
  double h = sqrt(f.step_x * f.step_x + f.step_y * f.step_y), x = h > 0 ? f.step_x / h : 1, y = h > 0 ? f.step_y / h : 0;
  uint32_t probes = f.probes > 1 ? f.probes : 2;
  double covered = h * EXTENT[f.probes], step = sqrt(covered * covered + 12 * more) / EXTENT[probes], side = sqrt(more);
  return step > 2 * pixel ? f : (footprint){f.level, 0, probes, step * x, step * y, -side * y, side * x};
}

footprint footprint_scaled(footprint f, double times, uint32_t most)
{
  double scale = times * (1 + 3 * f.coarser) * (double)(1ull << 2 * f.level);
  f.level = 0;
  f.coarser = 0;
  for (; f.level < most && scale >= 4; scale /= 4)
    f.level++;
  if (f.level < most && scale > 1) {
    f.coarser = BLEND * (scale - 1) / 3;
    if (f.coarser >= 1) {
      f.coarser = 0;
      f.level++;
    }
  }
  return f;
}
