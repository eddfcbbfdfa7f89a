/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/map_header.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const light_words[] = {"a point light", "a spotlight", "a parallel light"};
static const char *const filter_words[] = {"box", "triangle", "gaussian"};

static int same3(const double a[3], const double b[3])
{
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

static int same_axes(const frame *a, const frame *b)
{
  return same3(a->right, b->right) && same3(a->up, b->up) && same3(a->forward, b->forward);
}

static int same_face(const face *a, const face *b)
{
  if (a->width != b->width || a->height != b->height)
    return 0;
  return a->width == 0
      || (same_axes(&a->axes, &b->axes) && a->u0 == b->u0 && a->v0 == b->v0 && a->pixel_u == b->pixel_u
          && a->pixel_v == b->pixel_v && a->per_u == b->per_u && a->per_v == b->per_v
          && a->near_depth == b->near_depth && a->far_depth == b->far_depth);
}

static int same_projection(const projection *a, const projection *b)
{
  if (a->count != b->count || a->perspective != b->perspective || a->overlap != b->overlap
      || !same3(a->origin, b->origin) || !same_axes(&a->axes, &b->axes))
    return 0;
  for (uint32_t i = 0; i < a->count; i++)
    if (!same_face(&a->faces[i], &b->faces[i]))
      return 0;
  return 1;
}

/* "its origin was <1, 2, 3>, and is <1, 2, 4>" */
static dsm_result other_place(const char *path, const char *what, const double was[3], const double is[3], map_reason *why)
{
  return map_refused(why, "The shadow map \"%s\" is of another light: its %s was <%.10g, %.10g, %.10g>, and is "
                     "<%.10g, %.10g, %.10g>.", path, what, was[0], was[1], was[2], is[0], is[1], is[2]);
}

static dsm_result other_number(const char *path, const char *what, double was, double is, map_reason *why)
{
  return map_refused(why, "The shadow map \"%s\" is of another light: its %s was %.10g, and is %.10g.", path, what, was,
                     is);
}

static double degrees(double cosine)
{
  return acos(fmax(-1, fmin(1, cosine))) * (180 / acos(-1));
}

static dsm_result compare_light(const dsm_light *is, const dsm_light *was, const char *path, map_reason *why)
{
  if (is->kind != was->kind)
    return map_refused(why, "The shadow map \"%s\" is of another light: of %s, and this is %s.", path,
                       light_words[was->kind], light_words[is->kind]);
  if (!same3(is->origin, was->origin))
    return other_place(path, "origin", was->origin, is->origin, why);
  if (is->kind != DSM_LIGHT_POINT && !same3(is->direction, was->direction))
    return other_place(path, "direction", was->direction, is->direction, why);
  if (is->kind == DSM_LIGHT_SPOT && is->cos_angle != was->cos_angle)
    return other_number(path, "half angle in degrees", degrees(was->cos_angle), degrees(is->cos_angle), why);
  if (is->kind == DSM_LIGHT_PARALLEL && is->radius != was->radius)
    return other_number(path, "radius", was->radius, is->radius, why);
  return DSM_OK;
}

/* What a scene would have to write for the same map. */
typedef struct { char text[200]; } setting_text;

static setting_text text_of(const map_header *h, uint32_t word)
{
  setting_text t = {""};
  size_t size = sizeof t.text;
  const double *low = h->bounds.low, *high = h->bounds.high;
  if (word == WORD_RESOLUTION && h->resolution[1])
    snprintf(t.text, size, "<%u, %u>", (unsigned)h->resolution[0], (unsigned)h->resolution[1]);
  else if (word == WORD_RESOLUTION)
    snprintf(t.text, size, "%u", (unsigned)h->resolution[0]);
  else if (word == WORD_SAMPLES)
    snprintf(t.text, size, "%u", (unsigned)h->samples);
  else if (word == WORD_TOLERANCE && h->tolerance < 0)
    snprintf(t.text, size, "automatic");
  else if (word == WORD_TOLERANCE)
    snprintf(t.text, size, "%.10g", h->tolerance);
  else if (word == WORD_DEPTH_SAMPLES)
    snprintf(t.text, size, h->jittered ? "\"jittered\"" : "\"regular\"");
  else if (word == WORD_FILTER)
    snprintf(t.text, size, "\"%s\", %.10g", filter_words[h->filter], h->filter_width);
  else if (!h->bounded)
    snprintf(t.text, size, "none");
  else
    snprintf(t.text, size, "<%.10g, %.10g, %.10g>, <%.10g, %.10g, %.10g>", low[0], low[1], low[2], high[0], high[1],
             high[2]);
  return t;
}

static int same_setting(const map_header *a, const map_header *b, uint32_t word)
{
  switch (word) {
    case WORD_RESOLUTION:
      return a->resolution[0] == b->resolution[0] && a->resolution[1] == b->resolution[1];
    case WORD_SAMPLES:
      return a->samples == b->samples;
    case WORD_TOLERANCE:
      return a->tolerance == b->tolerance || b->scene_count > 1;   /* merging adds to it */
    case WORD_FILTER:
      return a->filter == b->filter && a->filter_width == b->filter_width;
    case WORD_DEPTH_SAMPLES:
      return a->jittered == b->jittered;
    default:
      return a->bounded == b->bounded
          && (!a->bounded || (same3(a->bounds.low, b->bounds.low) && same3(a->bounds.high, b->bounds.high)));
  }
}

/* What the bake depends on. */
static int is_of_the_bake(block_kind block, uint32_t word)
{
  if (word == WORD_SAMPLES)
    return block == BLOCK_DEEP_SHADOW;
  return word == WORD_RESOLUTION || word == WORD_TOLERANCE || word == WORD_FILTER || word == WORD_BOUNDS
      || word == WORD_DEPTH_SAMPLES;
}

static dsm_result compare_settings(const map_header *is, const map_header *was, const char *path, map_reason *why)
{
  const dsm_block *block = &settings_blocks[is->block];
  for (uint32_t i = 0; i < block->parameter_count; i++) {
    uint32_t word = settings_word(is->block, i);
    if (!is_of_the_bake(is->block, word) || same_setting(is, was, word))
      continue;
    setting_text then = text_of(was, word), now = text_of(is, word);
    return map_refused(why, "The shadow map \"%s\" was made with other settings: '%s' was %s, and is %s.", path,
                       block->parameters[i].name, then.text, now.text);
  }
  return DSM_OK;
}

static dsm_result compare_scene(const map_header *is, const map_header *was, const char *path, map_reason *why)
{
  int casters = 0, both = 0;
  for (uint32_t i = 0; i < was->scene_count; i++) {
    int same = strcmp(is->scenes[0].casters, was->scenes[i].casters) == 0;
    casters |= same;
    both |= same && strcmp(is->scenes[0].probes, was->scenes[i].probes) == 0;
  }
  if (!casters)
    return map_refused(why, "The shadow map \"%s\" is of another scene: the objects that cast shadows are not where they "
                       "were, or not the same.", path);
  if (!same_projection(&is->projection, &was->projection))
    return map_refused(why, "The shadow map \"%s\" has another frame than this light asks for.", path);
  if (!both)
    return map_refused(why, "The shadow map \"%s\" is of another scene: the objects that cast shadows are where they "
                       "were, but light rays meet something else.", path);
  return DSM_OK;
}

dsm_result map_header_compare(const map_header *wanted, const map_header *file, const char *path, map_reason *why)
{
  if (wanted->block != file->block)
    return map_refused(why, "The shadow map \"%s\" is that of a %s block, and cannot be used in a %s block.", path,
                       settings_blocks[file->block].name, settings_blocks[wanted->block].name);
  dsm_result result = compare_light(&wanted->light, &file->light, path, why);
  if (result == DSM_OK)
    result = compare_settings(wanted, file, path, why);
  if (result == DSM_OK)
    result = compare_scene(wanted, file, path, why);
  return result;
}
