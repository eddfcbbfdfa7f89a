/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A pixel between compression and packing: a stretch of its tile's vertices. */
#ifndef DSM_MAP_BAKED_PIXEL_H
#define DSM_MAP_BAKED_PIXEL_H

#include <stddef.h>

typedef struct {
  size_t first, count;    /* of its vertices */
  int coloured, marked;   /* channels differ; light can grow (then no vertices) */
  int volume, surface;    /* what its rays have met that takes light */
  int clear;              /* surfaces that take none, as containers of volumes */
  double tolerance;       /* error that its compression was allowed */
  double variance;        /* of its rays' average: the noise that lasts, see noise_lasting; 0 unless `accuracy` wants it */
  unsigned char need;     /* of a finer level, see tile.h */
  unsigned char absent;   /* not baked, as no look-up comes here; whoever does is to trace the ray */
} baked_pixel;

#endif
