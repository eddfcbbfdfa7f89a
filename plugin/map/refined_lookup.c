/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/view.h"

#include <math.h>

/* From the first places where a finer level counts, NEED_SHARE, to those where all of it does. */
static const double NEED_FADES = 0.25;

/* What of the pixels around a place want a finer level, weighted. */
typedef struct { double octaves, share; int always; } wish;

static void add_wish(wish *sum, const tile *t, uint32_t x, uint32_t y, double weight)
{
  uint32_t need = tile_need_at(t, y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE);
  if (need == 0)
    return;
  sum->always |= need == NEED_ALWAYS;
  sum->octaves += weight * (need - 1) / NEED_OCTAVE;
  sum->share += weight;
}

/* Both levels count while the share of pixels that want more grows from NEED_SHARE on, and while the error is less than an octave above
 * what is let pass. */
static double need_of(const wish *w)
{
  if (w->always)
    return 1;
  return w->share > NEED_SHARE ? fmin(1, (w->share - NEED_SHARE) / NEED_FADES) * fmin(1, w->octaves / w->share) : 0;
}

/* What is wanted of a finer level than this one there: of the four pixels around it. */
static dsm_result wish_at(view *v, uint32_t level, double x, double y, wish *sum)
{
  const face *f = &v->worker->map->projection.faces[v->at->face];
  uint32_t width = level_pixels(f->width, level), height = level_pixels(f->height, level);
  double size = (double)(1u << level);
  x = x / size - 0.5;
  y = y / size - 0.5;
  int32_t i = round_down(x), j = round_down(y);
  double across = x - i, up = y - j;
  const double weight[4] = {(1 - across) * (1 - up), across * (1 - up), (1 - across) * up, across * up};
  tile_key last = {v->at->face, level, UINT32_MAX, UINT32_MAX};
  const tile *t = NULL;
  *sum = (wish){0, 0, 0};
  for (uint32_t k = 0; k < 4; k++) {
    uint32_t px = (uint32_t)i + (k & 1), py = (uint32_t)j + (k >> 1);
    if (px >= width || py >= height || weight[k] == 0)
      continue;
    tile_key key = {v->at->face, level, px / TILE_SIDE, py / TILE_SIDE};
    if (key.x != last.x || key.y != last.y) {
      dsm_result result = worker_tile(v->worker, &key, &t);
      if (result != DSM_OK)
        return result;
      last = key;
    }
    add_wish(sum, t, px, py, weight[k]);
  }
  return DSM_OK;
}

/* How much that is, from 0 to 1: interpolated, so that no seam shows where levels meet. */
static dsm_result need_at(view *v, uint32_t level, double x, double y, double *need, int *always)
{
  wish sum;
  dsm_result result = wish_at(v, level, x, y, &sum);
  *need = result == DSM_OK ? need_of(&sum) : 0;
  *always = sum.always;
  return result;
}

/* What one level alone says is lost. */
static dsm_result read_level(view *v, uint32_t level, double x, double y, double *grey, rgb *coloured)
{
  double grey_before = v->lost_grey;
  rgb before = v->lost;
  v->lost_grey = 0;
  v->lost = rgb_grey(0);
  if (v->plane_count)
    view_see_planes(v, &VIEW_ONE_PLACE, level);
  dsm_result result = view_add_bilinear(v, level, x, y, 1);
  *grey = v->lost_grey;
  *coloured = v->lost;
  v->lost_grey = grey_before;
  v->lost = before;
  return result;
}

/* From 0 to 1: whether there can be more to see than this level tells. Where all of the light arrives, or none, there is not: pixels
 * of which each may be 0 or 1 have the mean m and the variance m (1 - m). */
static double in_question(const view *v, double grey, rgb coloured)
{
  double aim = v->worker->map->settings.accuracy, most = 0;
  for (int c = 0; c < 3; c++) {
    double lost = grey + coloured.c[c];
    most = fmax(most, lost * (1 - lost));
  }
  return fmin(1, most / (4 * aim * aim));
}

dsm_result view_add_refined(view *v, const footprint *f, double x, double y, double share)
{
  for (uint32_t level = v->worker->map->first_level; share > 0; level--) {
    double need = 0, grey, blind = v->blind;
    rgb coloured;
    int always = 0;
    dsm_result result = level > f->level ? need_at(v, level, x, y, &need, &always) : DSM_OK;
    if (result == DSM_OK)
      result = read_level(v, level, x, y, &grey, &coloured);
    if (result == DSM_OK && !always)
      need *= in_question(v, grey, coloured);
    if (level == f->level + 1)
      need *= 1 - f->coarser;
    if (result == DSM_TRACE && need > 0) {
      v->blind = blind;
      continue;
    }
    if (result != DSM_OK)
      return result;
    v->blind = blind + share * (1 - need) * (v->blind - blind);
    v->lost_grey += share * (1 - need) * grey;
    for (int c = 0; c < 3; c++)
      v->lost.c[c] += share * (1 - need) * coloured.c[c];
    share *= need;
  }
  return DSM_OK;
}

dsm_result view_first_error(view *v, uint32_t least, double x, double y, double *squared)
{
  const dsm_map *map = v->worker->map;
  uint32_t level = map->first_level;
  double aim = map->settings.accuracy, blind = v->blind, grey;
  rgb coloured;
  wish sum;
  *squared = 0;
  dsm_result result = wish_at(v, level, x, y, &sum);
  while (result == DSM_OK && sum.always && level > least)
    result = wish_at(v, --level, x, y, &sum);
  if (result != DSM_OK || !(sum.share > 0) || sum.always)
    return result;
  result = read_level(v, level, x, y, &grey, &coloured);
  v->blind = blind;
  if (result != DSM_OK)
    return result == DSM_TRACE ? DSM_OK : result;   /* a ray makes no error */
  double made = sum.share * exp2(sum.octaves / sum.share) * aim * aim;
  *squared = made * in_question(v, grey, coloured) * ldexp(1, (int)(map->first_level - level));
  return DSM_OK;
}
