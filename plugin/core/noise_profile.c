/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/noise_profile.h"

#include <stdlib.h>

dsm_result noise_reserve(noise_profile *s, size_t count)
{
  if (s->room < count) {
    noise_free(s);
    size_t room = count + count / 2;
    s->allowed = malloc(room * sizeof *s->allowed);
    s->variance = malloc(room * sizeof *s->variance);
    if (!s->allowed || !s->variance) {
      noise_free(s);
      return DSM_NO_MEMORY;
    }
    s->room = room;
  }
  return DSM_OK;
}

void noise_free(noise_profile *s)
{
  free(s->allowed);
  free(s->variance);
  *s = (noise_profile){0};
}

static int is_last_of_place(const vertices *v, size_t i)
{
  return i + 1 == v->count || v->data[i + 1].z > v->data[i].z;
}

double noise_lasting(const noise_profile *profile, const vertices *mean, double thin, double thin_at_least)
{
  double most = 0;
  const vertex *v = mean->data;
  for (size_t i = 0; i < mean->count; i++) {
    if (!is_last_of_place(mean, i))
      continue;
    double least = profile->variance[i], until = v[i].z + thin * v[i].z + thin_at_least;
    for (size_t k = i + 1; k < mean->count && v[k].z < until && least > most; k++)
      if (is_last_of_place(mean, k))
        least = fmin(least, profile->variance[k]);
    most = fmax(most, least);
  }
  return most;
}
