/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "bake/bake_pixel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/compress.h"
#include "core/compress_lattice.h"
#include "core/rounding.h"
#include "core/thin.h"
#include "core/transmittance.h"

/* The automatic tolerance is not below this: half of an 8-bit step. */
static const double LEAST_TOLERANCE = 0.002;

static int is_automatic(const dsm_settings *settings) { return settings->tolerance < 0; }

double finest_tolerance(const dsm_settings *settings)
{
  return is_automatic(settings) ? LEAST_TOLERANCE : settings->tolerance;
}

uint32_t bake_value_bits(const dsm_settings *settings)
{
  return settings->tolerance * settings->samples < 1 ? VALUE_BITS : rounding_value_bits(settings->tolerance);
}

/* Depth that a surface up to about 60 degrees from facing the light takes within a pixel's filter. */
noise_limits limits_of(const bake_job *job, uint32_t face_index, uint32_t level, uint32_t samples)
{
  const face *f = &job->projection->faces[face_index];
  double size = 2 * job->settings->filter_width * ldexp(fmax(f->pixel_u, f->pixel_v), (int)level);
  double most = noise_ceiling(samples);
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

static int wants_noise(const dsm_settings *settings)
{
  return is_automatic(settings) || settings->accuracy > 0;
}

static dsm_result make_room(pixel_scratch *s, uint32_t samples)
{
  if (s->room >= samples)
    return DSM_OK;
  free(s->first);
  free(s->weights);
  s->room = 0;
  s->first = malloc((samples + 1) * sizeof *s->first);
  s->weights = malloc(samples * sizeof *s->weights);
  if (!s->first || !s->weights)
    return DSM_NO_MEMORY;
  s->room = samples;
  return DSM_OK;
}

/* Whether it takes no light, as the container of a volume. */
static int is_clear(const event *e)
{
  return e->transmittance.c[0] == 1 && e->transmittance.c[1] == 1 && e->transmittance.c[2] == 1;
}

/* What the events of a pixel are. */
typedef struct { int coloured, volume, surface, clear; } pixel_kind;

static pixel_kind kind_of(const event *events, size_t count)
{
  pixel_kind kind = {0, 0, 0, 0};
  for (size_t i = 0; i < count; i++) {
    kind.coloured |= !rgb_is_grey(events[i].transmittance);
    if (events[i].back > events[i].front)
      kind.volume = 1;
    else if (is_clear(&events[i]))
      kind.clear = 1;
    else
      kind.surface = 1;
  }
  return kind;
}

/* A pixel with volume spans: the transmittance of every ray that counts, then their average and its noise. */
static dsm_result average_volume(const bake_job *job, pixel_scratch *s, const dsm_sink *sink, uint32_t first_ray,
                                 uint32_t samples)
{
  double tolerance = finest_tolerance(job->settings);
  dsm_result room = make_room(s, samples);
  if (room != DSM_OK)
    return room;
  s->transmittances.count = 0;
  uint32_t rays = 0;
  for (uint32_t i = first_ray; i < first_ray + samples; i++) {
    if (sink->spared[i])
      continue;
    size_t begin = sink->first[i], end = sink->first[i + 1];
    s->first[rays++] = s->transmittances.count;
    dsm_result result = transmittance_build(sink->ordered + begin, end - begin, tolerance,
                                            &s->transmittances);
    if (result != DSM_OK)
      return result;
  }
  s->first[rays] = s->transmittances.count;
  for (uint32_t i = 0; i < rays; i++)
    s->weights[i] = 1.0 / rays;
  average_input in = {s->transmittances.data, s->first, s->weights, rays};
  return average_and_noise(&in, &s->sweep, wants_noise(job->settings) ? &s->noise : NULL, &s->average);
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
static int is_a_guess(const bake_job *job, uint32_t samples, const event *events)
{
  const rgb *t = &events[0].transmittance;
  return samples == 1 && is_automatic(job->settings) && t->c[0] == 0 && t->c[1] == 0 && t->c[2] == 0;
}

/* So many rays in a pixel pay for the search for values that can be stored as they are. With 16, compression would take longer than all else
 * beside the rays, and with it the bake a third longer (measured: hair); with 64, a twelfth. */
enum { RAYS_FOR_LATTICE = 64 };

static dsm_result compress_pixel(const bake_job *job, const vertices *in, int channels, uint32_t samples, double spent, vertices *out)
{
  double tolerance = finest_tolerance(job->settings);
  uint32_t bits = bake_value_bits(job->settings);
  return samples < RAYS_FOR_LATTICE ? compress_minimal_after(in->data, in->count, channels, tolerance, spent + rounding_of_bits(bits), out)
                                    : compress_rounded(in->data, in->count, channels, tolerance, spent, bits, out);
}

dsm_result bake_pixel(const bake_job *job, pixel_scratch *s, const dsm_sink *sink, const noise_limits *limits,
                      uint32_t first_ray, uint32_t samples, vertices *stored, baked_pixel *pixel, tile_tally *tally)
{
  *pixel = (baked_pixel){.first = stored->count};
  if (memchr(sink->marked + first_ray, 1, samples)) {
    pixel->marked = 1;
    return DSM_OK;
  }
  size_t begin = sink->first[first_ray], count = sink->first[first_ray + samples] - begin;
  if (count == 0)
    return DSM_OK;
  const event *events = sink->ordered + begin;
  pixel_kind kind = kind_of(events, count);
  kind.volume |= memchr(sink->spared + first_ray, 1, samples) != NULL;
  step_input steps = {events, count, first_ray, samples, kind.coloured ? 3 : 1};
  s->average.count = 0;
  dsm_result result = kind.volume ? average_volume(job, s, sink, first_ray, samples)
                                  : step_sweep(&steps, &s->steps, wants_noise(job->settings) ? &s->noise : NULL,
                                               &s->average);
  if (result != DSM_OK)
    return result;
  pixel->volume = kind.volume;
  pixel->surface = kind.surface;
  pixel->clear = kind.clear;
  pixel->coloured = kind.coloured && !is_grey(&s->average);
  int channels = pixel->coloured ? 3 : 1, compressed = 0;
  const vertices *clean = &s->average;
  tally->vertices_in += s->average.count;
  if (job->settings->accuracy > 0)
    pixel->variance = noise_lasting(&s->noise, &s->average, limits->thin, limits->thin_at_least);
  if (is_automatic(job->settings))
    pixel->tolerance = noise_rms(&s->noise, s->average.count);
  if (kind.volume)
    thin_vertices(&s->average, is_automatic(job->settings) ? s->noise.allowed : NULL, thinning(job->settings));
  if (is_automatic(job->settings)) {
    s->smooth.count = 0;
    result = smooth_noise(&s->average, &s->noise, channels, limits, &s->relative, &s->smooth, &compressed);
    if (result != DSM_OK)
      return result;
    clean = &s->smooth;
  }
  double tolerance = finest_tolerance(job->settings);
  pixel->tolerance = is_a_guess(job, samples, events) ? noise_ceiling(1) : fmax(pixel->tolerance, tolerance);
  double spent = rounding_of_depths(kind.volume, tolerance) + (kind.volume ? spent_on_volume(job->settings) : 0);
  result = compressed ? vertices_append(stored, clean->data, clean->count)
                      : compress_pixel(job, clean, channels, samples, spent, stored);
  pixel->count = stored->count - pixel->first;
  return result;
}

void pixel_scratch_free(pixel_scratch *s)
{
  free(s->first);
  free(s->weights);
  vertices_free(&s->transmittances);
  vertices_free(&s->average);
  average_free(&s->sweep);
  step_free(&s->steps);
  noise_free(&s->noise);
  vertices_free(&s->smooth);
  vertices_free(&s->relative);
}
