/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Fewer vertices within a tolerance: the greedy algorithm of LV 3.3, for one or three channels at once
 * (LV 5.2). */
#ifndef DSM_CORE_COMPRESS_H
#define DSM_CORE_COMPRESS_H

#include "core/vertices.h"

/* Appends to `out` a function within `tolerance` of the input at every depth, in each of `channels` (1: only
 * red is read, and all three are set alike). Steps taller than the tolerance stay steps at their exact
 * depth; output depths are input depths; output stays in [0,1] and, if the input never grows, never grows.
 * Tolerance 0 merges only vertices that lie exactly on a line. One pass, constant state. A function that is
 * 1 to the tolerance gives no vertex; one that ends at 0 ends at exactly 0. "Within" is to rounding, a few
 * 1e-16. */
dsm_result compress_greedy(const vertex *in, size_t count, int channels, double tolerance, vertices *out);

#endif
