/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Fewer vertices within a tolerance, for one or three channels at once (LV 5.2): the greedy algorithm of LV 3.3, and
 * one that finds the fewest. */
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
/* The same, but with the fewest vertices that any such function of one channel has; up to twice as slow. It breaks
 * where it likes between the first and the last input depth, and is continuous except at tall steps. In front of
 * its first vertex it is exactly 1, so the near side of a first step from exactly 1 is not stored; behind its last
 * vertex it is level. Where the input ends at exactly 0 so does the output, at the last depth at the latest: this is
 * a condition on the functions of which the fewest vertices are found. Among the best it prefers the middle of
 * the tolerance, and the true values at tall steps.
 *
 * "The fewest" is to rounding: of the functions within a tolerance smaller by 2e-12, or by 2e-6 of it if that is
 * less. Where input or output is so steep that the rounding of a depth matters, the best break may not exist in
 * doubles, and with three channels no linear-time optimum is known: then it may be more, but never more than
 * compress_greedy gives. Below 1e-12 it is compress_greedy. Linear time, 170 bytes a vertex while it runs. */
dsm_result compress_minimal(const vertex *in, size_t count, int channels, double tolerance, vertices *out);
/* The same, where `spent` of the tolerance has gone already, or will go by rounding: the output is within the rest. A
 * step is still tall only if it is taller than the whole tolerance, as far as a line can pass it, which is twice the
 * rest; but a first step from 1 and steps to 0 are tall if they are taller than the rest. */
dsm_result compress_minimal_after(const vertex *in, size_t count, int channels, double tolerance, double spent,
                                  vertices *out);

#endif
