/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/map_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "store/map_parts.h"
#include "store/new_file.h"

#ifndef PACKAGE_VERSION
#define PACKAGE_VERSION "0.1"   /* configure knows better */
#endif

typedef struct {
  const deep_exr *exr;
  deep_writer *writer;
  const char *path;          /* as the user knows it */
  map_parts parts;
  stored_kind kind;
  tile_record *records;
  deep_tile deep;
  map_reason *why;
} writing;

static dsm_result cannot_write(const writing *w, const deep_error *error)
{
  if (strcmp(error->text, DEEP_NO_MEMORY) == 0)
    return map_no_memory(w->why);
  return map_refused(w->why, "The shadow map \"%s\" cannot be written: %s.", w->path, error->text);
}

dsm_result map_file_writable(const char *path, map_reason *why)
{
  new_file file;
  deep_error error;
  if (!deep_exr_load(&error))
    return map_refused(why, "The shadow map \"%s\" cannot be written: there is no OpenImageIO (%s).", path, error.text);
  dsm_result result = new_file_create(path, &file, why);
  if (result == DSM_OK)
    new_file_discard(&file);
  return result;
}

/* For whoever looks at the file with other programs. */
static void describe(const map_header *h, char *text, size_t size)
{
  static const char *const lights[] = {"a point light", "a spotlight", "a parallel light"};
  const char *light = lights[h->light.kind], *end = h->projection.perspective ? "origin" : "plane";
  if (h->block == BLOCK_SHADOW_MAP) {
    snprintf(text, size, "Shadow map of %s: one depth a pixel. Z, infinite where nothing casts a shadow, is counted from the tile's "
             "near depth, which is in part \"tiles\". Rows run upwards. Depth is the distance from the light's %s.", light, end);
    return;
  }
  snprintf(text, size, "Deep shadow map of %s, packed: the first pixel of each tile holds all 16 x 16 of them. \"dsmtool export\" makes "
           "a standard deep image of it. Rows run upwards. Depth is the distance from the light's %s.", light, end);
}

static dsm_result open_writer(writing *w, const char *temporary, const map_header *header, const attribute_list *list)
{
  char description[600];
  deep_error error = {""};
  describe(header, description, sizeof description);
  deep_attribute *all = malloc((list->count + 2) * sizeof *all);
  if (!all)
    return map_no_memory(w->why);
  memcpy(all, list->items, list->count * sizeof *all);
  all[list->count] = (deep_attribute){"Software", "deepshadow " PACKAGE_VERSION};
  all[list->count + 1] = (deep_attribute){"ImageDescription", description};
  w->writer = w->exr->create(temporary, w->parts.parts, w->parts.count, all, list->count + 2, &error);
  free(all);
  return w->writer ? DSM_OK : cannot_write(w, &error);
}

static dsm_result write_tile(writing *w, uint32_t part, const tile_key *key, const tile *t)
{
  deep_error error = {""};
  uint64_t number = map_parts_number(&w->parts, key);
  if (t->kind == TILE_FAILED)
    return map_refused(w->why, "The shadow map \"%s\" is not saved: some of its tiles could not be baked.", w->path);
  dsm_result result = store_tile(t, w->kind, &w->deep);
  if (result == DSM_NO_MEMORY)
    return map_no_memory(w->why);
  if (result != DSM_OK) {
    map_refused(w->why, "The shadow map \"%s\" cannot be written: one of its tiles is not as it should be.", w->path);
    return result;
  }
  w->records[number] = t->kind == TILE_LIT ? record_of_lit : tile_record_of(t, &w->deep, number);
  return w->exr->write(w->writer, part, key->x, key->y, &w->deep, &error) ? DSM_OK : cannot_write(w, &error);
}

static dsm_result write_tiles(writing *w, map_tile_giver give, void *data, int (*progress)(void *data, double share))
{
  for (uint32_t part = 0; part + 1 < w->parts.count; part++) {
    const deep_part *grid = &w->parts.parts[part];
    tile_key key = w->parts.keys[part];
    for (key.y = 0; key.y < grid->up; key.y++)
      for (key.x = 0; key.x < grid->across; key.x++) {
        const tile *t;
        double share = (double)map_parts_number(&w->parts, &key) / (double)w->parts.tile_count;
        dsm_result result = progress && progress(data, share) ? DSM_CANCELLED : give(data, &key, &t);
        if (result == DSM_OK)
          result = write_tile(w, part, &key, t);
        if (result != DSM_OK)
          return result;
      }
  }
  return DSM_OK;
}

static dsm_result write_content(writing *w, const char *temporary, const map_header *header, const attribute_list *list,
                                map_tile_giver give, void *data, int (*progress)(void *data, double share))
{
  dsm_result result = open_writer(w, temporary, header, list);
  if (result == DSM_OK)
    result = write_tiles(w, give, data, progress);
  if (result == DSM_OK) {
    deep_error error = {""};
    uint64_t seal = map_seal(list->items, list->count, w->records, w->parts.tile_count);
    if (!tile_table_write(w->exr, w->writer, &w->parts, w->records, seal, &error))
      result = cannot_write(w, &error);
  }
  if (w->writer)
    w->exr->finish(w->writer);
  return result;
}

/* A disk that was full at the end shows in the table, which is last. */
static dsm_result check_written(const writing *w, const char *temporary)
{
  map_header header;
  map_file *file;
  char text[MAP_REASON_SIZE];
  map_reason ignored = {text, sizeof text};
  dsm_result result = map_file_open(temporary, &header, &file, &ignored);
  if (result == DSM_REFUSED)
    return map_refused(w->why, "The shadow map \"%s\" cannot be written: what was written cannot be read again; is the "
                       "disk full?", w->path);
  if (result != DSM_OK)
    return map_no_memory(w->why);
  map_file_close(file);
  map_header_free(&header);
  return DSM_OK;
}

dsm_result map_file_write(const char *path, const map_header *header, map_tile_giver give, void *data,
                          int (*progress)(void *data, double share), map_reason *why)
{
  writing w = {.path = path, .why = why, .kind = map_header_kind(header)};
  deep_error error = {""};
  new_file file;
  w.exr = deep_exr_load(&error);
  if (!w.exr)
    return cannot_write(&w, &error);
  dsm_result result = new_file_create(path, &file, why);
  if (result != DSM_OK)
    return result;
  map_parts_lay(&w.parts, &header->projection, w.kind);
  w.records = malloc((w.parts.tile_count + 1) * sizeof *w.records);
  attribute_list list = {NULL, 0, 0};
  result = w.records && map_header_write(header, &list) == DSM_OK ? DSM_OK : map_no_memory(why);
  if (result == DSM_OK)
    result = write_content(&w, file.temporary, header, &list, give, data, progress);
  if (result == DSM_OK)
    result = check_written(&w, file.temporary);
  attribute_list_free(&list);
  free(w.records);
  free(w.deep.words);
  if (result == DSM_OK)
    return new_file_keep(&file, why);
  new_file_discard(&file);
  return result;
}
