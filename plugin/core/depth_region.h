/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The region of a depth map that one look-up compares, and its samples (RSC figures 3 and 4).
 *
 *        bounding box                    region itself (pattern "inside")
 *     +-----+-----+-----+               .-----.-----.-----.
 *     |  .  |    .|.    |              /   . / .   /    ./       a sample (.) in each part, at random ("jittered")
 *     +-----+-----x-----+             .-----.--x--.-----.        x: the point
 *     |    .|  .  |   . |            / .   /   . / .   /
 *     +-----+-----+-----+           '-----'-----'-----'
 *
 * Where what is shaded is w pixels wide on the map, the box reaches w * size_factor pixels to each side of the point, and
 * min_size at least: as RSC's code has it, the whole width counts for each half. There are about as many samples as asked
 * for, split over the two sides so that they are as far apart in both directions; not more than one a pixel, unless
 * min_samples asks for them.
 */
#ifndef DSM_CORE_DEPTH_REGION_H
#define DSM_CORE_DEPTH_REGION_H

#include "core/settings.h"

typedef struct {
  double sides[2][2];   /* of the parallelogram around the point, map pixels */
  uint32_t counts[2];   /* of samples along each of them, > 0 */
  sample_pattern pattern;
} depth_region;

typedef struct {
  double x, y;          /* map pixels from the point */
  double bias;          /* in [0,1): from the first bound to the second */
} depth_sample;

/* `footprint`: two sides of a parallelogram, map pixels, finite. Regions are at most 2e9 pixels wide. */
depth_region depth_region_of(const double footprint[2][2], const dsm_settings *settings);

static inline uint32_t depth_region_samples(const depth_region *region)
{
  return region->counts[0] * region->counts[1];
}

/* Sample `index` of those. Another seed gives others. */
depth_sample depth_region_sample(const depth_region *region, uint64_t seed, uint32_t index);

/* The seed of a point: the same point has the same samples, whoever asks, and whenever. */
uint64_t depth_region_seed(const double point[3]);

#endif
