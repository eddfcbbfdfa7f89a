/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/projection.h"

#include <math.h>

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalise(double a[3])
{
  double length = sqrt(dot(a, a));
  for (int i = 0; i < 3; i++)
    a[i] /= length;
}

frame frame_along(const double forward[3])
{
  frame f;
  /* the y axis, unless it is within 8 degrees of forward: an animated light then turns its frame but seldom */
  double helper[3] = {0, 1, 0};
  if (fabs(forward[1]) > 0.99) {
    helper[1] = 0;
    helper[2] = 1;
  }
  for (int i = 0; i < 3; i++)
    f.forward[i] = forward[i];
  cross(helper, f.forward, f.right);
  normalise(f.right);
  cross(f.forward, f.right, f.up);
  return f;
}

/* Whether the face can say anything about pixel coordinates x, y; false for NaN. */
static int touches(const face *f, double x, double y, double reach)
{
  return x > -reach && x < f->width + reach && y > -reach && y < f->height + reach;
}

/* Adds the face's view of the point at q (relative to the origin) unless it lies outside. */
static uint32_t add_hit(const projection *p, uint32_t index, const double q[3], double weight, double reach,
                        projected *hit)
{
  const face *f = &p->faces[index];
  if (f->width == 0)
    return 0;
  double z = dot(q, f->axes.forward);
  if (!(z > 0))
    return 0;
  double nearness = p->perspective ? 1 / z : 1, u = dot(q, f->axes.right) * nearness, v = dot(q, f->axes.up) * nearness;
  double x = (u - f->u0) * f->per_u, y = (v - f->v0) * f->per_v;
  if (!touches(f, x, y, reach))
    return 0;
  double depth = p->perspective ? sqrt(dot(q, q)) : z;
  if (!(depth > f->near_depth))
    return 0;
  *hit = (projected){index, weight, x, y, depth, u, v, nearness};
  return 1;
}

static uint32_t find_in_cube(const projection *p, const double q[3], double reach, projected hits[3])
{
  const double *axis[3] = {p->axes.forward, p->axes.right, p->axes.up};
  double along[3], size[3];
  for (int i = 0; i < 3; i++) {
    along[i] = dot(q, axis[i]);
    size[i] = fabs(along[i]);
  }
  /* each face's share falls from 1 to 0 where its larger tangent goes from 1 - overlap to 1 + overlap */
  double weight[3], sum = 0;
  for (int i = 0; i < 3; i++) {
    double other = fmax(size[(i + 1) % 3], size[(i + 2) % 3]);
    if (other < size[i] * (1 - p->overlap)) {
      uint32_t index = 2 * (uint32_t)i + (along[i] < 0);
      return add_hit(p, index, q, 1, reach, hits);
    }
    weight[i] = size[i] > 0 ? fmax(0, fmin(1, (1 + p->overlap - other / size[i]) / (2 * p->overlap))) : 0;
    sum += weight[i];
  }
  uint32_t n = 0;
  if (sum > 0)   /* false at the light itself */
    for (uint32_t i = 0; i < 3; i++)
      if (weight[i] > 0)
        n += add_hit(p, 2 * i + (along[i] < 0), q, weight[i] / sum, reach, hits + n);
  return n;
}

uint32_t projection_find(const projection *p, const double point[3], double reach, projected hits[3])
{
  double q[3];
  for (int i = 0; i < 3; i++)
    q[i] = point[i] - p->origin[i];
  if (p->count == MAX_FACES)
    return find_in_cube(p, q, reach, hits);
  return p->count ? add_hit(p, 0, q, 1, reach, hits) : 0;
}

/* Made twice, with all that stays the same kept in registers. */
static inline __attribute__((always_inline)) void make_rays(const projection *p, const face *of, int perspective, const double (*at)[2],
                                                            uint32_t count, dsm_ray *rays)
{
  const face f = *of;   /* a copy: rays could lie anywhere */
  const double origin[3] = {p->origin[0], p->origin[1], p->origin[2]};
  for (dsm_ray *ray = rays; ray < rays + count; ray++, at++) {
    double u = f.u0 + (*at)[0] * f.pixel_u, v = f.v0 + (*at)[1] * f.pixel_v;
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
      double across = u * f.axes.right[i] + v * f.axes.up[i];
      ray->origin[i] = perspective ? origin[i] : origin[i] + across;
      ray->direction[i] = perspective ? across + f.axes.forward[i] : f.axes.forward[i];
    }
    if (perspective)
      normalise(ray->direction);
    ray->near_depth = f.near_depth;
    ray->far_depth = f.far_depth;
  }
}

void projection_rays(const projection *p, uint32_t index, const double (*at)[2], uint32_t count, dsm_ray *rays)
{
  if (p->perspective)
    make_rays(p, &p->faces[index], 1, at, count, rays);
  else
    make_rays(p, &p->faces[index], 0, at, count, rays);
}

void projection_ray(const projection *p, uint32_t index, double x, double y, dsm_ray *ray)
{
  projection_rays(p, index, &(const double[2]){x, y}, 1, ray);
}
