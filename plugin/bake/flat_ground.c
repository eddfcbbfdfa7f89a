/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/flat_ground.h"

#include <math.h>

enum { FEWEST = 4 };   /* three lie on a plane always */

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* What is linear over the face where light ends on a plane, and back. */
static double linear_of(const projection *p, double u, double v, double depth)
{
  return p->perspective ? sqrt(1 + u * u + v * v) / depth : depth;
}

ground_hit ground_hit_of(const projection *p, uint32_t face_index, const dsm_ray *ray, double depth)
{
  const frame *axes = &p->faces[face_index].axes;
  if (p->perspective) {
    double along = dot(ray->direction, axes->forward);
    return (ground_hit){dot(ray->direction, axes->right) / along, dot(ray->direction, axes->up) / along, depth};
  }
  double from[3] = {ray->origin[0] - p->origin[0], ray->origin[1] - p->origin[1], ray->origin[2] - p->origin[2]};
  return (ground_hit){dot(from, axes->right), dot(from, axes->up), depth};
}

double ground_depth(const flat_ground *g, const projection *p, double u, double v)
{
  double linear = g->at + g->per_u * u + g->per_v * v;
  return p->perspective ? sqrt(1 + u * u + v * v) / linear : linear;
}

/* Least squares about the mean, where the normal equations are two. */
static flat_ground fit(const projection *p, const ground_hit *hits, uint32_t count)
{
  double u = 0, v = 0, w = 0, uu = 0, uv = 0, vv = 0, uw = 0, vw = 0;
  for (uint32_t i = 0; i < count; i++) {
    u += hits[i].u / count;
    v += hits[i].v / count;
    w += linear_of(p, hits[i].u, hits[i].v, hits[i].depth) / count;
  }
  for (uint32_t i = 0; i < count; i++) {
    double du = hits[i].u - u, dv = hits[i].v - v, dw = linear_of(p, hits[i].u, hits[i].v, hits[i].depth) - w;
    uu += du * du;
    uv += du * dv;
    vv += dv * dv;
    uw += du * dw;
    vw += dv * dw;
  }
  double divisor = uu * vv - uv * uv;
  if (!(divisor > 0))
    return (flat_ground){0, 0, 0, 0};
  flat_ground g = {0, (uw * vv - vw * uv) / divisor, (vw * uu - uw * uv) / divisor, 1};
  g.at = w - g.per_u * u - g.per_v * v;
  return g;
}

flat_ground ground_through(const projection *p, const ground_hit *hits, uint32_t count, double width, double width_at_least)
{
  flat_ground g = {0, 0, 0, 0};
  if (count < FEWEST)
    return g;
  g = fit(p, hits, count);
  for (uint32_t i = 0; i < count && g.known; i++) {
    double off = fabs(ground_depth(&g, p, hits[i].u, hits[i].v) - hits[i].depth);
    g.known = off <= width * hits[i].depth + width_at_least;   /* not where it is no number */
  }
  return g;
}
