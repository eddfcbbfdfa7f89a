/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/bake_tile.h"

#include <math.h>

#include "bake/seconds.h"
#include "bake/sparse_tile.h"
#include "bake/tile_need.h"
#include "core/face_fit.h"
#include "map/pack_tile.h"

/* Rays a pixel, before any of them tell how many more it takes. At the first level two find what there is to refine; in smooth volumes one
 * does. Of an edge, one ray in each of more pixels tells most (measured); but where all of a tile is full of things smaller
 * than a pixel, their mean is what counts. */
enum { FIRST_RAYS = 2, VOLUME_RAYS = 1, FILLED_RAYS = 4, PROBED = 4 };

/* `accuracy` is the root mean square over a picture, most of which is lit, dark or smooth, and of which each image pixel averages look-ups,
 * as each look-up averages pixels. So the noise of a tile's pixels may have a root mean square of this many times the aim (measured; see
 * tests/bench/accuracy.sh). A pixel counts as noisy as a whole if one of its rays has NOISY variance. */
static const double NOISE_SHARE = 25, NOISY = 0.1;

/* The wanted pixels of the tile that lie on its face. */
static place_list places_on_face(const face *f, const tile_key *key, const wanted_pixels *wanted)
{
  uint32_t width = level_pixels(f->width, key->level), height = level_pixels(f->height, key->level);
  place_list list = {.count = 0};
  for (uint32_t place = 0; place < TILE_PIXELS; place++)
    if (wanted->pixel[place] && key->x * TILE_SIDE + place % TILE_SIDE < width && key->y * TILE_SIDE + place / TILE_SIDE < height)
      list.place[list.count++] = (uint8_t)place;
  return list;
}

/* The variance of one ray's transmittance, from a pixel and its neighbours in the tile: few rays alone may all agree by chance. */
static double ray_variance(const baked_pixel pixels[TILE_PIXELS], const uint32_t rays[TILE_PIXELS], uint32_t place)
{
  tile_patch patch = tile_around(place);
  double sum = 0, count = 0;
  for (uint32_t k = 0; k < patch.count; k++) {
    uint32_t p = patch.place[k];
    sum += pixels[p].variance * rays[p];
    count += rays[p] > 0;
  }
  return sum / count;
}

/* How many rays a pixel of so many takes until the standard error of its mean is `aim`. Where rays are stratified well, the error
 * falls faster than by the square root; so it is never more than four times as many at once. */
static uint32_t wanted_rays(double variance, uint32_t rays, double aim, uint32_t most)
{
  uint32_t wanted = rays;
  while (variance > aim * aim * wanted && wanted < 4 * rays)
    wanted *= 2;
  return wanted < most ? wanted : most;
}

/* One round of more rays, all anew, where the mean of those so far is too uncertain. *added: whether there was anything to do. */
static dsm_result bake_more(const bake_job *job, bake_scratch *s, const tile_key *key, const place_list *all,
                            uint32_t rays[TILE_PIXELS], int *added, tile_tally *tally)
{
  double aim = NOISE_SHARE * job->settings->accuracy, noisy = 0;
  uint32_t wanted[TILE_PIXELS];
  for (uint32_t k = 0; k < all->count; k++)
    noisy += fmin(1, ray_variance(s->pixels, rays, all->place[k]) / NOISY);
  aim /= sqrt(fmax(noisy, TILE_SIDE) / TILE_PIXELS);
  for (uint32_t k = 0; k < all->count; k++) {
    uint32_t place = all->place[k], most = job->settings->samples;
    const baked_pixel *p = &s->pixels[place];
    if (p->need > 0 && most > FILLED_RAYS)
      most = FILLED_RAYS;   /* a finer level is likely to be read instead */
    wanted[place] = p->marked ? 0 : wanted_rays(ray_variance(s->pixels, rays, place), rays[place], aim, most);
  }
  dsm_result result = DSM_OK;
  *added = 0;
  for (uint32_t samples = 2; result == DSM_OK; samples *= 2) {
    if (samples > job->settings->samples)
      samples = job->settings->samples;
    place_list list = {.count = 0};
    for (uint32_t k = 0; k < all->count; k++)
      if (wanted[all->place[k]] == samples && rays[all->place[k]] < samples)
        list.place[list.count++] = all->place[k];
    if (list.count)
      result = bake_pass(job, s, key, samples, &list, tally);
    for (uint32_t k = 0; k < list.count; k++)
      rays[list.place[k]] = samples;
    *added |= list.count > 0;
    if (samples == job->settings->samples)
      break;
  }
  return result;
}

/* How many rays the pixels of a tile take that is wanted as a whole, told by every PROBEDth of them in both directions. */
static dsm_result probe(const bake_job *job, bake_scratch *s, const tile_key *key, const place_list *all, uint32_t *samples,
                        tile_tally *tally)
{
  place_list few = {.count = 0};
  for (uint32_t k = 0; k < all->count; k++)
    if (all->place[k] % PROBED == 0 && all->place[k] / TILE_SIDE % PROBED == 0)
      few.place[few.count++] = all->place[k];
  dsm_result result = few.count ? bake_pass(job, s, key, FIRST_RAYS, &few, tally) : DSM_OK;
  int volume = 0, surface = 0;
  double noisy = 0;
  for (uint32_t k = 0; k < few.count; k++) {
    const baked_pixel *p = &s->pixels[few.place[k]];
    volume |= p->volume;
    surface |= p->surface;
    noisy += fmin(1, FIRST_RAYS * p->variance / NOISY);
  }
  *samples = volume && !surface ? VOLUME_RAYS : 2 * noisy > few.count ? FILLED_RAYS : FIRST_RAYS;
  s->stored.count = 0;
  return result;
}

/* One for an aim of 0.01, and more for less, as the error of their mean falls with the square root (measured). A power of two, as all
 * numbers of rays but the last. */
static uint32_t edge_rays(double aim)
{
  uint32_t rays = 1;
  while (rays < FILLED_RAYS && rays * aim * aim < 0.999e-4)
    rays *= 2;
  return rays;
}

/* At the first level; 0: there is nothing to bake, or all is baked. */
static dsm_result choose_first_rays(const bake_job *job, bake_scratch *s, const tile_key *key, const place_list *all,
                                    const need_limits *limits, uint32_t *samples, tile_tally *tally)
{
  sparse_outcome outcome = SPARSE_NEVER;
  uint32_t casters = s->boxes.count;
  *samples = 0;
  dsm_result result = casters >= 1 && casters <= SPARSE_CASTERS ? bake_sparsely(job, s, key, all, casters, limits, &outcome, tally) : DSM_OK;
  if (result != DSM_OK || casters == 0 || outcome == SPARSE_DONE)
    return result;
  if (outcome == SPARSE_NEVER)
    return probe(job, s, key, all, samples, tally);
  *samples = VOLUME_RAYS;
  return DSM_OK;
}

static dsm_result choose_rays(const bake_job *job, bake_scratch *s, const tile_key *key, const place_list *all,
                              const need_limits *limits, uint32_t *samples, tile_tally *tally)
{
  dsm_result result = DSM_OK;
  *samples = 0;
  if (key->level >= first_level(job->settings))
    result = choose_first_rays(job, s, key, all, limits, samples, tally);
  else {
    if (16 * all->count > 15 * TILE_PIXELS)
      result = probe(job, s, key, all, samples, tally);
    if (*samples < edge_rays(job->settings->accuracy))
      *samples = edge_rays(job->settings->accuracy);
  }
  if (*samples > job->settings->samples)
    *samples = job->settings->samples;
  return result;
}

/* Few rays for all pixels, then more where they are wanted, until there is nothing to add. */
static dsm_result bake_adaptively(const bake_job *job, bake_scratch *s, const tile_key *key, const place_list *all,
                                  tile_tally *tally)
{
  uint32_t rays[TILE_PIXELS] = {0}, samples;
  const face *f = &job->projection->faces[key->face];
  double size = ldexp(fmax(f->pixel_u, f->pixel_v), (int)key->level);
  int perspective = job->projection->perspective;
  need_limits limits = {perspective ? size : 0, perspective ? 0 : size, job->settings->accuracy,
                        key->level >= first_level(job->settings)};
  tile_boxes_find(job, key, &s->boxes);
  dsm_result result = choose_rays(job, s, key, all, &limits, &samples, tally);
  if (result != DSM_OK || samples == 0)
    return result;
  for (uint32_t k = 0; k < all->count; k++)
    rays[all->place[k]] = samples;
  result = bake_pass(job, s, key, samples, all, tally);
  for (int added = 1; result == DSM_OK && added;) {
    if (key->level > 0) {
      tile_need(s->pixels, &s->stored, &limits);
      tile_boxes_want_finer(&s->boxes, job, key, limits.width, limits.width_at_least, s->pixels);
    }
    result = bake_more(job, s, key, all, rays, &added, tally);
  }
  return result;
}

static dsm_result bake_pixels(const bake_job *job, bake_scratch *s, const tile_key *key, const wanted_pixels *wanted,
                              tile_tally *tally)
{
  place_list all = places_on_face(&job->projection->faces[key->face], key, wanted);
  s->stored.count = 0;
  for (int i = 0; i < TILE_PIXELS; i++)
    s->pixels[i] = (baked_pixel){.absent = !wanted->pixel[i]};
  tally->pixels += all.count;
  return job->settings->accuracy > 0 ? bake_adaptively(job, s, key, &all, tally)
                                     : bake_pass(job, s, key, job->settings->samples, &all, tally);
}

dsm_result bake_tile(const bake_job *job, bake_scratch *s, const tile_key *key, const wanted_pixels *wanted,
                     const tile **out, tile_tally *tally)
{
  double start = seconds();
  *out = NULL;
  dsm_result result = bake_pixels(job, s, key, wanted, tally);
  double tolerance = finest_tolerance(job->settings);
  rounding rule = tolerance > 0 ? rounding_for(job->projection, key->face, key->level, 0, bake_value_bits(job->settings), tolerance)
                                : rounding_least();
  if (result == DSM_OK)
    result = pack_tile(s->pixels, &s->stored, &rule, out);
  if (result == DSM_OK)
    for (int i = 0; i < TILE_PIXELS; i++) {
      tally->pixels_marked += s->pixels[i].marked != 0;
      tally->pixels_coloured += s->pixels[i].coloured != 0;
      tally->vertices += s->pixels[i].count;
    }
  tally->bake_seconds += seconds() - start;
  return result;
}
