/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/fingerprint.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/events.h"
#include "store/map_file.h"

enum { PROBES = 1024 };

/* Spans are as long as this allows. It must not depend on the map's settings: the print is of the scene. */
static const double PROBE_TOLERANCE = 0.002;

/* An event in whole numbers. `ray` is PROBES more for a ray that is marked. */
typedef struct {
  int64_t ray, front, back, transmittance[3];
} print_event;

typedef struct {
  print_event *data;
  size_t count, room;
} print_list;

static dsm_result append(print_list *list, print_event e)
{
  if (list->count == list->room) {
    size_t room = 2 * list->room + 1024;
    print_event *data = realloc(list->data, room * sizeof *data);
    if (!data)
      return DSM_NO_MEMORY;
    list->data = data;
    list->room = room;
  }
  list->data[list->count++] = e;
  return DSM_OK;
}

/* Point i of Roberts's R2 sequence, which spreads evenly whatever their number. */
static void probe_point(uint32_t i, double point[2])
{
  static const double step[2] = {0.7548776662466927, 0.5698402909980532};   /* 1/g and 1/g^2, g^3 = g + 1 */
  for (int k = 0; k < 2; k++) {
    double x = 0.5 + step[k] * (i + 1);
    point[k] = x - floor(x);
  }
}

static int64_t rounded(double x)
{
  return (int64_t)rint(1e6 * x);
}

static int64_t rounded_depth(const dsm_ray *ray, double depth)
{
  double range = ray->far_depth - ray->near_depth;
  return range > 0 ? rounded((depth - ray->near_depth) / range) : 0;
}

static dsm_result trace_probes(dsm_worker *worker, const dsm_ray *rays, uint32_t count, dsm_sink *sink)
{
  const dsm_host *host = &worker->map->host;
  dsm_result result = host->pause && host->pause(worker->host_data) ? DSM_CANCELLED : sink_begin(sink, rays, count);
  if (result != DSM_OK)
    return result;
  worker->baking = 1;
  result = host->trace(worker->host_data, rays, count, PROBE_TOLERANCE, sink);
  worker->baking = 0;
  return result == DSM_OK ? sink_order(sink) : result;
}

static dsm_result print_face(dsm_worker *worker, uint32_t face_index, uint32_t count, dsm_ray *rays, dsm_sink *sink,
                             print_list *list)
{
  const projection *p = &worker->map->projection;
  for (uint32_t i = 0; i < count; i++) {
    double point[2];
    probe_point(i, point);
    projection_ray(p, face_index, point[0] * p->faces[face_index].width, point[1] * p->faces[face_index].height, &rays[i]);
  }
  dsm_result result = trace_probes(worker, rays, count, sink);
  for (uint32_t i = 0; i < count && result == DSM_OK; i++) {
    int64_t ray = (int64_t)face_index * 2 * PROBES + i;
    if (sink->marked[i])
      result = append(list, (print_event){.ray = ray + PROBES});
    for (size_t k = sink->first[i]; k < sink->first[i + 1] && result == DSM_OK; k++) {
      const event *e = &sink->ordered[k];
      const double *t = e->transmittance.c;
      result = append(list, (print_event){ray, rounded_depth(&rays[i], e->front), rounded_depth(&rays[i], e->back),
                                          {rounded(t[0]), rounded(t[1]), rounded(t[2])}});
    }
  }
  return result;
}

static int in_order(const void *a, const void *b)
{
  const int64_t *x = a, *y = b;
  for (size_t i = 0; i < sizeof(print_event) / sizeof *x; i++)
    if (x[i] != y[i])
      return x[i] < y[i] ? -1 : 1;
  return 0;
}

static dsm_result print_faces(dsm_worker *worker, print_list *list)
{
  const projection *p = &worker->map->projection;
  uint32_t with_pixels = 0, taken = 0;
  for (uint32_t i = 0; i < p->count; i++)
    with_pixels += p->faces[i].width > 0;
  dsm_sink sink = {0};
  dsm_ray *rays = malloc(PROBES * sizeof *rays);
  dsm_result result = rays ? DSM_OK : DSM_NO_MEMORY;
  for (uint32_t i = 0, k = 0; i < p->count && result == DSM_OK; i++)
    if (p->faces[i].width > 0) {
      uint32_t until = PROBES * ++k / with_pixels;
      result = print_face(worker, i, until - taken, rays, &sink, list);
      taken = until;
    }
  sink_free(&sink);
  free(rays);
  return result;
}

dsm_result fingerprint_take(dsm_worker *worker, scene_print *print, map_reason *why)
{
  const dsm_light *light = &worker->map->light;
  print_list list = {NULL, 0, 0};
  dsm_result result = map_digest(light->casters, light->caster_count * sizeof *light->casters, print->casters, why);
  if (result == DSM_OK) {
    result = print_faces(worker, &list);
    if (result == DSM_NO_MEMORY)
      map_no_memory(why);
  }
  if (result == DSM_OK && list.count)
    qsort(list.data, list.count, sizeof *list.data, in_order);
  if (result == DSM_OK)
    result = map_digest(list.data, list.count * sizeof *list.data, print->probes, why);
  free(list.data);
  return result;
}
