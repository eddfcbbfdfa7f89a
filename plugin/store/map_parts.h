/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The parts of a map's file: one for each level of each face, and the table of tiles. */
#ifndef DSM_STORE_MAP_PARTS_H
#define DSM_STORE_MAP_PARTS_H

#include "core/projection.h"
#include "map/tile.h"
#include "store/deep_exr.h"
#include "store/stored_tile.h"

typedef struct {
  deep_part parts[MAX_FACES * MAX_LEVELS + 1];
  uint32_t count;                                 /* the last one is the table */
  uint32_t part_of[MAX_FACES][MAX_LEVELS];        /* where that level is there */
  uint64_t first[MAX_FACES * MAX_LEVELS];         /* number of the part's first tile, as in tile_store_number */
  tile_key keys[MAX_FACES * MAX_LEVELS];          /* of that tile */
  uint64_t tile_count;
} map_parts;

void map_parts_lay(map_parts *parts, const projection *p, stored_kind kind);

static inline uint64_t map_parts_number(const map_parts *parts, const tile_key *key)
{
  uint32_t part = parts->part_of[key->face][key->level];
  return parts->first[part] + (uint64_t)key->y * parts->parts[part].across + key->x;
}

/* A checksum that covers the header and the records of all tiles. */
uint64_t map_seal(const deep_attribute *attributes, uint32_t attribute_count, const tile_record *records,
                  uint64_t tile_count);

/* The table with its seal. Reading fails too if it is not sealed. 0: failed, with an error. */
int tile_table_write(const deep_exr *exr, deep_writer *writer, const map_parts *parts, const tile_record *records,
                     uint64_t seal, deep_error *error);
int tile_table_read(const deep_exr *exr, deep_reader *reader, const map_parts *parts, tile_record *records,
                    uint64_t *seal, deep_error *error);

#endif
