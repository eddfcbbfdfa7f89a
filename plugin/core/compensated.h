/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A sum that does not drift (Neumaier 1974): it also keeps what rounding takes away. */
#ifndef DSM_CORE_COMPENSATED_H
#define DSM_CORE_COMPENSATED_H

#include <math.h>

typedef struct { double sum, lost; } compensated;

static inline void compensated_add(compensated *to, double x) {
  double sum = to->sum + x;
  to->lost += fabs(to->sum) >= fabs(x) ? (to->sum - sum) + x : (x - sum) + to->sum;
  to->sum = sum;
}

static inline double compensated_total(const compensated *of) { return of->sum + of->lost; }

#endif
