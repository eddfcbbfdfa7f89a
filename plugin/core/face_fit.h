/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Choosing a light's faces and fitting each to the casters that it sees. */
#ifndef DSM_CORE_FACE_FIT_H
#define DSM_CORE_FACE_FIT_H

#include "core/projection.h"

/* Lays out the faces of a light: one over the casters for a parallel light, a spotlight up to 60 degrees
 * from its axis, and a point light that sees its casters within 60 degrees of one direction; else the six
 * of a cube, each cropped to its casters. `resolution` is as in settings.h; it counts the margin, and a
 * face never has fewer pixels than its margin and one more. `filter_width` is the full width of a pixel's
 * filter in pixels. The light is valid: finite numbers, unit direction, boxes with low <= high. */
void face_fit(const dsm_light *light, const uint32_t resolution[2], double filter_width, projection *out);

#endif
