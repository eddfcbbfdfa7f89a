/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Tiles that memory has no room for, in a temporary file without a name, which is gone when the program ends however
 * it ends. */
#ifndef DSM_MAP_SPOOL_H
#define DSM_MAP_SPOOL_H

#include "dsm.h"
#include "map/tile.h"

typedef struct spool spool;

/* For tiles with numbers below `count`, in a file in the folder of `beside`, which is a path and need not exist. DSM_REFUSED:
 * no file can be made there. */
dsm_result spool_create(const char *beside, uint64_t count, spool **out);
void spool_destroy(spool *s);

/* [one] Keeps a tile with pixels (TILE_STORED), unless it is kept already: a tile made again has the same bytes. DSM_REFUSED: the
 * file takes no more, and nothing is written from then on. */
dsm_result spool_write(spool *s, uint64_t number, const tile *t);

/* [any, of a tile that is not being written] DSM_OK: *out is the tile, a new one with the bytes that were written, `used`
 * excepted, or NULL: it is not here. DSM_REFUSED, DSM_NO_MEMORY: it is, but cannot be read. */
dsm_result spool_read(const spool *s, uint64_t number, const tile **out);

/* [one, as spool_write] Nonzero: something could not be written. */
int spool_is_full(const spool *s);

#endif
