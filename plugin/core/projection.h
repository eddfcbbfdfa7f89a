/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The faces of a map and the way between points, pixels and rays.
 *
 *   up (v) ^        A face is a grid of pixels on an image plane in front of the light. Perspective faces
 *          |        use tangent coordinates: a point (x, y, z) in the frame right, up, forward lies at
 *   origin +--> z   u = x/z, v = y/z. Orthographic faces use u = x, v = y in scene units. Pixel (i, j) covers
 *           \       u0 + i pixel_u … u0 + (i+1) pixel_u, and so on up; in pixel coordinates its centre is
 *            right  (i + 1/2, j + 1/2).
 *
 * Every face has a margin around the casters so wide that its outermost pixels see none: what lies farther
 * out is lit, and no seam shows. The faces of a cube overlap by that margin; points within half a pixel of an
 * edge are answered by both faces (three at a corner), with weights that make the answer continuous.
 */
#ifndef DSM_CORE_PROJECTION_H
#define DSM_CORE_PROJECTION_H

#include "dsm.h"

typedef struct { double right[3], up[3], forward[3]; } frame;

typedef struct {
  frame axes;
  double u0, v0;                 /* the lower corner of pixel (0, 0) */
  double pixel_u, pixel_v;       /* a pixel's size: tangents or scene units */
  double per_u, per_v;           /* pixels a unit: 1/pixel_u, 1/pixel_v */
  double near_depth, far_depth;  /* of the casters in the face */
  uint32_t width, height;        /* 0 x 0: no casters, all lit */
} face;

#define MAX_FACES 6
#define MAX_LEVELS 16   /* of 16384 pixels and some margin */

/* Pixels of a coarser level along a side that has `pixels` of the finest: each covers 2^level of those, the last one less
 * where it does not divide. A face has levels down to a single pixel. */
static inline uint32_t level_pixels(uint32_t pixels, uint32_t level)
{
  return (uint32_t)(((uint64_t)pixels + (1ull << level) - 1) >> level);
}

static inline uint32_t face_levels(const face *f)
{
  uint32_t longer = f->width > f->height ? f->width : f->height, levels = longer > 0;
  while (levels && level_pixels(longer, levels - 1) > 1)
    levels++;
  return levels;
}

/* The level, or the coarsest that the face has. Cheaper than to count all of them. */
static inline uint32_t face_level_within(const face *f, uint32_t level)
{
  uint32_t longer = f->width > f->height ? f->width : f->height;
  while (level > 0 && longer <= 1u << (level - 1))
    level--;
  return level;
}

typedef struct {
  double origin[3];
  frame axes;            /* of a cube; the faces look along ±forward, ±right, ±up */
  int perspective;
  uint32_t count;        /* of faces: 0, 1 or 6 */
  int one_level;         /* there are no coarser ones: depths cannot be averaged */
  double overlap;        /* cube: tangents beyond 1 within which a neighbour's face answers too */
  face faces[MAX_FACES];
} projection;

/* Levels that the map has of a face. */
static inline uint32_t projection_levels(const projection *p, uint32_t face_index)
{
  const face *f = &p->faces[face_index];
  return p->one_level ? f->width > 0 : face_levels(f);
}

/* A point as one face sees it. */
typedef struct {
  uint32_t face;
  double weight;         /* of this face's answer; they add up to 1 */
  double x, y;           /* pixel coordinates, at most `reach` outside the face */
  double depth;
  double u, v;
  double nearness;       /* 1 / distance along the face's axis; 1 where the light is parallel */
} projected;

/* A vector at the point `at`, as the face's frame sees it: u, v in tangents or scene units. It is the derivative of the
 * projection there, times the vector. Inline, as a vector of two that is returned through memory makes the caller wait. */
static inline void projection_side(const projection *p, const projected *at, const double side[3], double out[2])
{
  const frame *axes = &p->faces[at->face].axes;
  double along = p->perspective ? side[0] * axes->forward[0] + side[1] * axes->forward[1] + side[2] * axes->forward[2] : 0;
  double u = side[0] * axes->right[0] + side[1] * axes->right[1] + side[2] * axes->right[2];
  double v = side[0] * axes->up[0] + side[1] * axes->up[1] + side[2] * axes->up[2];
  out[0] = (u - at->u * along) * at->nearness;
  out[1] = (v - at->v * along) * at->nearness;
}

/* Fills `hits` with the faces that answer for `point`; those with zero pixels are left out, and those from which it lies
 * outside by more than `reach` pixels (1/2 for a bilinear look-up), so that the weights may add up to less than 1: the
 * rest is lit. 0: lit. */
uint32_t projection_find(const projection *p, const double point[3], double reach, projected hits[3]);

/* The light rays through pixel coordinates x, y of a face that has pixels. */
void projection_rays(const projection *p, uint32_t face, const double (*at)[2], uint32_t count, dsm_ray *rays);
void projection_ray(const projection *p, uint32_t face, double x, double y, dsm_ray *ray);

/* An orthonormal frame that looks along `forward` (unit length), with `up` near the y axis where it can. */
frame frame_along(const double forward[3]);

#endif
