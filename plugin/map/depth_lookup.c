/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/depth_lookup.h"

#include "core/depth_region.h"
#include "map/depth_tile.h"

static const double HUGE_SIDE = 1e9;   /* pixels: as good as infinite, and no trouble */

/* What a tile answers to all samples of this look-up, whatever their bias. */
typedef enum { NOT_SEEN, ALL_LIT, ALL_DARK, MIXED } verdict;

/* A tile that a sample of this look-up has met. */
typedef struct {
  tile_key key;
  verdict verdict;
  const depth_tile *tile;   /* of MIXED */
  double z;                 /* the receiver's depth, relative to the tile's */
} met_tile;

/* 4 x 4 neighbouring tiles have places of their own. */
enum { MET_SIDE = 4 };

typedef struct {
  dsm_worker *worker;
  const projection *p;
  uint32_t face;                /* where the point lies */
  double u, v, depth, nearness; /* see projected */
  double pixel_u, pixel_v;      /* of all faces */
  double bias[2];               /* scene units */
  met_tile met[MET_SIDE * MET_SIDE];
} view;

static double dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The face of a cube that a direction belongs to, whether that face has pixels or not. */
static uint32_t face_towards(const projection *p, const double q[3])
{
  const double along[3] = {dot(q, p->axes.forward), dot(q, p->axes.right), dot(q, p->axes.up)};
  uint32_t i = fabs(along[0]) >= fabs(along[1]) && fabs(along[0]) >= fabs(along[2]) ? 0
             : fabs(along[1]) >= fabs(along[2]) ? 1 : 2;
  return 2 * i + (along[i] < 0);
}

/* Projects the receiver. 0: it lies behind the light, or there is no map. */
static int find_point(view *v, const double point[3])
{
  const projection *p = v->p;
  double q[3];
  for (int i = 0; i < 3; i++)
    q[i] = point[i] - p->origin[i];
  v->face = p->count == MAX_FACES ? face_towards(p, q) : 0;
  const frame *axes = &p->faces[v->face].axes;
  double z = dot(q, axes->forward);
  if (!(z > 0))
    return 0;
  v->u = dot(q, axes->right);
  v->v = dot(q, axes->up);
  v->depth = z;
  v->nearness = 1;
  if (p->perspective) {
    v->nearness = 1 / z;
    v->u *= v->nearness;
    v->v *= v->nearness;
    v->depth = sqrt(dot(q, q));
  }
  for (uint32_t i = 0; i < p->count; i++)
    if (p->faces[i].width) {
      v->pixel_u = p->faces[i].pixel_u;
      v->pixel_v = p->faces[i].pixel_v;
      return isfinite(v->u) && isfinite(v->v) && isfinite(v->depth);
    }
  return 0;
}

/* What the receiver stands for, in map pixels: without a footprint, one of them. */
static void find_footprint(const view *v, const dsm_receiver *receiver, double sides[2][2])
{
  projected at = {.face = v->face, .u = v->u, .v = v->v, .nearness = v->nearness};
  for (int i = 0; i < 2; i++) {
    sides[i][0] = i == 0;
    sides[i][1] = i == 1;
    if (!receiver->has_footprint)
      continue;
    projection_side(v->p, &at, receiver->footprint[i], sides[i]);
    sides[i][0] /= v->pixel_u;
    sides[i][1] /= v->pixel_v;
    for (int k = 0; k < 2; k++)
      if (!(fabs(sides[i][k]) < HUGE_SIDE))
        sides[i][k] = HUGE_SIDE;
  }
}

/* Pixel coordinates of a face, of a place on the image plane. 0: outside, and lit. */
static int find_pixel(const face *f, double u, double v, uint32_t *x, uint32_t *y)
{
  double px = (u - f->u0) * f->per_u, py = (v - f->v0) * f->per_v;
  if (!(px >= 0 && px < f->width && py >= 0 && py < f->height))   /* of a face without pixels, all are */
    return 0;
  *x = (uint32_t)px;
  *y = (uint32_t)py;
  return 1;
}

/* Goes on over a cube's edges: there, the next face knows. */
static int find_sample(const view *v, double u, double w, uint32_t *face_index, uint32_t *x, uint32_t *y)
{
  const projection *p = v->p;
  *face_index = v->face;
  if (p->count < MAX_FACES || (fabs(u) <= 1 && fabs(w) <= 1))
    return find_pixel(&p->faces[v->face], u, w, x, y);
  const frame *own = &p->faces[v->face].axes;
  double q[3];
  for (int i = 0; i < 3; i++)
    q[i] = u * own->right[i] + w * own->up[i] + own->forward[i];
  *face_index = face_towards(p, q);
  const face *f = &p->faces[*face_index];
  double z = dot(q, f->axes.forward);
  return find_pixel(f, dot(q, f->axes.right) / z, dot(q, f->axes.up) / z, x, y);
}

/* The tile, made if it has to be, and what can be said without its pixels (RSC 3.3). */
static dsm_result meet(view *v, const tile_key *key, met_tile *m)
{
  const double *bias = v->bias;
  const tile *t;
  dsm_result result = worker_tile(v->worker, key, &t);
  if (result != DSM_OK)
    return result;
  if (t->kind == TILE_FAILED)
    return DSM_TRACE;
  m->key = *key;
  m->verdict = ALL_LIT;
  if (t->kind == TILE_LIT)
    return DSM_OK;
  m->tile = depths_of(t);
  m->z = v->depth - t->near_depth;
  if (m->z > (double)m->tile->most + fmax(bias[0], bias[1]))
    m->verdict = ALL_DARK;
  else if (m->z > fmin(bias[0], bias[1]))
    m->verdict = MIXED;
  return DSM_OK;
}

/* Whether one sample lies in the shadow. */
static dsm_result compare(view *v, const depth_sample *sample, int *dark)
{
  const double *bias = v->bias;
  tile_key key = {0, 0, 0, 0};
  uint32_t x, y;
  *dark = 0;
  if (!find_sample(v, v->u + sample->x * v->pixel_u, v->v + sample->y * v->pixel_v, &key.face, &x, &y))
    return DSM_OK;
  key.x = x / TILE_SIDE;
  key.y = y / TILE_SIDE;
  met_tile *m = &v->met[key.y % MET_SIDE * MET_SIDE + key.x % MET_SIDE];
  if (m->verdict == NOT_SEEN || m->key.x != key.x || m->key.y != key.y || m->key.face != key.face) {
    dsm_result result = meet(v, &key, m);
    if (result != DSM_OK)
      return result;
  }
  if (m->verdict == MIXED) {
    float stored = m->tile->depth[y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE];
    *dark = m->z > (double)stored + (bias[0] + sample->bias * (bias[1] - bias[0]));
  }
  else
    *dark = m->verdict == ALL_DARK;
  return DSM_OK;
}

/* RSC's bounds are numbers that a user finds by trying, in scene units. The automatic ones follow from the region: over it, a
 * surface inclined by up to 56 degrees (1.5 to 1) does not come nearer to the light than that. A pixel more is for where
 * in a pixel its ray went. The ratio of the two is RSC's. */
static void choose_bias(view *v, const depth_region *r)
{
  static const double slope[2] = {1.5, 2};
  const double *given = v->worker->map->settings.depth_bias;
  double z = v->p->perspective ? v->depth / sqrt(1 + v->u * v->u + v->v * v->v) : 1;
  double across = 0.5 * (fabs(r->sides[0][0]) + fabs(r->sides[1][0])) + 1;
  double up = 0.5 * (fabs(r->sides[0][1]) + fabs(r->sides[1][1])) + 1;
  double reach = z * fmax(across * v->pixel_u, up * v->pixel_v);
  for (int i = 0; i < 2; i++)
    v->bias[i] = given[i] < 0 ? slope[i] * reach : given[i];
}

/* Whether the face, alone, has no pixel in the region. */
static int is_outside(const view *v, const depth_region *r)
{
  const face *f = &v->p->faces[v->face];
  if (v->p->count == MAX_FACES)
    return 0;
  double x = (v->u - f->u0) * f->per_u, y = (v->v - f->v0) * f->per_v;
  double across = 0.5 * (fabs(r->sides[0][0]) + fabs(r->sides[1][0]));
  double up = 0.5 * (fabs(r->sides[0][1]) + fabs(r->sides[1][1]));
  return x + across < 0 || x - across > f->width || y + up < 0 || y - up > f->height || !(v->depth > f->near_depth);
}

static dsm_result lit(double out[3])
{
  out[0] = out[1] = out[2] = 1;
  return DSM_OUTSIDE;
}

dsm_result depth_look_up(dsm_worker *worker, const dsm_receiver *receiver, double out[3])
{
  view v = {.worker = worker, .p = &worker->map->projection};
  double sides[2][2];
  if (!find_point(&v, receiver->point))
    return lit(out);
  find_footprint(&v, receiver, sides);
  depth_region region = depth_region_of(sides, &worker->map->settings);
  if (is_outside(&v, &region))
    return lit(out);
  choose_bias(&v, &region);
  uint64_t seed = depth_region_seed(receiver->point);
  uint32_t samples = depth_region_samples(&region), dark = 0;
  for (uint32_t i = 0; i < samples; i++) {
    depth_sample sample = depth_region_sample(&region, seed, i);
    int is_dark;
    dsm_result result = compare(&v, &sample, &is_dark);
    if (result != DSM_OK)
      return result;
    dark += (uint32_t)is_dark;
  }
  worker_count_samples(worker, samples);
  out[0] = out[1] = out[2] = 1 - (double)dark / samples;
  return DSM_OK;
}
