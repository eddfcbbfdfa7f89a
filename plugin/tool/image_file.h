/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Images other than maps, through OpenImageIO: the C face of what is C++. Rows count from the top. */
#ifndef DSM_TOOL_IMAGE_FILE_H
#define DSM_TOOL_IMAGE_FILE_H

#include "store/deep_exr.h"
#include "store/map_reason.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Writes a flat image whose format the file's ending names. `channels` is 1 (Y), 2 (Y, A), 3 (R, G, B) or 4 (with A).
 * `values` has width * height * channels linear numbers. What was there before is replaced only when all is written.
 * DSM_REFUSED, DSM_NO_MEMORY. */
dsm_result flat_image_write(const char *path, uint32_t width, uint32_t height, uint32_t channels, const float *values,
                            map_reason *why);

/* Something that takes light: all at z where z_back == z, else exponentially from z to z_back. */
typedef struct {
  float z, z_back;   /* scene units from the light */
  float alpha[3];    /* share of the light that it takes; red, green, blue */
} deep_sample;

typedef struct {
  uint32_t width, height;
  int coloured;      /* alpha differs by channel: AR, AG, AB instead of A */
} image_size;

typedef struct image_writer image_writer;

/* A deep scanline OpenEXR file with Z, ZBack, A or AR, AG, AB, and black R, G, B. */
dsm_result image_writer_open(const char *path, const image_size *size, const deep_attribute *attributes,
                             uint32_t attribute_count, image_writer **writer, map_reason *why);
/* Appends one row; pixel x has the samples first[x] … first[x + 1] - 1. */
dsm_result image_writer_row(image_writer *writer, const deep_sample *samples, const size_t *first, map_reason *why);
/* Finishes the file if `keep` is not 0 and all rows have been written, else leaves what was there before. */
dsm_result image_writer_close(image_writer *writer, int keep, map_reason *why);

typedef struct image_reader image_reader;

/* Any deep image with Z and A, or AR, AG, AB; ZBack is Z where it is missing. All of it is read at once. DSM_REFUSED: it is no
 * such image; DSM_NO_MEMORY. */
dsm_result image_reader_open(const char *path, image_size *size, image_reader **reader, map_reason *why);
/* NULL: there is no such text. Lives as long as the reader. */
const char *image_reader_attribute(const image_reader *reader, const char *name);
uint32_t image_reader_count(const image_reader *reader, uint32_t x, uint32_t y);
deep_sample image_reader_sample(const image_reader *reader, uint32_t x, uint32_t y, uint32_t index);
void image_reader_close(image_reader *reader);

#ifdef __cplusplus
}
#endif
#endif
