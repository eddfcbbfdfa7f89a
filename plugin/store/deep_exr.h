/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Tiled OpenEXR files of several parts, deep or flat, through OpenImageIO. This is the C face of what is C++; it knows nothing of
 * maps.
 *
 * OpenImageIO takes a third of a second to load, with hundreds of libraries that it depends on, and some of those
 * start threads. So what is behind this face is a library of its own beside the plugin, loaded by the first map that has
 * to do with a file.
 */
#ifndef DSM_STORE_DEEP_EXR_H
#define DSM_STORE_DEEP_EXR_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define DEEP_SIDE 16                          /* pixels along a side of a tile */
#define DEEP_PIXELS (DEEP_SIDE * DEEP_SIDE)
#define DEEP_CHANNELS 6                       /* at most */

/* A part is a grid of whole tiles. */
typedef struct {
  char name[16];
  uint32_t across, up;                        /* tiles, > 0 */
  uint32_t channel_count;
  const char *channels[DEEP_CHANNELS];
  uint32_t integers;                          /* bit c: channel c holds integers, else floats */
  uint32_t flat;                              /* not deep: every pixel has one sample. All parts of a file or none */
} deep_part;

typedef struct { const char *name, *text; } deep_attribute;   /* of the first part; `text` is not empty */

/* Samples of pixel 0, pixel 1 … in rows; for each sample the 32 bits of each of its channels, in the
 * order that the part names them. */
typedef struct {
  uint32_t count[DEEP_PIXELS];
  uint32_t *words;                            /* malloc'd */
  size_t room;                                /* for so many words */
} deep_tile;

typedef struct deep_writer deep_writer;
typedef struct deep_reader deep_reader;

/* `error` is set to a short phrase, without a full stop, by every function that fails. One thread at a time for each
 * writer and reader. */
typedef struct { char text[300]; } deep_error;
#define DEEP_NO_MEMORY "out of memory"        /* that phrase where it is nothing else */

typedef struct {
  uint32_t size;   /* of this table: another one is of another version */

  /* Makes or overwrites the file. NULL: failed. */
  deep_writer *(*create)(const char *path, const deep_part *parts, uint32_t part_count,
                         const deep_attribute *attributes, uint32_t attribute_count, deep_error *error);
  /* Every tile once: part by part, row by row. 0: failed. */
  int (*write)(deep_writer *writer, uint32_t part, uint32_t x, uint32_t y, const deep_tile *tile, deep_error *error);
  /* Closes and destroys. What the last writes to disk have met is not told: read the end of the file again to know. */
  void (*finish)(deep_writer *writer);

  deep_reader *(*open)(const char *path, deep_error *error);   /* NULL: failed */
  /* NULL: the first part has no such text. Lives as long as the reader. */
  const char *(*attribute)(deep_reader *reader, const char *name);
  /* Whether the file has these parts, and no more. To be asked, and answered with yes, before anything is read. `error` is left alone
   * unless something else went wrong. */
  int (*has_parts)(deep_reader *reader, const deep_part *parts, uint32_t part_count, deep_error *error);
  /* Fills `tile`, enlarging `words` as needed; they are not NULL then, even if there are none. 0: failed; `words` is still the caller's. */
  int (*read)(deep_reader *reader, uint32_t part, uint32_t x, uint32_t y, deep_tile *tile, deep_error *error);
  void (*close)(deep_reader *reader);

  /* A SHA-1 in hexadecimal. 0: out of memory. */
  int (*digest)(const void *bytes, size_t size, char out[41]);
} deep_exr;

/* The table, loaded if need be. NULL: it cannot be. [any thread] */
const deep_exr *deep_exr_load(deep_error *error);

/* The file that holds the table, and the symbol there. */
#define DEEP_EXR_LIBRARY "deepshadow_files.so"
extern const deep_exr deep_exr_table;

#ifdef __cplusplus
}
#endif
#endif
