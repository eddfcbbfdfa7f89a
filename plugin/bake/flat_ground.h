/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A plane that ends all light of a tile, as a floor does.
 *
 *   light  \  |  /        Light rays that meet a plane do so at distances whose inverse, measured along the face's axis, is linear over the face
 *           \ | /         (parallel ones at depths that are). So a few rays tell whether all of them end on one plane,
 *   _________\|/____      and where those between them do.
 */
#ifndef DSM_BAKE_FLAT_GROUND_H
#define DSM_BAKE_FLAT_GROUND_H

#include "core/projection.h"

/* Where one ray ends. */
typedef struct { double u, v, depth; } ground_hit;

/* Zero-initialised: none. */
typedef struct {
  double at, per_u, per_v;   /* the inverse, or the depth, is at + per_u * u + per_v * v */
  int known;
} flat_ground;

/* The place of a ray of this face, of which `depth` is known. */
ground_hit ground_hit_of(const projection *p, uint32_t face, const dsm_ray *ray, double depth);

/* The plane on which all of these lie, to within width * depth + width_at_least; not `known` if there is none, or fewer than four. */
flat_ground ground_through(const projection *p, const ground_hit *hits, uint32_t count, double width, double width_at_least);

/* The depth at which light that leaves the face at u, v ends on a known plane. */
double ground_depth(const flat_ground *g, const projection *p, double u, double v);

#endif
