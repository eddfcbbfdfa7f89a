/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "tool/header_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

number_text number_as_text(double number)
{
  number_text out;
  for (int digits = 1; digits <= 17; digits++) {
    snprintf(out.text, sizeof out.text, "%.*g", digits, number);
    if (strtod(out.text, NULL) == number && (digits > 6 || !strchr(out.text, 'e')))   /* rather 10 than 1e+01 */
      break;
  }
  return out;
}

#define NUMBER(x) (number_as_text(x).text)

typedef struct { char text[100]; } vector_text;

static vector_text vector_as_text(const double v[3])
{
  vector_text out;
  snprintf(out.text, sizeof out.text, "<%s, %s, %s>", NUMBER(v[0]), NUMBER(v[1]), NUMBER(v[2]));
  return out;
}

#define VECTOR(v) (vector_as_text(v).text)

typedef struct { header_line *lines; uint32_t count; } list;

__attribute__((format(printf, 4, 5)))
static void add(list *to, header_topic topic, const char *name, const char *format, ...)
{
  if (to->count == MAX_HEADER_LINES)
    return;
  header_line *line = &to->lines[to->count++];
  va_list arguments;
  line->topic = topic;
  snprintf(line->name, sizeof line->name, "%s", name);
  va_start(arguments, format);
  vsnprintf(line->text, sizeof line->text, format, arguments);
  va_end(arguments);
}

static void add_light(list *to, const dsm_light *light)
{
  vector_text at = vector_as_text(light->origin);
  const char *origin = at.text;
  if (light->kind == DSM_LIGHT_POINT)
    add(to, ABOUT_LIGHT, "light", "a point light at %s", origin);
  else if (light->kind == DSM_LIGHT_SPOT)
    add(to, ABOUT_LIGHT, "light", "a spotlight at %s along %s, up to %.10g degrees from its axis", origin,
        VECTOR(light->direction), acos(light->cos_angle) * 180 / acos(-1));
  else if (light->radius > 0)
    add(to, ABOUT_LIGHT, "light", "parallel light from %s along %s, up to %s from its axis", origin,
        VECTOR(light->direction), NUMBER(light->radius));
  else
    add(to, ABOUT_LIGHT, "light", "parallel light from %s along %s", origin, VECTOR(light->direction));
}

static void add_face(list *to, const projection *p, uint32_t index)
{
  const face *f = &p->faces[index];
  char name[24];
  if (!f->width)
    return;
  snprintf(name, sizeof name, "face %u", (unsigned)index);
  add(to, ABOUT_FRAME, name, "%u x %u pixels of %s x %s %s", (unsigned)f->width, (unsigned)f->height, NUMBER(f->pixel_u),
      NUMBER(f->pixel_v), p->perspective ? "(tangents)" : "scene units");
  add(to, ABOUT_FRAME, name, "lower left corner at %s, %s", NUMBER(f->u0), NUMBER(f->v0));
  add(to, ABOUT_FRAME, name, "casters from depth %s to %s", NUMBER(f->near_depth), NUMBER(f->far_depth));
  add(to, ABOUT_FRAME, name, "looks along %s, %s is up", VECTOR(f->axes.forward), VECTOR(f->axes.up));
}

static void add_deep_settings(list *to, const map_header *h)
{
  static const char *const filters[] = {"box", "triangle", "gaussian"};
  add(to, ABOUT_SETTINGS, "samples", "%u rays a pixel", (unsigned)h->samples);
  add(to, ABOUT_SETTINGS, "filter", "%s, %s pixels wide", h->filter <= FILTER_GAUSSIAN ? filters[h->filter] : "unknown",
      NUMBER(h->filter_width));
  if (h->tolerance < 0)
    add(to, ABOUT_TOLERANCE, "tolerance", "automatic");
  else
    add(to, ABOUT_TOLERANCE, "tolerance", "%s", NUMBER(h->tolerance));
}

static void add_settings(list *to, const map_header *h)
{
  if (h->resolution[1])
    add(to, ABOUT_SETTINGS, "resolution", "%u x %u", (unsigned)h->resolution[0], (unsigned)h->resolution[1]);
  else
    add(to, ABOUT_SETTINGS, "resolution", "%u", (unsigned)h->resolution[0]);
  if (h->block == BLOCK_DEEP_SHADOW)
    add_deep_settings(to, h);
  else
    add(to, ABOUT_SETTINGS, "samples", h->jittered ? "one ray a pixel, jittered" : "one ray a pixel, through its middle");
  if (h->bounded)
    add(to, ABOUT_SETTINGS, "bounds", "%s, %s", VECTOR(h->bounds.low), VECTOR(h->bounds.high));
}

uint32_t header_lines(const map_header *header, header_line lines[MAX_HEADER_LINES])
{
  list to = {lines, 0};
  const projection *p = &header->projection;
  if (header->block == BLOCK_SHADOW_MAP)
    add(&to, ABOUT_SETTINGS, "map", "shadow_map: one depth a pixel, where half of the light is gone");
  add_light(&to, &header->light);
  add(&to, ABOUT_FRAME, "frame", "%s, %s", p->perspective ? "perspective, depth is the distance from the light"
      : "orthographic, depth is the distance from the light's plane", p->count == MAX_FACES ? "a cube" : "one face");
  for (uint32_t i = 0; i < p->count; i++)
    add_face(&to, p, i);
  add_settings(&to, header);
  add(&to, ABOUT_SCENE, "scenes", header->scene_count == 1 ? "%u" : "%u, merged", (unsigned)header->scene_count);
  return to.count;
}
