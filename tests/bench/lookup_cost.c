/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * What a look-up costs once the tiles are there, in nanoseconds on one thread: the median of nine runs.
 *
 *   lookup_cost [RESOLUTION [SAMPLES [BLUR [TOLERANCE]]]]     512 16 0 automatic
 *
 * The scene is like hair for a map: a parallel light's rays each end at a random depth in a layer above a floor. Points
 * are visited along scan lines of a picture (coherent) or anywhere (random), in the air or on the floor with its plane.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "../unit/random.h"
#include "dsm.h"

enum { LOOKUPS = 200000, RUNS = 9, SIDE = 447 };

static dsm_result trace_hair(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink)
{
  static const double opaque[3] = {0, 0, 0};
  (void)data;
  (void)tolerance;
  for (uint32_t i = 0; i < count; i++) {
    rng r = rng_seeded((uint64_t)(int64_t)(1e9 * rays[i].origin[0]) * 31 + (uint64_t)(int64_t)(1e9 * rays[i].origin[1]));
    double depth = rng_below(&r, 4) ? rng_between(&r, 1, 2) : 3;
    dsm_result result = dsm_api.sink_surface(sink, i, depth, opaque);
    if (result != DSM_OK)
      return result;
  }
  return DSM_OK;
}

static double now(void)
{
  struct timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int by_size(const void *a, const void *b)
{
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void fill(dsm_receiver *points, int coherent, int on_floor, double footprint)
{
  rng r = rng_seeded(7);
  for (int i = 0; i < LOOKUPS; i++) {
    double x = coherent ? (i % SIDE) * 1.8 / SIDE - 0.9 : rng_between(&r, -0.9, 0.9);
    double y = coherent ? (i / SIDE) * 1.8 / SIDE - 0.9 : rng_between(&r, -0.9, 0.9);
    points[i] = (dsm_receiver){.point = {x, y, on_floor ? 3 : 1.5 + 0.3 * sin(9 * x) * cos(7 * y)}};
    if (footprint > 0) {
      points[i].has_footprint = 1;
      points[i].footprint[0][0] = points[i].footprint[1][1] = footprint;
    }
    if (on_floor) {
      points[i].plane_count = 2;
      points[i].planes[0] = (dsm_plane){{0.1, 0.2, -sqrt(0.95)}, 0};
      points[i].planes[1] = (dsm_plane){{0, 0, -1}, 0.5};
    }
  }
}

static double median_ns(dsm_worker *worker, const dsm_receiver *points)
{
  double times[RUNS], rgb[3], sum = 0;
  for (int run = -1; run < RUNS; run++) {   /* the first one bakes */
    double start = now();
    for (int i = 0; i < LOOKUPS; i++) {
      dsm_api.lookup(worker, &points[i], rgb);
      sum += rgb[0];
    }
    if (run >= 0)
      times[run] = (now() - start) / LOOKUPS * 1e9;
  }
  if (!(sum >= 0))
    exit(1);
  qsort(times, RUNS, sizeof *times, by_size);
  return times[RUNS / 2];
}

static void set(dsm_settings *settings, const char *word, double number)
{
  uint32_t row = 0;
  char why[200];
  while (strcmp(dsm_api.blocks[0].parameters[row].name, word))
    row++;
  if (dsm_api.settings_set(settings, row, NULL, &number, 1, why, sizeof why) != DSM_OK) {
    fprintf(stderr, "%s\n", why);
    exit(1);
  }
}

int main(int argc, char **argv)
{
  double resolution = argc > 1 ? atof(argv[1]) : 512, samples = argc > 2 ? atof(argv[2]) : 16;
  double blur = argc > 3 ? atof(argv[3]) : 0;
  dsm_host host = {.size = sizeof host, .trace = trace_hair};
  dsm_box box = {{-1, -1, 1}, {1, 1, 3}};
  dsm_light light = {.size = sizeof light, .kind = DSM_LIGHT_PARALLEL, .direction = {0, 0, 1}, .casters = &box,
                     .caster_count = 1};
  dsm_settings *settings = dsm_api.settings_create(0);
  dsm_map *map;
  dsm_worker *worker;
  dsm_receiver *points = malloc(LOOKUPS * sizeof *points);
  set(settings, "resolution", resolution);
  set(settings, "samples", samples);
  set(settings, "blur", blur);
  if (argc > 4)
    set(settings, "tolerance", atof(argv[4]));
  if (!points || dsm_api.map_create(&host, &light, settings, &map) != DSM_OK
      || dsm_api.worker_create(map, NULL, &worker) != DSM_OK)
    return 1;
  printf("%10s %10s\n", "", "ns");
  for (int k = 0; k < 6; k++) {
    fill(points, k % 2 == 0, k / 2, k / 2 == 2 ? 2.4 / resolution : 0);
    printf("%s, %s %6.1f\n", k / 2 == 2 ? "seen " : k / 2 ? "floor" : "air  ", k % 2 ? "random  " : "coherent", median_ns(worker, points));
  }
  dsm_statistics s = {.size = sizeof s};
  dsm_api.statistics(map, &s);
  printf("vertices a pixel %.2f, bytes %llu\n", (double)s.vertices / (double)s.pixels_baked, (unsigned long long)s.bytes);
  dsm_api.worker_destroy(worker);
  dsm_api.map_destroy(map);
  dsm_api.settings_destroy(settings);
  free(points);
  return 0;
}
