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
#ifndef DSM_CORE_NOISE_PROFILE_H
#define DSM_CORE_NOISE_PROFILE_H

#include <math.h>
#include <stddef.h>

#include "core/extremes.h"
#include "core/vertices.h"

/* LV 4: half of the worst noise that this many rays can have. */
static inline double noise_ceiling(double rays) { return 0.25 / sqrt(rays); }

/* What turns sums of squared differences into squared errors, for so many rays. */
typedef struct { double variance, ceiling; } noise_scale;

static inline noise_scale noise_scale_of(double rays)
{
  return (noise_scale){rays > 1 ? 1 / (2 * rays * (rays - 1)) : 0, noise_ceiling(rays)};
}

/* The variance of the mean itself. */
static inline double noise_variance(double squares, const noise_scale *scale) { return squares * scale->variance; }

/* What the disagreement of a pixel's rays allows: half the standard error, but at least what one of the
 * disagreeing rays adds, as that ray's own step lies where chance put it; at most the ceiling. `squares` is
 * the sum of the squared differences of neighbours, `pairs` how many neighbours differ. */
static inline double noise_allowed(double squares, double pairs, const noise_scale *scale)
{
  if (!(squares > 0))
    return 0;
  /* Every disagreeing ray has two neighbours. From four such rays on, half the error is more than one ray's
   * step; the hundredth lets that step itself pass. */
  double share = pairs > 8 ? 0.5 * 0.5 : 1.01 * 1.01 / greater(1, pairs / 2), square = share * noise_variance(squares, scale);
  return square < scale->ceiling * scale->ceiling ? sqrt(square) : scale->ceiling;
}

/* Zero-initialise; a caller keeps it between pixels. Both hold from a vertex of the average to the next, or to infinity; of
 * the vertices at one depth the last tells. */
typedef struct {
  double *allowed;    /* error that is noise */
  double *variance;   /* noise_variance */
  size_t room;
} noise_profile;

/* The largest variance that lasts for a depth of thin * z + thin_at_least, or to infinity. A slanted surface, which every ray of
 * the pixel meets at another depth, is no noise that more rays would help against. */
double noise_lasting(const noise_profile *profile, const vertices *mean, double thin, double thin_at_least);

/* Room for so many vertices; what they hold is not kept. */
dsm_result noise_reserve(noise_profile *profile, size_t count);

/* Root mean square of `allowed` over the `count` vertices of the average. */
static inline double noise_rms(const noise_profile *profile, size_t count)
{
  double squares = 0;
  for (size_t i = 0; i < count; i++)
    squares += profile->allowed[i] * profile->allowed[i];
  return count ? sqrt(squares / (double)count) : 0;
}

void noise_free(noise_profile *profile);

#endif
