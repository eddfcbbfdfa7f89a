/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The bias of a look-up: how far in front of the receiver a pixel is to be read so that the receiver's own
 * surface, as the pixel's filter has seen it, is not in the way.
 *
 * A pixel's rays meet the receiver's plane at many depths. Read at the point's own depth, the pixel would
 * count those in front of it as shadow (acne); read in front of the least of them, it counts none. That depth
 * follows from the plane, so nothing has to be tuned: flat ground under steep light moves by nothing, at
 * grazing light by much, where the surface gets little light anyway.
 */
#ifndef DSM_CORE_RECEIVER_DEPTH_H
#define DSM_CORE_RECEIVER_DEPTH_H

#include "core/projection.h"

/* One of the receiver's planes as one face sees it around one point, for the pixels of one level. Computed once a face, level
 * and look-up. All pixels are those of the finest level. */
typedef struct {
  double slope_u, slope_v;   /* perspective: growth of the plane's nearness (1/depth) relative to that at the point, a
                                pixel; orthographic: growth of nearness (-depth) a pixel */
  double reach;              /* the same, from a pixel's centre to the nearest corner of its footprint, and the bound
                                of the second order */
  double middle;             /* the same, to a quarter of the way */
  double depth;              /* perspective: of the point; orthographic: 0 */
  double constant;           /* scene units added to the plane's own share */
} receiver_plane;

/* How far around its centre a pixel has seen the scene, and how far from the point pixels are read, in each direction. */
typedef struct { double half, farthest; } receiver_region;

/* `bias` is the settings': scene units in place of what the plane tells, or SETTING_AUTOMATIC. */
void receiver_plane_seen(const projection *p, const projected *at, const dsm_plane *bound, const receiver_region *region, double bias,
                         receiver_plane *plane);

/* A rise of nearness in scene units toward the light. Nearness 1 + rise means depth / (1 + rise). */
static inline double receiver_units(const receiver_plane *plane, double rise)
{
  rise = rise > 0 ? rise : 0;
  return plane->depth > 0 ? plane->depth * (rise / (1 + rise)) : rise;
}

/* Scene units toward the light at which a pixel is to be read, given the offset of its centre from the point in pixels.
 * >= 0; the whole depth where the plane runs through the light. */
static inline double receiver_bias(const receiver_plane *plane, double du, double dv)
{
  return receiver_units(plane, plane->slope_u * du + plane->slope_v * dv + plane->reach) + plane->constant;
}

/* Likewise, where about two thirds of the plane, as the pixel's filter sees it, lie behind. */
static inline double receiver_middle(const receiver_plane *plane, double du, double dv)
{
  return receiver_units(plane, plane->slope_u * du + plane->slope_v * dv + plane->middle);
}

#endif
