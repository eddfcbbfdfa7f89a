/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A host whose scenes have closed-form answers: spheres, flat sheets and boxes of fog. It drives the library through
 * dsm_api as a renderer does. Include after cmocka.h.
 */
#ifndef TESTS_ORACLE_H
#define TESTS_ORACLE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../unit/random.h"
#include "dsm.h"

typedef enum { SPHERE, SHEET, FOG } shape_kind;

typedef struct {
  shape_kind kind;
  dsm_box box;              /* SHEET: flat along `axis`; SPHERE: its bounds; FOG: where it is */
  double pass[3];           /* SPHERE, SHEET: transmittance of each surface */
  double density[3];        /* FOG: extinction at box.low along `axis`, a scene unit */
  double growth;            /* FOG: density is multiplied by 1 + growth * (position - box.low[axis]) */
  int axis;
} shape;

typedef struct {
  const shape *shapes;
  int count;
  dsm_result fail_with;     /* what trace returns instead of tracing, unless DSM_OK */
  int32_t stop;             /* what pause returns */
  dsm_box *boxes;           /* of the shapes, as long as the map lives */
  int sentences;            /* reported so far */
  char last[600];
} world;

static inline shape sphere_at(double x, double y, double z, double radius, double pass) {
  return (shape){SPHERE, {{x - radius, y - radius, z - radius}, {x + radius, y + radius, z + radius}},
                 {pass, pass, pass}, {0}, 0, 0};
}

/* A square sheet across the z axis. */
static inline shape sheet_at(double z, double half, double r, double g, double b) {
  return (shape){SHEET, {{-half, -half, z}, {half, half, z}}, {r, g, b}, {0}, 0, 2};
}

static inline shape fog_in(dsm_box box, double r, double g, double b, double growth) {
  return (shape){FOG, box, {0}, {r, g, b}, growth, 2};
}

/* Depths where the ray is in the box. */
static inline int cross_box(const dsm_box *box, const dsm_ray *ray, double span[2]) {
  span[0] = ray->near_depth;
  span[1] = ray->far_depth;
  for (int i = 0; i < 3; ++i) {
    if (ray->direction[i] == 0) {
      if (ray->origin[i] < box->low[i] || ray->origin[i] > box->high[i]) return 0;
      continue;
    }
    double a = (box->low[i] - ray->origin[i]) / ray->direction[i], b = (box->high[i] - ray->origin[i]) / ray->direction[i];
    span[0] = fmax(span[0], fmin(a, b));
    span[1] = fmin(span[1], fmax(a, b));
  }
  return span[0] < span[1];
}

static inline dsm_result trace_sphere(const shape *s, const dsm_ray *ray, uint32_t index, dsm_sink *sink) {
  double centre[3], radius = 0.5 * (s->box.high[0] - s->box.low[0]), along = 0, away = 0;
  for (int i = 0; i < 3; ++i) {
    centre[i] = 0.5 * (s->box.low[i] + s->box.high[i]) - ray->origin[i];
    along += centre[i] * ray->direction[i];
  }
  for (int i = 0; i < 3; ++i) {
    double d = centre[i] - along * ray->direction[i];
    away += d * d;
  }
  if (away > radius * radius) return DSM_OK;
  double half = sqrt(radius * radius - away);
  dsm_result result = DSM_OK;
  if (along - half > 0) result = dsm_api.sink_surface(sink, index, along - half, s->pass);
  if (result == DSM_OK && along + half > 0) result = dsm_api.sink_surface(sink, index, along + half, s->pass);
  return result;
}

static inline dsm_result trace_sheet(const shape *s, const dsm_ray *ray, uint32_t index, dsm_sink *sink) {
  double depth = (s->box.low[s->axis] - ray->origin[s->axis]) / ray->direction[s->axis];
  if (!(depth > 0)) return DSM_OK;
  for (int i = 0; i < 3; ++i) {
    double p = ray->origin[i] + depth * ray->direction[i];
    if (i != s->axis && (p < s->box.low[i] || p > s->box.high[i])) return DSM_OK;
  }
  return dsm_api.sink_surface(sink, index, depth, s->pass);
}

/* The integral of a fog's density of 1 from depth a to b. */
static inline double fog_integral(const shape *s, const dsm_ray *ray, double a, double b) {
  double middle = ray->origin[s->axis] + 0.5 * (a + b) * ray->direction[s->axis] - s->box.low[s->axis];
  return (b - a) * (1 + s->growth * middle);
}

static inline dsm_result trace_fog(const shape *s, const dsm_ray *ray, double tolerance, uint32_t index, dsm_sink *sink) {
  double span[2];
  if (!cross_box(&s->box, ray, span)) return DSM_OK;
  /* within a part of length h the density's change bends the logarithm by slope h^2 / 8 */
  double slope = fabs(s->growth * ray->direction[s->axis]) * fmax(s->density[0], fmax(s->density[1], s->density[2]));
  double length = span[1] - span[0], bend = fmax(tolerance / 16, 1e-7);
  int parts = 1 + (int)(length * sqrt(slope / (8 * bend)));
  for (int k = 0; k < parts; ++k) {
    double a = span[0] + length * k / parts, b = span[0] + length * (k + 1) / parts, pass[3];
    for (int c = 0; c < 3; ++c) pass[c] = exp(-s->density[c] * fog_integral(s, ray, a, b));
    dsm_result result = dsm_api.sink_span(sink, index, a, b, pass);
    if (result != DSM_OK) return result;
  }
  return DSM_OK;
}

static inline dsm_result trace_world(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink) {
  const world *w = data;
  if (w->fail_with != DSM_OK) return w->fail_with;
  for (uint32_t r = 0; r < count; ++r)
    for (int i = w->count - 1; i >= 0; --i) {   /* backwards: events need no order */
      const shape *s = &w->shapes[i];
      dsm_result result = s->kind == SPHERE ? trace_sphere(s, &rays[r], r, sink)
                        : s->kind == SHEET ? trace_sheet(s, &rays[r], r, sink)
                                           : trace_fog(s, &rays[r], tolerance, r, sink);
      if (result != DSM_OK) return result;
    }
  return DSM_OK;
}

static inline int32_t pause_world(void *data) { return ((const world *)data)->stop; }

static inline void report_world(void *data, int32_t severity, const char *sentence) {
  world *w = data;
  (void)severity;
  ++w->sentences;
  snprintf(w->last, sizeof w->last, "%s", sentence);
}

static inline dsm_host host_of(world *w) { return (dsm_host){sizeof(dsm_host), w, trace_world, pause_world, report_world}; }

/* A settings object from "word value value …" pairs, one word a string; NULL ends. Of a deep map, unless the first string is
 * the name of another block. */
static inline dsm_settings *settings_of(const char *const *words) {
  uint32_t chosen = 0;
  for (uint32_t i = 0; i < dsm_api.block_count; ++i)
    if (words && *words && strcmp(*words, dsm_api.blocks[i].name) == 0) {
      chosen = i;
      ++words;
    }
  const dsm_block *block = &dsm_api.blocks[chosen];
  dsm_settings *settings = dsm_api.settings_create(chosen);
  assert_non_null(settings);
  for (; words && *words; ++words) {
    char name[32], choice[32] = "", why[200];
    double numbers[6];
    int n = 0;
    uint32_t index = 0, count;
    sscanf(*words, "%31s%n", name, &n);
    const char *rest = *words + n;
    if (sscanf(rest, " %31[a-z]%n", choice, &n) == 1) rest += n;
    int got = sscanf(rest, "%lf %lf %lf %lf %lf %lf", &numbers[0], &numbers[1], &numbers[2], &numbers[3], &numbers[4], &numbers[5]);
    count = got > 0 ? (uint32_t)got : 0;
    while (strcmp(block->parameters[index].name, name) != 0) ++index;
    if (dsm_api.settings_set(settings, index, choice[0] ? choice : NULL, numbers, count, why, sizeof why) != DSM_OK)
      fail_msg("%s", why);
  }
  return settings;
}

static inline dsm_light spot_at(double x, double y, double z, double dx, double dy, double dz, double degrees) {
  double length = sqrt(dx * dx + dy * dy + dz * dz);
  return (dsm_light){.size = sizeof(dsm_light), .kind = DSM_LIGHT_SPOT, .origin = {x, y, z},
                     .direction = {dx / length, dy / length, dz / length}, .cos_angle = cos(degrees * acos(-1) / 180)};
}

static inline dsm_light point_at(double x, double y, double z) {
  return (dsm_light){.size = sizeof(dsm_light), .kind = DSM_LIGHT_POINT, .origin = {x, y, z}};
}

static inline dsm_light parallel_at(double x, double y, double z, double dx, double dy, double dz) {
  dsm_light light = spot_at(x, y, z, dx, dy, dz, 0);
  light.kind = DSM_LIGHT_PARALLEL;
  return light;
}

/* A world has one map at a time; map_close takes both apart. */
static inline dsm_map *map_of(world *w, dsm_light light, const char *const *words) {
  w->boxes = malloc((size_t)(w->count + 1) * sizeof *w->boxes);
  assert_non_null(w->boxes);
  for (int i = 0; i < w->count; ++i) w->boxes[i] = w->shapes[i].box;
  light.casters = w->boxes;
  light.caster_count = (uint64_t)w->count;
  dsm_settings *settings = settings_of(words);
  dsm_host host = host_of(w);
  dsm_map *map = NULL;
  dsm_result result = dsm_api.map_create(&host, &light, settings, &map);
  dsm_api.settings_destroy(settings);
  if (result != DSM_OK) fail_msg("map_create: %d, %s", (int)result, w->last);
  return map;
}

static inline void map_close(world *w, dsm_map *map) {
  dsm_api.map_destroy(map);
  free(w->boxes);
  w->boxes = NULL;
}

/* A map with one worker, the shape of most tests. */
typedef struct { world w; dsm_map *map; dsm_worker *worker; } stage;

static inline void stage_open(stage *s, const shape *shapes, int count, dsm_light light, const char *const *words) {
  memset(s, 0, sizeof *s);
  s->w.shapes = shapes;
  s->w.count = count;
  s->map = map_of(&s->w, light, words);
  assert_int_equal(dsm_api.worker_create(s->map, &s->w, &s->worker), DSM_OK);
}

static inline void stage_close(stage *s) {
  dsm_api.worker_destroy(s->worker);
  map_close(&s->w, s->map);
}

static inline dsm_receiver in_air(double x, double y, double z) { return (dsm_receiver){.point = {x, y, z}}; }

static inline dsm_receiver on_plane(double x, double y, double z, double nx, double ny, double nz) {
  return (dsm_receiver){.point = {x, y, z}, .plane_count = 1, .planes = {{.normal = {nx, ny, nz}}}};
}

/* Light of one channel; fails the test unless the map has an answer. */
static inline double light_of(stage *s, dsm_receiver receiver, int channel) {
  double rgb[3] = {-1, -1, -1};
  dsm_result result = dsm_api.lookup(s->worker, &receiver, rgb);
  if (result != DSM_OK && result != DSM_OUTSIDE) fail_msg("lookup: %d", (int)result);
  for (int c = 0; c < 3; ++c) assert_true(rgb[c] >= 0 && rgb[c] <= 1);
  return rgb[channel];
}

#define WORDS(...) ((const char *const[]){__VA_ARGS__, NULL})

#endif
