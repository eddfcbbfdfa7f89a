/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "tool/merge_tile.h"

#include <math.h>
#include <stdlib.h>

#include "core/compress.h"
#include "map/pack_tile.h"
#include "map/read_tile.h"

/* The weighted mean of the tiles that store anything; lit ones do not know theirs. */
static double error_of(const merge_input *in)
{
  double sum = 0, weights = 0;
  if (in->error >= 0)
    return in->error;
  for (uint32_t i = 0; i < in->count; i++)
    if (in->tiles[i]->kind == TILE_STORED) {
      sum += in->weights[i] * (double)in->tiles[i]->tolerance;
      weights += in->weights[i];
    }
  return weights > 0 ? sum / weights : 0;
}

/* The pixel's functions into s->parts, s->first. */
static dsm_result gather(const merge_input *in, merge_scratch *s, uint32_t place, baked_pixel *pixel)
{
  s->parts.count = 0;
  for (uint32_t i = 0; i < in->count; i++) {
    const tile *t = in->tiles[i];
    s->first[i] = s->parts.count;
    if (t->kind != TILE_STORED)
      continue;
    if (tile_is_marked(t, place)) {
      pixel->marked = 1;
      return DSM_OK;
    }
    dsm_result result = read_pixel(t, place, &s->parts);
    if (result != DSM_OK)
      return result;
    pixel->coloured |= tile_is_coloured(t, place);
  }
  s->first[in->count] = s->parts.count;
  return DSM_OK;
}

/* Half of what the inputs were allowed. Where that was a share of their noise, the average has less of it (its variance is
 * that of one map times the sum of the squared weights), and is allowed the same share of that. */
static double added_to(const merge_input *in, double error)
{
  if (in->tolerance >= 0)
    return in->tolerance;
  double variance = 0;
  for (uint32_t i = 0; i < in->count; i++)
    variance += in->weights[i] * in->weights[i];
  return in->error >= 0 ? 0.5 * error : fmin(0.5, sqrt(variance)) * error;
}

static dsm_result merge_pixel(const merge_input *in, merge_scratch *s, uint32_t place, double added, double error)
{
  baked_pixel *pixel = &s->pixels[place];
  *pixel = (baked_pixel){.first = s->stored.count};
  dsm_result result = gather(in, s, place, pixel);
  if (result != DSM_OK || pixel->marked || s->parts.count == 0)
    return result;
  average_input functions = {s->parts.data, s->first, in->weights, in->count};
  s->average.count = 0;
  result = average_sweep(&functions, &s->heap, &s->average);
  if (result == DSM_OK)
    result = compress_minimal_after(s->average.data, s->average.count, pixel->coloured ? 3 : 1, added, VALUE_ROUNDING,
                                    &s->stored);
  pixel->count = s->stored.count - pixel->first;
  pixel->tolerance = error + added;
  return result;
}

dsm_result merge_tiles(const merge_input *in, merge_scratch *s, const tile **out)
{
  *out = NULL;
  if (s->room <= in->count) {
    free(s->first);
    s->first = malloc(((size_t)in->count + 1) * sizeof *s->first);
    s->room = s->first ? in->count + 1 : 0;
    if (!s->first)
      return DSM_NO_MEMORY;
  }
  double error = error_of(in), added = added_to(in, error);
  s->stored.count = 0;
  for (uint32_t place = 0; place < TILE_PIXELS; place++) {
    dsm_result result = merge_pixel(in, s, place, added, error);
    if (result != DSM_OK)
      return result;
  }
  const rounding rule = rounding_least();
  return pack_tile(s->pixels, &s->stored, &rule, out);
}

void merge_scratch_free(merge_scratch *s)
{
  vertices_free(&s->parts);
  vertices_free(&s->average);
  vertices_free(&s->stored);
  average_free(&s->heap);
  free(s->first);
  s->first = NULL;
  s->room = 0;
}
