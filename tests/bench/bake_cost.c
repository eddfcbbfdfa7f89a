/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * What a bake costs outside host->trace, in nanoseconds a ray, by scene, samples a pixel and tolerance.
 *
 *   bake_cost [hair|glass|smoke [SAMPLES [TOLERANCE [RESOLUTION]]]]      nothing: all of them, the least of five runs
 *
 * A negative tolerance is the automatic one. Where the machine is busy, `valgrind --tool=callgrind` on a small
 * resolution counts instructions, and tells which function they are in.
 *
 * The scenes, as a parallel light sees them: opaque hairs half a pixel wide on a ball above a floor, on 128 x 128
 * pixels; five rippled sheets of coloured glass, and a cloud of twenty spans a ray, on 32 x 32.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../unit/random.h"
#include "dsm.h"

static void stop(const char *why)
{
  fprintf(stderr, "%s\n", why);
  exit(1);
}

static void check(dsm_result result)
{
  if (result != DSM_OK && result != DSM_OUTSIDE)
    stop("the library has failed");
}

/* ---- Hair: straight ribbons in a grid of cells. A ray runs along z, so that only x and y count. ---------------- */

enum { HAIRS = 25000, CELLS = 256, MOST_IN_CELL = 400 };

static const double BALL = 0.5, HAIR_LENGTH = 0.3, HAIR_RADIUS = 0.5 / 128, BALL_DEPTH = 2, FLOOR_DEPTH = 3;

typedef struct { double root[3], along[3]; } hair;
typedef struct { uint32_t count, hairs[MOST_IN_CELL]; } cell;

static hair hairs[HAIRS];
static cell (*cells)[CELLS];

static int cell_of(double x) { return (int)fmax(0, fmin(CELLS - 1, (x + 1) * (CELLS / 2))); }

static void enter_in_cell(uint32_t index, int x, int y)
{
  cell *c = &cells[y][x];
  if (x < 0 || y < 0 || x >= CELLS || y >= CELLS || (c->count > 0 && c->hairs[c->count - 1] == index))
    return;
  if (c->count < MOST_IN_CELL)
    c->hairs[c->count++] = index;
}

static void grow_hairs(void)
{
  rng r = rng_seeded(2000);
  cells = calloc(CELLS, sizeof *cells);
  if (!cells)
    stop("out of memory");
  for (uint32_t i = 0; i < HAIRS; i++) {
    double normal[3], length = 0;
    for (int k = 0; k < 3; k++) {
      normal[k] = rng_between(&r, -1, 1);
      length += normal[k] * normal[k];
    }
    for (int k = 0; k < 3; k++) {
      normal[k] /= sqrt(length);
      hairs[i].root[k] = BALL * normal[k] + (k == 2 ? BALL_DEPTH : 0);
      hairs[i].along[k] = HAIR_LENGTH * (normal[k] + rng_between(&r, -0.4, 0.4));
    }
    for (int step = 0; step <= CELLS; step++) {
      double t = (double)step / CELLS;
      int x = cell_of(hairs[i].root[0] + t * hairs[i].along[0]), y = cell_of(hairs[i].root[1] + t * hairs[i].along[1]);
      for (int near = 0; near < 9; near++)
        enter_in_cell(i, x + near % 3 - 1, y + near / 3 - 1);
    }
  }
}

/* The depth at which a ray meets a hair, or infinity. */
static double meet(const hair *h, double x, double y)
{
  double dx = x - h->root[0], dy = y - h->root[1];
  double square = h->along[0] * h->along[0] + h->along[1] * h->along[1];
  double t = (dx * h->along[0] + dy * h->along[1]) / square, away = dx * h->along[1] - dy * h->along[0];
  if (!(t > 0 && t < 1) || away * away > square * HAIR_RADIUS * HAIR_RADIUS)
    return HUGE_VAL;
  return h->root[2] + t * h->along[2];
}

static dsm_result trace_hair(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink)
{
  static const double opaque[3] = {0, 0, 0};
  (void)data;
  (void)tolerance;
  for (uint32_t r = 0; r < count; r++) {
    double x = rays[r].origin[0], y = rays[r].origin[1], inside = BALL * BALL - x * x - y * y;
    double nearest = fabs(x) < 0.9 ? FLOOR_DEPTH : HUGE_VAL;
    if (inside > 0)
      nearest = BALL_DEPTH - sqrt(inside);
    const cell *c = &cells[cell_of(y)][cell_of(x)];
    for (uint32_t i = 0; i < c->count; i++)
      nearest = fmin(nearest, meet(&hairs[c->hairs[i]], x, y));
    if (nearest < HUGE_VAL)
      check(dsm_api.sink_surface(sink, r, nearest, opaque));
  }
  return DSM_OK;
}

/* ---- Glass and smoke -------------------------------------------------------------------------------------------- */

static double ripple(double x, double y, int k) { return 0.04 * sin(7 * x + 3 * k) * cos((5 + k) * y); }

static dsm_result trace_glass(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink)
{
  (void)data;
  (void)tolerance;
  for (uint32_t r = 0; r < count; r++)
    for (int k = 0; k < 5; k++) {
      double colour[3] = {0.9, 0.8 - 0.1 * k, 0.5 + 0.1 * k};
      double depth = 1.2 + 0.35 * k + ripple(rays[r].origin[0], rays[r].origin[1], k);
      check(dsm_api.sink_surface(sink, r, depth, colour));
    }
  return DSM_OK;
}

static dsm_result trace_smoke(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink)
{
  (void)data;
  (void)tolerance;
  for (uint32_t r = 0; r < count; r++) {
    double x = rays[r].origin[0], y = rays[r].origin[1], front = 1.2 + ripple(x, y, 0);
    for (int k = 0; k < 20; k++) {
      double back = 1.2 + 0.08 * (k + 1) + ripple(x, y, k), pass = exp(-0.08 - ripple(x, y, k + 1));
      check(dsm_api.sink_span(sink, r, front, back, (double[3]){pass, pass, pass}));
      front = back;
    }
  }
  return DSM_OK;
}

/* ---- The bake --------------------------------------------------------------------------------------------------- */

typedef struct {
  const char *name;
  double resolution;
  dsm_result (*trace)(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink);
} scene;

static const scene scenes[] = {{"hair", 128, trace_hair}, {"glass", 32, trace_glass}, {"smoke", 32, trace_smoke}};

static int32_t never(void *data)
{
  (void)data;
  return 0;
}

static void tell(void *data, int32_t severity, const char *sentence)
{
  (void)data;
  (void)severity;
  stop(sentence);
}

static void set(dsm_settings *settings, const char *name, double value)
{
  uint32_t index = 0;
  char why[200];
  while (strcmp(dsm_api.blocks[0].parameters[index].name, name) != 0)
    index++;
  if (dsm_api.settings_set(settings, index, NULL, &value, 1, why, sizeof why) != DSM_OK)
    stop(why);
}

/* Nanoseconds a ray outside trace. */
static double bake(const scene *s, double resolution, uint32_t samples, double tolerance, dsm_statistics *statistics)
{
  dsm_host host = {sizeof host, NULL, s->trace, never, tell};
  dsm_box box = {{-1, -1, 1}, {1, 1, 3.1}};
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_PARALLEL, .direction = {0, 0, 1}, .casters = &box,
                     .caster_count = 1};
  dsm_settings *settings = dsm_api.settings_create(0);
  dsm_map *map;
  dsm_worker *worker;
  set(settings, "resolution", resolution);
  set(settings, "samples", samples);
  if (tolerance >= 0)
    set(settings, "tolerance", tolerance);
  check(dsm_api.map_create(&host, &light, settings, &map));
  check(dsm_api.worker_create(map, NULL, &worker));
  for (int i = 0; i < 32 * 32; i++) {
    dsm_receiver at = {.point = {(i % 32 + 0.5) / 16 - 1, (i / 32 + 0.5) / 16 - 1, 3.05}};
    double rgb[3];
    check(dsm_api.lookup(worker, &at, rgb));
  }
  *statistics = (dsm_statistics){.size = sizeof *statistics};
  dsm_api.statistics(map, statistics);
  dsm_api.worker_destroy(worker);
  dsm_api.map_destroy(map);
  dsm_api.settings_destroy(settings);
  return 1e9 * (statistics->bake_seconds - statistics->trace_seconds) / (double)statistics->rays;
}

static void measure(const scene *s, uint32_t samples, double tolerance)
{
  double cost = HUGE_VAL;
  dsm_statistics statistics;
  for (int run = 0; run < 5; run++)   /* what else the machine does can only add */
    cost = fmin(cost, bake(s, s->resolution, samples, tolerance, &statistics));
  printf("%-6s %7u   %-9.4g %9.0f %11.2f %14.1f\n", s->name, samples, tolerance, cost,
         (double)statistics.events / (double)statistics.rays, (double)statistics.vertices / (double)statistics.pixels);
}

int main(int count, char **words)
{
  const uint32_t samples[] = {16, 256};
  setvbuf(stdout, NULL, _IOLBF, 0);
  if (count < 2 || strcmp(words[1], "hair") == 0)
    grow_hairs();
  printf("scene  samples   tolerance  ns a ray  events/ray  vertices/pixel\n");
  for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
    if (count > 1 && strcmp(words[1], scenes[s].name) != 0)
      continue;
    if (count > 2) {
      dsm_statistics statistics;
      double resolution = count > 4 ? atof(words[4]) : scenes[s].resolution;
      double tolerance = count > 3 ? atof(words[3]) : -1;
      printf("%.0f\n", bake(&scenes[s], resolution, (uint32_t)atoi(words[2]), tolerance, &statistics));
      continue;
    }
    for (int k = 0; k < 2; k++) {
      measure(&scenes[s], samples[k], -1);
      measure(&scenes[s], samples[k], 0.25 / sqrt(samples[k]));
    }
  }
  free(cells);
  return 0;
}
