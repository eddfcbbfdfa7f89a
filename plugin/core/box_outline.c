/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/box_outline.h"

#include <math.h>
#include <string.h>

typedef struct { double c[3]; } point3;

/* A box face clipped by four planes has at most eight corners. */
typedef struct { point3 p[8]; int n; } polygon;

static void include_point(rectangle *r, double u, double v)
{
  r->u0 = fmin(r->u0, u);
  r->u1 = fmax(r->u1, u);
  r->v0 = fmin(r->v0, v);
  r->v1 = fmax(r->v1, v);
}

static void include_depths(outline *sum, double near_depth, double far_depth)
{
  sum->near_depth = fmin(sum->near_depth, near_depth);
  sum->far_depth = fmax(sum->far_depth, far_depth);
}

static point3 to_frame(const double origin[3], const frame *axes, const dsm_box *box, int corner)
{
  double q[3];
  for (int i = 0; i < 3; i++)
    q[i] = ((corner >> i & 1) ? box->high[i] : box->low[i]) - origin[i];
  point3 out = {{0, 0, 0}};
  for (int i = 0; i < 3; i++) {
    out.c[0] += q[i] * axes->right[i];
    out.c[1] += q[i] * axes->up[i];
    out.c[2] += q[i] * axes->forward[i];
  }
  return out;
}

/* Sutherland and Hodgman: keeps the side where n·p >= 0 of a convex polygon. */
static void clip(polygon *poly, const double n[3])
{
  polygon out;
  out.n = 0;
  for (int i = 0; i < poly->n; i++) {
    const double *a = poly->p[i].c, *b = poly->p[(i + 1) % poly->n].c;
    double da = n[0] * a[0] + n[1] * a[1] + n[2] * a[2], db = n[0] * b[0] + n[1] * b[1] + n[2] * b[2];
    if (da >= 0 && out.n < 8)
      out.p[out.n++] = poly->p[i];
    if ((da > 0 && db < 0) || (da < 0 && db > 0)) {
      double t = da / (da - db);
      if (out.n < 8)
        out.p[out.n++] = (point3){{a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
                                   a[2] + t * (b[2] - a[2])}};
    }
  }
  *poly = out;
}

/* The box's surface, cut by the pyramid over the window, projected. The rays that hit the box hit its
 * surface, so the corners of what is left bound them; the light is not inside. */
static int clipped_area(const point3 corner[8], const rectangle *w, rectangle *area)
{
  static const int sides[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                  {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
  const double plane[4][3] = {{1, 0, -w->u0}, {-1, 0, w->u1}, {0, 1, -w->v0}, {0, -1, w->v1}};
  double size = 0;
  for (int k = 0; k < 8; k++)
    for (int i = 0; i < 3; i++)
      size = fmax(size, fabs(corner[k].c[i]));
  int seen = 0;
  for (int s = 0; s < 6; s++) {
    polygon poly;
    poly.n = 4;
    for (int k = 0; k < 4; k++)
      poly.p[k] = corner[sides[s][k]];
    for (int k = 0; k < 4 && poly.n; k++)
      clip(&poly, plane[k]);
    for (int k = 0; k < poly.n; k++) {
      const double *p = poly.p[k].c;
      seen = 1;
      if (p[2] > 1e-12 * size)
        include_point(area, fmax(w->u0, fmin(w->u1, p[0] / p[2])), fmax(w->v0, fmin(w->v1, p[1] / p[2])));
      else {   /* it reaches the light, where every direction begins */
        include_point(area, w->u0, w->v0);
        include_point(area, w->u1, w->v1);
      }
    }
  }
  return seen;
}

/* Whether a box lies wholly, and not just by rounding, on the far side of the plane through the origin with the normal
 * a * across + b * axes->forward. */
static int is_beyond(const double centre[3], const double half[3], const frame *axes, const double across[3], double a,
                     double b)
{
  double middle = 0, reach = 0, size = 0;
  for (int i = 0; i < 3; i++) {
    double n = a * across[i] + b * axes->forward[i];
    middle += n * centre[i];
    reach += fabs(n) * half[i];
    size += fabs(n * centre[i]);
  }
  return middle + reach < -1e-12 * (size + reach);
}

/* Sees at a glance most boxes that the pyramid misses: a cube's faces each miss most of the scene. */
static int is_clearly_missed(const double origin[3], const frame *axes, const rectangle *w, const dsm_box *box)
{
  double centre[3], half[3];
  for (int i = 0; i < 3; i++) {
    centre[i] = 0.5 * (box->low[i] + box->high[i]) - origin[i];
    half[i] = 0.5 * (box->high[i] - box->low[i]);
  }
  return is_beyond(centre, half, axes, axes->right, 0, 1) || is_beyond(centre, half, axes, axes->right, 1, -w->u0)
         || is_beyond(centre, half, axes, axes->right, -1, w->u1) || is_beyond(centre, half, axes, axes->up, 1, -w->v0)
         || is_beyond(centre, half, axes, axes->up, -1, w->v1);
}

static void add_perspective(outline *sum, const double origin[3], const frame *axes, const rectangle *w,
                            const dsm_box *box)
{
  if (is_clearly_missed(origin, axes, w, box))
    return;
  point3 corner[8];
  int inside = 1;
  for (int k = 0; k < 8; k++) {
    corner[k] = to_frame(origin, axes, box, k);
    const double *p = corner[k].c;
    int within_u = p[0] >= w->u0 * p[2] && p[0] <= w->u1 * p[2], within_v = p[1] >= w->v0 * p[2] && p[1] <= w->v1 * p[2];
    inside &= within_u && within_v && p[2] > 0;
  }
  double nearest = 0, farthest = 0;
  for (int i = 0; i < 3; i++) {
    double low = box->low[i] - origin[i], high = box->high[i] - origin[i];
    double gap = fmax(0, fmax(low, -high)), reach = fmax(fabs(low), fabs(high));
    nearest += gap * gap;
    farthest += reach * reach;
  }
  rectangle area = OUTLINE_EMPTY.area;
  if (nearest == 0)   /* the light is in the box */
    area = *w;
  else if (inside)
    for (int k = 0; k < 8; k++)
      include_point(&area, corner[k].c[0] / corner[k].c[2], corner[k].c[1] / corner[k].c[2]);
  else if (!clipped_area(corner, w, &area))
    return;
  include_point(&sum->area, area.u0, area.v0);
  include_point(&sum->area, area.u1, area.v1);
  include_depths(sum, sqrt(nearest), sqrt(farthest));
}

static void add_orthographic(outline *sum, const double origin[3], const frame *axes, const rectangle *w,
                             const dsm_box *box)
{
  rectangle area = OUTLINE_EMPTY.area;
  double nearest = INFINITY, farthest = -INFINITY;
  for (int k = 0; k < 8; k++) {
    point3 p = to_frame(origin, axes, box, k);
    include_point(&area, p.c[0], p.c[1]);
    nearest = fmin(nearest, p.c[2]);
    farthest = fmax(farthest, p.c[2]);
  }
  area = (rectangle){fmax(area.u0, w->u0), fmax(area.v0, w->v0), fmin(area.u1, w->u1), fmin(area.v1, w->v1)};
  if (farthest < 0 || area.u0 > area.u1 || area.v0 > area.v1)
    return;
  include_point(&sum->area, area.u0, area.v0);
  include_point(&sum->area, area.u1, area.v1);
  include_depths(sum, fmax(0, nearest), farthest);
}

/* Rounding has room, so that the sum does not depend on it. */
int outline_holds(const outline *sum, const double origin[3], const frame *axes, int perspective, const dsm_box *box)
{
  double at[3] = {0, 0, 0}, reach[3] = {0, 0, 0}, nearest = 0, farthest = 0, away = 0;
  for (int i = 0; i < 3; i++) {
    double middle = 0.5 * (box->low[i] + box->high[i]) - origin[i], half = 0.5 * (box->high[i] - box->low[i]);
    double gap = fabs(middle) - half, end = fabs(middle) + half;
    at[0] += middle * axes->right[i];
    at[1] += middle * axes->up[i];
    at[2] += middle * axes->forward[i];
    reach[0] += half * fabs(axes->right[i]);
    reach[1] += half * fabs(axes->up[i]);
    reach[2] += half * fabs(axes->forward[i]);
    nearest += gap > 0 ? gap * gap : 0;
    farthest += end * end;
    away += end;
  }
  const double room = 1e-12;
  double front = at[2] - reach[2], back = at[2] + reach[2], scale[2] = {1, 1}, slack = room * away;
  if (perspective) {
    if (!(front > 0.01 * away))
      return 0;
    scale[0] = 1 / front;
    scale[1] = 1 / back;
    slack = 100 * room;
  }
  else if (!(front - slack >= sum->near_depth && back + slack <= sum->far_depth))
    return 0;
  double u0 = at[0] - reach[0], u1 = at[0] + reach[0], v0 = at[1] - reach[1], v1 = at[1] + reach[1];
  return u0 * scale[u0 > 0] - slack >= sum->area.u0 && u1 * scale[u1 < 0] + slack <= sum->area.u1
         && v0 * scale[v0 > 0] - slack >= sum->area.v0 && v1 * scale[v1 < 0] + slack <= sum->area.v1
         && (!perspective || (nearest * (1 - room) >= sum->near_depth * sum->near_depth
                              && farthest * (1 + room) <= sum->far_depth * sum->far_depth));
}

void outline_add(outline *sum, const double origin[3], const frame *axes, int perspective,
                 const rectangle *window, const dsm_box *box)
{
  if (outline_holds(sum, origin, axes, perspective, box))
    return;
  if (perspective)
    add_perspective(sum, origin, axes, window, box);
  else
    add_orthographic(sum, origin, axes, window, box);
}
