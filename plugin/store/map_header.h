/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What a map file says of itself: all that is needed to use the map without its scene, and to know the scene again. */
#ifndef DSM_STORE_MAP_HEADER_H
#define DSM_STORE_MAP_HEADER_H

#include "core/projection.h"
#include "core/settings.h"
#include "store/attribute_list.h"
#include "store/map_reason.h"
#include "store/stored_tile.h"

/* Formats of files, and the newest: one more whenever an older program would misread a file. Deep maps were of format 1 before. */
enum { DEPTHS_FORMAT = 2, DEEP_FORMAT = 3, NEWEST_FORMAT = 3 };

#define DIGEST_CHARS 41   /* a SHA-1 in hexadecimal and its end */

/* The scene at one time. A merged map has one for each map that went into it. */
typedef struct {
  char casters[DIGEST_CHARS];   /* the boxes of all casters */
  char probes[DIGEST_CHARS];    /* what light rays meet on their way */
} scene_print;

typedef struct {
  block_kind block;          /* the kind of map */
  dsm_light light;           /* without its casters */
  projection projection;
  uint32_t resolution[2];
  int jittered;              /* of maps of depths alone; filter, samples, tolerance, colour and marks are of deep ones */
  uint32_t samples;
  filter_kind filter;
  double filter_width;
  double tolerance;          /* or SETTING_AUTOMATIC */
  int bounded;               /* `bounds` was set */
  dsm_box bounds;
  int coloured;              /* some pixel stores three channels */
  uint64_t vertices, pixels_marked;   /* or depths */
  uint32_t scene_count;      /* >= 1 */
  scene_print *scenes;       /* owned */
} map_header;

void map_header_free(map_header *header);

uint32_t map_header_format(const map_header *header);
/* Of the map's tiles in a file. */
stored_kind map_header_kind(const map_header *header);

/* The header as attributes of a file, "dsm:…", in one fixed order; read back, they give a header with the same bits.
 * DSM_NO_MEMORY. Free the list in any case. */
dsm_result map_header_write(const map_header *header, attribute_list *list);

/* `get` returns the text of an attribute or NULL. DSM_REFUSED, with a sentence about `path`: it has no format or a newer
 * one, or not everything that map_header_write gives, text for text. Otherwise `header` is the caller's to free. */
dsm_result map_header_read(const char *(*get)(void *data, const char *name), void *data, const char *path,
                           map_header *header, map_reason *why);

/* DSM_OK: a map with header `wanted` may be read from the file. DSM_REFUSED: a sentence says what differs first, of light,
 * settings, casters, faces, and what light rays meet. One of the file's scenes must be that of `wanted`, which has one. */
dsm_result map_header_compare(const map_header *wanted, const map_header *file, const char *path, map_reason *why);

#endif
