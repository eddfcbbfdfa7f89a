/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* fmin and fmax without their care for NaN, which costs a call each. For numbers that are known to be some. */
#ifndef DSM_CORE_EXTREMES_H
#define DSM_CORE_EXTREMES_H

static inline double lesser(double a, double b) { return a < b ? a : b; }
static inline double greater(double a, double b) { return a > b ? a : b; }

#endif
