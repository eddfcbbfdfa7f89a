/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/bake_tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bake/smooth_noise.h"
#include "core/compress.h"
#include "core/thin.h"
#include "core/transmittance.h"
#include "map/pack_tile.h"

enum { BATCH_RAYS = 4096 };   /* enough for a host to sort its objects by; a quarter of a megabyte of rays */

/* The automatic tolerance is not below this: half of an 8-bit step. */
static const double LEAST_TOLERANCE = 0.002;

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int paused(const bake_job *job)
{
  return job->host->pause && job->host->pause(job->host_data);
}

static int is_automatic(const dsm_settings *settings) { return settings->tolerance < 0; }

/* The smallest tolerance that a pixel of this map can come to have: what tracing has to be good for. */
static double finest_tolerance(const dsm_settings *settings)
{
  return is_automatic(settings) ? LEAST_TOLERANCE : settings->tolerance;
}

/* Depth that a surface up to about 60 degrees from facing the light takes within a pixel's filter. */
static noise_limits limits_of(const bake_job *job, uint32_t face_index)
{
  const face *f = &job->projection->faces[face_index];
  double size = 2 * job->settings->filter_width * fmax(f->pixel_u, f->pixel_v);
  double most = noise_ceiling(job->settings->samples);
  int perspective = job->projection->perspective;
  return (noise_limits){LEAST_TOLERANCE, fmax(most, LEAST_TOLERANCE), perspective ? size : 0,
                        perspective ? 0 : size};
}

/* Rays with volume spans have far more vertices together than their average needs; a small part of the tolerance
 * spares most of the work on them. */
static double thinning(const dsm_settings *settings) { return finest_tolerance(settings) / 32; }

/* What of the tolerance the function of a pixel with volume spans has cost: transmittance_build, and thinning. */
static double spent_on_volume(const dsm_settings *settings)
{
  return fmax(finest_tolerance(settings) / 4, 1e-6) + thinning(settings);
}

static dsm_result make_room(bake_scratch *s, uint32_t samples, uint32_t rays)
{
  if (s->room_samples < samples) {
    free(s->first);
    free(s->weights);
    free(s->path);
    s->room_samples = 0;
    s->first = malloc((samples + 1) * sizeof *s->first);
    s->weights = malloc(samples * sizeof *s->weights);
    s->path = malloc(samples * sizeof *s->path);
    if (!s->first || !s->weights || !s->path)
      return DSM_NO_MEMORY;
    s->room_samples = samples;
    pixel_sample_path(samples, s->path);
    for (uint32_t i = 0; i < samples; i++)
      s->weights[i] = 1.0 / samples;
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

/* The pixel's rays, neighbours one after the other. */
static void make_rays(const bake_job *job, const pixel_point *path, uint32_t face_index, uint32_t x, uint32_t y,
                      dsm_ray *rays)
{
  pixel_filter filter = {job->settings->filter, job->settings->filter_width};
  pixel_seed seed = pixel_sample_seed(face_index, x, y);
  for (uint32_t i = 0; i < job->settings->samples; i++) {
    double offset[2];
    pixel_sample_offset(&filter, seed, path[i], offset);
    projection_ray(job->projection, face_index, x + 0.5 + offset[0], y + 0.5 + offset[1], &rays[i]);
  }
}

/* What the events of a pixel are. */
typedef struct { int coloured, volume; } pixel_kind;

static pixel_kind kind_of(const event *events, size_t count)
{
  pixel_kind kind = {0, 0};
  for (size_t i = 0; i < count; i++) {
    kind.coloured |= !rgb_is_grey(events[i].transmittance);
    kind.volume |= events[i].back > events[i].front;
  }
  return kind;
}

/* A pixel with volume spans: the transmittance of every ray, then their average and its noise. */
static dsm_result average_volume(const bake_job *job, bake_scratch *s, uint32_t first_ray)
{
  uint32_t samples = job->settings->samples;
  double tolerance = finest_tolerance(job->settings);
  s->transmittances.count = 0;
  for (uint32_t i = 0; i < samples; i++) {
    size_t begin = s->sink.first[first_ray + i], end = s->sink.first[first_ray + i + 1];
    s->first[i] = s->transmittances.count;
    dsm_result result = transmittance_build(s->sink.ordered + begin, end - begin, tolerance,
                                            &s->transmittances);
    if (result != DSM_OK)
      return result;
  }
  s->first[samples] = s->transmittances.count;
  average_input in = {s->transmittances.data, s->first, s->weights, samples};
  return average_and_noise(&in, &s->sweep, is_automatic(job->settings) ? &s->noise : NULL, &s->average);
}

static int is_grey(const vertices *v)
{
  for (size_t i = 0; i < v->count; i++)
    if (!rgb_is_grey(v->data[i].v))
      return 0;
  return 1;
}

/* One ray that ends at once tells nothing of what its neighbours would have met. Its step stays where it is; but coarser
 * levels, which average such pixels, need not keep all of them. */
static int is_a_guess(const bake_job *job, const event *events)
{
  const rgb *t = &events[0].transmittance;
  return job->settings->samples == 1 && is_automatic(job->settings) && t->c[0] == 0 && t->c[1] == 0 && t->c[2] == 0;
}

/* Averages, compresses and keeps one pixel of the batch. */
static dsm_result bake_pixel(const bake_job *job, bake_scratch *s, const noise_limits *limits,
                             uint32_t first_ray, baked_pixel *pixel, tile_tally *tally)
{
  uint32_t samples = job->settings->samples;
  *pixel = (baked_pixel){.first = s->stored.count};
  if (memchr(s->sink.marked + first_ray, 1, samples)) {
    pixel->marked = 1;
    return DSM_OK;
  }
  size_t begin = s->sink.first[first_ray], count = s->sink.first[first_ray + samples] - begin;
  if (count == 0)
    return DSM_OK;
  const event *events = s->sink.ordered + begin;
  pixel_kind kind = kind_of(events, count);
  step_input steps = {events, count, first_ray, samples, kind.coloured ? 3 : 1};
  s->average.count = 0;
  dsm_result result = kind.volume ? average_volume(job, s, first_ray)
                                  : step_sweep(&steps, &s->steps, is_automatic(job->settings) ? &s->noise : NULL,
                                               &s->average);
  if (result != DSM_OK)
    return result;
  pixel->coloured = kind.coloured && !is_grey(&s->average);
  int channels = pixel->coloured ? 3 : 1;
  const vertices *clean = &s->average;
  tally->vertices_in += s->average.count;
  if (is_automatic(job->settings))
    pixel->tolerance = noise_rms(&s->noise, s->average.count);
  if (kind.volume)
    thin_vertices(&s->average, is_automatic(job->settings) ? s->noise.allowed : NULL, thinning(job->settings));
  if (is_automatic(job->settings)) {
    s->smooth.count = 0;
    result = smooth_noise(&s->average, &s->noise, channels, limits, &s->relative, &s->smooth);
    if (result != DSM_OK)
      return result;
    clean = &s->smooth;
  }
  double tolerance = finest_tolerance(job->settings);
  pixel->tolerance = is_a_guess(job, events) ? noise_ceiling(1) : fmax(pixel->tolerance, tolerance);
  double spent = VALUE_ROUNDING + (kind.volume ? spent_on_volume(job->settings) : 0);
  result = compress_minimal_after(clean->data, clean->count, channels, tolerance, spent, &s->stored);
  pixel->count = s->stored.count - pixel->first;
  return result;
}

/* The part of a tile that lies on its face, in pixels. */
typedef struct { uint32_t x, y, across, up; } tile_part;

static tile_part part_on_face(const face *f, const tile_key *key)
{
  tile_part p = {key->x * TILE_SIDE, key->y * TILE_SIDE, TILE_SIDE, TILE_SIDE};
  if (p.x + p.across > f->width)
    p.across = f->width - p.x;
  if (p.y + p.up > f->height)
    p.up = f->height - p.y;
  return p;
}

static dsm_result trace_batch(const bake_job *job, bake_scratch *s, uint32_t rays, tile_tally *tally)
{
  dsm_result result = sink_begin(&s->sink, s->rays, rays);
  if (result != DSM_OK)
    return result;
  double start = seconds();
  result = job->host->trace(job->host_data, s->rays, rays, finest_tolerance(job->settings), &s->sink);
  tally->trace_seconds += seconds() - start;
  tally->rays += rays;
  tally->events += s->sink.count;
  return result == DSM_OK ? sink_order(&s->sink) : result;
}

static dsm_result bake_pixels(const bake_job *job, bake_scratch *s, const tile_key *key, tile_tally *tally)
{
  tile_part part = part_on_face(&job->projection->faces[key->face], key);
  noise_limits limits = limits_of(job, key->face);
  uint32_t samples = job->settings->samples, total = part.across * part.up;
  uint32_t batch = samples < BATCH_RAYS ? BATCH_RAYS / samples : 1;
  if (batch > total)
    batch = total;
  dsm_result result = make_room(s, samples, batch * samples);
  s->stored.count = 0;
  for (int i = 0; i < TILE_PIXELS; i++)
    s->pixels[i] = (baked_pixel){0};

  for (uint32_t done = 0; result == DSM_OK && done < total; done += batch) {
    uint32_t count = batch < total - done ? batch : total - done;
    for (uint32_t i = 0; i < count; i++)
      make_rays(job, s->path, key->face, part.x + (done + i) % part.across, part.y + (done + i) / part.across,
                s->rays + (size_t)i * samples);
    result = paused(job) ? DSM_CANCELLED : trace_batch(job, s, count * samples, tally);
    for (uint32_t i = 0; i < count && result == DSM_OK; i++) {
      uint32_t place = (done + i) / part.across * TILE_SIDE + (done + i) % part.across;
      result = paused(job) ? DSM_CANCELLED : bake_pixel(job, s, &limits, i * samples, &s->pixels[place], tally);
    }
  }
  tally->pixels += total;
  return result;
}

dsm_result bake_tile(const bake_job *job, bake_scratch *s, const tile_key *key, const tile **out,
                     tile_tally *tally)
{
  double start = seconds();
  uint64_t dropped = s->sink.dropped, clamped = s->sink.clamped;
  *out = NULL;
  dsm_result result = bake_pixels(job, s, key, tally);
  if (result == DSM_OK)
    result = pack_tile(s->pixels, &s->stored, out);
  if (result == DSM_OK)
    for (int i = 0; i < TILE_PIXELS; i++) {
      tally->pixels_marked += s->pixels[i].marked != 0;
      tally->pixels_coloured += s->pixels[i].coloured != 0;
      tally->vertices += s->pixels[i].count;
    }
  tally->events_dropped += s->sink.dropped - dropped;
  tally->events_clamped += s->sink.clamped - clamped;
  tally->bake_seconds += seconds() - start;
  return result;
}

void bake_scratch_free(bake_scratch *s)
{
  free(s->rays);
  free(s->first);
  free(s->weights);
  free(s->path);
  sink_free(&s->sink);
  vertices_free(&s->transmittances);
  vertices_free(&s->average);
  vertices_free(&s->stored);
  average_free(&s->sweep);
  step_free(&s->steps);
  noise_free(&s->noise);
  vertices_free(&s->smooth);
  vertices_free(&s->relative);
}
