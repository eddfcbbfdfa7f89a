/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A map in a file: one OpenEXR file a light, written and read through OpenImageIO.
 *
 *   part "f0.l0"       deep, in tiles of 16 x 16 pixels: face 0, level 0. One channel of whole numbers, "words"
 *   part "f1.l0" …     the other faces, then the coarser levels
 *   part "tiles"       last: a deep pixel a tile, in the order of tile_store_number, 256 to a tile of the part. One sample
 *                      where the tile is stored, none where it is lit: near depth (the halves of a double), tolerance,
 *                      checksum. After the last tile one sample more, the seal: how many tiles there are, and a checksum
 *                      of all records and of the header
 *
 * Row 0 of a part is the lowest one of the face; pixels beyond the face's edge are empty. The first pixel of a tile has all words of it
 * (map/tile_words.h), as memory holds it: floats in channels of their own would take two to three times the bytes. So a map that was read
 * has the same bits as the one that was written. A lit tile has none.
 * A map of depths has flat parts instead, "f0", "f1" … and "tiles": Z alone, a float relative to the tile's near depth, INFINITY where
 * there is no surface and all over lit tiles; a record for every tile, of lit ones with a tolerance of -1.
 * Attributes of the first part ("dsm:…") hold the header. The same map gives the same bytes.
 */
#ifndef DSM_STORE_MAP_FILE_H
#define DSM_STORE_MAP_FILE_H

#include "map/tile.h"
#include "store/map_header.h"
#include "store/map_reason.h"

typedef struct map_file map_file;

/* Opens a file and checks all of it that can be checked without reading its tiles. DSM_REFUSED, with a reason that names
 * the file: it is missing, no map, damaged, or of a newer or an older format; DSM_NO_MEMORY. `header` is the caller's to free. */
dsm_result map_file_open(const char *path, map_header *header, map_file **file, map_reason *why);

/* [any thread] One tile, with all the bytes that it had when it was written but `used` and `volume`: a new tile or &tile_lit.
 * DSM_REFUSED: it is damaged; DSM_NO_MEMORY. */
dsm_result map_file_tile(map_file *file, const tile_key *key, const tile **out, map_reason *why);
void map_file_close(map_file *file);

/* [any thread] Bytes of the file that a level of all faces takes. */
uint64_t map_file_level_bytes(const map_file *file, uint32_t level);

/* Hands over one tile of the map that is being written; it must live until the next call. Only DSM_OK goes on. */
typedef dsm_result (*map_tile_giver)(void *data, const tile_key *key, const tile **out);

/* Asks for each tile once: level by level from the finest, face by face, row by row. Writes under a temporary name beside
 * `path`, reads the end again, then renames: any failure leaves what was there before, and nothing else. DSM_REFUSED, with
 * a reason; DSM_INVALID: a tile is none that could be read again, or coloured where the header knows of no colour; DSM_NO_MEMORY; what
 * `give` returned. `progress` may be NULL; if it returns nonzero the writing is given up (DSM_CANCELLED). */
dsm_result map_file_write(const char *path, const map_header *header, map_tile_giver give, void *data,
                          int (*progress)(void *data, double share), map_reason *why);

/* DSM_OK if a file can be made at this path, and can be written at all; leaves none. */
dsm_result map_file_writable(const char *path, map_reason *why);

/* A SHA-1. DSM_REFUSED: the library for files is missing; DSM_NO_MEMORY. */
dsm_result map_digest(const void *bytes, size_t size, char out[DIGEST_CHARS], map_reason *why);

#endif
