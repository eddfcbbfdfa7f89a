/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "tool/built_map.h"

#include <stdlib.h>
#include <string.h>

#include "map/whole_map.h"
#include "store/map_file.h"
#include "tool/command.h"
#include "tool/open_map.h"

/* Nothing is traced, and makers say themselves what is wrong. */
static dsm_result create_map(const map_header *header, dsm_map **out)
{
  dsm_host host = {.size = sizeof host};
  dsm_settings settings;
  settings_defaults(&settings);
  return map_create_framed(&host, &header->light, &settings, &header->projection, out);
}

/* Where the path's file is. Evicted tiles wait there rather than be made twice; without room for them they are. */
static void spool_beside(dsm_map *map, const char *path)
{
  const char *slash = strrchr(path, '/');
  size_t length = slash ? (size_t)(slash - path) + 1 : 0;
  char *folder = malloc(length + 2);
  if (!folder)
    return;
  memcpy(folder, path, length);
  memcpy(folder + length, ".", 2);
  map_spool(map, folder);
  free(folder);
}

static dsm_result give_tile(void *data, const tile_key *key, const tile **out)
{
  dsm_worker *worker = data;
  worker_leave(worker);
  worker_enter(worker);
  dsm_result result = worker_tile(worker, key, out);
  return result == DSM_OK && (*out)->kind == TILE_FAILED ? DSM_REFUSED : result;
}

static int write_file(dsm_worker *worker, const char *path, map_header *header)
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  dsm_statistics sums = {.size = sizeof sums};
  map_statistics(worker->map, &sums);
  header->coloured = sums.pixels_coloured > 0;
  header->vertices = sums.vertices;
  header->pixels_marked = sums.pixels_marked;
  if (sums.tiles_failed)
    return trouble("%s was not written, as a part of it could not be made.", path);
  worker_enter(worker);
  dsm_result result = map_file_write(path, header, give_tile, worker, NULL, &why);
  worker_leave(worker);
  if (result == DSM_OK || result == DSM_NO_MEMORY)
    return result == DSM_OK ? STATUS_FINE : trouble_memory();
  return *text ? trouble("%s", text) : trouble("%s was not written, as a part of it could not be made again.", path);
}

/* Coarser levels may have colour and marks where the finest has; never elsewhere. */
static int make_and_write(dsm_worker *worker, const char *path, map_header *header)
{
  double share;
  dsm_result result;
  while ((result = map_bake_next(worker, &share)) == DSM_OK && !worker->map->tiles_failed)
    ;
  return result == DSM_DONE || result == DSM_OK ? write_file(worker, path, header) : trouble_memory();
}

int built_map_write(const char *path, map_header *header, tile_maker *maker)
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  dsm_map *map;
  dsm_worker *worker = NULL;
  int status = STATUS_FINE;
  dsm_result result = map_file_writable(path, &why);
  if (result != DSM_OK)
    status = trouble_because(result, &why);
  if (status == STATUS_FINE && create_map(header, &map) != DSM_OK)
    status = trouble_memory();
  if (status != STATUS_FINE) {
    maker->destroy(maker);
    return status;
  }
  spool_beside(map, path);
  if (worker_create(map, NULL, maker, &worker) == DSM_OK)
    status = make_and_write(worker, path, header);
  else {
    maker->destroy(maker);
    status = trouble_memory();
  }
  worker_destroy(worker);
  map_destroy(map);
  return status;
}

void built_tile_count(const tile *t, tile_tally *tally)
{
  if (t->kind != TILE_STORED)
    return;
  for (uint32_t place = 0; place < TILE_PIXELS; place++) {
    tally->vertices += tile_visibility(t, place).count;
    tally->pixels_coloured += tile_is_coloured(t, place) != 0;
    tally->pixels_marked += tile_is_marked(t, place) != 0;
  }
  tally->pixels += TILE_PIXELS;
}
