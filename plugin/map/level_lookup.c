/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/view.h"

/* How much of the light that a pixel lets through in front of a surface its own slope may take away in the
 * middle of it, and how much of all light: the surface takes about a third there. */
static const double CONTACT = 0.5, OWN = 0.4;

/* An occluder is close if it takes more than this of the light just in front of the surface's range of depths. */
static const double CLOSE = 0.25;

/* A stored depth is off by up to half a step of a float, 2^-24 of its distance from the tile's near depth, and in coarser levels by
 * some more. This much keeps a receiver in front of its own step, and far casters in the tile do not make it more. */
static const double DEPTH_ROUNDING = 0x1p-21;

/* Light is grazing where the plane goes so many times deeper within a pixel than the pixel is wide (88.6 degrees), and a bound that asks for
 * less bias than the plane does is no help if it is that of an object more than so many pixels deep: what stands on it is stepped over. */
static const double GRAZING = 40, LARGE = 40;

/* So much of the light that is left in front of the surface must be missing beyond what the surface itself takes. */
static const double HIDDEN = 0.3;

/* What is known of a tile before its pixels are read: most have neither colour nor marks, and records of a few lengths. Constants,
 * of which the compiler makes a function each. */
typedef struct {
  int plain;       /* neither coloured nor marked nor wide */
  int whole;       /* see codes_are_whole */
  size_t bytes;    /* of a record; DELTAS, or UNKNOWN */
} reading;

enum { DELTAS = 0, UNKNOWN = 100 };

/* visibility_find in a pixel that may be asked more than once, in deltas from front to back. */
typedef struct {
  const visibility *function;
  uint32_t *hint;
  search_mark *mark;
  uint32_t serial;   /* of the tile */
  int begun;         /* in deltas: the walk is where the last call left it */
  delta_walk walk;
} searched;

/* The first search of a pixel begins where that of the last look-up ended, if that was in the same tile, and leaves its own mark. */
static inline __attribute__((always_inline)) int find_in_deltas(const view *v, searched *pixel, visibility_key key, visibility_place *place)
{
  const visibility *function = pixel->function;
  search_mark *last = pixel->mark;
  delta_mark later, *mark = pixel->begun ? &later : &last->mark;
  if (!pixel->begun) {
    pixel->begun = 1;
    pixel->walk = last->serial == pixel->serial ? delta_resume(&v->deltas, function->first, function->records, mark, key.word >> DELTA_SHIFT)
                                                : delta_begin(&v->deltas, function->first, function->records);
    last->serial = pixel->serial;
    *mark = (delta_mark){pixel->walk.at, pixel->walk.depth, pixel->walk.fall};
  }
  return delta_find(function->codes, &v->deltas, &pixel->walk, key, place, mark);
}

static inline __attribute__((always_inline)) int find(const view *v, searched *pixel, visibility_key key, visibility_place *place,
                                                      reading as)
{
  if (as.bytes == DELTAS)
    return find_in_deltas(v, pixel, key, place);
  return as.bytes == UNKNOWN ? visibility_find(pixel->function, key, pixel->hint, place)
                             : visibility_find_as(pixel->function, key, pixel->hint, place, as.bytes, as.whole);
}

/* visibility_find for what is rarely asked, with a mark in the pixel's deltas or NULL. */
static int find_again(const visibility *function, const delta_mark *mark, double z, visibility_place *place)
{
  visibility_key key = visibility_key_of(function->codes, z);
  uint32_t hint = 0;
  if (!mark)
    return visibility_find(function, key, &hint, place);
  delta_mark later;
  delta_word_shape shape = delta_shape_of(function->codes);
  delta_walk walk = delta_resume(&shape, function->first, function->records, mark, key.word >> DELTA_SHIFT);
  return delta_find(function->codes, &shape, &walk, key, place, &later);
}

/* Whether much light is lost between depth z and where `seen` of it is left. */
static int is_close(const visibility *function, const delta_mark *mark, double z, uint32_t channel, double seen)
{
  visibility_place place;
  double before = find_again(function, mark, z, &place) ? visibility_value(function, &place, channel) : 1;
  return before - seen > CLOSE * before;
}

/* Under grazing light: whether something else than the surface hides the point, at depth z, from the light, of which `seen` arrives in
 * front of the surface. The surface itself leaves a part of the pixel in front of z that follows from its plane: at least `left`, whether the
 * filter is flat or has a peak. Where that is little, the pixel is blind to what stands on the surface. */
static int hides_more(view *v, const visibility *function, const delta_mark *mark, double z, double du, double dv, const double seen[3],
                      double weight)
{
  const receiver_plane *p = &v->planes[0];
  double rise = (p->slope_u * du + p->slope_v * dv) / p->reach, left = rise > 0 ? 0.5 - rise : 0.5 - 0.5 * rise;
  if (left < HIDDEN) {
    v->blind += weight * (function->channels == 1 ? seen[0] : fmax(seen[0], fmax(seen[1], seen[2])));
    return 0;
  }
  visibility_place at;
  if (!find_again(function, mark, z, &at))
    return 0;
  for (uint32_t c = 0; c < function->channels; c++)
    if (seen[c] > 2 * VIEW_LEAST && visibility_value(function, &at, c) < (fmin(left, 1) - HIDDEN) * seen[c])
      return 1;
  return 0;
}

/* Reads a pixel in front of where the receiver's own surface can be. Every plane bounds the surface by itself, so the
 * one that asks for the least bias is enough. du, dv: from the point to the pixel's centre.
 *
 *       light         The bias steps over what lies within it: also over an edge that touches the surface, and light
 *         |           would leak in along the contact. But the surface alone leaves most of the light in the
 *   1 ----+---.       middle of its range of depths (o). Where less is left there, an occluder is so near that the map
 *         |    `.o    cannot tell the two apart, and says so: unless far occluders have left so few rays that those
 *                     may well be the ones that the surface takes, and nothing else is close in front of it. */
static inline __attribute__((always_inline)) dsm_result add_surface(view *v, const tile *t, searched *pixel, double du, double dv,
                                                                    double weight, reading as)
{
  const visibility_codes *codes = &t->codes;
  const visibility *function = pixel->function;
  double z = v->at->depth - t->near_depth;
  z -= DEPTH_ROUNDING * fabs(z) + v->own_rounding;
  double tangent = receiver_bias(&v->planes[0], du, dv);
  double other = v->plane_count > 1 ? receiver_bias(&v->planes[1], du, dv) : tangent;
  visibility_place front = {0, 0, 0, 0, 0}, middle = {0, 0, 0, 0, 0};
  visibility_key key = visibility_key_as(codes, z - (tangent < other ? tangent : other), as.whole);
  int dims = find(v, pixel, key, &front, as);
  const delta_mark *mark = as.bytes == DELTAS ? &pixel->mark->mark : NULL;
  double seen[3] = {1, 1, 1};
  int in_doubt = 0;
  for (uint32_t c = 0; c < function->channels; c++) {
    if (dims)
      seen[c] = visibility_value(function, &front, c);
    in_doubt |= v->automatic && tangent <= other && seen[c] > 2 * VIEW_LEAST;
  }
  if (v->grazing && (tangent <= other || other > LARGE * v->pixel) && hides_more(v, function, mark, z, du, dv, seen, weight))
    return DSM_TRACE;
  if (in_doubt) {
    visibility_key deeper = visibility_key_as(codes, z - receiver_middle(&v->planes[0], du, dv), as.whole);
    if (as.bytes == DELTAS && deeper.word < key.word)   /* by rounding alone */
      deeper = key;
    in_doubt = find(v, pixel, deeper, &middle, as);
  }
  for (uint32_t c = 0; c < function->channels; c++) {
    double taken = in_doubt ? seen[c] - visibility_value(function, &middle, c) : 0;
    if (taken > CONTACT * seen[c] + VIEW_LEAST && (taken > OWN || is_close(function, mark, z - 2 * tangent, c, seen[c])))
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
    function = (visibility){&t->codes, (uint32_t)first, tile_counts(t)[place], tile_counts(t)[place], 1};
  else if (tile_is_marked(t, place))
    return DSM_TRACE;
  else
    function = tile_visibility_from(t, place, first);
  if (function.count == 0)
    return DSM_OK;
  searched pixel = {.function = &function, .serial = t->serial};
  if (as.bytes == DELTAS)
    pixel.mark = &v->worker->marks[y % MARK_SIDE * MARK_SIDE + x % MARK_SIDE];
  else
    pixel.hint = &v->worker->hints[y % HINT_SIDE * HINT_SIDE + x % HINT_SIDE];
  if (v->plane_count)
    return add_surface(v, t, &pixel, (x + 0.5) * size - v->at->x, (y + 0.5) * size - v->at->y, weight, as);
  visibility_place at;
  if (!find(v, &pixel, v->key, &at, as))
    return DSM_OK;
  if (function.channels == 1)
    v->lost_grey += weight * (1 - visibility_value(&function, &at, 0));
  else
    for (uint32_t c = 0; c < 3; c++)
      v->lost.c[c] += weight * (1 - visibility_value(&function, &at, c));
  return DSM_OK;
}

typedef dsm_result pixel_adder(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight);

static dsm_result add_pixel_of_deltas(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){1, 1, DELTAS});
}

static dsm_result add_pixel_of_3(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){1, 1, 3});
}

static dsm_result add_pixel_of_4(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){1, 1, 4});
}

static dsm_result add_pixel_of_5(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){1, 1, 5});
}

static dsm_result add_pixel_of_6(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){1, 0, 6});
}

static dsm_result add_pixel(view *v, const tile *t, uint32_t place, size_t first, uint32_t x, uint32_t y, double size, double weight)
{
  return add_pixel_as(v, t, place, first, x, y, size, weight, (reading){0, codes_are_whole(&t->codes), UNKNOWN});
}

/* Four pixels of one tile, the first of them (x, y). Both rows are sent for before the first is read. */
static dsm_result add_rows(view *v, const tile *t, uint32_t x, uint32_t y, double size, const double weight[4], pixel_adder *add)
{
  uint32_t place = y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE;
  size_t low = tile_first(t, place), high = tile_first(t, place + TILE_SIDE);
  const unsigned char *records = (const unsigned char *)t + t->codes.records;
  __builtin_prefetch(records + low * t->codes.record_bits / 8);
  __builtin_prefetch(records + high * t->codes.record_bits / 8);
  dsm_result result = add(v, t, place, low, x, y, size, weight[0]);
  if (result == DSM_OK)
    result = add(v, t, place + 1, low + tile_records(t, place), x + 1, y, size, weight[1]);
  place += TILE_SIDE;
  if (result == DSM_OK)
    result = add(v, t, place, high, x, y + 1, size, weight[2]);
  return result == DSM_OK ? add(v, t, place + 1, high + tile_records(t, place), x + 1, y + 1, size, weight[3]) : result;
}

/* As add_rows for a point in the air, where pixels are plain: nothing can be in doubt. Of most look-ups, as media ask at every sample. */
static inline __attribute__((always_inline)) dsm_result add_air_as(view *v, const tile *t, uint32_t x, uint32_t y, const double weight[4],
                                                                   size_t bytes)
{
  uint32_t place = y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE;
  const unsigned char *counts = tile_counts(t) + place;
  const uint32_t count[4] = {counts[0], counts[1], counts[TILE_SIDE], counts[TILE_SIDE + 1]};
  uint32_t first[4] = {tile_first(t, place), 0, tile_first(t, place + TILE_SIDE), 0};
  first[1] = first[0] + count[0];
  first[3] = first[2] + count[2];
  double lost = 0;
  for (uint32_t k = 0; k < 4; k++) {
    if (count[k] == 0)
      continue;
    visibility function = {&t->codes, first[k], count[k], count[k], 1};
    visibility_place at;
    uint32_t *hint = &v->worker->hints[(y + (k >> 1)) % HINT_SIDE * HINT_SIDE + (x + (k & 1)) % HINT_SIDE];
    if (visibility_find_as(&function, v->key, hint, &at, bytes, 1))
      lost += weight[k] * (1 - visibility_value(&function, &at, 0));
  }
  v->lost_grey += lost;
  return DSM_OK;
}

/* Gets ready for a tile's pixels: the point's own depth there, or how to read deltas. Returns whether pixels are plain. */
static inline int begin_tile(view *v, const tile *t)
{
  if (!v->plane_count)
    v->key = visibility_key_of(&t->codes, v->at->depth - t->near_depth);
  if (codes_are_deltas(&t->codes))
    v->deltas = delta_shape_of(&t->codes);
  return (t->layout & ~TILE_REFINED) == 0;
}

/* What reads a pixel of the tile. The least that a float and a value take is 5 bytes, the most that another code and a value do as well. */
static inline pixel_adder *adder_of(const tile *t, int plain)
{
  if (plain && codes_are_deltas(&t->codes))
    return add_pixel_of_deltas;
  switch (plain ? t->codes.record_bits / 8 : 0) {
    case 3: return add_pixel_of_3;
    case 4: return add_pixel_of_4;
    case 5: return codes_are_whole(&t->codes) ? add_pixel_of_5 : add_pixel;
    case 6: return add_pixel_of_6;
    default: return add_pixel;
  }
}

static inline dsm_result add_square(view *v, const tile_key *key, uint32_t x, uint32_t y, double size,
                                    const double weight[4])
{
  const tile *t;
  dsm_result result = worker_tile(v->worker, key, &t);
  if (result != DSM_OK || t->kind != TILE_STORED)
    return result != DSM_OK ? result : t->kind == TILE_LIT ? DSM_OK : DSM_TRACE;
  int plain = begin_tile(v, t);
  pixel_adder *add = adder_of(t, plain);
  if (!v->plane_count) {
    if (add == add_pixel_of_4)
      return add_air_as(v, t, x, y, weight, 4);
    if (add == add_pixel_of_5)
      return add_air_as(v, t, x, y, weight, 5);
  }
  return add_rows(v, t, x, y, size, weight, add);
}

static dsm_result add_apart(view *v, uint32_t level, uint32_t x, uint32_t y, double size, double weight)
{
  tile_key key = {v->at->face, level, x / TILE_SIDE, y / TILE_SIDE};
  const tile *t;
  dsm_result result = worker_tile(v->worker, &key, &t);
  if (result != DSM_OK || t->kind != TILE_STORED)
    return result != DSM_OK ? result : t->kind == TILE_LIT ? DSM_OK : DSM_TRACE;
  uint32_t place = y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE;
  return adder_of(t, begin_tile(v, t))(v, t, place, tile_first(t, place), x, y, size, weight);
}

dsm_result view_add_bilinear(view *v, uint32_t level, double x, double y, double share)
{
  const face *f = &v->worker->map->projection.faces[v->at->face];
  uint32_t width = level_pixels(f->width, level), height = level_pixels(f->height, level);
  double size = (double)(1u << level);
  if (level > 0) {
    x /= size;
    y /= size;
  }
  int32_t i = round_down(x - 0.5), j = round_down(y - 0.5);
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

/* A pixel that is an average of finer ones reaches as far as those; one that is baked for itself has a filter of its own size. */
void view_see_planes(view *v, const footprint *f, uint32_t level)
{
  const dsm_map *map = v->worker->map;
  double size = (double)(1u << level), along = 0.5 * (f->probes - 1);
  double far_x = along * fabs(f->step_x) + fabs(f->side_x), far_y = along * fabs(f->step_y) + fabs(f->side_y);
  double baked = (double)(1u << (level < map->first_level ? level : map->first_level));
  receiver_region region = {0.5 * (size - baked) + map->support * baked, size + (far_x > far_y ? far_x : far_y)};
  for (uint32_t k = 0; k < v->plane_count; k++)
    receiver_plane_seen(&map->projection, v->at, &v->receiver->planes[k], &region, map->settings.bias, &v->planes[k]);
  double width = map->projection.faces[v->at->face].pixel_u;   /* pixels are square, or nearly */
  v->grazing = v->planes[0].reach > GRAZING * region.half * width && v->automatic;
  v->pixel = v->planes[0].depth > 0 ? width * v->at->depth : width;
}
