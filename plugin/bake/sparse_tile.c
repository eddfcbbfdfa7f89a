/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/sparse_tile.h"

#include <math.h>

#include "bake/flat_ground.h"
#include "core/compress_lattice.h"
#include "core/rounding.h"

/* Baked pixels along a side, from few to more. */
static const uint32_t SIDES[] = {4, 8};
enum { TRIES = sizeof SIDES / sizeof *SIDES };

/* The pixels on the face are a rectangle from the tile's first one on. 0: that is too narrow. */
static int make_grid(const place_list *whole, uint32_t side, sparse_grid *grid)
{
  uint32_t last = whole->place[whole->count - 1], width = last % TILE_SIDE, height = last / TILE_SIDE;
  grid->side = side;
  for (uint32_t k = 0; k < side; k++) {
    grid->x[k] = (uint8_t)((k * width + (side - 1) / 2) / (side - 1));
    grid->y[k] = (uint8_t)((k * height + (side - 1) / 2) / (side - 1));
  }
  return width >= 2 * (side - 1) && height >= 2 * (side - 1);
}

static dsm_result bake_grid(const bake_job *job, bake_scratch *s, const tile_key *key, const sparse_grid *grid, tile_tally *tally)
{
  place_list list = {.count = 0};
  for (uint32_t j = 0; j < grid->side; j++)
    for (uint32_t i = 0; i < grid->side; i++)
      list.place[list.count++] = (uint8_t)sparse_place(grid, i, j);
  return bake_pass(job, s, key, 1, &list, tally);
}

/* A ground is flat if its depths are off by no more than this share of a pixel's width: much less than a look-up allows for. */
static const double FLAT = 0.01;

/* Whether light ends in one step at the last vertex, and nowhere else in a step. */
static int ends_at_once(const vertex *v, size_t count)
{
  if (count == 0 || rgb_max(v[count - 1].v) > 0)
    return 0;
  size_t steps = v[0].v.c[0] < 1 || v[0].v.c[1] < 1 || v[0].v.c[2] < 1;
  for (size_t i = 1; i < count; i++)
    steps += v[i].z == v[i - 1].z;
  return steps == 1 && (count == 1 || v[count - 2].z == v[count - 1].z);
}

/* The plane on which all light of baked pixels ends that no volume has taken before. Not known: there is none, or not for all. */
static flat_ground find_ground(const bake_job *job, const bake_scratch *s, const tile_key *key, const sparse_grid *grid,
                               const need_limits *limits)
{
  ground_hit hits[SPARSE_MOST * SPARSE_MOST];
  uint32_t count = 0, all = grid->side * grid->side;
  for (uint32_t k = 0; k < all; k++) {   /* as bake_grid traced them */
    const baked_pixel *p = &s->pixels[sparse_place(grid, k % grid->side, k / grid->side)];
    const vertex *v = s->stored.data + p->first;
    if (p->marked || p->count == 0)
      return (flat_ground){0, 0, 0, 0};
    if (p->surface && ends_at_once(v, p->count))
      hits[count++] = ground_hit_of(job->projection, key->face, &s->rays[k], v[p->count - 1].z);
    else if (p->surface || rgb_max(v[p->count - 1].v) > 0)
      return (flat_ground){0, 0, 0, 0};
  }
  if (2 * count < all)
    return (flat_ground){0, 0, 0, 0};
  return ground_through(job->projection, hits, count, FLAT * limits->width, FLAT * limits->width_at_least);
}

/* Leaves what is in front of the ground. */
static void take_ground_off(bake_scratch *s, const sparse_grid *grid)
{
  for (uint32_t k = 0; k < grid->side * grid->side; k++) {
    baked_pixel *p = &s->pixels[sparse_place(grid, k % grid->side, k / grid->side)];
    if (p->surface)
      p->count -= p->count <= 2 ? p->count : 1;
  }
}

static int any_volume(const bake_scratch *s, const sparse_grid *grid)
{
  for (uint32_t k = 0; k < grid->side * grid->side; k++)
    if (s->pixels[sparse_place(grid, k % grid->side, k / grid->side)].volume)
      return 1;
  return 0;
}

/* Nothing but volumes, or what holds them. */
static int is_all_volume(const bake_scratch *s, const sparse_grid *grid)
{
  int volume = 0;
  for (uint32_t j = 0; j < grid->side; j++)
    for (uint32_t i = 0; i < grid->side; i++) {
      const baked_pixel *p = &s->pixels[sparse_place(grid, i, j)];
      if (p->surface || p->marked)
        return 0;
      volume |= p->volume || p->clear;
    }
  return volume;
}

/* The interval of a line of baked pixels that holds pixel `at`, and the weight of its far end. */
static uint32_t interval_of(const uint8_t *line, uint32_t at, double *weight)
{
  uint32_t k = 0;
  while (at > line[k + 1])
    k++;
  *weight = (double)(at - line[k]) / (line[k + 1] - line[k]);
  return k;
}

/* Ends the average of what is in front of the ground there. */
static dsm_result end_at(vertices *average, double depth)
{
  rgb left = vertices_at(average->data, average->count, depth);
  while (average->count > 0 && average->data[average->count - 1].z >= depth)
    average->count--;
  dsm_result result = vertices_push(average, depth, left);
  return result == DSM_OK ? vertices_push(average, depth, rgb_grey(0)) : result;
}

/* Of the middle of a pixel. */
static double ground_below(const bake_job *job, const tile_key *key, const flat_ground *ground, uint32_t x, uint32_t y)
{
  const face *f = &job->projection->faces[key->face];
  double size = ldexp(1, (int)key->level);
  return ground_depth(ground, job->projection, f->u0 + (key->x * TILE_SIDE + x + 0.5) * size * f->pixel_u,
                      f->v0 + (key->y * TILE_SIDE + y + 0.5) * size * f->pixel_v);
}

/* The average of up to four baked pixels, whose vertices are in s->stored, on the ground. */
static dsm_result fill_pixel(const bake_job *job, bake_scratch *s, const tile_key *key, const sparse_grid *grid,
                             const flat_ground *ground, uint32_t x, uint32_t y)
{
  double across, up, weights[4];
  uint32_t i = interval_of(grid->x, x, &across), j = interval_of(grid->y, y, &up);
  size_t first[5];
  uint32_t count = 0;
  int coloured = 0;
  s->near_by.count = 0;
  for (uint32_t q = 0; q < 4; q++) {
    double weight = (q & 1 ? across : 1 - across) * (q >> 1 ? up : 1 - up);
    if (weight == 0)
      continue;
    const baked_pixel *p = &s->pixels[sparse_place(grid, i + (q & 1), j + (q >> 1))];
    first[count] = s->near_by.count;
    weights[count++] = weight;
    coloured |= p->coloured;
    dsm_result result = p->count ? vertices_append(&s->near_by, s->stored.data + p->first, p->count) : DSM_OK;
    if (result != DSM_OK)
      return result;
  }
  first[count] = s->near_by.count;
  average_input in = {s->near_by.data, first, weights, count};
  s->pixel.average.count = 0;
  dsm_result result = average_sweep(&in, &s->pixel.sweep, &s->pixel.average);
  int volume = s->pixel.average.count > 0;
  if (result == DSM_OK && ground->known)
    result = end_at(&s->pixel.average, ground_below(job, key, ground, x, y));
  if (result != DSM_OK)
    return result;
  double tolerance = finest_tolerance(job->settings);
  baked_pixel *out = &s->pixels[y * TILE_SIDE + x];
  *out = (baked_pixel){.first = s->stored.count, .coloured = coloured, .volume = volume, .surface = ground->known, .tolerance = 2 * tolerance};
  result = compress_rounded(s->pixel.average.data, s->pixel.average.count, coloured ? 3 : 1, tolerance, rounding_of_depths(1, tolerance),
                            bake_value_bits(job->settings), &s->stored);
  out->count = s->stored.count - out->first;
  return result;
}

static int is_baked(const sparse_grid *grid, uint32_t x, uint32_t y)
{
  int across = 0, up = 0;
  for (uint32_t k = 0; k < grid->side; k++) {
    across |= grid->x[k] == x;
    up |= grid->y[k] == y;
  }
  return across && up;
}

/* Baked pixels are filled last, as the others are made of them, and only where there is a ground to put back. */
static dsm_result fill(const bake_job *job, bake_scratch *s, const tile_key *key, const sparse_grid *grid, const flat_ground *ground)
{
  dsm_result result = DSM_OK;
  for (int baked = 0; baked <= ground->known; baked++)
    for (uint32_t y = 0; y <= grid->y[grid->side - 1]; y++)
      for (uint32_t x = 0; x <= grid->x[grid->side - 1] && result == DSM_OK; x++)
        if (is_baked(grid, x, y) == baked)
          result = fill_pixel(job, s, key, grid, ground, x, y);
  return result;
}

static void forget(bake_scratch *s, const sparse_grid *grid)
{
  for (uint32_t j = 0; j < grid->side; j++)
    for (uint32_t i = 0; i < grid->side; i++)
      s->pixels[sparse_place(grid, i, j)] = (baked_pixel){0};
  s->stored.count = 0;
}

/* A plane alone takes the most pixels: nothing says that all of its caster has been seen. With one more caster, both must show. */
static sparse_outcome judge(const bake_scratch *s, const sparse_grid *grid, const flat_ground *ground, uint32_t casters,
                            const need_limits *limits)
{
  if (ground->known && !any_volume(s, grid))
    return casters > 1 ? SPARSE_NEVER : grid->side == SIDES[TRIES - 1] ? SPARSE_DONE : SPARSE_BENT;
  if (!ground->known && (casters > 1 || !is_all_volume(s, grid)))
    return SPARSE_NEVER;
  return sparse_is_enough(s->pixels, &s->stored, limits, grid, ground->known) ? SPARSE_DONE : SPARSE_BENT;
}

dsm_result bake_sparsely(const bake_job *job, bake_scratch *s, const tile_key *key, const place_list *whole, uint32_t casters,
                         const need_limits *limits, sparse_outcome *outcome, tile_tally *tally)
{
  sparse_grid grid;
  *outcome = SPARSE_NEVER;
  for (int k = 0; k < TRIES && whole->count > 0 && make_grid(whole, SIDES[k], &grid); k++) {
    dsm_result result = bake_grid(job, s, key, &grid, tally);
    if (result != DSM_OK)
      return result;
    flat_ground ground = find_ground(job, s, key, &grid, limits);
    if (ground.known)
      take_ground_off(s, &grid);
    *outcome = judge(s, &grid, &ground, casters, limits);
    if (*outcome == SPARSE_DONE)
      return fill(job, s, key, &grid, &ground);
    forget(s, &grid);
    if (*outcome == SPARSE_NEVER)
      break;
  }
  return DSM_OK;
}
