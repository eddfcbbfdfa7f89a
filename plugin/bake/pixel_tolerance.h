/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The automatic tolerance: how far compression may move a pixel's visibility (DESIGN.md 1).
 *
 * There is no point in preserving noise (LV 4), and none in losing what is no noise. How noisy a pixel is depends on
 * depth: between the first and the last hit of a slanted sheet of glass its rays disagree, before and behind it they do
 * not. So the standard error is measured between any two depths of the average, and what counts is its root
 * mean square over depth; but where light is left behind everything, no more than the noise there, for most
 * receivers lie there. (Where none is left, compression ends at exactly 0.) The largest over depth would let a
 * sheet of glass bend the plateaus around it; the last alone would keep all of the noise of hair on a head.
 *
 * Rays are stratified, so their spread would overrate the error by far where the scene is smooth (LV 2). The
 * estimator is that of collapsed strata (Cochran, Sampling Techniques, 5A.12): over pairs of neighbouring strata, the
 * variance of the mean is at most the sum of squared differences over N^2. For an edge it has the right rate, N^-3/2,
 * as only pairs that the edge parts count; in a gradient it overrates by a constant.
 */
#ifndef DSM_BAKE_PIXEL_TOLERANCE_H
#define DSM_BAKE_PIXEL_TOLERANCE_H

#include "core/average.h"

/* Scratch that a caller keeps between pixels; zero-initialise. */
typedef struct {
  double *variance;     /* between a vertex and the next */
  double *pairs;        /* that differ there */
  size_t room;
} tolerance_scratch;

/* Measures `in` (equal weights), whose average is `mean`. `order` is that of pixel_sample_pairs. *tolerance is from
 * `least` to LV's 0.25/sqrt(N); `least` for a single ray, of which nothing is known. */
dsm_result pixel_tolerance(const average_input *in, const uint32_t *order, const vertices *mean, double least,
                           tolerance_scratch *scratch, double *tolerance);
void tolerance_free(tolerance_scratch *scratch);

#endif
