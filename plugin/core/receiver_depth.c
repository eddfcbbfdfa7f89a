/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/receiver_depth.h"

#include <math.h>

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Steeper than this a plane counts as running through the light. Keeps numbers finite: infinity times an
 * offset of 0 would be NaN. */
static const double STEEPEST = 1e30;

static double quotient(double a, double b)
{
  double q = a / b;
  return q > STEEPEST ? STEEPEST : q < -STEEPEST ? -STEEPEST : q == q ? q : 0;
}

/* A plane through the light has no slope that could be added up: it is in front of everything, everywhere. */
static receiver_plane if_edge_on(receiver_plane plane)
{
  if (fabs(plane.slope_u) >= STEEPEST || fabs(plane.slope_v) >= STEEPEST) {
    plane.slope_u = plane.slope_v = 0;
    plane.reach = plane.middle = STEEPEST;
  }
  return plane;
}

receiver_plane receiver_plane_seen(const projection *p, const projected *at, const dsm_plane *bound,
                                   const receiver_region *region, double bias)
{
  receiver_plane plane = {0, 0, 0, 0, 0, 0};
  const face *f = &p->faces[at->face];
  const double *normal = bound->normal, half = region->half;
  if (bias >= 0) {
    plane.constant = bias;
    return plane;
  }
  plane.constant = bound->rise > 0 ? bound->rise : 0;
  double nu = dot(normal, f->axes.right), nv = dot(normal, f->axes.up), nz = dot(normal, f->axes.forward);
  if (!p->perspective) {
    /* nu u + nv v + nz z = d: depth falls by nu/nz a unit of u */
    plane.slope_u = quotient(nu * f->pixel_u, nz);
    plane.slope_v = quotient(nv * f->pixel_v, nz);
    plane.reach = half * (fabs(plane.slope_u) + fabs(plane.slope_v));
    plane.middle = 0.25 * plane.reach;
    return if_edge_on(plane);
  }
  /* Along the unit direction w through tangents (u, v) the plane lies at depth d / (n·w), where d = n·(point - light).
   * g = n·w = m / len, m = nu u + nv v + nz, len = |(u, v, 1)|. Relative to its value at the point it grows by the
   * gradient of g over g. The sign of d cancels. The second derivatives of g
   * stay below 1: half of that, relative to g, bounds the second order. */
  double len2 = at->u * at->u + at->v * at->v + 1, len = sqrt(len2);
  double m = nu * at->u + nv * at->v + nz, g = m / len;
  plane.slope_u = quotient((nu - m * at->u / len2) / len * f->pixel_u, g);
  plane.slope_v = quotient((nv - m * at->v / len2) / len * f->pixel_v, g);
  double pixel = fmax(f->pixel_u, f->pixel_v), far_corner = region->farthest + half;
  double slope = half * (fabs(plane.slope_u) + fabs(plane.slope_v));
  double curve = quotient(0.5 * pixel * pixel * 2 * far_corner * far_corner, fabs(g));
  plane.reach = slope + curve;
  plane.middle = 0.25 * slope + curve;
  plane.depth = at->depth;
  return if_edge_on(plane);
}
