/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/tile_boxes.h"

#include <math.h>

#include "core/box_outline.h"

/* With more casters than that, looking at all their boxes would cost more than it spares. */
enum { MOST_BOXES = 2000 };

/* Pixel widths: a caster as thin as the first is missed by rays of some pixels, unless it is as wide as the second. */
static const double THIN = 2, WIDE = 8;

/* Of the sizes of what is compared: rounding must not decide. */
static const double ROUNDING = 1e-9;

static rectangle tile_area(const bake_job *job, const tile_key *key)
{
  const face *f = &job->projection->faces[key->face];
  double size = ldexp(TILE_SIDE, (int)key->level), reach = ldexp(job->settings->filter_width, (int)key->level);
  return (rectangle){f->u0 + (key->x * size - reach) * f->pixel_u, f->v0 + (key->y * size - reach) * f->pixel_v,
                     f->u0 + ((key->x + 1) * size + reach) * f->pixel_u, f->v0 + ((key->y + 1) * size + reach) * f->pixel_v};
}

void tile_boxes_find(const bake_job *job, const tile_key *key, tile_boxes *out)
{
  out->count = MOST_TILE_BOXES + 1;
  if (!job->light || job->light->caster_count > MOST_BOXES)
    return;
  const face *f = &job->projection->faces[key->face];
  rectangle tile = tile_area(job, key);
  out->count = 0;
  for (uint64_t i = 0; i < job->light->caster_count && out->count <= MOST_TILE_BOXES; i++) {
    outline seen = OUTLINE_EMPTY;
    outline_add(&seen, job->projection->origin, &f->axes, job->projection->perspective, &tile, &job->light->casters[i]);
    if (!(seen.area.u0 <= seen.area.u1))
      continue;
    if (out->count < MOST_TILE_BOXES)
      out->box[out->count] = &job->light->casters[i];
    out->count++;
  }
}

static int may_meet(const dsm_box *box, const dsm_ray *ray)
{
  double from = ray->near_depth, to = ray->far_depth;
  for (int k = 0; k < 3; k++) {
    double o = ray->origin[k], d = ray->direction[k], slack = ROUNDING * (fabs(o) + fabs(box->low[k]) + fabs(box->high[k]));
    double low = box->low[k] - slack - o, high = box->high[k] + slack - o;
    if (fabs(d) < ROUNDING) {   /* as good as along the two planes */
      double bent = ROUNDING * (fabs(ray->far_depth) + fabs(o));
      if (low > bent || high < -bent)
        return 0;
      continue;
    }
    double enters = (d > 0 ? low : high) / d, leaves = (d > 0 ? high : low) / d;
    from = enters > from ? enters : from;   /* fmax is a call */
    to = leaves < to ? leaves : to;
  }
  return from <= to;
}

int tile_boxes_may_meet(const tile_boxes *boxes, const dsm_ray *rays, uint32_t count)
{
  if (boxes->count > MOST_TILE_BOXES)
    return 1;
  for (uint32_t k = 0; k < boxes->count; k++)
    for (uint32_t i = 0; i < count; i++)
      if (may_meet(boxes->box[k], &rays[i]))
        return 1;
  return 0;
}

static int is_small(const dsm_box *box, double pixel)
{
  double a = box->high[0] - box->low[0], b = box->high[1] - box->low[1], c = box->high[2] - box->low[2];
  double least = fmin(a, fmin(b, c)), most = fmax(a, fmax(b, c)), middle = a + b + c - least - most;
  return least < THIN * pixel && middle < WIDE * pixel;
}

void tile_boxes_want_finer(const tile_boxes *boxes, const bake_job *job, const tile_key *key, double width, double width_at_least,
                           baked_pixel pixels[TILE_PIXELS])
{
  const face *f = &job->projection->faces[key->face];
  rectangle tile = tile_area(job, key);
  double size = ldexp(1, (int)key->level);
  for (uint32_t k = 0; k < boxes->count && boxes->count <= MOST_TILE_BOXES; k++) {
    outline seen = OUTLINE_EMPTY;
    outline_add(&seen, job->projection->origin, &f->axes, job->projection->perspective, &tile, boxes->box[k]);
    if (!is_small(boxes->box[k], width * seen.near_depth + width_at_least))
      continue;
    for (uint32_t i = 0; i < TILE_PIXELS; i++) {
      double u = f->u0 + (key->x * TILE_SIDE + i % TILE_SIDE + 0.5) * size * f->pixel_u;
      double v = f->v0 + (key->y * TILE_SIDE + i / TILE_SIDE + 0.5) * size * f->pixel_v;
      int inside = u > seen.area.u0 - size * f->pixel_u && u < seen.area.u1 + size * f->pixel_u
                && v > seen.area.v0 - size * f->pixel_v && v < seen.area.v1 + size * f->pixel_v;
      if (inside && !pixels[i].absent)
        pixels[i].need = NEED_ALWAYS;
    }
  }
}
