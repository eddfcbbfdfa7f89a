/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A clock for statistics; nothing that is computed depends on it. */
#ifndef DSM_BAKE_SECONDS_H
#define DSM_BAKE_SECONDS_H

#include <time.h>

static inline double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
