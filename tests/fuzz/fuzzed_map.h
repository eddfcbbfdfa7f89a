/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * What the fuzzed readers of maps share: every tile is read, and what was read is looked at.
 *
 * Sums are right whatever was damaged, so that damage gets where chance would never seal it: checksum_add below stands before the
 * plugin's own when the linker looks for it, every sum is 0 with it, and so are those of the table as it is read. damaged_map_test.c is
 * about files with true sums.
 */
#ifndef TESTS_FUZZED_MAP_H
#define TESTS_FUZZED_MAP_H

#include <stdlib.h>

#include "map/depth_tile.h"
#include "map/tile_store.h"
#include "store/map_file.h"
#include "store/map_parts.h"

int __real_tile_table_read(const deep_exr *exr, deep_reader *reader, const map_parts *parts, tile_record *records, uint64_t *seal,
                           deep_error *error);
int __wrap_tile_table_read(const deep_exr *exr, deep_reader *reader, const map_parts *parts, tile_record *records, uint64_t *seal,
                           deep_error *error);

/* Both ends of what is summed are touched, for who watches that they are there. */
uint64_t checksum_add(uint64_t sum, const void *bytes, size_t size) {
  const volatile unsigned char *b = bytes;
  (void)sum;
  if (size) (void)b[0], (void)b[size - 1];
  return 0;
}

int __wrap_tile_table_read(const deep_exr *exr, deep_reader *reader, const map_parts *parts, tile_record *records, uint64_t *seal,
                           deep_error *error) {
  int read = __real_tile_table_read(exr, reader, parts, records, seal, error);
  for (uint64_t n = 0; read && n < parts->tile_count; ++n) records[n].checksum = 0;
  *seal = 0;
  return read;
}

/* A pixel that was accepted: depths never fall, light never grows. A long one is looked at in part, as deltas are walked for each
 * vertex anew. */
static inline void look_at_pixel(const tile *t, uint32_t place) {
  enum { MOST = 48 };
  visibility v = tile_visibility(t, place);
  double depth = 0;
  uint32_t least[3] = {VALUE_STEPS, VALUE_STEPS, VALUE_STEPS};
  for (uint32_t k = 0; k < v.count && k < MOST; ++k) {
    double here = visibility_depth(&v, k);
    if (!(here >= depth && here < INFINITY)) abort();
    depth = here;
    for (uint32_t c = 0; c < v.channels; ++c) {
      uint32_t value = visibility_stored(&v, k, c);
      if (value > least[c]) abort();
      least[c] = value;
    }
  }
}

static inline void look_at_tile(const tile *t) {
  if (!(t->near_depth >= 0 && t->near_depth < INFINITY)) abort();
  if (t->kind != TILE_STORED) return;
  for (uint32_t i = 0; i < TILE_PIXELS; ++i)
    if (!tile_has_depths(t))
      look_at_pixel(t, i);
    else if (!(depths_of(t)->depth[i] >= 0))
      abort();
}

static inline void read_tiles(map_file *file, const map_header *header, map_reason *why) {
  tile_store store;
  if (tile_store_create(&store, &header->projection, UINT64_MAX) != DSM_OK) return;
  for (uint64_t n = 0; n < store.tile_count; ++n) {
    tile_key key = tile_store_key(&store, n);
    const tile *t;
    if (map_file_tile(file, &key, &t, why) != DSM_OK) continue;
    look_at_tile(t);
    tile_destroy(t);
  }
  tile_store_destroy(&store);
}

/* 0: refused, with a sentence. */
static inline int read_whole_map(const char *path) {
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  map_header header;
  map_file *file;
  if (map_file_open(path, &header, &file, &why) != DSM_OK) {
    if (!text[0]) abort();
    return 0;
  }
  read_tiles(file, &header, &why);
  map_file_close(file);
  map_header_free(&header);
  return 1;
}

#endif
