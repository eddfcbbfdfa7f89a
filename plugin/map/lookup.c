/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/lookup.h"

#include <math.h>

#include "core/receiver_depth.h"

/* One face's view of the receiver, and what it takes from the light. */
typedef struct {
  dsm_worker *worker;
  const projected *at;
  receiver_plane planes[2];
  uint32_t plane_count;   /* 0: read at the point's own depth */
  double own_rounding;   /* of the receiver's depth itself */
  rgb lost;              /* share of light that does not arrive, weighted */
} view;

/* Every plane bounds the surface by itself, so the one that asks for the least is enough. */
static double least_bias(const view *v, double du, double dv)
{
  double half = v->worker->map->footprint;
  double bias = receiver_bias(&v->planes[0], du, dv, half);
  return v->plane_count < 2 ? bias : fmin(bias, receiver_bias(&v->planes[1], du, dv, half));
}

/* Adds what pixel (x, y) takes away, `weight` being its bilinear weight times the face's. */
static dsm_result add_pixel(view *v, uint32_t x, uint32_t y, double weight)
{
  const projected *at = v->at;
  tile_key key = {at->face, 0, x / TILE_SIDE, y / TILE_SIDE};
  const tile *t;
  dsm_result result = worker_tile(v->worker, &key, &t);
  if (result != DSM_OK)
    return result;
  if (t->kind != TILE_STORED)
    return t->kind == TILE_LIT ? DSM_OK : DSM_TRACE;

  const tile_pixel *pixel = &tile_pixels(t)[y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE];
  if (pixel->word == 0)
    return DSM_OK;
  if (pixel->word & PIXEL_MARKED)
    return DSM_TRACE;
  double z = at->depth - t->near_depth;
  if (v->plane_count)
    z -= least_bias(v, x + 0.5 - at->x, y + 0.5 - at->y) + t->depth_rounding + v->own_rounding;
  visibility function = tile_visibility(t, pixel);
  uint32_t *hint = &v->worker->hints[y % HINT_SIDE * HINT_SIDE + x % HINT_SIDE];
  rgb seen = visibility_at(&function, z, hint);
  for (int c = 0; c < 3; c++)
    v->lost.c[c] += weight * (1 - seen.c[c]);
  return DSM_OK;
}

/* The bilinear average over the 2 x 2 pixels whose centres surround the point; those outside the face are lit. */
static dsm_result add_face(view *v)
{
  const face *f = &v->worker->map->projection.faces[v->at->face];
  double x = v->at->x - 0.5, y = v->at->y - 0.5;   /* from -1 to width and height, see projection.c */
  double left = floor(x), below = floor(y);
  double across = x - left, up = y - below;
  int32_t i = (int32_t)left, j = (int32_t)below;
  for (int k = 0; k < 4; k++) {
    int32_t px = i + (k & 1), py = j + (k >> 1);
    double weight = v->at->weight * (k & 1 ? across : 1 - across) * (k >> 1 ? up : 1 - up);
    if (!(weight > 0) || px < 0 || py < 0 || px >= (int32_t)f->width || py >= (int32_t)f->height)
      continue;
    dsm_result result = add_pixel(v, (uint32_t)px, (uint32_t)py, weight);
    if (result != DSM_OK)
      return result;
  }
  return DSM_OK;
}

/* Zero times a finite number is 0, times anything else NaN. */
static int all_finite(const dsm_receiver *r)
{
  double sum = 0;
  for (int i = 0; i < 3; i++)
    sum += r->point[i] * 0;
  for (uint32_t k = 0; k < r->plane_count; k++)
    sum += (r->planes[k].normal[0] + r->planes[k].normal[1] + r->planes[k].normal[2] + r->planes[k].rise) * 0;
  return sum == 0;
}

dsm_result map_lookup(dsm_worker *worker, const dsm_receiver *receiver, double out[3])
{
  if (receiver->plane_count > 2 || !all_finite(receiver))
    return DSM_INVALID;
  const dsm_map *map = worker->map;
  projected hits[3];
  uint32_t count = projection_find(&map->projection, receiver->point, hits);
  view v;
  v.worker = worker;
  v.lost = rgb_grey(0);
  v.plane_count = receiver->plane_count;
  for (uint32_t i = 0; i < count; i++) {
    v.at = &hits[i];
    v.own_rounding = hits[i].depth * 0x1p-49;   /* some roundings of a double */
    for (uint32_t k = 0; k < v.plane_count; k++)
      v.planes[k] = receiver_plane_seen(&map->projection, &hits[i], &receiver->planes[k], map->settings.bias);
    dsm_result result = add_face(&v);
    if (result != DSM_OK)
      return result;
  }
  /* what is lost is summed, not what is left, so that an unshadowed point is 1 exactly */
  for (int c = 0; c < 3; c++)
    out[c] = fmin(1, fmax(0, 1 - v.lost.c[c]));
  return count ? DSM_OK : DSM_OUTSIDE;
}
