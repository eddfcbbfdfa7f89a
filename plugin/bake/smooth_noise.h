/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The automatic tolerance: compression by what is noise and nothing else.
 *
 *   1 ---------.            There is no point in preserving noise (LV 4), and none in losing what is no
 *      calm    |_  noisy    noise. The rays of a pixel meet a slanted sheet of glass at as many depths as
 *                |_         there are rays: a staircase, of which each step is chance. Before and behind it
 *                  |_____   they agree. One tolerance for the whole pixel would either bend the plateaus or
 *                    calm   keep the staircase, so the stretches where rays disagree are compressed first,
 *                           each by its own noise and with its ends held; then the whole, by `least`.
 */
#ifndef DSM_BAKE_SMOOTH_NOISE_H
#define DSM_BAKE_SMOOTH_NOISE_H

#include "core/noise_profile.h"
#include "core/vertices.h"

typedef struct {
  double least;           /* the tolerance where there is no noise */
  double most;            /* noise_ceiling */
  /* A stretch no longer than thin * depth + thin_at_least is one slanted surface as a pixel sees it.
   * Nothing else lies in it, and the surface itself is read in front of it: `most` is allowed. */
  double thin, thin_at_least;
} noise_limits;

/* Appends `mean` to `out`, its noisy stretches simplified: within the root mean square over depth of the
 * stretch's `profile->allowed`, or within `most` where it is thin. Where noise never ends, not beyond what
 * it is at the end. Never grows if the mean does not. `scratch` is overwritten. *compressed: all of it is one such stretch, of which
 * another compression within `least` would make little less. */
dsm_result smooth_noise(const vertices *mean, const noise_profile *profile, int channels,
                        const noise_limits *limits, vertices *scratch, vertices *out, int *compressed);

#endif
