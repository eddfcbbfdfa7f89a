/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * A visibility function as the samples of a standard deep image, and back.
 *
 * A map is linear between vertices; OpenEXR has light fall exponentially within a sample ("Interpreting OpenEXR Deep
 * Pixels"). The exponential through two points hangs below the line between them:
 *
 *   V1 *.        linear        so a segment is split where it would hang by more than the tolerance, into as few
 *      | ` . `  .              samples as that takes: each reaches as far as it can.
 *      |  exp.     ` .
 *   V2 |         ` - ..*
 */
#ifndef DSM_TOOL_DEEP_SAMPLES_H
#define DSM_TOOL_DEEP_SAMPLES_H

#include "core/vertices.h"
#include "tool/image_file.h"

typedef struct {
  deep_sample *data;
  size_t count, capacity;
} deep_samples;

/* Appends the samples of a function that never grows: tidy (sorted, none overlaps another), and within `tolerance` > 0 of the
 * function at every depth but for the rounding of depths to floats. Vertices that coincide as floats make one step.
 * `channels` is 1 or 3. */
dsm_result deep_samples_of(const vertex *data, size_t count, int channels, double tolerance, deep_samples *out);
void deep_samples_free(deep_samples *list);

/* The largest distance between the line and the exponential from `a` to `b`, 1 >= a >= b >= 0. */
double exponential_sag(double a, double b);

#endif
