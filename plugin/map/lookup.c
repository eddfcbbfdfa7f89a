/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/lookup.h"

#include "map/depth_lookup.h"
#include "map/view.h"

/* The coarsest level that a camera ray's footprint may ask for: beyond, an image pixel covers hundreds of map pixels, and
 * a smaller map would do. */
enum { FOOTPRINT_LEVEL = 5 };

/* With `accuracy` each level that is read costs rays of its own. So long footprints are read coarser, and all of them with coarser pixels. */
enum { REFINED_PROBES = 4,
       BLIND_LEVELS = 2 };   /* finer than the first, at most, for points without a footprint: media, and what is seen in mirrors */

/* The light of a cube is among what casts its shadows, and they fill the picture: pixels that are read are so many times smaller in area
 * (measured). Not where `blur` wants them as large as they are. */
static const double IN_CUBES = 1.0 / 16;

/* Where so much is lost by all pixels together, those that are blind are not believed. */
static const double SHADOWED = 0.02;

static dsm_result add_level(view *v, const footprint *f, uint32_t level, double share)
{
  if (v->plane_count)
    view_see_planes(v, f, level);
  if (f->probes == 1)
    return view_add_bilinear(v, level, v->at->x, v->at->y, share);
  int two = f->side_x != 0 || f->side_y != 0;
  dsm_result result = DSM_OK;
  share /= two ? 2 * f->probes : f->probes;
  for (uint32_t k = 0; k < f->probes && result == DSM_OK; k++) {
    double along = k - 0.5 * (f->probes - 1), x = v->at->x + along * f->step_x, y = v->at->y + along * f->step_y;
    result = view_add_bilinear(v, level, x - f->side_x, y - f->side_y, share);
    if (two && result == DSM_OK)
      result = view_add_bilinear(v, level, x + f->side_x, y + f->side_y, share);
  }
  return result;
}

static dsm_result add_probes(view *v, const footprint *f)
{
  dsm_result result = DSM_OK;
  for (uint32_t k = 0; k < f->probes && result == DSM_OK; k++) {
    double along = k - 0.5 * (f->probes - 1);
    result = view_add_refined(v, f, v->at->x + along * f->step_x, v->at->y + along * f->step_y, v->at->weight / f->probes);
  }
  return result;
}

static dsm_result add_footprint(view *v, const footprint *f)
{
  if (f->level < v->worker->map->first_level)
    return add_probes(v, f);
  dsm_result result = add_level(v, f, f->level, v->at->weight * (1 - f->coarser));
  return result == DSM_OK && f->coarser > 0 ? add_level(v, f, f->level + 1, v->at->weight * f->coarser) : result;
}

/* The finest level for points without a footprint. */
static uint32_t blind_level(const dsm_map *map)
{
  uint32_t least = map->first_level > BLIND_LEVELS ? map->first_level - BLIND_LEVELS : 0;
  return map->explored_level > least ? map->explored_level : least;
}

/* How far outside the face the point lies, pixels; less than 0: inside. */
static double distance_beside(const view *v)
{
  const face *f = &v->worker->map->projection.faces[v->at->face];
  double x = v->at->x, y = v->at->y, left = -x, low = -y;
  double across = left > x - f->width ? left : x - f->width, up = low > y - f->height ? low : y - f->height;
  return across > up ? across : up;
}

/* What the receiver and the map's blur ask for on this face. No probes: nothing that is on it. */
static footprint choose(const view *v, int has_footprint)
{
  const dsm_map *map = v->worker->map;
  spread region = spread_of_square(map->blur);
  uint32_t most = map->blur_level;
  int alone = map->projection.count == 1;   /* what lies beyond a cube's face is not lit: see face_fit.c */
  if (has_footprint) {
    spread_add(&region, &map->projection, v->at, v->receiver->footprint);
    if (alone && map->first_level == 0 && !footprint_may_reach(&region, distance_beside(v)))
      return (footprint){0, 0, 0, 0, 0, 0, 0};
    if (alone && most < FOOTPRINT_LEVEL)
      most = FOOTPRINT_LEVEL;
    if (most < map->first_level)
      most = map->first_level;
  }
  most = face_level_within(&map->projection.faces[v->at->face], most);
  if (map->first_level == 0) {
    footprint f = footprint_of(&region, most, alone && has_footprint ? FOOTPRINT_PROBES : 1);
    return alone && has_footprint && map->blur == 0 ? footprint_in_rows(f) : f;
  }
  footprint f = footprint_of(&region, most, has_footprint ? REFINED_PROBES : 1);
  footprint own = f;
  f = footprint_scaled(f, has_footprint ? map->coarser * (alone || map->blur > 0 ? 1 : IN_CUBES) : 1, most);
  if (f.level >= map->first_level)   /* coarser pixels cost nothing, and spare nothing */
    f = own.level >= map->first_level ? own : (footprint){map->first_level, 0, own.probes, own.step_x, own.step_y, 0, 0};
  if (!alone)
    f = (footprint){f.level, f.coarser, 1, 0, 0, 0, 0};   /* beside the face a look-up would find nothing */
  if (!has_footprint && f.level < blind_level(map))
    f = (footprint){blind_level(map), 0, 1, 0, 0, 0, 0};
  return f;
}

/* Where the region is too wide to tell an occluder from the surface that it touches, or a part of it is marked, a
 * narrower one may do: the shadow sharpens towards the contact. */
static dsm_result add_wide(view *v, int has_footprint)
{
  footprint f = choose(v, has_footprint);
  if (f.probes == 0)
    return DSM_OK;
  for (;;) {
    double grey = v->lost_grey, blind = v->blind;
    rgb lost = v->lost;
    dsm_result result = add_footprint(v, &f);
    if (result != DSM_TRACE || (f.level == 0 && f.coarser == 0 && f.probes == 1) || v->worker->map->first_level > 0)
      return result;
    v->lost_grey = grey;
    v->lost = lost;
    v->blind = blind;
    f = (footprint){f.level > 0 ? f.level - 1 : 0, 0, 1, 0, 0, 0, 0};
  }
}

/* Zero times a finite number is 0, times anything else NaN. */
int receiver_is_sound(const dsm_receiver *r)
{
  if (r->plane_count > 2)
    return 0;
  double sum = (r->point[0] + r->point[1] + r->point[2]) * 0;
  for (uint32_t k = 0; k < r->plane_count; k++)
    sum += (r->planes[k].normal[0] + r->planes[k].normal[1] + r->planes[k].normal[2] + r->planes[k].rise) * 0;
  if (r->has_footprint)
    for (int i = 0; i < 3; i++)
      sum += (r->footprint[0][i] + r->footprint[1][i]) * 0;
  return sum == 0;
}

/* How far outside a face a point may lie and still be shadowed by what is in it, finest pixels. */
static double reach_of(const dsm_map *map, int has_footprint)
{
  uint32_t level = map->blur_level;
  if (level < map->first_level)
    level = map->first_level;
  if (has_footprint)
    return footprint_reach(level > FOOTPRINT_LEVEL ? level : FOOTPRINT_LEVEL, 1);
  return level > 0 ? footprint_reach(level, 0) : 0.5;
}

static dsm_result look_up(dsm_worker *worker, const dsm_receiver *receiver, double out[3])
{
  const dsm_map *map = worker->map;
  int wide = receiver->has_footprint || map->blur > 0 || map->first_level > 0;
  projected hits[3];
  uint32_t count = projection_find(&map->projection, receiver->point, reach_of(map, receiver->has_footprint != 0), hits);
  view v;
  view_begin(&v, worker, receiver);
  for (uint32_t i = 0; i < count; i++) {
    v.at = &hits[i];
    v.own_rounding = hits[i].depth * 0x1p-49;   /* some roundings of a double */
    dsm_result result = wide ? add_wide(&v, receiver->has_footprint != 0) : add_level(&v, &VIEW_ONE_PLACE, 0, hits[i].weight);
    if (result != DSM_OK)
      return result;
  }
  if (v.blind > VIEW_LEAST && v.lost_grey + fmax(v.lost.c[0], fmax(v.lost.c[1], v.lost.c[2])) > SHADOWED)
    return DSM_TRACE;
  /* what is lost is summed, not what is left, so that an unshadowed point is 1 exactly; the weights add up
   * to 1 but for rounding, and where all is lost nothing may be left of that */
  for (int c = 0; c < 3; c++) {
    double lost = v.lost_grey + v.lost.c[c];
    out[c] = lost < 1 - 1e-14 ? 1 - lost : 0;
  }
  return count ? DSM_OK : DSM_OUTSIDE;
}

dsm_result map_lookup(dsm_worker *worker, const dsm_receiver *receiver, double out[3])
{
  if (!receiver_is_sound(receiver))
    return DSM_INVALID;
  worker_enter(worker);
  dsm_result result = map_has_depths(worker->map) ? depth_look_up(worker, receiver, out) : look_up(worker, receiver, out);
  worker_leave(worker);
  return result;
}
