/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/map_header_words.h"
#include "store/plain_numbers.h"

enum { MOST_SCENES = 65536 };

typedef struct {
  const char *(*get)(void *data, const char *name);
  void *data;
} getter;

/* The text, or one that nothing can be read from. */
static const char *text_of(const getter *g, const char *name)
{
  const char *text = g->get(g->data, name);
  return text ? text : "";
}

static int read_numbers(const char *text, double *out, int count)
{
  for (int i = 0; i < count; i++) {
    char *end;
    out[i] = strtod(text, &end);
    if (end == text || isnan(out[i]))
      return 0;
    text = end;
  }
  return 1;
}

static int all_finite(const double *n, int count)
{
  double sum = 0;
  for (int i = 0; i < count; i++)
    sum += n[i] * 0;
  return sum == 0;
}

static int read_count(const char *text, double most, double *out)
{
  return read_numbers(text, out, 1) && *out >= 0 && *out <= most && *out == floor(*out);
}

/* The place of the text's first word in the list, or -1. */
static int read_word(const char *text, const char *const *words, int count)
{
  size_t length = strcspn(text, " ");
  for (int i = 0; i < count; i++)
    if (strlen(words[i]) == length && memcmp(words[i], text, length) == 0)
      return i;
  return -1;
}

static int read_light(const getter *g, dsm_light *light)
{
  int kind = read_word(text_of(g, "dsm:light"), light_words, 3);
  if (kind < 0 || !read_numbers(text_of(g, "dsm:origin"), light->origin, 3) || !all_finite(light->origin, 3))
    return 0;
  light->size = sizeof *light;
  light->kind = (uint32_t)kind;
  return (kind == DSM_LIGHT_POINT || read_numbers(text_of(g, "dsm:direction"), light->direction, 3))
      && (kind != DSM_LIGHT_SPOT || read_numbers(text_of(g, "dsm:cos_angle"), &light->cos_angle, 1))
      && (kind != DSM_LIGHT_PARALLEL || read_numbers(text_of(g, "dsm:radius"), &light->radius, 1));
}

static void take_axes(const double *n, frame *axes)
{
  memcpy(axes->right, n, sizeof axes->right);
  memcpy(axes->up, n + 3, sizeof axes->up);
  memcpy(axes->forward, n + 6, sizeof axes->forward);
}

static int read_face(const char *text, face *f)
{
  static const double most_pixels = 1 << (MAX_LEVELS - 1);   /* more have more levels */
  double n[19];
  if (!read_numbers(text, n, 19) || !(n[0] >= 0 && n[0] <= most_pixels && n[1] >= 0 && n[1] <= most_pixels))
    return 0;
  f->width = (uint32_t)n[0];
  f->height = (uint32_t)n[1];
  f->u0 = n[2];
  f->v0 = n[3];
  f->pixel_u = n[4];
  f->pixel_v = n[5];
  f->per_u = n[6];
  f->per_v = n[7];
  f->near_depth = n[8];
  f->far_depth = n[9];
  take_axes(n + 10, &f->axes);
  return (f->width > 0) == (f->height > 0)
      && (f->width == 0 || (all_finite(n, 19) && f->pixel_u > 0 && f->pixel_v > 0 && f->near_depth <= f->far_depth));
}

static int read_projection(const getter *g, projection *p)
{
  static const char *const words[] = {"orthographic", "perspective"};
  double n[12];
  p->perspective = read_word(text_of(g, "dsm:projection"), words, 2);
  if (p->perspective < 0 || !read_numbers(text_of(g, "dsm:frame"), n, 12) || !all_finite(n, 12))
    return 0;
  memcpy(p->origin, n, sizeof p->origin);
  take_axes(n + 3, &p->axes);
  if (!read_numbers(text_of(g, "dsm:faces"), n, 2) || !(n[0] == 0 || n[0] == 1 || n[0] == MAX_FACES))
    return 0;
  p->count = (uint32_t)n[0];
  p->overlap = n[1];
  for (uint32_t i = 0; i < p->count; i++) {
    char name[40];
    snprintf(name, sizeof name, "dsm:face%u", (unsigned)i);
    if (!read_face(text_of(g, name), &p->faces[i]))
      return 0;
  }
  return 1;
}

static int read_deep_settings(const getter *g, map_header *h)
{
  double samples;
  if (!read_count(text_of(g, "dsm:samples"), UINT32_MAX, &samples))
    return 0;
  h->samples = (uint32_t)samples;
  const char *tolerance = text_of(g, "dsm:tolerance"), *filter = text_of(g, "dsm:filter");
  h->tolerance = SETTING_AUTOMATIC;
  if (strcmp(tolerance, "automatic") != 0 && !(read_numbers(tolerance, &h->tolerance, 1) && h->tolerance >= 0))
    return 0;
  int kind = read_word(filter, filter_words, 3);
  if (kind < 0 || !read_numbers(filter + strlen(filter_words[kind]), &h->filter_width, 1) || !(h->filter_width > 0))
    return 0;
  h->filter = (filter_kind)kind;
  return 1;
}

static int read_depth_settings(const getter *g, map_header *h)
{
  h->jittered = read_word(text_of(g, "dsm:depth_samples"), depth_words, 2);
  return h->jittered >= 0;
}

static int read_settings(const getter *g, map_header *h)
{
  double n[6];
  if (!read_numbers(text_of(g, "dsm:resolution"), n, 2) || !(n[0] >= 1 && n[0] <= 16384 && n[1] >= 0 && n[1] <= 16384))
    return 0;
  h->resolution[0] = (uint32_t)n[0];
  h->resolution[1] = (uint32_t)n[1];
  if (!(h->block == BLOCK_SHADOW_MAP ? read_depth_settings(g, h) : read_deep_settings(g, h)))
    return 0;
  const char *bounds = text_of(g, "dsm:bounds");
  h->bounded = strcmp(bounds, "none") != 0;
  if (h->bounded && !read_numbers(bounds, n, 6))
    return 0;
  for (int i = 0; i < 3 && h->bounded; i++) {
    h->bounds.low[i] = n[i];
    h->bounds.high[i] = n[3 + i];
  }
  return 1;
}

static int read_scene(const char *text, scene_print *scene)
{
  if (strlen(text) != 2 * (DIGEST_CHARS - 1) + 1)
    return 0;
  memcpy(scene->casters, text, DIGEST_CHARS - 1);
  memcpy(scene->probes, text + DIGEST_CHARS, DIGEST_CHARS - 1);
  return 1;
}

static int read_content(const getter *g, map_header *h)
{
  double n;
  int depths = h->block == BLOCK_SHADOW_MAP;
  h->coloured = !depths && strcmp(text_of(g, "dsm:colour"), "yes") == 0;
  if (!read_count(text_of(g, depths ? "dsm:depths" : "dsm:vertices"), 0x1p53, &n))
    return 0;
  h->vertices = (uint64_t)n;
  if (!depths && !read_count(text_of(g, "dsm:pixels_marked"), 0x1p53, &n))
    return 0;
  h->pixels_marked = depths ? 0 : (uint64_t)n;
  if (!read_count(text_of(g, "dsm:scenes"), MOST_SCENES, &n) || n < 1)
    return 0;
  h->scene_count = (uint32_t)n;
  h->scenes = calloc(h->scene_count, sizeof *h->scenes);
  for (uint32_t i = 0; h->scenes && i < h->scene_count; i++) {
    char name[40];
    snprintf(name, sizeof name, "dsm:scene%u", (unsigned)i);
    if (!read_scene(text_of(g, name), &h->scenes[i]))
      return 0;
  }
  return h->scenes != NULL;
}

/* What was understood, written again, must be what was read: so every character counts. */
static dsm_result check_texts(const getter *g, const map_header *h, const char *path, map_reason *why)
{
  attribute_list list;
  dsm_result result = map_header_write(h, &list);
  for (uint32_t i = 0; i < list.count && result == DSM_OK; i++)
    if (strcmp(text_of(g, list.items[i].name), list.items[i].text) != 0)
      result = map_refused(why, "The shadow map \"%s\" is damaged: \"%s\" in its header is not what it should be.",
                           path, list.items[i].name);
  attribute_list_free(&list);
  return result == DSM_NO_MEMORY ? map_no_memory(why) : result;
}

dsm_result map_header_read(const char *(*get)(void *data, const char *name), void *data, const char *path,
                           map_header *header, map_reason *why)
{
  getter g = {get, data};
  memset(header, 0, sizeof *header);
  const char *format = get(data, "dsm:format");
  if (!format)
    return map_refused(why, "\"%s\" is an OpenEXR image, but not a shadow map.", path);
  unsigned long number = strtoul(format, NULL, 10);
  if (number > NEWEST_FORMAT)
    return map_refused(why, "The shadow map \"%s\" has format %lu, and this program knows only formats up to %u: it was "
                       "written by a newer one.", path, number, (unsigned)NEWEST_FORMAT);
  if (number == 1)
    return map_refused(why, "The shadow map \"%s\" has format 1, and this program reads only formats from %u on: it was written by an "
                       "older one. Bake the map again, with save_file.", path, (unsigned)DEPTHS_FORMAT);
  number_style style;
  if (!plain_numbers(&style))
    return map_no_memory(why);
  header->block = strcmp(text_of(&g, "dsm:map"), "depths") == 0 ? BLOCK_SHADOW_MAP : BLOCK_DEEP_SHADOW;
  header->projection.one_level = header->block == BLOCK_SHADOW_MAP;
  int read = read_light(&g, &header->light) && read_projection(&g, &header->projection) && read_settings(&g, header)
          && read_content(&g, header);
  restore_numbers(&style);
  dsm_result result = read ? check_texts(&g, header, path, why)
                    : header->scene_count && !header->scenes ? map_no_memory(why)
                    : map_refused(why, "The shadow map \"%s\" is damaged: its header cannot be read.", path);
  if (result != DSM_OK)
    map_header_free(header);
  return result;
}
