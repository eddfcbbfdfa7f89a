/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/step_sweep.h"

#include <stdlib.h>
#include <string.h>

#include "core/compensated.h"
#include "core/depth_sort.h"
#include "core/transmittance.h"

typedef struct {
  double *now;           /* transmittance of each ray behind the depths met so far: a number a channel */
  uint32_t rays;
  double share;          /* of a ray, where that is exact, as it spares a division; else 0 */
  compensated sum[3];    /* of `now`, over all rays */
  double *gaps;          /* [i]: squared difference of rays i and i + 1; NULL: the noise is not wanted */
  double squares;        /* the sum of `gaps`, */
  double pairs;          /* and how many of them are not 0 */
} sweep;

/* Each is made twice, for one channel and for three, which spares grey a third of the work. */
#define FOR_CHANNELS static inline __attribute__((always_inline))

FOR_CHANNELS void renew_gap(sweep *s, int channels, uint32_t i)
{
  const double *a = s->now + (size_t)i * channels, *b = a + channels;
  double square = 0, was = s->gaps[i];
  for (int c = 0; c < channels; c++) {
    double gap = a[c] - b[c];
    square = gap * gap > square ? gap * gap : square;
  }
  s->gaps[i] = square;
  s->squares += square - was;
  s->pairs += (square > 0) - (was > 0);
}

FOR_CHANNELS void meet(sweep *s, int channels, uint32_t ray, const rgb *transmittance)
{
  double *now = s->now + (size_t)ray * channels;
  for (int c = 0; c < channels; c++) {
    double behind = transmittance_behind(now[c], transmittance->c[c]);
    /* This difference is exact unless it is more than half, which a ray can lose forty times at most. */
    compensated_add(&s->sum[c], behind - now[c]);
    now[c] = behind;
  }
  if (s->gaps && ray > 0)
    renew_gap(s, channels, ray - 1);
  if (s->gaps && ray + 1 < s->rays)
    renew_gap(s, channels, ray);
}

/* What is dark at the end must be exactly 0. */
FOR_CHANNELS void settle_darkness(sweep *s, int channels)
{
  for (int c = 0; c < channels; c++) {
    int dark = 1;
    for (uint32_t i = 0; i < s->rays; i++)
      dark &= s->now[(size_t)i * channels + c] == 0;
    if (dark)
      s->sum[c] = (compensated){0, 0};
  }
}

/* Brings the average up to date; 1 if it has fallen. Rounding must not make it grow, nor negative. */
FOR_CHANNELS int settle(const sweep *s, int channels, rgb *mean)
{
  int fallen = 0;
  for (int c = 0; c < channels; c++) {
    double v = s->share > 0 ? compensated_total(&s->sum[c]) * s->share : compensated_total(&s->sum[c]) / s->rays;
    if (!(v < mean->c[c]))
      continue;
    mean->c[c] = v > 0 ? v : 0;
    fallen = 1;
  }
  if (channels == 1)
    *mean = rgb_grey(mean->c[0]);
  return fallen;
}

/* `mean` has room for two vertices an event. */
FOR_CHANNELS void run(sweep *s, int channels, const depth_key *keys, const step_input *in, noise_profile *profile, vertices *mean)
{
  size_t begin = mean->count;
  vertex *out = mean->data + begin;
  rgb last = rgb_grey(1);
  double noise = 0, variance = 0;
  noise_scale scale = noise_scale_of(s->rays);
  for (size_t i = 0; i < in->count;) {
    double z = keys[i].z;
    for (; i < in->count && keys[i].z == z; i++) {
      const event *surface = &in->surfaces[keys[i].index];
      meet(s, channels, surface->ray - in->first_ray, &surface->transmittance);
    }
    if (i == in->count)
      settle_darkness(s, channels);
    rgb before = last;
    if (!settle(s, channels, &last))
      continue;
    out[0] = (vertex){z, before};
    out[1] = (vertex){z, last};
    out += 2;
    if (profile) {
      size_t n = (size_t)(out - mean->data) - begin;
      profile->allowed[n - 2] = noise;
      profile->variance[n - 2] = variance;
      if (s->pairs == 0)
        s->squares = 0;   /* without the rounding of those that were */
      profile->allowed[n - 1] = noise = noise_allowed(s->squares, s->pairs, &scale);
      profile->variance[n - 1] = variance = noise_variance(s->squares, &scale);
    }
  }
  mean->count = (size_t)(out - mean->data);
}

/* So that a worker allocates but a few times. */
static dsm_result make_room(step_scratch *scratch, size_t count, size_t numbers)
{
  if (scratch->room_keys < 2 * count || scratch->room_numbers < numbers) {
    step_free(scratch);
    scratch->keys = malloc(3 * count * sizeof *scratch->keys);
    scratch->numbers = malloc(numbers * sizeof *scratch->numbers);
    if (!scratch->keys || !scratch->numbers) {
      step_free(scratch);
      return DSM_NO_MEMORY;
    }
    scratch->room_keys = 3 * count;
    scratch->room_numbers = numbers;
  }
  return DSM_OK;
}

dsm_result step_sweep(const step_input *in, step_scratch *scratch, noise_profile *profile, vertices *mean)
{
  if (in->count == 0)
    return DSM_OK;
  size_t values = (size_t)in->rays * in->channels;
  dsm_result result = make_room(scratch, in->count, values + in->rays);
  if (result == DSM_OK)
    result = vertices_reserve(mean, 2 * in->count);
  if (result == DSM_OK && profile)
    result = noise_reserve(profile, 2 * in->count);
  if (result != DSM_OK)
    return result;
  for (size_t i = 0; i < in->count; i++)
    scratch->keys[i] = (depth_key){in->surfaces[i].front, i};
  depth_sort(scratch->keys, in->count, scratch->keys + in->count);

  sweep s = {.now = scratch->numbers, .rays = in->rays, .share = in->rays & (in->rays - 1) ? 0 : 1.0 / in->rays};
  for (size_t i = 0; i < values; i++)
    s.now[i] = 1;
  if (profile) {
    s.gaps = s.now + values;
    memset(s.gaps, 0, s.rays * sizeof *s.gaps);
  }
  for (int c = 0; c < in->channels; c++)
    s.sum[c].sum = s.rays;
  if (in->channels == 1)
    run(&s, 1, scratch->keys, in, profile, mean);
  else
    run(&s, 3, scratch->keys, in, profile, mean);
  return DSM_OK;
}

void step_free(step_scratch *scratch)
{
  free(scratch->keys);
  free(scratch->numbers);
  *scratch = (step_scratch){0};
}
