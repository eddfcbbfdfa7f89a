/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Choosing a light's faces and fitting each to the casters that it sees. */
#ifndef DSM_CORE_FACE_FIT_H
#define DSM_CORE_FACE_FIT_H

#include <math.h>

#include "core/projection.h"
#include "core/settings.h"

/* Lays out the faces of a light: one over the casters for a parallel light, a spotlight up to 60 degrees
 * from its axis, and a point light that sees its casters within 60 degrees of one direction; else the six
 * of a cube, each cropped to its casters. `bounds` counts as one caster more. `resolution` counts the margin, and a
 * face never has fewer pixels than its margin and one more. The light is valid: finite numbers, unit
 * direction, boxes with low <= high. */
void face_fit(const dsm_light *light, const dsm_settings *settings, projection *out);

/* Width of `blur` in pixels of the finest level, and the coarsest level that it asks for. */
static inline double blur_pixels(const dsm_settings *settings)
{
  return settings->blur * fmax(settings->resolution[0], settings->resolution[1]);
}
uint32_t blur_level(const dsm_settings *settings);

/* The level at which a map with `accuracy` begins, from which it is refined where that is needed: of some 256 pixels along a
 * face. What its pixels do not show is never found. 0: all is baked at the finest level. */
uint32_t first_level(const dsm_settings *settings);

#endif
