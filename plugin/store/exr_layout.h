/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The layout of an OpenEXR file of several tiled parts, checked before OpenEXR sees it: OpenEXR 3.1 takes the lengths that a file
 * gives on trust, and asks for gigabytes if a few bytes are damaged.
 *
 *   magic | version | header of part 0: attributes | header of part 1 … | where each tile is, part by part | tiles
 *
 * Only lengths and places are checked here, against the size of the file and one another; what they hold is not.
 */
#ifndef DSM_STORE_EXR_LAYOUT_H
#define DSM_STORE_EXR_LAYOUT_H

#include <stdint.h>

#include "dsm.h"

typedef struct exr_layout exr_layout;

/* DSM_OK: *out is the layout of a file that has one. DSM_REFUSED: a length or a place is wrong, or the file cannot be read.
 * DSM_NO_MEMORY. */
dsm_result exr_layout_open(const char *path, exr_layout **out);
void exr_layout_close(exr_layout *layout);   /* may be NULL */

/* [any] Whether tile (x, y) of a part lies in the file and takes no more memory than its bytes can fill. */
int exr_layout_tile(const exr_layout *layout, uint32_t part, uint32_t x, uint32_t y);
/* [any] Bytes of the file that a part's tiles take, and what says where they are; of those tiles that are where they should be. */
uint64_t exr_layout_bytes(const exr_layout *layout, uint32_t part);

#endif
