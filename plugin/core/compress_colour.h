/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Three channels with one list of depths: few vertices, but not the fewest. For compress_minimal. */
#ifndef DSM_CORE_COMPRESS_COLOUR_H
#define DSM_CORE_COMPRESS_COLOUR_H

#include "core/compress_tunnel.h"

/* Sets *lost if it finds nothing. `out` is as it was then, or if it fails. */
dsm_result compress_colour(const vertex *in, size_t count, bounds within, vertices *out, int *lost);

#endif
