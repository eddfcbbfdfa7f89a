/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What of an axis-aligned box a face can see: the rectangle that it covers on the image plane, and its
 * depths. */
#ifndef DSM_CORE_BOX_OUTLINE_H
#define DSM_CORE_BOX_OUTLINE_H

#include "core/projection.h"

typedef struct { double u0, v0, u1, v1; } rectangle;   /* on the image plane; empty while u0 > u1 */

typedef struct {
  rectangle area;
  double near_depth, far_depth;
} outline;

#define OUTLINE_EMPTY ((outline){{INFINITY, INFINITY, -INFINITY, -INFINITY}, INFINITY, -INFINITY})

/* Grows `sum` by what of the box lies in front of the light and inside `window`. Exact for perspective up to
 * rounding; a box that touches the light covers the window. Depths are those of the whole box (perspective:
 * distances). */
void outline_add(outline *sum, const double origin[3], const frame *axes, int perspective,
                 const rectangle *window, const dsm_box *box);

/* Whether a box lies well inside what has been seen, so that neither it nor a box in it makes that any larger. Of many boxes nearly all do,
 * and need not be projected. */
int outline_holds(const outline *sum, const double origin[3], const frame *axes, int perspective, const dsm_box *box);

#endif
