/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/bake_pass.h"

#include <math.h>
#include <stdlib.h>

#include "bake/seconds.h"

/* Of a batch, at most unless one pixel has more: a quarter of a megabyte. Of a share, at least: enough for a host to sort its objects by. */
enum { BATCH_RAYS = 4096, SHARE_RAYS = 1024 };

enum { RAYS_AT_ONCE = 16 };

static int paused(const bake_job *job)
{
  return job->host->pause && job->host->pause(job->host_data);
}

static dsm_result make_room(bake_scratch *s, uint32_t samples, uint32_t rays)
{
  if (s->room_path < samples) {
    free(s->path);
    s->room_path = s->path_samples = 0;
    s->path = malloc(samples * sizeof *s->path);
    if (!s->path)
      return DSM_NO_MEMORY;
    s->room_path = samples;
  }
  if (s->path_samples != samples) {
    pixel_sample_path(samples, s->path);
    s->path_samples = samples;
  }
  if (s->room_rays < rays) {
    free(s->rays);
    s->room_rays = 0;
    s->rays = malloc(rays * sizeof *s->rays);
    if (!s->rays)
      return DSM_NO_MEMORY;
    s->room_rays = rays;
  }
  return DSM_OK;
}

/* The rays of the pixel at a place, neighbours one after the other. */
static void make_rays(const bake_job *job, const tile_key *key, uint32_t place, const pixel_point *path, uint32_t samples,
                      dsm_ray *rays)
{
  pixel_filter filter = {job->settings->filter, job->settings->filter_width};
  uint32_t x = key->x * TILE_SIDE + place % TILE_SIDE, y = key->y * TILE_SIDE + place / TILE_SIDE;
  pixel_seed seed = pixel_sample_seed(key->face + MAX_FACES * key->level, x, y);
  double size = ldexp(1, (int)key->level), at[RAYS_AT_ONCE][2];
  for (uint32_t i = 0, count; i < samples; i += count) {
    count = samples - i < RAYS_AT_ONCE ? samples - i : RAYS_AT_ONCE;
    pixel_sample_offsets(&filter, seed, path + i, count, at);
    for (uint32_t k = 0; k < count; k++) {
      at[k][0] = size * (x + 0.5 + at[k][0]);
      at[k][1] = size * (y + 0.5 + at[k][1]);
    }
    projection_rays(job->projection, key->face, at, count, rays + i);
  }
}

static dsm_result trace_batch(const bake_job *job, bake_scratch *s, uint32_t samples, uint32_t rays, tile_tally *tally)
{
  dsm_result result = sink_begin(&s->sink, s->rays, rays);
  if (result != DSM_OK)
    return result;
  double start = seconds();
  s->sink.pixel_rays = samples;
  result = job->host->trace(job->host_data, s->rays, rays, finest_tolerance(job->settings), &s->sink);
  tally->trace_seconds += seconds() - start;
  tally->rays += rays;
  tally->events += s->sink.count;
  return result == DSM_OK ? sink_order(&s->sink) : result;
}

/* A pass in shares. The last ones may be smaller, or empty. */
typedef struct {
  tile_shares shares;   /* first: shares of ours are the pass that begins with them */
  const tile_key *key;
  const place_list *places;
  uint32_t samples, share_pixels;
  bake_scratch *out;    /* of the thread whose tile it is */
} pass;

static uint32_t smaller(uint32_t a, uint32_t b)
{
  return a < b ? a : b;
}

static uint32_t larger(uint32_t a, uint32_t b)
{
  return a > b ? a : b;
}

static uint32_t past_share(const pass *p, uint32_t share)
{
  return smaller((share + 1) * p->share_pixels, p->places->count);
}

/* The rays of as many pixels as a batch takes, from *done on, of which *count have something to trace: their places. The others are lit. */
static void fill_batch(const pass *p, const bake_job *job, bake_scratch *s, baked_share *out, uint32_t past, uint32_t batch, uint32_t *done,
                       uint8_t place[TILE_PIXELS], uint32_t *count)
{
  uint32_t samples = p->samples;
  for (*count = 0; *done < past && *count < batch; ++*done) {
    dsm_ray *rays = s->rays + (size_t)*count * samples;
    place[*count] = p->places->place[*done];
    make_rays(job, p->key, place[*count], s->path, samples, rays);
    if (job->settings->accuracy > 0 && !tile_boxes_may_meet(&p->out->boxes, rays, samples))
      p->out->pixels[place[*count]] = (baked_pixel){.first = out->stored.count};
    else
      ++*count;
  }
}

static dsm_result bake_batches(const pass *p, const bake_job *job, bake_scratch *s, uint32_t share)
{
  uint32_t past = past_share(p, share), samples = p->samples;
  uint32_t batch = smaller(p->share_pixels, larger(BATCH_RAYS / samples, 1));
  baked_share *out = &p->out->shares[share];
  noise_limits limits = limits_of(job, p->key->face, p->key->level, samples);
  dsm_result result = make_room(s, samples, batch * samples);
  for (uint32_t done = share * p->share_pixels; result == DSM_OK && done < past;) {
    uint8_t place[TILE_PIXELS];
    uint32_t count;
    fill_batch(p, job, s, out, past, batch, &done, place, &count);
    result = paused(job) ? DSM_CANCELLED : count == 0 ? DSM_OK : trace_batch(job, s, samples, count * samples, &out->tally);
    for (uint32_t i = 0; i < count && result == DSM_OK; i++)
      result = paused(job) ? DSM_CANCELLED
                           : bake_pixel(job, &s->pixel, &s->sink, &limits, i * samples, samples, &out->stored,
                                        &p->out->pixels[place[i]], &out->tally);
  }
  return result;
}

static dsm_result bake_share(const pass *p, const bake_job *job, bake_scratch *s, uint32_t share)
{
  double start = seconds();
  uint64_t dropped = s->sink.dropped, clamped = s->sink.clamped;
  baked_share *out = &p->out->shares[share];
  out->stored.count = 0;   /* a helper may have given it up */
  out->tally = (tile_tally){0};
  dsm_result result = bake_batches(p, job, s, share);
  out->tally.events_dropped = s->sink.dropped - dropped;
  out->tally.events_clamped = s->sink.clamped - clamped;
  if (s != p->out)   /* else it is a part of what the tile takes */
    out->tally.bake_seconds = seconds() - start;
  return result;
}

static dsm_result make_share(tile_shares *shares, tile_maker *maker, uint32_t share)
{
  pixel_baker *b = (pixel_baker *)(void *)maker;
  return bake_share((const pass *)(const void *)shares, &b->job, &b->scratch, share);
}

/* Puts the shares together. */
static dsm_result gather(const pass *p, uint32_t share, tile_tally *tally)
{
  const baked_share *from = &p->out->shares[share];
  for (uint32_t i = share * p->share_pixels; i < past_share(p, share); i++)
    p->out->pixels[p->places->place[i]].first += p->out->stored.count;
  tile_tally_add(tally, &from->tally);
  return vertices_append(&p->out->stored, from->stored.data, from->stored.count);
}

dsm_result bake_pass(const bake_job *job, bake_scratch *s, const tile_key *key, uint32_t samples,
                     const place_list *places, tile_tally *tally)
{
  uint32_t count = smaller(MOST_SHARES, larger(places->count * samples / SHARE_RAYS, 1));
  pass p = {.shares = {.count = count, .make = make_share}, .key = key, .places = places, .samples = samples,
            .share_pixels = (places->count + count - 1) / count, .out = s};
  dsm_result result = DSM_OK;
  for (uint32_t k = 0; k < count; k++) {
    s->shares[k].stored.count = 0;
    s->shares[k].tally = (tile_tally){0};
  }
  if (job->store && count > 1)
    result = tile_shares_do(job->store, key, &p.shares, job->maker);
  else
    for (uint32_t k = 0; k < count && result == DSM_OK; k++)
      result = bake_share(&p, job, s, k);
  for (uint32_t k = 0; k < count; k++) {
    dsm_result gathered = gather(&p, k, tally);
    if (result == DSM_OK)
      result = gathered;
  }
  return result;
}

void bake_scratch_free(bake_scratch *s)
{
  free(s->rays);
  free(s->path);
  sink_free(&s->sink);
  pixel_scratch_free(&s->pixel);
  vertices_free(&s->stored);
  vertices_free(&s->near_by);
  for (uint32_t k = 0; k < MOST_SHARES; k++)
    vertices_free(&s->shares[k].stored);
}
