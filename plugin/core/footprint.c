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
  footprint f = {0, 0, 1, 0, 0};
  double trace = region->xx + region->yy;
  if (!(trace > PIXEL))   /* the usual case; false for NaN too */
    return f;
  double half = 0.5 * (region->xx - region->yy), mean = 0.5 * trace;
  double apart = sqrt(half * half + region->xy * region->xy);
  double longer = mean + apart, shorter = fmax(mean - apart, PIXEL);
  double scale = 1 + 4 * (shorter - PIXEL), rest = longer - shorter;
  if (!(longer < 1e30)) {   /* as good as infinite */
    choose_level(&f, 1e30, most);
    return f;
  }
  double length = rest > 0 ? sqrt(12 * rest) : 0;
  if (probes == 1)
    scale += 4 * fmax(0, rest);
  else {
    double finest = length / (probes - 1);
    scale = fmax(scale, finest * finest);
  }
  choose_level(&f, scale, most);
  if (probes > 1 && length > 0) {
    double pixel = sqrt(fmin(scale, ldexp(1, 2 * (int)most)));
    f.probes = (uint32_t)fmin(probes, 1 + floor(length / pixel + 0.5));
    /* n points, h apart, have the variance (n^2 - 1) h^2 / 12; no farther apart than two pixels */
    double n = f.probes, h = f.probes > 1 ? fmin(length / sqrt(n * n - 1), 2 * pixel) : 0;
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

footprint footprint_scaled(footprint f, double times, uint32_t most)
{
  double scale = times * ldexp(1 + 3 * f.coarser, 2 * (int)f.level);
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
