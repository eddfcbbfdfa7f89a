/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/explore.h"

#include <math.h>

#include "map/lookup.h"
#include "map/view.h"

/* Of the squared aim, in units of what pixels let pass (measured: tests/bench/accuracy.sh). */
static const double PASSED = 0.12;

/* Of the width of pixels, in that of footprints. The least is what it would be if nobody had seen the picture. */
static const double COARSEST = 64;

enum { PROBES = 4 };   /* as a look-up has them */

static dsm_result explore_face(dsm_worker *worker, const dsm_receiver *receiver, const projected *at)
{
  dsm_map *map = worker->map;
  exploration *e = &map->explored;
  view v;
  spread region = {0, 0, 0};
  double squared;
  view_begin(&v, worker, receiver);
  v.at = at;
  spread_add(&region, &map->projection, at, receiver->footprint);
  footprint f = footprint_of(&region, MAX_LEVELS - 1, map->projection.count == 1 ? PROBES : 1);
  double width = sqrt((1 + 3 * f.coarser) * ldexp(1, 2 * (int)f.level)) / ldexp(1, (int)map->first_level);
  e->octaves += log2(width);
  e->looked++;
  if (width >= 1)
    return DSM_OK;   /* no finer level is read */
  dsm_result result = view_first_error(&v, f.level, at->x, at->y, &squared);
  e->squares += at->weight * squared * width;
  return result;
}

dsm_result map_explore(dsm_worker *worker, const dsm_receiver *receiver)
{
  const dsm_map *map = worker->map;
  projected hits[3];
  if (!receiver_is_sound(receiver))
    return DSM_INVALID;
  if (map->first_level == 0 || !receiver->has_footprint)
    return DSM_OK;
  dsm_result result = DSM_OK;
  worker_enter(worker);
  uint32_t count = projection_find(&map->projection, receiver->point, 0.5, hits);
  for (uint32_t i = 0; i < count && result == DSM_OK; i++)
    result = explore_face(worker, receiver, &hits[i]);
  worker_leave(worker);
  return result;
}

/* Pixels of this share of the footprints' width make the error that is aimed at. */
static double width_of(const exploration *e, double camera_rays, double rays_across, double aim)
{
  double wide = PASSED * camera_rays * aim * aim / e->squares;   /* infinite: no edge was seen */
  return wide >= rays_across ? wide : cbrt(wide * rays_across * rays_across);
}

void map_explored(dsm_map *map, uint64_t camera_rays, double rays_across)
{
  const exploration *e = &map->explored;
  if (map->first_level == 0 || e->looked == 0 || !(rays_across > 0))
    return;
  double width = width_of(e, (double)camera_rays, rays_across, map->settings.accuracy);
  width = fmax(sqrt(map->coarser), fmin(COARSEST, width));
  map->coarser = width * width;
  double level = map->first_level + log2(width) + e->octaves / (double)e->looked + 0.5;
  map->explored_level = level < 1 ? 0 : level < map->first_level ? (uint32_t)level : map->first_level;
}
