/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/lookup.h"

#include "core/footprint.h"
#include "core/receiver_depth.h"
#include "map/depth_lookup.h"

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
} view;

static const footprint AT_ONE_PLACE = {0, 0, 1, 0, 0};

/* How much of the light that a pixel lets through in front of a surface its own slope may take away in the
 * middle of it, and how much of all light: the surface takes about a third there. */
static const double CONTACT = 0.5, OWN = 0.4;

/* Less light than this is not worth a ray; so a surface that sees no more than twice as much is in no doubt. */
static const double LEAST = 1e-3;

/* An occluder is close if it takes more than this of the light just in front of the surface's range of depths. */
static const double CLOSE = 0.25;

/* The coarsest level that a camera ray's footprint may ask for: beyond, an image pixel covers hundreds of map pixels, and
 * a smaller map would do. */
enum { FOOTPRINT_LEVEL = 5 };

/* With `accuracy` each level that is read costs rays of its own. So long footprints are read coarser, and all of them with pixels of
 * COARSER * accuracy^(4/3) times the area, at most: the error that an edge leaves in an image pixel goes with the 3/2 power of a map
 * pixel's width. COARSER is measured, with 3 x 3 camera rays in an image pixel. */
enum { REFINED_PROBES = 4,
       BLIND_LEVELS = 2 };   /* finer than the first, at most, for points without a footprint: media, and what is seen in mirrors */
static const double COARSER = 1020, MOST_COARSER = 16;

/* From the first places where a finer level counts, NEED_SHARE, to those where all of it does. */
static const double NEED_FADES = 0.25;

/* A stored depth is off by up to half a step of a float, 2^-24 of its distance from the tile's near depth, and in coarser levels by
 * some more. This much keeps a receiver in front of its own step, and far casters in the tile do not make it more. */
static const double DEPTH_ROUNDING = 0x1p-21;

/* Light is grazing where the plane goes so many times deeper within a pixel than the pixel is wide (88.6 degrees), and a bound that asks for
 * less bias than the plane does is no help if it is that of an object more than so many pixels deep: what stands on it is stepped over. */
static const double GRAZING = 40, LARGE = 40;

/* So much of the light that is left in front of the surface must be missing beyond what the surface itself takes. */
static const double HIDDEN = 0.3;

/* Where so much is lost by all pixels together, those that are blind are not believed. */
static const double SHADOWED = 0.02;

/* Whether much light is lost between depth z and where `seen` of it is left. */
static int is_close(const visibility *function, double z, uint32_t channel, double seen)
{
  visibility_place place;
  uint32_t hint = 0;
  double before = visibility_find(function, visibility_key_of(function->codes, z), &hint, &place) ? visibility_value(function, &place, channel) : 1;
  return before - seen > CLOSE * before;
}

/* Under grazing light: whether something else than the surface hides the point, at depth z, from the light, of which `seen` arrives in
 * front of the surface. The surface itself leaves a part of the pixel in front of z that follows from its plane: at least `left`, whether the
 * filter is flat or has a peak. Where that is little, the pixel is blind to what stands on the surface. */
static int hides_more(view *v, const visibility *function, double z, double du, double dv, const double seen[3],
                      double weight)
{
  const receiver_plane *p = &v->planes[0];
  double rise = (p->slope_u * du + p->slope_v * dv) / p->reach, left = rise > 0 ? 0.5 - rise : 0.5 - 0.5 * rise;
  if (left < HIDDEN) {
    v->blind += weight * (function->channels == 1 ? seen[0] : fmax(seen[0], fmax(seen[1], seen[2])));
    return 0;
  }
  visibility_place at;
  uint32_t hint = 0;
  if (!visibility_find(function, visibility_key_of(function->codes, z), &hint, &at))
    return 0;
  for (uint32_t c = 0; c < function->channels; c++)
    if (seen[c] > 2 * LEAST && visibility_value(function, &at, c) < (fmin(left, 1) - HIDDEN) * seen[c])
      return 1;
  return 0;
}

/* What is known of a tile before its pixels are read: most have neither colour nor marks, and records of a few lengths. Constants,
 * of which the compiler makes a function each. */
typedef struct {
  int plain;       /* neither coloured nor marked nor wide */
  int whole;       /* see codes_are_whole */
  size_t bytes;    /* of a record */
} reading;

/* Reads a pixel in front of where the receiver's own surface can be. Every plane bounds the surface by itself, so the
 * one that asks for the least bias is enough. du, dv: from the point to the pixel's centre.
 *
 *       light         The bias steps over what lies within it: also over an edge that touches the surface, and light
 *         |           would leak in along the contact. But the surface alone leaves most of the light in the
 *   1 ----+---.       middle of its range of depths (o). Where less is left there, an occluder is so near that the map
 *         |    `.o    cannot tell the two apart, and says so: unless far occluders have left so few rays that those
 *                     may well be the ones that the surface takes, and nothing else is close in front of it. */
static inline __attribute__((always_inline)) dsm_result add_surface(view *v, const tile *t, const visibility *function, double du,
                                                                    double dv, uint32_t *hint, double weight, reading as)
{
  const visibility_codes *codes = &t->codes;
  double z = v->at->depth - t->near_depth;
  z -= DEPTH_ROUNDING * fabs(z) + v->own_rounding;
  double tangent = receiver_bias(&v->planes[0], du, dv);
  double other = v->plane_count > 1 ? receiver_bias(&v->planes[1], du, dv) : tangent;
  visibility_place front = {0, 0, 0, 0, 0}, middle = {0, 0, 0, 0, 0};
  int dims = visibility_find_as(function, visibility_key_as(codes, z - (tangent < other ? tangent : other), as.whole), hint,
                                &front, as.bytes, as.whole);
  double seen[3] = {1, 1, 1};
  int in_doubt = 0;
  for (uint32_t c = 0; c < function->channels; c++) {
    if (dims)
      seen[c] = visibility_value(function, &front, c);
    in_doubt |= v->automatic && tangent <= other && seen[c] > 2 * LEAST;
  }
  if (v->grazing && (tangent <= other || other > LARGE * v->pixel) && hides_more(v, function, z, du, dv, seen, weight))
    return DSM_TRACE;
  in_doubt = in_doubt && visibility_find_as(function, visibility_key_as(codes, z - receiver_middle(&v->planes[0], du, dv), as.whole),
                                            hint, &middle, as.bytes, as.whole);
  for (uint32_t c = 0; c < function->channels; c++) {
    double taken = in_doubt ? seen[c] - visibility_value(function, &middle, c) : 0;
    if (taken > CONTACT * seen[c] + LEAST && (taken > OWN || is_close(function, z - 2 * tangent, c, seen[c])))
      return DSM_TRACE;
    *(function->channels == 1 ? &v->lost_grey : &v->lost.c[c]) += weight * (1 - seen[c]);
  }
  return DSM_OK;
}

/* Adds what a pixel takes away, whose vertices begin with record `first`. `place` is that of pixel (x, y) in tile t. */
static inline __attribute__((always_inline)) dsm_result add_pixel_as(view *v, const tile *t, uint32_t place, size_t first, uint32_t x,
                                                                     uint32_t y, double size, double weight, reading as)
{
  visibility function;
  if (as.plain)
    function = (visibility){&t->codes, codes_word(&t->codes, first), tile_counts(t)[place], 1};
  else if (tile_is_marked(t, place))
    return DSM_TRACE;
  else
    function = tile_visibility_from(t, place, first);
  if (function.count == 0)
    return DSM_OK;
  uint32_t *hint = &v->worker->hints[y % HINT_SIDE * HINT_SIDE + x % HINT_SIDE];
  if (v->plane_count)
    return add_surface(v, t, &function, (x + 0.5) * size - v->at->x, (y + 0.5) * size - v->at->y, hint, weight, as);
  visibility_place at;
  if (!visibility_find_as(&function, v->key, hint, &at, as.bytes, as.whole))
    return DSM_OK;
  if (function.channels == 1)
    v->lost_grey += weight * (1 - visibility_value(&function, &at, 0));
  else
    for (uint32_t c = 0; c < 3; c++)
      v->lost.c[c] += weight * (1 - visibility_value(&function, &at, c));
  return DSM_OK;
}

typedef dsm_result pixel_adder(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight);

static dsm_result add_pixel_of_3(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){1, 1, 3});
}

static dsm_result add_pixel_of_4(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){1, 1, 4});
}

static dsm_result add_pixel_of_6(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){1, 0, 6});
}

static dsm_result add_pixel(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){0, codes_are_whole(&t->codes), t->codes.record_bytes});
}

/* Four pixels of one tile, the first of them (x, y). Both rows are sent for before the first is read. */
static inline __attribute__((always_inline)) dsm_result add_rows(view *v, const tile *t, uint32_t x, uint32_t y, double size,
                                                                 const double weight[4], pixel_adder *add)
{
  uint32_t place = y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE;
  size_t low = tile_first(t, place), high = tile_first(t, place + TILE_SIDE);
  const unsigned char *records = (const unsigned char *)t + t->codes.records;
  __builtin_prefetch(records + low * t->codes.record_bytes);
  __builtin_prefetch(records + high * t->codes.record_bytes);
  dsm_result result = add(v, t, place, low, x, y, size, weight[0]);
  if (result == DSM_OK)
    result = add(v, t, place + 1, low + tile_records(t, place), x + 1, y, size, weight[1]);
  place += TILE_SIDE;
  if (result == DSM_OK)
    result = add(v, t, place, high, x, y + 1, size, weight[2]);
  return result == DSM_OK ? add(v, t, place + 1, high + tile_records(t, place), x + 1, y + 1, size, weight[3]) : result;
}

static inline dsm_result add_square(view *v, const tile_key *key, uint32_t x, uint32_t y, double size,
                                    const double weight[4])
{
  const tile *t;
  dsm_result result = worker_tile(v->worker, key, &t);
  if (result != DSM_OK || t->kind != TILE_STORED)
    return result != DSM_OK ? result : t->kind == TILE_LIT ? DSM_OK : DSM_TRACE;
  if (!v->plane_count)
    v->key = visibility_key_of(&t->codes, v->at->depth - t->near_depth);
  switch ((t->layout & ~TILE_REFINED) == 0 ? t->codes.record_bytes : 0) {
    case 3: return add_rows(v, t, x, y, size, weight, add_pixel_of_3);   /* the least that a float and a value take is 5 */
    case 4: return add_rows(v, t, x, y, size, weight, add_pixel_of_4);
    case 6: return add_rows(v, t, x, y, size, weight, add_pixel_of_6);   /* the most that another code and a value take is 5 */
    default: return add_rows(v, t, x, y, size, weight, add_pixel);
  }
}

static dsm_result add_apart(view *v, uint32_t level, uint32_t x, uint32_t y, double size, double weight)
{
  tile_key key = {v->at->face, level, x / TILE_SIDE, y / TILE_SIDE};
  const tile *t;
  dsm_result result = worker_tile(v->worker, &key, &t);
  if (result != DSM_OK || t->kind != TILE_STORED)
    return result != DSM_OK ? result : t->kind == TILE_LIT ? DSM_OK : DSM_TRACE;
  uint32_t place = y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE;
  if (!v->plane_count)
    v->key = visibility_key_of(&t->codes, v->at->depth - t->near_depth);
  return add_pixel(v, t, place, tile_first(t, place), x, y, size, weight);
}

/* Rounds down. */
static inline int32_t below(double x)
{
  int32_t i = (int32_t)x;
  return i - (x < i);
}

/* The bilinear average over the 2 x 2 pixels of a level whose centres surround x, y (pixels of the finest level); those
 * outside the face are lit. */
static dsm_result add_bilinear(view *v, uint32_t level, double x, double y, double share)
{
  const face *f = &v->worker->map->projection.faces[v->at->face];
  uint32_t width = level_pixels(f->width, level), height = level_pixels(f->height, level);
  double size = (double)(1u << level);
  if (level > 0) {
    x /= size;
    y /= size;
  }
  int32_t i = below(x - 0.5), j = below(y - 0.5);
  double across = x - 0.5 - i, up = share * (y - 0.5 - j);
  const double weight[4] = {(1 - across) * (share - up), across * (share - up), (1 - across) * up, across * up};
  uint32_t px = (uint32_t)i, py = (uint32_t)j;   /* huge where they are negative */
  if (px % TILE_SIDE < TILE_SIDE - 1 && py % TILE_SIDE < TILE_SIDE - 1 && px < width && py < height) {
    tile_key key = {v->at->face, level, px / TILE_SIDE, py / TILE_SIDE};
    return add_square(v, &key, px, py, size, weight);   /* what of a tile lies outside is stored as lit */
  }
  dsm_result result = DSM_OK;
  for (uint32_t k = 0; k < 4 && result == DSM_OK; k++)
    if (px + (k & 1) < width && py + (k >> 1) < height && weight[k] > 0)
      result = add_apart(v, level, px + (k & 1), py + (k >> 1), size, weight[k]);
  return result;
}

/* The planes as the pixels of one level meet them. A pixel that is an average of finer ones reaches as far as those; one that is
 * baked for itself has a filter of its own size. */
static void see_planes(view *v, const footprint *f, uint32_t level)
{
  const dsm_map *map = v->worker->map;
  double size = (double)(1u << level), apart = fabs(f->step_x) > fabs(f->step_y) ? fabs(f->step_x) : fabs(f->step_y);
  double baked = (double)(1u << (level < map->first_level ? level : map->first_level));
  receiver_region region = {0.5 * (size - baked) + map->support * baked, size + 0.5 * (f->probes - 1) * apart};
  for (uint32_t k = 0; k < v->plane_count; k++)
    v->planes[k] = receiver_plane_seen(&map->projection, v->at, &v->receiver->planes[k], &region, map->settings.bias);
  double width = map->projection.faces[v->at->face].pixel_u;   /* pixels are square, or nearly */
  v->grazing = v->planes[0].reach > GRAZING * region.half * width && v->automatic;
  v->pixel = v->planes[0].depth > 0 ? width * v->at->depth : width;
}

static dsm_result add_level(view *v, const footprint *f, uint32_t level, double share)
{
  if (v->plane_count)
    see_planes(v, f, level);
  if (f->probes == 1)
    return add_bilinear(v, level, v->at->x, v->at->y, share);
  dsm_result result = DSM_OK;
  for (uint32_t k = 0; k < f->probes && result == DSM_OK; k++) {
    double along = k - 0.5 * (f->probes - 1);
    result = add_bilinear(v, level, v->at->x + along * f->step_x, v->at->y + along * f->step_y, share / f->probes);
  }
  return result;
}

/* How much the place wants a finer level than this one, from 0 to 1: interpolated, so that no seam shows where levels meet. Both levels
 * count while the share of pixels that want more grows from NEED_SHARE on, and while the error is less than an octave above what is let
 * pass. */
static dsm_result need_at(view *v, uint32_t level, double x, double y, double *need)
{
  const face *f = &v->worker->map->projection.faces[v->at->face];
  uint32_t width = level_pixels(f->width, level), height = level_pixels(f->height, level);
  double size = (double)(1u << level);
  x = x / size - 0.5;
  y = y / size - 0.5;
  int32_t i = below(x), j = below(y);
  double across = x - i, up = y - j;
  const double weight[4] = {(1 - across) * (1 - up), across * (1 - up), (1 - across) * up, across * up};
  double octaves = 0, share = 0;
  *need = 0;
  for (uint32_t k = 0; k < 4; k++) {
    uint32_t px = (uint32_t)i + (k & 1), py = (uint32_t)j + (k >> 1);
    if (px >= width || py >= height || weight[k] == 0)
      continue;
    tile_key key = {v->at->face, level, px / TILE_SIDE, py / TILE_SIDE};
    const tile *t;
    dsm_result result = worker_tile(v->worker, &key, &t);
    if (result != DSM_OK)
      return result;
    uint32_t n = tile_need_at(t, py % TILE_SIDE * TILE_SIDE + px % TILE_SIDE);
    if (n == NEED_ALWAYS) {
      *need = 1;
      return DSM_OK;
    }
    octaves += weight[k] * (n > 0 ? n - 1 : 0) / NEED_OCTAVE;
    share += n > 0 ? weight[k] : 0;
  }
  if (share > NEED_SHARE)
    *need = fmin(1, (share - NEED_SHARE) / NEED_FADES) * fmin(1, octaves / share);
  return DSM_OK;
}

/* What one level alone says is lost. */
static dsm_result read_level(view *v, uint32_t level, double x, double y, double *grey, rgb *coloured)
{
  double grey_before = v->lost_grey;
  rgb before = v->lost;
  v->lost_grey = 0;
  v->lost = rgb_grey(0);
  if (v->plane_count)
    see_planes(v, &AT_ONE_PLACE, level);
  dsm_result result = add_bilinear(v, level, x, y, 1);
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

/* Reads a map with `accuracy` at one place: from its first level on as fine as the place wants, but no finer than the footprint
 * asks for. Where a level cannot tell an occluder from the surface that it touches, a finer one may. */
static dsm_result add_refined(view *v, const footprint *f, double x, double y, double share)
{
  for (uint32_t level = v->worker->map->first_level; share > 0; level--) {
    double need = 0, grey;
    rgb coloured;
    dsm_result result = level > f->level ? need_at(v, level, x, y, &need) : DSM_OK;
    if (result == DSM_OK)
      result = read_level(v, level, x, y, &grey, &coloured);
    if (result == DSM_OK)
      need *= in_question(v, grey, coloured);
    if (level == f->level + 1)
      need *= 1 - f->coarser;
    if (result == DSM_TRACE && need > 0)
      continue;
    if (result != DSM_OK)
      return result;
    v->lost_grey += share * (1 - need) * grey;
    for (int c = 0; c < 3; c++)
      v->lost.c[c] += share * (1 - need) * coloured.c[c];
    share *= need;
  }
  return DSM_OK;
}

static dsm_result add_probes(view *v, const footprint *f)
{
  dsm_result result = DSM_OK;
  for (uint32_t k = 0; k < f->probes && result == DSM_OK; k++) {
    double along = k - 0.5 * (f->probes - 1);
    result = add_refined(v, f, v->at->x + along * f->step_x, v->at->y + along * f->step_y, v->at->weight / f->probes);
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

/* What the receiver and the map's blur ask for on this face. */
static footprint choose(const view *v, int has_footprint)
{
  const dsm_map *map = v->worker->map;
  spread region = spread_of_square(map->blur);
  uint32_t levels = face_levels(&map->projection.faces[v->at->face]), most = map->blur_level;
  int alone = map->projection.count == 1;   /* what lies beyond a cube's face is not lit: see face_fit.c */
  if (has_footprint) {
    spread_add(&region, &map->projection, v->at, v->receiver->footprint);
    if (alone && most < FOOTPRINT_LEVEL)
      most = FOOTPRINT_LEVEL;
    if (most < map->first_level)
      most = map->first_level;
  }
  if (most >= levels)
    most = levels - 1;
  if (map->first_level == 0)
    return footprint_of(&region, most, alone && has_footprint ? FOOTPRINT_PROBES : 1);
  footprint f = footprint_of(&region, most, alone && has_footprint ? REFINED_PROBES : 1);
  double times = has_footprint ? fmin(MOST_COARSER, COARSER * pow(map->settings.accuracy, 4.0 / 3)) : 1;
  f = footprint_scaled(f, times, most);
  if (!has_footprint && f.level + BLIND_LEVELS < map->first_level)
    f = (footprint){map->first_level - BLIND_LEVELS, 0, 1, 0, 0};
  return f;
}

/* Where the region is too wide to tell an occluder from the surface that it touches, or a part of it is marked, a
 * narrower one may do: the shadow sharpens towards the contact. */
static dsm_result add_wide(view *v, int has_footprint)
{
  footprint f = choose(v, has_footprint);
  for (;;) {
    double grey = v->lost_grey, blind = v->blind;
    rgb lost = v->lost;
    dsm_result result = add_footprint(v, &f);
    if (result != DSM_TRACE || (f.level == 0 && f.coarser == 0 && f.probes == 1) || v->worker->map->first_level > 0)
      return result;
    v->lost_grey = grey;
    v->lost = lost;
    v->blind = blind;
    f = (footprint){f.level > 0 ? f.level - 1 : 0, 0, 1, 0, 0};
  }
}

/* Zero times a finite number is 0, times anything else NaN. */
static int all_finite(const dsm_receiver *r)
{
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
  v.worker = worker;
  v.receiver = receiver;
  v.lost_grey = 0;
  v.lost = rgb_grey(0);
  v.blind = 0;
  v.plane_count = receiver->plane_count;
  v.automatic = map->settings.bias < 0;
  for (uint32_t i = 0; i < count; i++) {
    v.at = &hits[i];
    v.own_rounding = hits[i].depth * 0x1p-49;   /* some roundings of a double */
    dsm_result result = wide ? add_wide(&v, receiver->has_footprint != 0) : add_level(&v, &AT_ONE_PLACE, 0, hits[i].weight);
    if (result != DSM_OK)
      return result;
  }
  if (v.blind > LEAST && v.lost_grey + fmax(v.lost.c[0], fmax(v.lost.c[1], v.lost.c[2])) > SHADOWED)
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
  if (receiver->plane_count > 2 || !all_finite(receiver))
    return DSM_INVALID;
  worker_enter(worker);
  dsm_result result = map_has_depths(worker->map) ? depth_look_up(worker, receiver, out) : look_up(worker, receiver, out);
  worker_leave(worker);
  return result;
}
