/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The visibility function of a pixel: the weighted average of its rays' transmittance functions (LV 5.1). */
#ifndef DSM_CORE_AVERAGE_H
#define DSM_CORE_AVERAGE_H

#include <stdint.h>

#include "core/noise_profile.h"
#include "core/vertices.h"

/* Function i is all[first[i]] … all[first[i+1]-1], with weight weights[i] >= 0; the weights add up to 1. */
typedef struct {
  const vertex *all;
  const size_t *first;
  const double *weights;
  uint32_t count;
} average_input;

/* Scratch that a caller keeps between calls; zero-initialise. */
typedef struct {
  struct depth_key *keys;
  struct average_cursor *functions;
  double *numbers;
  size_t room_vertices, room_functions;
} average_scratch;

/* Appends the average to `out`: a sweep in O(n log n) over n vertices that carries value and slope.
 * Free of drift: after 10^6 vertices the running value is within 1e-12 of the direct sum. Vertices that
 * change neither value nor slope are left out. In [0,1]; never grows if no function does. */
dsm_result average_sweep(const average_input *in, average_scratch *scratch, vertices *out);
/* The same, and the noise of the average into profile->allowed, one number for each vertex appended. The weights are
 * equal, and the functions in the order of pixel_sample_path, so that neighbours come one after the other. 0 where
 * they agree, or for a single one. */
dsm_result average_and_noise(const average_input *in, average_scratch *scratch, noise_profile *profile, vertices *out);
void average_free(average_scratch *scratch);

#endif
