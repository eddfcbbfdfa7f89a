/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Where in the scene the pixels of an exported image are: attributes that import finds again. */
#ifndef DSM_TOOL_IMAGE_FRAME_H
#define DSM_TOOL_IMAGE_FRAME_H

#include "store/map_header.h"
#include "tool/image_file.h"

/* Makes of a map's projection that of a map whose finest level is this level of this face, and which has no other face. */
void image_frame_of(projection *p, uint32_t face, uint32_t level);

/* The header as attributes that no program mistakes for those of a map. DSM_NO_MEMORY; free the list in any case. */
dsm_result image_frame_write(const map_header *header, attribute_list *list);

/* DSM_OK: *header is the caller's to free, and one of its faces, *face, has the image's pixels; or *found is 0: the image was
 * not exported from a map, or cropped or scaled since. DSM_REFUSED, DSM_NO_MEMORY. */
dsm_result image_frame_read(const image_reader *reader, const image_size *size, const char *path, int *found,
                            map_header *header, uint32_t *face, map_reason *why);

#endif
