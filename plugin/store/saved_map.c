/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/saved_map.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "store/fingerprint.h"

/* ---- A file as the source of tiles -------------------------------------------------------------------------- */

typedef struct {
  tile_source source;   /* first */
  map_file *file;
  const dsm_map *map;
  atomic_flag told;     /* of damage */
} file_source;

static dsm_result read_tile(tile_source *source, const tile_key *key, const tile **out)
{
  file_source *s = (file_source *)source;
  static const char ending[] = " Shadows there are ray-traced.";
  char text[MAP_REASON_SIZE + sizeof ending] = "";
  map_reason why = {text, MAP_REASON_SIZE};
  dsm_result result = map_file_tile(s->file, key, out, &why);
  if (result != DSM_OK && !atomic_flag_test_and_set(&s->told))
    map_report(s->map, 1, strcat(text, ending));
  return result;
}

static void destroy_source(tile_source *source)
{
  file_source *s = (file_source *)source;
  map_file_close(s->file);
  free(s);
}

/* The file is the source's from now on, or closed. */
static dsm_result read_from(dsm_map *map, map_file *file, map_reason *why)
{
  file_source *s = malloc(sizeof *s);
  if (!s) {
    map_file_close(file);
    return map_no_memory(why);
  }
  s->source = (tile_source){read_tile, destroy_source};
  s->file = file;
  s->map = map;
  atomic_flag_clear(&s->told);
  if (map->source)
    map->source->destroy(map->source);
  map->source = &s->source;
  return DSM_OK;
}

/* ---- What a map says of itself -------------------------------------------------------------------------------- */

/* With room for one scene; `scene` must live as long as the header, which is not to be freed. */
static map_header header_of(const dsm_map *map, scene_print *scene)
{
  const dsm_settings *s = &map->settings;
  map_header h;
  memset(&h, 0, sizeof h);
  h.light = map->light;
  h.light.casters = NULL;
  h.light.caster_count = 0;
  h.block = s->block;
  h.jittered = s->jittered;
  h.projection = map->projection;
  memcpy(h.resolution, s->resolution, sizeof h.resolution);
  h.samples = s->samples;
  h.filter = s->filter;
  h.filter_width = s->filter_width;
  h.tolerance = s->tolerance;
  h.bounded = s->bounded;
  h.bounds = s->bounds;
  h.scene_count = 1;
  h.scenes = scene;
  return h;
}

/* What the settings say that a map for these pixels was made with. */
static dsm_settings settings_of(const map_header *h)
{
  dsm_settings s;
  if (h->block == BLOCK_SHADOW_MAP)
    settings_shadow_map_defaults(&s);
  else
    settings_defaults(&s);
  s.jittered = h->jittered;
  memcpy(s.resolution, h->resolution, sizeof s.resolution);
  s.samples = h->samples;
  s.filter = h->filter;
  s.filter_width = h->filter_width;
  s.tolerance = h->tolerance;
  s.bounded = h->bounded;
  s.bounds = h->bounds;
  return s;
}

static dsm_result told(const dsm_map *map, dsm_result result, const map_reason *why)
{
  if (result != DSM_OK && result != DSM_CANCELLED && why->text[0])
    map_report(map, 2, why->text);
  return result;
}

/* What `accuracy` leaves out follows from what one picture looks at; a file has no place for it. */
static dsm_result fits_a_file(const dsm_map *map, map_reason *why)
{
  if (map->settings.accuracy > 0)
    return map_refused(why, "A shadow map with accuracy can be neither saved nor loaded: it is only as fine as what one picture looks at.");
  return DSM_OK;
}

/* ---- Loading ---------------------------------------------------------------------------------------------------- */

static dsm_result compare(dsm_worker *worker, const map_header *header, const char *path, map_reason *why)
{
  scene_print scene;
  dsm_result result = fingerprint_take(worker, &scene, why);
  if (result != DSM_OK)
    return result;
  map_header wanted = header_of(worker->map, &scene);
  return map_header_compare(&wanted, header, path, why);
}

dsm_result saved_map_load(dsm_worker *worker, const char *path)
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  map_header header;
  map_file *file;
  dsm_result result = fits_a_file(worker->map, &why);
  if (result == DSM_OK)
    result = map_file_open(path, &header, &file, &why);
  if (result != DSM_OK)
    return told(worker->map, result, &why);
  result = compare(worker, &header, path, &why);
  map_header_free(&header);
  if (result == DSM_OK)
    result = read_from(worker->map, file, &why);
  else
    map_file_close(file);
  return told(worker->map, result, &why);
}

dsm_result saved_map_open(const char *path, const dsm_host *host, map_header *header, dsm_map **map, map_reason *why)
{
  map_file *file;
  *map = NULL;
  dsm_result result = map_file_open(path, header, &file, why);
  if (result != DSM_OK)
    return result;
  dsm_settings settings = settings_of(header);
  result = map_create_framed(host, &header->light, &settings, &header->projection, map);
  if (result == DSM_OK)
    result = read_from(*map, file, why);
  else {
    map_file_close(file);
    map_no_memory(why);
  }
  if (result != DSM_OK) {
    map_destroy(*map);
    *map = NULL;
    map_header_free(header);
  }
  return result;
}

/* ---- Saving ----------------------------------------------------------------------------------------------------- */

typedef struct {
  map_saving saving;   /* first */
  char *path;
  scene_print scene;   /* as it was before the first tile was baked */
} file_saving;

static void destroy_saving(map_saving *saving)
{
  file_saving *s = (file_saving *)saving;
  free(s->path);
  free(s);
}

dsm_result saved_map_begin(dsm_worker *worker, const char *path)
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  dsm_map *map = worker->map;
  dsm_result result = fits_a_file(map, &why);
  if (result == DSM_OK)
    result = map_file_writable(path, &why);
  if (result != DSM_OK)
    return told(map, result, &why);
  file_saving *s = calloc(1, sizeof *s);
  if (!s || !(s->path = strdup(path))) {
    free(s);
    return told(map, map_no_memory(&why), &why);
  }
  s->saving.destroy = destroy_saving;
  result = fingerprint_take(worker, &s->scene, &why);
  if (result != DSM_OK) {
    destroy_saving(&s->saving);
    return told(map, result, &why);
  }
  if (map->saving)
    map->saving->destroy(map->saving);
  map->saving = &s->saving;
  map_spool(map, path);   /* without, what the cache cannot hold is baked again */
  return DSM_OK;
}

typedef struct {
  dsm_worker *worker;
  void (*progress)(void *worker_data, double share);
} giver;

/* The tile stays until the next one is asked for. */
static dsm_result give_tile(void *data, const tile_key *key, const tile **out)
{
  dsm_worker *worker = ((giver *)data)->worker;
  worker_leave(worker);
  worker_enter(worker);
  return worker_tile(worker, key, out);
}

static int go_on(void *data, double share)
{
  giver *g = data;
  const dsm_host *host = &g->worker->map->host;
  if (g->progress)
    g->progress(g->worker->host_data, share);
  return host->pause && host->pause(g->worker->host_data);
}

static map_header finished_header(dsm_map *map, scene_print *scene)
{
  map_header h = header_of(map, scene);
  pthread_mutex_lock(&map->store.mutex);
  h.coloured = map->tally.pixels_coloured > 0;
  h.vertices = map->tally.vertices;
  h.pixels_marked = map->tally.pixels_marked;
  pthread_mutex_unlock(&map->store.mutex);
  return h;
}

dsm_result saved_map_end(dsm_worker *worker, void (*progress)(void *worker_data, double share))
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  dsm_map *map = worker->map;
  file_saving *s = (file_saving *)map->saving;
  if (!s) {
    map_refused(&why, "A shadow map was to be saved without an announcement.");
    return told(map, DSM_INVALID, &why);
  }
  giver g = {worker, progress};
  map_header header = finished_header(map, &s->scene);
  worker_enter(worker);
  dsm_result result = map_file_write(s->path, &header, give_tile, &g, go_on, &why);
  worker_leave(worker);
  map_file *file;
  map_header again;
  if (result == DSM_OK)
    result = map_file_open(s->path, &again, &file, &why);
  if (result == DSM_OK) {
    map_header_free(&again);
    result = read_from(map, file, &why);
  }
  if (result == DSM_OK) {
    destroy_saving(map->saving);
    map->saving = NULL;
    map_spool_end(map);   /* all can be read from the file now */
  }
  return told(map, result, &why);
}
