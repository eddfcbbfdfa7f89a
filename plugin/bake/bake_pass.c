/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/bake_pass.h"

#include <math.h>
#include <stdlib.h>

#include "bake/seconds.h"

enum { BATCH_RAYS = 4096 };   /* enough for a host to sort its objects by; a quarter of a megabyte of rays */

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
  double size = ldexp(1, (int)key->level);
  for (uint32_t i = 0; i < samples; i++) {
    double offset[2];
    pixel_sample_offset(&filter, seed, path[i], offset);
    projection_ray(job->projection, key->face, size * (x + 0.5 + offset[0]), size * (y + 0.5 + offset[1]), &rays[i]);
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

dsm_result bake_pass(const bake_job *job, bake_scratch *s, const tile_key *key, uint32_t samples,
                     const place_list *places, tile_tally *tally)
{
  uint32_t batch = samples < BATCH_RAYS ? BATCH_RAYS / samples : 1;
  if (batch > places->count)
    batch = places->count;
  noise_limits limits = limits_of(job, key->face, key->level, samples);
  dsm_result result = make_room(s, samples, batch * samples);
  for (uint32_t done = 0; result == DSM_OK && done < places->count; done += batch) {
    uint32_t count = batch < places->count - done ? batch : places->count - done;
    for (uint32_t i = 0; i < count; i++)
      make_rays(job, key, places->place[done + i], s->path, samples, s->rays + (size_t)i * samples);
    result = paused(job) ? DSM_CANCELLED : trace_batch(job, s, samples, count * samples, tally);
    for (uint32_t i = 0; i < count && result == DSM_OK; i++)
      result = paused(job) ? DSM_CANCELLED
                           : bake_pixel(job, &s->pixel, &s->sink, &limits, i * samples, samples, &s->stored,
                                        &s->pixels[places->place[done + i]], tally);
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
}
