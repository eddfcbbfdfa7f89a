/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Compression for values that are stored in a few bits. */
#ifndef DSM_CORE_COMPRESS_LATTICE_H
#define DSM_CORE_COMPRESS_LATTICE_H

#include <stdint.h>

#include "core/vertices.h"

/* As compress_minimal_after, where values are to be rounded to multiples of 1 / (2^value_bits - 1) by whoever stores them: then it is
 * still within the tolerance, apart from what is `spent` on other things. No more vertices, to rounding as there, than compression that
 * leaves room for any rounding of values has, and mostly fewer, as most values are such multiples already: vertices stand where segments
 * cross those. Colours, and values of VALUE_BITS, are left to compress_minimal_after with that room. Linear time, 1.3 times as long
 * as that (measured: hair). */
dsm_result compress_rounded(const vertex *in, size_t count, int channels, double tolerance, double spent, uint32_t value_bits,
                            vertices *out);

#endif
