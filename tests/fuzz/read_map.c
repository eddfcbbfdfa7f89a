/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Any bytes as a map's file: opened as a render opens it, and every tile read. Built and run by run.sh.
 *
 * Nothing is asked of the result but that it is one: no crash, no leak, no hang, no allocation beyond what the file's own size
 * can explain. The file that the library sees lies in memory.
 */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "map/tile_store.h"
#include "store/map_file.h"

static char path[64];

static void forget_file(void) { unlink(path); }

static int put(const unsigned char *bytes, size_t size) {
  if (!path[0]) {
    snprintf(path, sizeof path, "/dev/shm/deep-shadow-fuzz-%ld.exr", (long)getpid());
    atexit(forget_file);
  }
  FILE *file = fopen(path, "wb");
  if (!file) return 0;
  size_t written = fwrite(bytes, 1, size, file);
  return fclose(file) == 0 && written == size;
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

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size);

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size) {
  char text[MAP_REASON_SIZE];
  map_reason why = {text, sizeof text};
  map_header header;
  map_file *file;
  if (!put(bytes, size)) abort();
  if (map_file_open(path, &header, &file, &why) != DSM_OK) return 0;
  read_all(file, &header);
  map_file_close(file);
  map_header_free(&header);
  return 0;
}
