/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Where the rays of a pixel go (LV 3.2).
 *
 * The points are the first `count` of a two-dimensional Sobol' sequence with nested uniform (Owen)
 * scrambling, a different one a pixel. Whatever `count` is, the unit square's dyadic boxes hold their share
 * of it: at 16 points every cell of a 4 x 4 grid, every column of 16 and every row of 16 holds one. An edge
 * then has the error of jittered sampling, O(N^-3/4), an axis-aligned one and smooth smoke less; `count` need
 * not be a square; and no table is kept. Filters are sampled by their density (inverse of the distribution
 * function in x and y), so that all rays weigh 1/count and none is spent where the filter hardly counts.
 */
#ifndef DSM_CORE_PIXEL_SAMPLE_H
#define DSM_CORE_PIXEL_SAMPLE_H

#include "core/settings.h"

typedef struct { filter_kind kind; double width; } pixel_filter;   /* full width of the support in map pixels */
typedef struct { uint32_t x, y; } pixel_seed;
typedef struct { uint32_t x, y; } pixel_point;   /* of the sequence before scrambling, bits reversed */

/* The first `count` points, in the order of a path through the strata: neighbours share a small dyadic box, in
 * every pixel, as scrambling maps dyadic boxes to dyadic boxes. Their differences measure a pixel's sampling
 * error. */
void pixel_sample_path(uint32_t count, pixel_point *path);

pixel_seed pixel_sample_seed(uint32_t face, uint32_t x, uint32_t y);
/* Offsets of points from the pixel's centre in map pixels, within ± width/2. */
void pixel_sample_offsets(const pixel_filter *filter, pixel_seed seed, const pixel_point *points, uint32_t count,
                          double (*offsets)[2]);

/* A filter's inverse distribution function on a support of ±1, for u in [0,1]. */
double pixel_filter_inverse(filter_kind kind, double u);

#endif
