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
static void settle_edge_on(receiver_plane *plane)
{
  if (fabs(plane->slope_u) >= STEEPEST || fabs(plane->slope_v) >= STEEPEST) {
    plane->slope_u = plane->slope_v = 0;
    plane->reach = plane->middle = STEEPEST;
  }
}

/* nu u + nv v + nz z = d: depth falls by nu/nz a unit of u. */
static void see_parallel(const face *f, double nu, double nv, double nz, double half, receiver_plane *plane)
{
  plane->slope_u = quotient(nu * f->pixel_u, nz);
  plane->slope_v = quotient(nv * f->pixel_v, nz);
  plane->reach = half * (fabs(plane->slope_u) + fabs(plane->slope_v));
  plane->middle = 0.25 * plane->reach;
}

/* Along the unit direction w through tangents (u, v) the plane lies at depth d / (n·w), where d = n·(point - light).
 * g = n·w = m / len, m = nu u + nv v + nz, len = |(u, v, 1)|. Relative to its value at the point it grows by the
 * gradient of g over g, which is nu / m - u / len^2 a unit of u. The sign of d cancels. The second derivatives of g
 * stay below 1: half of that, relative to g, bounds the second order. */
static void see_perspective(const face *f, const projected *at, double nu, double nv, double nz, const receiver_region *region,
                            receiver_plane *plane)
{
  double len = at->depth * at->nearness, len2 = len * len, m = nu * at->u + nv * at->v + nz;
  plane->slope_u = quotient((nu * len2 - m * at->u) * f->pixel_u, m * len2);
  plane->slope_v = quotient((nv * len2 - m * at->v) * f->pixel_v, m * len2);
  double pixel = fmax(f->pixel_u, f->pixel_v), far_corner = region->farthest + region->half;
  double slope = region->half * (fabs(plane->slope_u) + fabs(plane->slope_v));
  double curve = quotient(pixel * pixel * far_corner * far_corner * len, fabs(m));
  plane->reach = slope + curve;
  plane->middle = 0.25 * slope + curve;
  plane->depth = at->depth;
}

void receiver_plane_seen(const projection *p, const projected *at, const dsm_plane *bound, const receiver_region *region, double bias,
                         receiver_plane *plane)
{
  *plane = (receiver_plane){0, 0, 0, 0, 0, 0};
  if (bias >= 0) {
    plane->constant = bias;
    return;
  }
  plane->constant = bound->rise > 0 ? bound->rise : 0;
  const face *f = &p->faces[at->face];
  double nu = dot(bound->normal, f->axes.right), nv = dot(bound->normal, f->axes.up), nz = dot(bound->normal, f->axes.forward);
  if (p->perspective)
    see_perspective(f, at, nu, nv, nz, region, plane);
  else
    see_parallel(f, nu, nv, nz, region->half, plane);
  settle_edge_on(plane);
}
