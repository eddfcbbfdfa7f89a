/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * How noisy a pixel's average is, depth by depth.
 *
 * Rays are stratified, so their spread would overrate the error of their mean by far where the scene is
 * smooth (LV 2). The estimator is that of successive differences (Wolter, Introduction to Variance
 * Estimation, 8.2): along a path through neighbouring strata, half the sum of squared differences over N (N -
 * 1). For an edge it has the right rate, N^-3/2, as only neighbours that the edge parts count; in a gradient
 * it overrates by a constant; and it is not 0 wherever any two rays disagree.
 */
#ifndef DSM_BAKE_NOISE_PROFILE_H
#define DSM_BAKE_NOISE_PROFILE_H

#include <math.h>

#include "core/average.h"

/* LV 4: half of the worst noise that this many rays can have. */
static inline double noise_ceiling(double rays) { return 0.25 / sqrt(rays); }

/* Zero-initialise; a caller keeps it between pixels. */
typedef struct {
  double *allowed;   /* error that is noise, from a vertex of the average to the next, or to infinity */
  double *pairs;     /* scratch */
  size_t room;
} noise_profile;

/* Measures `in` (equal weights), whose average is `mean`, into profile->allowed, one number a vertex: half
 * the standard error, but at least what one of the disagreeing rays adds, as that ray's own step lies where
 * chance put it. At most noise_ceiling. `order` is that of pixel_sample_path. 0 where the rays agree,
 * or for a single ray. */
dsm_result noise_measure(noise_profile *profile, const average_input *in, const uint32_t *order,
                         const vertices *mean);
void noise_free(noise_profile *profile);

#endif
