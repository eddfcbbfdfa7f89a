/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/noise_profile.h"

#include <stdlib.h>

dsm_result noise_reserve(noise_profile *s, size_t count)
{
  if (s->room < count) {
    noise_free(s);
    size_t room = count + count / 2;
    s->allowed = malloc(room * sizeof *s->allowed);
    if (!s->allowed)
      return DSM_NO_MEMORY;
    s->room = room;
  }
  return DSM_OK;
}

void noise_free(noise_profile *s)
{
  free(s->allowed);
  *s = (noise_profile){0};
}
