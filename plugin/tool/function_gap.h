/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* How far two visibility functions are from each other. */
#ifndef DSM_TOOL_FUNCTION_GAP_H
#define DSM_TOOL_FUNCTION_GAP_H

#include "core/vertices.h"

typedef struct {
  double largest;   /* difference, over all depths and channels */
  double squares;   /* integral of the squared difference from near_depth to far_depth, mean of the channels; scene units */
} function_gap;

/* Exact but for rounding: between neighbouring vertices of either, the difference is linear. */
function_gap function_gap_of(const vertex *a, size_t a_count, const vertex *b, size_t b_count, double near_depth,
                             double far_depth);

#endif
