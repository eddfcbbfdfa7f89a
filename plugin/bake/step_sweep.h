/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A pixel that nothing but surfaces dim, as nearly all are: its average and the noise of that, in one pass.
 *
 * Each ray has a transmittance now, at first 1. The surfaces of all rays are met in order of depth; each
 * changes its ray's transmittance, hence their sum, and the two differences to the ray's neighbours, hence the
 * noise. No ray's function of depth is ever written down, and nothing is searched for: the sort is the cost.
 */
#ifndef DSM_BAKE_STEP_SWEEP_H
#define DSM_BAKE_STEP_SWEEP_H

#include "core/noise_profile.h"
#include "core/vertices.h"
#include "core/events.h"

/* All events of rays first_ray … first_ray + rays - 1, as sink_order leaves them. */
typedef struct {
  const event *surfaces;
  size_t count;
  uint32_t first_ray, rays;
  int channels;   /* 1: all are grey; only red is read, and all three are set alike */
} step_input;

/* Scratch that a caller keeps between calls; zero-initialise. */
typedef struct {
  struct depth_key *keys;
  size_t room_keys;
  double *numbers;
  size_t room_numbers;
} step_scratch;

/* Appends the average to `mean`, and writes its noise to `profile` unless that is NULL. Both are what
 * average_and_noise makes of the rays' functions, to rounding; the average is free of drift, and
 * for opaque surfaces it is exact. */
dsm_result step_sweep(const step_input *in, step_scratch *scratch, noise_profile *profile, vertices *mean);
void step_free(step_scratch *scratch);

#endif
