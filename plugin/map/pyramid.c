/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/pyramid.h"

#include <math.h>
#include <stdlib.h>

#include "core/average.h"
#include "core/compress.h"
#include "core/compress_lattice.h"
#include "map/pack_tile.h"
#include "map/read_tile.h"

typedef struct {
  const tile *children[4];        /* row by row, the lowest first; NULL where the face ends */
  vertices parts, average, stored;
  average_scratch heap;
  baked_pixel pixels[TILE_PIXELS];
  rounding rule;
  double least_tolerance;         /* that a pixel can have */
  double ray_step;                /* what a step is at least that is not one ray's of a pixel alone; 0 where tolerance was given */
} pyramid_scratch;

/* The finer pixel in quarter `q` of pixel (x, y): its tile and its place there. */
static const tile *child_at(const pyramid_scratch *s, uint32_t x, uint32_t y, uint32_t q, uint32_t *place)
{
  uint32_t cx = 2 * x + (q & 1), cy = 2 * y + (q >> 1);
  *place = cy % TILE_SIDE * TILE_SIDE + cx % TILE_SIDE;
  return s->children[cy / TILE_SIDE * 2 + cx / TILE_SIDE];
}

/* The tolerance of a pixel whose stored parts have these squared ones. Where halving would go below what stored values can
 * tell, compression would keep every step of thousands of pixels in vain; but a map without tolerance stays exact. */
static double halved(double squares, int parts)
{
  double half = 0.5 * sqrt(squares / parts);
  return half > 0 ? fmax(half, 2 * VALUE_ROUNDING) : 0;
}

/* What is fainter than compression may be off is not stored. So at the automatic tolerance, which is wide, all of the room for rounding is
 * left unused: else the widest filters make a ball's shadow 1.1 % too weak instead of 0.8 (measured). */
static dsm_result compress(pyramid_scratch *s, int channels, double tolerance, double spent)
{
  const vertices *in = &s->average;
  uint32_t bits = s->rule.value_bits;
  if (s->ray_step > 0)
    return compress_minimal_after(in->data, in->count, channels, tolerance, spent + rounding_of_bits(bits), &s->stored);
  return compress_rounded(in->data, in->count, channels, tolerance, spent, bits, &s->stored);
}

/* Where a face ends, the pixel's other parts are lit: nothing casts a shadow there. */
static dsm_result make_pixel(pyramid_scratch *s, uint32_t x, uint32_t y, baked_pixel *out)
{
  static const double weights[4] = {0.25, 0.25, 0.25, 0.25};
  size_t first[5];
  double squares = 0;
  int parts = 0, coloured = 0;
  *out = (baked_pixel){.first = s->stored.count};
  s->parts.count = 0;
  for (uint32_t q = 0; q < 4; q++) {
    uint32_t place;
    const tile *t = child_at(s, x, y, q, &place);
    first[q] = s->parts.count;
    if (!t || t->kind != TILE_STORED)
      continue;
    if (tile_is_marked(t, place)) {
      out->marked = 1;
      return DSM_OK;
    }
    dsm_result result = read_pixel(t, place, &s->parts);
    if (result != DSM_OK)
      return result;
    if (s->parts.count > first[q]) {
      squares += (double)t->tolerance * t->tolerance;
      coloured |= tile_is_coloured(t, place);
      out->volume |= t->volume;
      parts++;
    }
  }
  if (!parts)
    return DSM_OK;
  first[4] = s->parts.count;
  s->average.count = 0;
  average_input in = {s->parts.data, first, weights, 4};
  dsm_result result = average_sweep(&in, &s->heap, &s->average);
  if (result != DSM_OK)
    return result;
  out->coloured = coloured;
  out->tolerance = halved(squares, parts);
  double tall = fmax(out->tolerance, s->ray_step), spent = rounding_of_depths(out->volume, s->least_tolerance) + (tall - out->tolerance);
  result = compress(s, coloured ? 3 : 1, tall, spent);
  out->count = s->stored.count - out->first;
  return result;
}

/* The automatic tolerance is half of the noise, and lets one ray's step pass: it lies where chance put it. */
static double step_of_a_ray(const dsm_settings *settings, uint32_t level)
{
  return settings->tolerance < 0 ? 1.01 / ldexp(settings->samples, 2 * (int)level) : 0;
}

static void set_rounding(pyramid_scratch *s, const dsm_map *map, const tile_key *key)
{
  uint32_t halvings = key->level - map->first_level;
  double least = INFINITY;
  for (int q = 0; q < 4; q++)
    if (s->children[q] && s->children[q]->tolerance > 0)
      least = fmin(least, (double)s->children[q]->tolerance);
  double tolerance = s->least_tolerance = least < INFINITY ? halved(least * least, 1) : 0;
  s->rule = tolerance > 0 ? rounding_for(&map->projection, key->face, key->level, halvings, rounding_value_bits(tolerance), tolerance)
                          : rounding_least();
}

static dsm_result make_pixels(pyramid_scratch *s, const tile **out)
{
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    dsm_result result = make_pixel(s, i % TILE_SIDE, i / TILE_SIDE, &s->pixels[i]);
    if (result != DSM_OK)
      return result;
  }
  return pack_tile(s->pixels, &s->stored, &s->rule, out);
}

/* Tells whether any of the four stores anything. */
static dsm_result get_children(dsm_worker *worker, const tile_key *key, const tile *children[4], int *stored)
{
  const tile_grid *grid = &worker->map->store.grids[key->face][key->level - 1];
  *stored = 0;
  for (uint32_t q = 0; q < 4; q++) {
    tile_key child = {key->face, key->level - 1, 2 * key->x + (q & 1), 2 * key->y + (q >> 1)};
    children[q] = NULL;
    if (child.x >= grid->across || child.y >= grid->up)
      continue;
    dsm_result result = worker_tile(worker, &child, &children[q]);
    if (result != DSM_OK)
      return result;
    *stored |= children[q]->kind == TILE_STORED;
  }
  return DSM_OK;
}

dsm_result pyramid_make(dsm_worker *worker, const tile_key *key, const tile **out)
{
  const tile *children[4];
  int stored;
  *out = NULL;
  dsm_result result = get_children(worker, key, children, &stored);
  if (result != DSM_OK)
    return result;
  for (int q = 0; q < 4; q++)
    if (children[q] && children[q]->kind == TILE_FAILED) {
      *out = &tile_failed;
      return DSM_OK;
    }
  if (!stored) {
    *out = &tile_lit;
    return DSM_OK;
  }
  pyramid_scratch *s = calloc(1, sizeof *s);
  if (!s)
    return DSM_NO_MEMORY;
  for (int q = 0; q < 4; q++)
    s->children[q] = children[q];
  s->ray_step = step_of_a_ray(&worker->map->settings, key->level);
  set_rounding(s, worker->map, key);
  result = make_pixels(s, out);
  vertices_free(&s->parts);
  vertices_free(&s->average);
  vertices_free(&s->stored);
  average_free(&s->heap);
  free(s);
  return result;
}
