/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The bias of a look-up: how far in front of the receiver a pixel is to be read so that the receiver's own surface,
 * as the pixel's filter has seen it, is not in the way (DESIGN.md 5).
 *
 * A pixel's rays meet the receiver's plane at many depths. Read at the point's own depth, the pixel would count those
 * in front of it as shadow (acne); read in front of the least of them, it counts none. That depth follows from the
 * plane, so nothing has to be tuned: flat ground under steep light moves by nothing, at grazing light by much, where
 * the surface gets little light anyway.
 */
#ifndef DSM_CORE_RECEIVER_DEPTH_H
#define DSM_CORE_RECEIVER_DEPTH_H

#include "core/projection.h"

/* One of the receiver's planes as one face sees it around one point. Computed once a face and look-up. */
typedef struct {
  double slope_u, slope_v;   /* perspective: growth of plane's nearness (1/depth) relative to that at the point, a
                                pixel; orthographic: growth of -depth a pixel */
  double curve;              /* perspective: bound of the second order, a squared pixel */
  double depth;              /* perspective: of the point; orthographic: 0 */
  double constant;           /* scene units added to the plane's own share */
} receiver_plane;

/* `bias` is the settings': scene units in place of what the plane tells, or SETTING_AUTOMATIC. */
receiver_plane receiver_plane_seen(const projection *p, const projected *at, const dsm_plane *bound, double bias);

/* Scene units toward the light at which a pixel is to be read, given the offset of its centre from the point and
 * the half width of its footprint, both in pixels. >= 0; infinite where the plane runs through the light. */
static inline double receiver_bias(const receiver_plane *plane, double du, double dv, double half)
{
  double across = (du < 0 ? -du : du) + half, up = (dv < 0 ? -dv : dv) + half;
  double slope_u = plane->slope_u < 0 ? -plane->slope_u : plane->slope_u;
  double slope_v = plane->slope_v < 0 ? -plane->slope_v : plane->slope_v;
  double rise = plane->slope_u * du + slope_u * half + plane->slope_v * dv + slope_v * half
              + plane->curve * (across * across + up * up);
  rise = rise > 0 ? rise : 0;
  /* nearness 1 + rise means depth / (1 + rise) */
  double own = plane->depth > 0 ? plane->depth * rise / (1 + rise) : rise;
  return own + plane->constant;
}

#endif
