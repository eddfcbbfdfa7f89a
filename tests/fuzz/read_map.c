/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Any bytes as a map's file: opened as a render opens it, and every tile read. Built and run by run.sh.
 *
 * Nothing is asked of the result but that it is one: no crash, no leak, no hang, no allocation beyond what the file's own size
 * can explain. The seal over header and table is taken for right (the linker wraps the two functions below), so that tiles are
 * reached that chance would never seal.
 */
#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include "fuzzed_file.h"
#include "map/tile_store.h"
#include "store/map_file.h"
#include "store/map_parts.h"

static uint64_t seal_in_file;

int __real_tile_table_read(const deep_exr *exr, deep_reader *reader, const map_parts *parts, tile_record *records, uint64_t *seal,
                           deep_error *error);
int __wrap_tile_table_read(const deep_exr *exr, deep_reader *reader, const map_parts *parts, tile_record *records, uint64_t *seal,
                           deep_error *error);
uint64_t __wrap_map_seal(const deep_attribute *attributes, uint32_t attribute_count, const tile_record *records, uint64_t tile_count);

int __wrap_tile_table_read(const deep_exr *exr, deep_reader *reader, const map_parts *parts, tile_record *records, uint64_t *seal,
                           deep_error *error) {
  int read = __real_tile_table_read(exr, reader, parts, records, seal, error);
  seal_in_file = *seal;
  return read;
}

uint64_t __wrap_map_seal(const deep_attribute *attributes, uint32_t attribute_count, const tile_record *records, uint64_t tile_count) {
  (void)attributes, (void)attribute_count, (void)records, (void)tile_count;
  return seal_in_file;
}

/* What loads by itself elsewhere is linked in here, with sanitizers. */
const deep_exr *deep_exr_load(deep_error *error) {
  (void)error;
  return &deep_exr_table;
}

static char path[64];

static void forget_file(void) { unlink(path); }

/* The file lies in memory, and is made once. */
static void put(const unsigned char *bytes, size_t size) {
  static int file = -1;
  if (file < 0) {
    snprintf(path, sizeof path, "/dev/shm/deep-shadow-fuzz-%ld.exr", (long)getpid());
    file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
    atexit(forget_file);
  }
  if (file < 0 || ftruncate(file, (off_t)size) || pwrite(file, bytes, size, 0) != (ssize_t)size) abort();
  fuzzed_file_set(bytes, size);
}

static void read_all(map_file *file, const map_header *header) {
  tile_store store;
  char text[MAP_REASON_SIZE];
  map_reason why = {text, sizeof text};
  if (tile_store_create(&store, &header->projection, UINT64_MAX) != DSM_OK) return;
  for (uint64_t n = 0; n < store.tile_count; ++n) {
    tile_key key = tile_store_key(&store, n);
    const tile *t;
    if (map_file_tile(file, &key, &t, &why) == DSM_OK) tile_destroy(t);
  }
  tile_store_destroy(&store);
}

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size) {
  char text[MAP_REASON_SIZE];
  map_reason why = {text, sizeof text};
  map_header header;
  map_file *file;
  put(bytes, size);
  if (map_file_open(path, &header, &file, &why) != DSM_OK) return 0;
  read_all(file, &header);
  map_file_close(file);
  map_header_free(&header);
  return 0;
}
