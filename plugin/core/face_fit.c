/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/face_fit.h"

#include <math.h>
#include <string.h>

#include "core/box_outline.h"
#include "core/footprint.h"

static const double COS_WIDEST = 0.5;   /* 60 degrees: beyond, a perspective pixel at the rim is 1/8 as
                                           large as one in the middle, and a cube serves better */

/* The cosine of a millionth of a degree is 1. A spot as narrow as that is as wide as the rounding of a cosine makes it, or
 * all of its light would fall beside the face. Squared. */
static const double COS_ROUNDING = 0x1p-48;

enum { TOGETHER = 16 };   /* boxes */

enum { FIRST_PIXELS = 256 };   /* of the level at which a map with `accuracy` begins */

/* What a fit is made for. */
typedef struct {
  const dsm_light *light;
  const dsm_box *bounds;        /* one more box to be held, or NULL */
  const uint32_t *resolution;
  uint32_t margin;              /* pixels on each side of a face */
} wish;

/* Pixels on each side that see no caster. One whole pixel must lie between the casters' outline and the
 * centre of the outermost pixel's filter support. */
static uint32_t margin_pixels(double filter_width)
{
  return (uint32_t)ceil(0.5 * filter_width + 0.5);
}

/* Beyond the edge of a single face all is lit, but beyond that of a cube's face lies the next one; and the coarse pixels with which
 * a map with `accuracy` begins reach out of any face. What look-ups read there has to be in the face's own margin. */
static uint32_t wide_margin(const dsm_settings *settings)
{
  uint32_t blur = blur_level(settings), first = first_level(settings);
  double reach = footprint_reach(blur > first ? blur : first, 0);
  return margin_pixels(settings->filter_width) + (uint32_t)ceil(reach - 1.5);
}

uint32_t first_level(const dsm_settings *settings)
{
  uint32_t pixels = settings->resolution[0] > settings->resolution[1] ? settings->resolution[0] : settings->resolution[1];
  uint32_t level = 0;
  while (settings->accuracy > 0 && pixels >> level > FIRST_PIXELS)
    level++;
  return level;
}

uint32_t blur_level(const dsm_settings *settings)
{
  double width = blur_pixels(settings);
  spread region = spread_of_square(width);
  footprint f = footprint_of(&region, MAX_LEVELS - 1, 1);
  return f.coarser > 0 ? f.level + 1 : f.level;
}

static uint64_t box_count(const wish *w)
{
  return w->light->caster_count + (w->bounds != NULL);
}

static const dsm_box *box_at(const wish *w, uint64_t i)
{
  return i < w->light->caster_count ? &w->light->casters[i] : w->bounds;
}

static uint32_t inner_pixels(uint32_t resolution, uint32_t margin)
{
  return resolution > 2 * margin ? resolution - 2 * margin : 1;
}

/* Sets a face's grid: whole pixels of the given size, centred over the area, margin added. */
static void lay_grid(face *f, const outline *seen, uint32_t margin, double pixel_u, double pixel_v)
{
  const rectangle *a = &seen->area;
  double across = a->u1 - a->u0, up = a->v1 - a->v0;
  uint32_t inner_u = (uint32_t)fmax(1, ceil(across / pixel_u - 1e-6));   /* forgives rounding, not casters */
  uint32_t inner_v = (uint32_t)fmax(1, ceil(up / pixel_v - 1e-6));
  f->width = inner_u + 2 * margin;
  f->height = inner_v + 2 * margin;
  f->pixel_u = pixel_u;
  f->pixel_v = pixel_v;
  f->per_u = 1 / pixel_u;
  f->per_v = 1 / pixel_v;
  f->u0 = 0.5 * (a->u0 + a->u1) - 0.5 * f->width * pixel_u;
  f->v0 = 0.5 * (a->v0 + a->v1) - 0.5 * f->height * pixel_v;
  /* room for the rounding of a host's own depths at the very front and back */
  double slack = 1e-9 * (seen->far_depth - seen->near_depth) + 1e-15 * seen->far_depth;
  f->near_depth = fmax(0, seen->near_depth - slack);
  f->far_depth = seen->far_depth + slack;
}

/* Pixel size for areas up to `across` x `up`; `least` keeps it above rounding where casters are points or
 * lines. */
static void pixel_size(const uint32_t resolution[2], uint32_t margin, double across, double up, double least,
                       double size[2])
{
  if (resolution[1]) {
    size[0] = fmax(across / inner_pixels(resolution[0], margin), least);
    size[1] = fmax(up / inner_pixels(resolution[1], margin), least);
  }
  else
    size[0] = size[1] = fmax(fmax(across, up) / inner_pixels(resolution[0], margin), least);
}

static double lower(double a, double b)
{
  return a < b ? a : b;
}

static double higher(double a, double b)
{
  return a > b ? a : b;
}

static dsm_box box_around(const dsm_box *boxes, uint64_t count)
{
  dsm_box all = boxes[0];
  for (uint64_t k = 1; k < count; k++)
    for (int i = 0; i < 3; i++) {
      all.low[i] = lower(all.low[i], boxes[k].low[i]);
      all.high[i] = higher(all.high[i], boxes[k].high[i]);
    }
  return all;
}

/* Boxes that follow each other mostly lie near each other, and inside what has been seen: then they are not looked at one by one. */
static outline outline_of(const wish *w, const projection *p, const frame *axes, const rectangle *window)
{
  outline sum = OUTLINE_EMPTY;
  uint64_t count = w->light->caster_count;
  for (uint64_t first = 0, past; first < count; first = past) {
    past = first + TOGETHER < count ? first + TOGETHER : count;
    dsm_box all = box_around(&w->light->casters[first], past - first);
    if (!outline_holds(&sum, p->origin, axes, p->perspective, &all))
      for (uint64_t i = first; i < past; i++)
        outline_add(&sum, p->origin, axes, p->perspective, window, &w->light->casters[i]);
  }
  if (w->bounds)
    outline_add(&sum, p->origin, axes, p->perspective, window, w->bounds);
  return sum;
}

/* Pulls an area that was collected in a widened window back to the window. It may become a line or a point. */
static void clamp_to(rectangle *a, const rectangle *w)
{
  a->u0 = fmax(w->u0, fmin(w->u1, a->u0));
  a->u1 = fmax(w->u0, fmin(w->u1, a->u1));
  a->v0 = fmax(w->v0, fmin(w->v1, a->v0));
  a->v1 = fmax(w->v0, fmin(w->v1, a->v1));
}

/* Casters just outside the window reach into it through the filter: they are looked for in the window widened
 * by the margin at its largest. */
static outline outline_near(const wish *w, const projection *p, const frame *axes, const rectangle *window)
{
  double size[2];
  uint32_t margin = w->margin;
  pixel_size(w->resolution, margin, window->u1 - window->u0, window->v1 - window->v0, 0, size);
  rectangle wide = {window->u0 - margin * size[0], window->v0 - margin * size[1],
                    window->u1 + margin * size[0], window->v1 + margin * size[1]};
  outline seen = outline_of(w, p, axes, &wide);
  clamp_to(&seen.area, window);
  return seen;
}

static void fit_one(const wish *w, projection *p, const rectangle *window)
{
  face *f = &p->faces[0];
  f->axes = p->axes;
  p->count = 1;
  outline seen = outline_near(w, p, &p->axes, window);
  if (!(seen.near_depth <= seen.far_depth))
    return;
  const rectangle *a = &seen.area;
  double reach = fmax(fmax(fabs(a->u0), fabs(a->u1)), fmax(fabs(a->v0), fabs(a->v1)));
  double size[2];
  pixel_size(w->resolution, w->margin, a->u1 - a->u0, a->v1 - a->v0, 1e-14 * reach + 1e-30, size);
  lay_grid(f, &seen, w->margin, size[0], size[1]);
}

static void negate(double a[3])
{
  for (int i = 0; i < 3; i++)
    a[i] = -a[i];
}

static frame cube_axes(const frame *base, int index)
{
  frame f = *base;
  if (index / 2 == 1) {
    memcpy(f.forward, base->right, sizeof f.forward);
    memcpy(f.right, base->forward, sizeof f.right);
    negate(f.right);
  }
  else if (index / 2 == 2) {
    memcpy(f.forward, base->up, sizeof f.forward);
    memcpy(f.up, base->forward, sizeof f.up);
    negate(f.up);
  }
  if (index % 2) {
    negate(f.forward);
    negate(f.right);
  }
  return f;
}

/* All faces of a cube have pixels of one size, so that shadows keep their softness across edges; the largest
 * face has the resolution asked for. `half` is set for spotlights up to 90 degrees, which leave the back
 * dark. */
static void fit_cube(const wish *w, projection *p, int half)
{
  outline seen[MAX_FACES];
  double across = 0, up = 0;
  p->count = MAX_FACES;
  for (int i = 0; i < MAX_FACES; i++) {
    face *f = &p->faces[i];
    f->axes = cube_axes(&p->axes, i);
    seen[i] = OUTLINE_EMPTY;
    rectangle window = {-1, -1, 1, 1};
    if (half && i == 1)
      continue;
    if (half && i >= 2) {
      /* the spot's forward axis is ∓right of faces 2 and 3 and ∓up of faces 4 and 5 */
      double *low = i < 4 ? &window.u0 : &window.v0, *high = i < 4 ? &window.u1 : &window.v1;
      double along = 0;
      for (int k = 0; k < 3; k++)
        along += p->axes.forward[k] * (i < 4 ? f->axes.right[k] : f->axes.up[k]);
      *(along > 0 ? low : high) = 0;
    }
    seen[i] = outline_near(w, p, &f->axes, &window);
    if (seen[i].near_depth <= seen[i].far_depth) {
      across = fmax(across, seen[i].area.u1 - seen[i].area.u0);
      up = fmax(up, seen[i].area.v1 - seen[i].area.v0);
    }
  }
  double size[2];
  pixel_size(w->resolution, w->margin, across, up, 1e-9, size);
  p->overlap = 0.5 * fmin(1, fmin(size[0], size[1]));
  for (int i = 0; i < MAX_FACES; i++)
    if (seen[i].near_depth <= seen[i].far_depth)
      lay_grid(&p->faces[i], &seen[i], w->margin, size[0], size[1]);
}

/* The direction of the middle of all casters, and whether they all lie within 60 degrees of it. */
static int narrow_view(const wish *w, double direction[3])
{
  const double *origin = w->light->origin;
  double low[3], high[3], length = 0;
  for (int i = 0; i < 3; i++) {
    low[i] = INFINITY;
    high[i] = -INFINITY;
    for (uint64_t k = 0; k < box_count(w); k++) {
      low[i] = fmin(low[i], box_at(w, k)->low[i]);
      high[i] = fmax(high[i], box_at(w, k)->high[i]);
    }
    direction[i] = 0.5 * (low[i] - origin[i]) + 0.5 * (high[i] - origin[i]);
    length += direction[i] * direction[i];
  }
  length = sqrt(length);
  if (!(length > 0))
    return 0;
  for (int i = 0; i < 3; i++)
    direction[i] /= length;
  /* a cone of less than 90 degrees is convex: it holds a box if it holds the corners */
  for (uint64_t k = 0; k < box_count(w); k++)
    for (int corner = 0; corner < 8; corner++) {
      const dsm_box *box = box_at(w, k);
      double along = 0, square = 0;
      for (int i = 0; i < 3; i++) {
        double q = ((corner >> i & 1) ? box->high[i] : box->low[i]) - origin[i];
        along += q * direction[i];
        square += q * q;
      }
      if (!(along > 0) || along < COS_WIDEST * sqrt(square))
        return 0;
    }
  return 1;
}

static void fit_light(wish *w, const dsm_settings *settings, projection *out)
{
  static const double ahead[3] = {0, 0, 1};
  const dsm_light *light = w->light;
  int half = 0;
  double forward[3];
  if (light->kind == DSM_LIGHT_PARALLEL) {
    double r = light->radius > 0 ? light->radius : INFINITY;
    rectangle window = {-r, -r, r, r};
    out->axes = frame_along(light->direction);
    fit_one(w, out, &window);
    return;
  }
  if (light->kind == DSM_LIGHT_SPOT) {
    double c = light->cos_angle, t = sqrt(fmax(0, 1 - c * c) + COS_ROUNDING) / fmax(c, 1e-300);
    rectangle window = {-t, -t, t, t};
    out->axes = frame_along(light->direction);
    if (c >= COS_WIDEST) {
      fit_one(w, out, &window);
      return;
    }
    half = c >= 0;
  }
  else if (narrow_view(w, forward)) {
    const double t = 2;   /* above tan 60 degrees: all casters are inside */
    rectangle window = {-t, -t, t, t};
    out->axes = frame_along(forward);
    fit_one(w, out, &window);
    return;
  }
  else
    out->axes = frame_along(ahead);
  w->margin = wide_margin(settings);
  fit_cube(w, out, half);
}

void face_fit(const dsm_light *light, const dsm_settings *settings, projection *out)
{
  memset(out, 0, sizeof *out);
  memcpy(out->origin, light->origin, sizeof out->origin);
  out->perspective = light->kind != DSM_LIGHT_PARALLEL;
  out->one_level = settings->block == BLOCK_SHADOW_MAP;
  if (light->caster_count == 0)
    return;
  wish w = {light, settings->bounded ? &settings->bounds : NULL, settings->resolution,
            settings->accuracy > 0 ? wide_margin(settings) : margin_pixels(settings->filter_width)};
  fit_light(&w, settings, out);
}
