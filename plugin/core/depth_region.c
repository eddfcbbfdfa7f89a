/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/depth_region.h"

#include <math.h>
#include <string.h>

#include "core/hash.h"
#include "core/pixel_sample.h"

static const double WIDEST = 1e9;   /* pixels; no map is as wide */

/* Also of NaN. */
static double limited(double pixels)
{
  return pixels < WIDEST ? pixels : WIDEST;
}

static double clamp(double x, double low, double high)
{
  return x < low ? low : x > high ? high : x;
}

/* The heart of RSC's figure 4: how many samples along each dimension of a box that reaches half[0], half[1] pixels. Where
 * the box has fewer pixels than there would be samples, one for each pixel; else as many as asked for, as far apart in
 * both directions. */
static void split_samples(const double half[2], const dsm_settings *settings, uint32_t counts[2])
{
  double most = settings->samples, least = settings->min_samples < most ? settings->min_samples : most, s, t;
  if (half[0] * half[1] * 4 < most) {
    s = floor(2 * half[0] + 0.5);
    t = floor(2 * half[1] + 0.5);
  }
  else {
    t = clamp(floor(sqrt(half[1] * most / half[0]) + 0.5), least, most);
    s = floor(most / t + 0.5);
  }
  counts[0] = (uint32_t)clamp(s, least, most);
  counts[1] = (uint32_t)clamp(t, least, most);
}

/* A box around the parallelogram: it does not matter how the image's pixels lie on the map. */
static void bounding_box(depth_region *r, const double footprint[2][2], const dsm_settings *settings, double half[2])
{
  for (int k = 0; k < 2; k++) {
    double width = fabs(footprint[0][k]) + fabs(footprint[1][k]);
    half[k] = limited(fmax(settings->size_factor * width, settings->min_size));
    r->sides[k][k] = 2 * half[k];
  }
}

/* The parallelogram itself, as much larger. A side that is too short grows in its own direction, or across the other one
 * if it has none. */
static void enlarged(depth_region *r, const double footprint[2][2], const dsm_settings *settings, double half[2])
{
  double length[2];
  for (int k = 0; k < 2; k++)
    length[k] = hypot(footprint[k][0], footprint[k][1]);
  for (int k = 0; k < 2; k++) {
    const double *own = footprint[k], *other = footprint[1 - k];
    double direction[2] = {k == 0, k == 1};
    half[k] = limited(fmax(settings->size_factor * length[k], settings->min_size));
    if (length[k] > 0) {
      direction[0] = own[0] / length[k];
      direction[1] = own[1] / length[k];
    }
    else if (length[1 - k] > 0) {
      direction[0] = -other[1] / length[1 - k];
      direction[1] = other[0] / length[1 - k];
    }
    for (int i = 0; i < 2; i++)
      r->sides[k][i] = 2 * half[k] * direction[i];
  }
}

depth_region depth_region_of(const double footprint[2][2], const dsm_settings *settings)
{
  depth_region r;
  double half[2];
  memset(&r, 0, sizeof r);
  r.pattern = settings->pattern;
  if (r.pattern == PATTERN_INSIDE)
    enlarged(&r, footprint, settings, half);
  else
    bounding_box(&r, footprint, settings, half);
  split_samples(half, settings, r.counts);
  return r;
}

/* In [0,1). */
static double unit(uint32_t bits)
{
  return bits * 0x1p-32;
}

/* In [-1/2,1/2], where in the region's side. RSC's figure 4 has Rand() for a place in a part as for a bias, which would leave
 * three quarters of each part alone; their figure 3 shows samples all over it. */
static double along_side(const depth_region *r, uint32_t index, uint32_t count, double random)
{
  switch (r->pattern) {
    case PATTERN_UNIFORM:
      return random - 0.5;
    case PATTERN_GAUSSIAN:
      return 0.5 * pixel_filter_inverse(FILTER_GAUSSIAN, random);
    default:
      return (index + random) / count - 0.5;
  }
}

depth_sample depth_region_sample(const depth_region *r, uint64_t seed, uint32_t index)
{
  uint64_t place = hash_mix(seed + (2 * (uint64_t)index + 1) * 0x9e3779b97f4a7c15u);
  uint64_t bias = hash_mix(seed + (2 * (uint64_t)index + 2) * 0x9e3779b97f4a7c15u);
  double a = along_side(r, index / r->counts[1], r->counts[0], unit((uint32_t)place));
  double b = along_side(r, index % r->counts[1], r->counts[1], unit((uint32_t)(place >> 32)));
  return (depth_sample){a * r->sides[0][0] + b * r->sides[1][0], a * r->sides[0][1] + b * r->sides[1][1],
                        unit((uint32_t)(bias >> 32))};
}

uint64_t depth_region_seed(const double point[3])
{
  uint64_t seed = 0x5851f42d4c957f2du;
  for (int i = 0; i < 3; i++) {
    double x = point[i] + 0.0;   /* there are two zeros */
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    seed = hash_mix(seed ^ bits) + 0x9e3779b97f4a7c15u;
  }
  return seed;
}
