/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/map_file.h"

#include <errno.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "store/exr_layout.h"
#include "store/map_parts.h"

struct map_file {
  const deep_exr *exr;
  exr_layout *layout;       /* asked before the reader is */
  deep_reader *reader;
  char *path;
  map_parts parts;
  stored_kind kind;
  tile_record *records;     /* one for each tile */
  pthread_mutex_t mutex;    /* of the reader and the tile */
  deep_tile deep;
};

static dsm_result cannot_load(const char *path, const deep_error *error, map_reason *why)
{
  return map_refused(why, "The shadow map \"%s\" cannot be used: there is no OpenImageIO (%s).", path, error->text);
}

static int is_memory(const deep_error *error) { return strcmp(error->text, DEEP_NO_MEMORY) == 0; }

static dsm_result damaged(const char *path, const deep_error *error, map_reason *why)
{
  if (is_memory(error))
    return map_no_memory(why);
  return map_refused(why, "The shadow map \"%s\" is damaged or cut off (%s).", path, error->text);
}

dsm_result map_digest(const void *bytes, size_t size, char out[DIGEST_CHARS], map_reason *why)
{
  deep_error error;
  const deep_exr *exr = deep_exr_load(&error);
  if (!exr)
    return map_refused(why, "A shadow map cannot be saved or loaded: there is no OpenImageIO (%s).", error.text);
  return exr->digest(bytes, size, out) ? DSM_OK : map_no_memory(why);
}

static dsm_result cannot_read(const char *path, int error, map_reason *why)
{
  char reason[200];
  if (error == ENOENT)
    return map_refused(why, "There is no shadow map \"%s\".", path);
  if (strerror_r(error, reason, sizeof reason))
    snprintf(reason, sizeof reason, "error %d", error);
  return map_refused(why, "The shadow map \"%s\" cannot be read: %s.", path, reason);
}

/* Whether any of a map's attributes stands there; their names sort early. */
static int has_our_words(const unsigned char *bytes, size_t count)
{
  for (size_t i = 0; i + 5 <= count; i++)
    if (memcmp(bytes + i, "\0dsm:", 5) == 0)
      return 1;
  return 0;
}

/* OpenImageIO has the same words for whatever it cannot open. */
static dsm_result check_kind(const char *path, uint64_t *size, map_reason *why)
{
  static const unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};
  unsigned char first[4096];
  struct stat there;
  *size = 0;
  if (stat(path, &there))
    return cannot_read(path, errno, why);
  if (!S_ISREG(there.st_mode))
    return map_refused(why, "The shadow map \"%s\" cannot be read: this is not the name of a file.", path);
  FILE *file = fopen(path, "rb");
  if (!file)
    return cannot_read(path, errno, why);
  *size = (uint64_t)there.st_size;
  size_t n = fread(first, 1, sizeof first, file);
  fclose(file);
  if (n < sizeof magic || memcmp(first, magic, sizeof magic) != 0)
    return map_refused(why, "\"%s\" is not an OpenEXR file, so it is no shadow map.", path);
  if (!has_our_words(first, n))
    return map_refused(why, n < sizeof first ? "\"%s\" is not a shadow map, or damaged or cut off."
                                             : "\"%s\" is an OpenEXR image, but not a shadow map.", path);
  return DSM_OK;
}

static const char *get_attribute(void *data, const char *name)
{
  map_file *file = data;
  return file->exr->attribute(file->reader, name);
}

static dsm_result read_table(map_file *file, const map_header *header, map_reason *why)
{
  file->records = malloc((file->parts.tile_count + 1) * sizeof *file->records);
  attribute_list list = {NULL, 0, 0};
  dsm_result result = file->records ? map_header_write(header, &list) : DSM_NO_MEMORY;
  if (result == DSM_OK) {
    deep_error error = {""};
    uint64_t seal;
    if (!tile_table_read(file->exr, file->reader, &file->parts, file->records, &seal, &error))
      result = damaged(file->path, &error, why);
    else if (seal != map_seal(list.items, list.count, file->records, file->parts.tile_count))
      result = map_refused(why, "The shadow map \"%s\" is damaged: its header and its tiles do not belong together.",
                           file->path);
  }
  else
    map_no_memory(why);
  attribute_list_free(&list);
  return result;
}

/* Whether the reader may be trusted with the table of tiles. */
static int table_is_sound(const map_file *file)
{
  uint32_t last = file->parts.count - 1;
  const deep_part *table = &file->parts.parts[last];
  for (uint32_t y = 0; y < table->up; y++)
    for (uint32_t x = 0; x < table->across; x++)
      if (!exr_layout_tile(file->layout, last, x, y))
        return 0;
  return 1;
}

/* Even an empty tile takes this many bytes. */
enum { LEAST_TILE = 40 };

static dsm_result check_content(map_file *file, uint64_t size, map_header *header, map_reason *why)
{
  deep_error error = {""};
  dsm_result result = map_header_read(get_attribute, file, file->path, header, why);
  if (result != DSM_OK)
    return result;
  file->kind = map_header_kind(header);
  map_parts_lay(&file->parts, &header->projection, file->kind);
  if (file->parts.tile_count > size / LEAST_TILE)
    result = map_refused(why, "The shadow map \"%s\" is damaged or cut off: it is too short for its tiles.", file->path);
  else if (!file->exr->has_parts(file->reader, file->parts.parts, file->parts.count, &error))
    result = is_memory(&error) ? map_no_memory(why)
           : map_refused(why, "The shadow map \"%s\" is damaged: it does not have the parts that its header tells of.", file->path);
  else if (!table_is_sound(file))
    result = map_refused(why, "The shadow map \"%s\" is damaged or cut off: its table of tiles is not where it should be.",
                         file->path);
  else
    result = read_table(file, header, why);
  if (result != DSM_OK)
    map_header_free(header);
  return result;
}

static dsm_result check_layout(map_file *file, map_reason *why)
{
  dsm_result result = exr_layout_open(file->path, &file->layout);
  if (result == DSM_REFUSED)
    return map_refused(why, "The shadow map \"%s\" is damaged or cut off: its parts are not where they should be.", file->path);
  return result == DSM_OK ? DSM_OK : map_no_memory(why);
}

dsm_result map_file_open(const char *path, map_header *header, map_file **out, map_reason *why)
{
  deep_error error = {""};
  uint64_t size;
  *out = NULL;
  dsm_result result = check_kind(path, &size, why);
  if (result != DSM_OK)
    return result;
  const deep_exr *exr = deep_exr_load(&error);
  if (!exr)
    return cannot_load(path, &error, why);
  map_file *file = calloc(1, sizeof *file);
  if (!file || pthread_mutex_init(&file->mutex, NULL)) {
    free(file);
    return map_no_memory(why);
  }
  file->exr = exr;
  file->path = strdup(path);
  result = file->path ? check_layout(file, why) : map_no_memory(why);
  if (result == DSM_OK) {
    file->reader = exr->open(path, &error);
    result = file->reader ? check_content(file, size, header, why) : damaged(path, &error, why);
  }
  if (result == DSM_OK)
    *out = file;
  else
    map_file_close(file);
  return result;
}

/* Under the mutex. */
static dsm_result read_tile(map_file *file, const tile_key *key, const tile **out, deep_error *error)
{
  uint64_t number = map_parts_number(&file->parts, key);
  const tile_record *record = &file->records[number];
  uint32_t part = file->parts.part_of[key->face][key->level];
  if (record->tolerance < 0) {
    *out = &tile_lit;
    return DSM_OK;
  }
  if (!exr_layout_tile(file->layout, part, key->x, key->y)) {
    snprintf(error->text, sizeof error->text, "it is not where it should be");
    return DSM_REFUSED;
  }
  if (!file->exr->read(file->reader, part, key->x, key->y, &file->deep, error))
    return is_memory(error) ? DSM_NO_MEMORY : DSM_REFUSED;
  return restore_tile(&file->deep, file->kind, record, number, out);
}

dsm_result map_file_tile(map_file *file, const tile_key *key, const tile **out, map_reason *why)
{
  deep_error error = {"its checksum is wrong"};
  *out = NULL;
  pthread_mutex_lock(&file->mutex);
  dsm_result result = read_tile(file, key, out, &error);
  pthread_mutex_unlock(&file->mutex);
  if (result == DSM_REFUSED)
    map_refused(why, "The shadow map \"%s\" is damaged at tile %u, %u of level %u of face %u (%s).", file->path,
                (unsigned)key->x, (unsigned)key->y, (unsigned)key->level, (unsigned)key->face, error.text);
  else if (result != DSM_OK)
    map_no_memory(why);
  return result;
}

uint64_t map_file_level_bytes(const map_file *file, uint32_t level)
{
  uint64_t sum = 0;
  for (uint32_t part = 0; part + 1 < file->parts.count; part++)
    sum += file->parts.keys[part].level == level ? exr_layout_bytes(file->layout, part) : 0;
  return sum;
}

void map_file_close(map_file *file)
{
  if (!file)
    return;
  if (file->reader)
    file->exr->close(file->reader);
  exr_layout_close(file->layout);
  pthread_mutex_destroy(&file->mutex);
  free(file->records);
  free(file->deep.words);
  free(file->path);
  free(file);
}
