/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/map.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/face_fit.h"
#include "core/footprint.h"
#include "map/worker.h"

/* A filter's support is enlarged by this before the receiver's plane is searched for its nearest depth:
 * receivers are rarely quite flat, and an eighth of a pixel on each side costs a contact shadow nothing
 * visible. */
static const double SUPPORT_SAFETY = 1.25;

static const double MEGABYTE = 1024 * 1024;

/* A cache is too small once so many tiles have been made again, and more than in the first place: that is most of the work. */
enum { MANY_AGAIN = 100 };

static const double LARGEST = 1e150;   /* squares of lengths must stay finite */

static int valid_vector(const double v[3])
{
  for (int i = 0; i < 3; i++)
    if (!(fabs(v[i]) <= LARGEST))
      return 0;
  return 1;
}

/* The sentence that says what is wrong with the light, or NULL. Makes the direction unit length. */
static const char *check_light(dsm_light *light)
{
  if (light->kind > DSM_LIGHT_PARALLEL)
    return "The shadow map's light is of an unknown kind.";
  if (!valid_vector(light->origin))
    return "The shadow map's light has no finite origin.";
  if (light->kind != DSM_LIGHT_POINT) {
    const double *d = light->direction;
    double length = valid_vector(d) ? sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) : 0;
    if (!(length > 0))
      return "The shadow map's light has no direction.";
    for (int i = 0; i < 3; i++)
      light->direction[i] /= length;
  }
  if (light->kind == DSM_LIGHT_SPOT && !(light->cos_angle >= -1 && light->cos_angle <= 1))
    return "The shadow map's light has a cosine of its half angle outside -1 to 1.";
  if (light->kind == DSM_LIGHT_PARALLEL && !(light->radius >= 0))
    return "The shadow map's light has a negative radius.";
  if (light->caster_count && !light->casters)
    return "The shadow map was given a number of casters but not their boxes.";
  for (uint64_t k = 0; k < light->caster_count; k++) {
    const dsm_box *b = &light->casters[k];
    if (!valid_vector(b->low) || !valid_vector(b->high)
        || b->low[0] > b->high[0] || b->low[1] > b->high[1] || b->low[2] > b->high[2])
      return "The shadow map was given a caster without a finite, ordered box.";
  }
  return NULL;
}

void map_report(const dsm_map *map, int32_t severity, const char *sentence)
{
  if (map->host.report)
    map->host.report(map->host.data, severity, sentence);
}

static dsm_result refuse(const dsm_host *host, dsm_result result, const char *sentence)
{
  if (host->report)
    host->report(host->data, 2, sentence);
  return result;
}

dsm_result map_create(const dsm_host *host, const dsm_light *light, const dsm_settings *settings, dsm_map **out)
{
  if (!out)
    return DSM_INVALID;
  *out = NULL;
  if (!host || host->size < sizeof *host || !host->trace)
    return DSM_INVALID;   /* too short to hold `report`, or of no use */
  if (!light || light->size < sizeof *light)
    return refuse(host, DSM_INVALID, "The host's description of the shadow map's light is too short.");
  dsm_light checked = *light;
  const char *wrong = check_light(&checked);
  if (wrong)
    return refuse(host, DSM_INVALID, wrong);

  dsm_settings chosen;
  settings_defaults(&chosen);
  if (settings)
    chosen = *settings;
  settings_complete(&chosen);
  projection faces = {.count = 0};
  face_fit(&checked, &chosen, &faces);
  return map_create_framed(host, &checked, &chosen, &faces, out);
}

dsm_result map_create_framed(const dsm_host *host, const dsm_light *light, const dsm_settings *settings,
                             const projection *faces, dsm_map **out)
{
  *out = NULL;
  dsm_map *map = calloc(1, sizeof *map);
  if (!map)
    return refuse(host, DSM_NO_MEMORY, "There is no memory for a shadow map.");
  map->host = *host;
  map->light = *light;
  map->settings = *settings;
  map->settings.save_file = map->settings.load_file = NULL;   /* the host's business, and not ours to keep */
  map->support = 0.5 * map->settings.filter_width * SUPPORT_SAFETY;
  map->blur = blur_pixels(&map->settings);
  map->blur_level = blur_level(&map->settings);
  map->first_level = first_level(&map->settings);
  map->coarser = footprint_coarser(map->settings.accuracy);
  map->projection = *faces;
  if (tile_store_create(&map->store, &map->projection, (uint64_t)(map->settings.cache * MEGABYTE)) != DSM_OK) {
    free(map);
    return refuse(host, DSM_NO_MEMORY, "There is no memory for the tile table of a shadow map.");
  }
  *out = map;
  return DSM_OK;
}

void map_destroy(dsm_map *map)
{
  if (!map)
    return;
  if (map->source)
    map->source->destroy(map->source);
  if (map->saving)
    map->saving->destroy(map->saving);
  tile_store_destroy(&map->store);
  free(map);
}

dsm_result map_spool(dsm_map *map, const char *beside)
{
  tile_cache *cache = &map->store.cache;
  return cache->spool ? DSM_OK : spool_create(beside, cache->count, &cache->spool);
}

void map_spool_end(dsm_map *map)
{
  spool_destroy(map->store.cache.spool);
  map->store.cache.spool = NULL;
}

/* Under the mutex. Nonzero: it has happened, and nobody has told the host yet. */
static int tell_once(int happened, int *told)
{
  int tell = happened && !*told;
  *told |= happened;
  return tell;
}

static void add_cost(tile_tally *sum, const tile_tally *tally)
{
  sum->rays += tally->rays;
  sum->events += tally->events;
  sum->events_dropped += tally->events_dropped;
  sum->events_clamped += tally->events_clamped;
  sum->bake_seconds += tally->bake_seconds;
  sum->trace_seconds += tally->trace_seconds;
}

static void add_content(tile_tally *sum, const tile_tally *tally)
{
  sum->pixels += tally->pixels;
  sum->pixels_marked += tally->pixels_marked;
  sum->pixels_coloured += tally->pixels_coloured;
  sum->vertices_in += tally->vertices_in;
  sum->vertices += tally->vertices;
}

void tile_tally_add(tile_tally *sum, const tile_tally *tally)
{
  add_cost(sum, tally);
  add_content(sum, tally);
}

void map_count_made(dsm_map *map, const tile_key *key, const tile_tally *tally, int failed)
{
  const tile_cache *cache = &map->store.cache;
  pthread_mutex_lock(&map->store.mutex);
  add_cost(&map->tally, tally);
  if (!tile_cache_was_made(cache, tile_store_number(&map->store, key))) {
    add_content(&map->tally, tally);
    map->tiles_baked += !failed;
    map->tiles_failed += (uint64_t)failed;
  }
  else
    map->tiles_again++;
  int tell_failure = tell_once(failed, &map->told_failure);
  int tell_events = tell_once(tally->events_dropped || tally->events_clamped, &map->told_bad_events);
  int tell_small = tell_once(map->tiles_again > MANY_AGAIN && map->tiles_again > map->tiles_baked, &map->told_small);
  int tell_full = tell_once(cache->spool && spool_is_full(cache->spool), &map->told_full);
  pthread_mutex_unlock(&map->store.mutex);

  if (tell_events) {
    char text[200];
    snprintf(text, sizeof text, "A shadow map was given events with impossible numbers; in the first such "
             "tile %llu were dropped and %llu corrected.", (unsigned long long)tally->events_dropped,
             (unsigned long long)tally->events_clamped);
    map_report(map, 1, text);
  }
  if (tell_failure)
    map_report(map, 1, "A tile of a shadow map could not be baked (is there too little memory?); shadows "
               "there are ray-traced.");
  if (tell_small) {
    char text[200];
    snprintf(text, sizeof text, "A shadow map's 'cache' of %g MB is too small for the tiles that the picture looks at: most of "
             "them are baked again and again. A larger one saves time.", map->settings.cache);
    map_report(map, 1, text);
  }
  if (tell_full)
    map_report(map, 1, "The temporary file for what a shadow map's cache cannot hold takes no more (is the disk full?); "
               "parts of the map are baked again when they are needed.");
}

void map_count_read(dsm_map *map, const tile_key *key, int failed)
{
  pthread_mutex_lock(&map->store.mutex);
  map->tiles_read += !failed;
  map->tiles_failed += failed && !tile_cache_was_made(&map->store.cache, tile_store_number(&map->store, key));
  pthread_mutex_unlock(&map->store.mutex);
}

void map_statistics(const dsm_map *map, dsm_statistics *out)
{
  dsm_statistics s;
  memset(&s, 0, sizeof s);
  const projection *p = &map->projection;
  s.near_depth = INFINITY;
  for (uint32_t i = 0; i < p->count; i++) {
    const face *f = &p->faces[i];
    if (f->width == 0)
      continue;
    s.faces++;
    s.pixels += (uint64_t)f->width * f->height;
    s.near_depth = fmin(s.near_depth, f->near_depth);
    s.far_depth = fmax(s.far_depth, f->far_depth);
  }
  if (s.faces == 0)
    s.near_depth = 0;
  s.tiles = map->store.tile_count;
  uint64_t bookkeeping = sizeof *map + s.tiles * sizeof(tile_slot) + s.tiles / 8;

  pthread_mutex_t *mutex = (pthread_mutex_t *)(size_t)&map->store.mutex;   /* const towards the host only */
  pthread_mutex_lock(mutex);
  s.tiles_baked = map->tiles_baked;
  s.tiles_failed = map->tiles_failed;
  s.pixels_baked = map->tally.pixels;
  s.pixels_marked = map->tally.pixels_marked;
  s.pixels_coloured = map->tally.pixels_coloured;
  s.rays = map->tally.rays;
  s.events = map->tally.events;
  s.events_dropped = map->tally.events_dropped;
  s.events_clamped = map->tally.events_clamped;
  s.vertices_in = map->tally.vertices_in;
  s.vertices = map->tally.vertices;
  s.tiles_read = map->tiles_read;
  s.tiles_evicted = map->store.cache.evicted;
  s.tiles_again = map->tiles_again;
  s.bytes = bookkeeping + map->store.cache.bytes;
  s.bytes_most = bookkeeping + map->store.cache.bytes_most;
  s.bake_seconds = map->tally.bake_seconds;
  s.trace_seconds = map->tally.trace_seconds;
  s.samples = map->samples + worker_samples(map->workers);
  pthread_mutex_unlock(mutex);

  s.size = out->size < sizeof s ? out->size : (uint32_t)sizeof s;
  if (s.size >= sizeof s.size)
    memcpy(out, &s, s.size);
}
