/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/lookup.h"

#include "core/receiver_depth.h"

/* One face's view of the receiver, and what it takes from the light. */
typedef struct {
  dsm_worker *worker;
  const projected *at;
  receiver_plane planes[2];
  uint32_t plane_count;   /* 0: read at the point's own depth */
  int automatic;          /* bias */
  double own_rounding;    /* of the receiver's depth itself */
  rgb lost;               /* share of light that does not arrive, weighted */
} view;

/* How much of the light that a pixel lets through in front of a surface its own slope may take away in the
 * middle of it. The surface itself takes about a third there. */
static const double CONTACT = 0.5;

/* Less light than this is not worth a ray. */
static const double UNSEEN = 1e-3;

/* Reads a pixel in front of where the receiver's own surface can be. Every plane bounds the surface by itself, so the
 * one that asks for the least bias is enough.
 *
 *       light         The bias steps over what lies within it: also over an edge that touches the surface, and light
 *         |           would leak in along the contact. But the surface alone leaves most of the light in the
 *   1 ----+---.       middle of its range of depths (o). Where less is left there, an occluder is so near that the map
 *         |    `.o    cannot tell the two apart, and says so. */
static inline dsm_result read_pixel(view *v, const tile *t, const visibility *function, double du, double dv,
                                    uint32_t *hint, rgb *seen)
{
  double z = v->at->depth - t->near_depth;
  if (!v->plane_count) {
    *seen = visibility_at(function, z, hint);
    return DSM_OK;
  }
  z -= t->depth_rounding + v->own_rounding;
  double tangent = receiver_bias(&v->planes[0], du, dv);
  double other = v->plane_count > 1 ? receiver_bias(&v->planes[1], du, dv) : tangent;
  *seen = visibility_at(function, z - (tangent < other ? tangent : other), hint);
  if (!v->automatic || tangent > other || seen->c[0] + seen->c[1] + seen->c[2] <= 2 * UNSEEN)
    return DSM_OK;
  rgb middle = visibility_at(function, z - receiver_middle(&v->planes[0], du, dv), hint);
  for (int c = 0; c < 3; c++)
    if (middle.c[c] < CONTACT * seen->c[c] - UNSEEN)
      return DSM_TRACE;
  return DSM_OK;
}

/* Adds what pixel (x, y), which lies in tile t, takes away. `weight` is its bilinear weight times the
 * face's. */
static inline dsm_result add_pixel(view *v, const tile *t, uint32_t x, uint32_t y, double weight)
{
  if (t->kind != TILE_STORED)
    return t->kind == TILE_LIT ? DSM_OK : DSM_TRACE;
  const tile_pixel *pixel = &tile_pixels(t)[y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE];
  if (pixel->word == 0)
    return DSM_OK;
  if (pixel->word & PIXEL_MARKED)
    return DSM_TRACE;
  visibility function = tile_visibility(t, pixel);
  uint32_t *hint = &v->worker->hints[y % HINT_SIDE * HINT_SIDE + x % HINT_SIDE];
  rgb seen;
  dsm_result result = read_pixel(v, t, &function, x + 0.5 - v->at->x, y + 0.5 - v->at->y, hint, &seen);
  if (result != DSM_OK)
    return result;
  for (int c = 0; c < 3; c++)
    v->lost.c[c] += weight * (1 - seen.c[c]);
  return DSM_OK;
}

/* The bilinear average over the 2 x 2 pixels whose centres surround the point; those outside the face are
 * lit. */
static dsm_result add_face(view *v)
{
  const face *f = &v->worker->map->projection.faces[v->at->face];
  double x = v->at->x - 0.5, y = v->at->y - 0.5;   /* from -1 to width and height, see projection.c */
  int32_t i = (int32_t)(x + 1) - 1, j = (int32_t)(y + 1) - 1;   /* rounded down */
  double across = x - i, up = y - j;
  const tile *t = NULL;
  tile_key key = {v->at->face, 0, 0, 0};
  for (int k = 0; k < 4; k++) {
    int32_t px = i + (k & 1), py = j + (k >> 1);
    double weight = v->at->weight * (k & 1 ? across : 1 - across) * (k >> 1 ? up : 1 - up);
    if (!(weight > 0) || px < 0 || py < 0 || px >= (int32_t)f->width || py >= (int32_t)f->height)
      continue;
    uint32_t tile_x = (uint32_t)px / TILE_SIDE, tile_y = (uint32_t)py / TILE_SIDE;
    dsm_result result = DSM_OK;
    if (!t || tile_x != key.x || tile_y != key.y) {   /* mostly all four are in one */
      key.x = tile_x;
      key.y = tile_y;
      result = worker_tile(v->worker, &key, &t);
    }
    if (result == DSM_OK)
      result = add_pixel(v, t, (uint32_t)px, (uint32_t)py, weight);
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
  v.automatic = map->settings.bias < 0;
  for (uint32_t i = 0; i < count; i++) {
    v.at = &hits[i];
    v.own_rounding = hits[i].depth * 0x1p-49;   /* some roundings of a double */
    for (uint32_t k = 0; k < v.plane_count; k++)
      v.planes[k] = receiver_plane_seen(&map->projection, &hits[i], &receiver->planes[k], map->footprint,
                                        map->settings.bias);
    dsm_result result = add_face(&v);
    if (result != DSM_OK)
      return result;
  }
  /* what is lost is summed, not what is left, so that an unshadowed point is 1 exactly; four weights add up
   * to 1 but for rounding, and where all is lost nothing may be left of that */
  for (int c = 0; c < 3; c++)
    out[c] = v.lost.c[c] < 1 - 1e-15 ? 1 - v.lost.c[c] : 0;
  return count ? DSM_OK : DSM_OUTSIDE;
}
