/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * What a look-up knows on its way (LV 3.4): lookup.c makes a view for each face that the point falls on and chooses levels; level_lookup.c
 * reads one level, refined_lookup.c several where the map is finer in places. They add up what is lost. Functions return DSM_OK, DSM_TRACE where
 * the map cannot tell, or why a tile cannot be had. One thread: the worker's.
 */
#ifndef DSM_MAP_VIEW_H
#define DSM_MAP_VIEW_H

#include "core/footprint.h"
#include "core/receiver_depth.h"
#include "core/visibility.h"
#include "map/worker.h"

/* One face's view of the receiver, and what it takes from the light. */
typedef struct {
  dsm_worker *worker;
  const dsm_receiver *receiver;
  const projected *at;
  receiver_plane planes[2];
  uint32_t plane_count;   /* 0: read at the point's own depth */
  int automatic;          /* bias */
  int grazing;            /* the light, on the first plane: see hides_more */
  double pixel;           /* width of a pixel here, scene units */
  double blind;           /* light that arrives by pixels in which the surface hides what stands on it, weighted */
  double own_rounding;    /* of the receiver's depth itself */
  double lost_grey;       /* share of light that does not arrive, weighted: in pixels without colour */
  rgb lost;               /* and in those with colour */
  visibility_key key;     /* the point's own depth, in the tile that is being read */
  delta_word_shape deltas;   /* of that tile, if it has deltas */
} view;

static inline void view_begin(view *v, dsm_worker *worker, const dsm_receiver *receiver)
{
  v->worker = worker;
  v->receiver = receiver;
  v->lost_grey = 0;
  v->lost = rgb_grey(0);
  v->blind = 0;
  v->plane_count = receiver->plane_count;
  v->automatic = worker->map->settings.bias < 0;
}

/* Less light than this is not worth a ray; so a surface that sees no more than twice as much is in no doubt. */
#define VIEW_LEAST 1e-3

/* A footprint without extent, of the finest level. */
#define VIEW_ONE_PLACE ((footprint){0, 0, 1, 0, 0, 0, 0})

/* Rounds down. */
static inline int32_t round_down(double x)
{
  int32_t i = (int32_t)x;
  return i - (x < i);
}

/* Adds `share` of the bilinear average over the 2 x 2 pixels of a level whose centres surround x, y (pixels of the finest level);
 * those outside the face are lit. After view_see_planes, if there are planes. */
dsm_result view_add_bilinear(view *v, uint32_t level, double x, double y, double share);

/* The planes as the pixels of one level meet them, within a footprint. */
void view_see_planes(view *v, const footprint *f, uint32_t level);

/* Reads a map with `accuracy` at one place: from its first level on as fine as the place wants, but no finer than the footprint
 * asks for. Where a level cannot tell an occluder from the surface that it touches, a finer one may. */
dsm_result view_add_refined(view *v, const footprint *f, double x, double y, double share);

/* The squared error that the first level alone would make at a place, as its tiles tell; where it wants a finer one always, that of the next,
 * but not finer than `least`, with pixels as wide as those of the first. */
dsm_result view_first_error(view *v, uint32_t least, double x, double y, double *squared);

#endif
