/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/bake_depth.h"

#include <math.h>

#include "bake/seconds.h"
#include "core/transmittance.h"

/* Half is half: what a span's light is to this precision decides at most by how much of a span a depth is off. */
static const double TOLERANCE = 0.002;

static dsm_ray make_ray(const bake_job *job, const tile_key *key, uint32_t x, uint32_t y)
{
  static const pixel_filter whole_pixel = {FILTER_BOX, 1};
  double offset[2] = {0, 0};
  dsm_ray ray;
  if (job->settings->jittered) {
    pixel_point first;
    pixel_sample_path(1, &first);
    pixel_sample_offsets(&whole_pixel, pixel_sample_seed(key->face, x, y), &first, 1, &offset);
  }
  projection_ray(job->projection, key->face, x + 0.5 + offset[0], y + 0.5 + offset[1], &ray);
  return ray;
}

static double mean(rgb v)
{
  return (v.c[0] + v.c[1] + v.c[2]) / 3;
}

/* Where the function of depth falls to a half, INFINITY if it does not. */
static double half_depth(const vertices *light)
{
  double z = 0, before = 1;
  for (size_t i = 0; i < light->count; i++) {
    double value = mean(light->data[i].v), at = light->data[i].z;
    if (value <= 0.5) {
      double share = before > value ? (before - 0.5) / (before - value) : 1;
      return i > 0 && at > z ? z + share * (at - z) : at;
    }
    z = at;
    before = value;
  }
  return INFINITY;
}

/* An opaque surface as the first event, nearly always; else all events of the ray. */
static dsm_result depth_of(depth_scratch *s, uint32_t ray, double *depth)
{
  const event *events = s->sink.ordered + s->sink.first[ray];
  size_t count = s->sink.first[ray + 1] - s->sink.first[ray];
  *depth = INFINITY;
  if (count == 0)
    return DSM_OK;
  if (events[0].front == events[0].back && mean(events[0].transmittance) <= 0.5) {
    *depth = events[0].front;
    return DSM_OK;
  }
  s->light.count = 0;
  dsm_result result = transmittance_build(events, count, TOLERANCE, &s->light);
  *depth = half_depth(&s->light);
  return result;
}

static dsm_result trace(const bake_job *job, depth_scratch *s, uint32_t count, tile_tally *tally)
{
  dsm_result result = sink_begin(&s->sink, s->rays, count);
  if (result != DSM_OK)
    return result;
  double start = seconds();
  result = job->host->trace(job->host_data, s->rays, count, TOLERANCE, &s->sink);
  tally->trace_seconds += seconds() - start;
  tally->rays += count;
  tally->events += s->sink.count;
  return result == DSM_OK ? sink_order(&s->sink) : result;
}

static uint32_t part_of(uint32_t pixels, uint32_t first)
{
  return pixels - first < TILE_SIDE ? pixels - first : TILE_SIDE;
}

/* Pixels beyond the face's edge are as those without a surface. */
static dsm_result find_depths(const bake_job *job, depth_scratch *s, const tile_key *key, double depths[TILE_PIXELS],
                              tile_tally *tally)
{
  const face *f = &job->projection->faces[key->face];
  uint32_t left = key->x * TILE_SIDE, low = key->y * TILE_SIDE;
  uint32_t across = part_of(f->width, left), up = part_of(f->height, low);
  for (uint32_t i = 0; i < across * up; i++)
    s->rays[i] = make_ray(job, key, left + i % across, low + i / across);
  for (uint32_t i = 0; i < TILE_PIXELS; i++)
    depths[i] = INFINITY;
  if (job->host->pause && job->host->pause(job->host_data))
    return DSM_CANCELLED;
  dsm_result result = trace(job, s, across * up, tally);
  for (uint32_t i = 0; i < across * up && result == DSM_OK; i++) {
    double *depth = &depths[i / across * TILE_SIDE + i % across];
    result = depth_of(s, i, depth);
    tally->vertices += *depth < INFINITY;
  }
  tally->pixels += across * up;
  return result;
}

dsm_result bake_depth(const bake_job *job, depth_scratch *s, const tile_key *key, const tile **out, tile_tally *tally)
{
  double start = seconds(), depths[TILE_PIXELS];
  uint64_t dropped = s->sink.dropped, clamped = s->sink.clamped;
  *out = NULL;
  dsm_result result = find_depths(job, s, key, depths, tally);
  if (result == DSM_OK)
    result = depth_tile_pack(depths, out);
  tally->events_dropped += s->sink.dropped - dropped;
  tally->events_clamped += s->sink.clamped - clamped;
  tally->bake_seconds += seconds() - start;
  return result;
}

void depth_scratch_free(depth_scratch *s)
{
  sink_free(&s->sink);
  vertices_free(&s->light);
}
