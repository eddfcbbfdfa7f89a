/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The words of a deep_shadow { } block: the published table, and the checked values that a map is built
 * with. */
#ifndef DSM_CORE_SETTINGS_H
#define DSM_CORE_SETTINGS_H

#include "dsm.h"

typedef enum { FILTER_BOX, FILTER_TRIANGLE, FILTER_GAUSSIAN } filter_kind;   /* as the table orders them */

/* Indices into settings_table. */
enum {
  WORD_RESOLUTION, WORD_SAMPLES, WORD_TOLERANCE, WORD_FILTER, WORD_BLUR, WORD_BIAS, WORD_BOUNDS, WORD_SAVE_FILE,
  WORD_LOAD_FILE, WORD_CACHE, WORD_COUNT
};

#define SETTING_AUTOMATIC (-1.0)   /* of tolerance and bias, which are never negative */

struct dsm_settings {
  uint32_t resolution[2];   /* [1] is 0: square pixels, resolution[0] of them along the longer side */
  uint32_t samples;         /* rays a pixel */
  double tolerance;         /* or SETTING_AUTOMATIC */
  filter_kind filter;
  double filter_width;      /* full width of the filter's support in map pixels */
  double blur;              /* full width of the look-up's own filter as a share of the map */
  double bias;              /* scene units, or SETTING_AUTOMATIC */
  int bounded;              /* `bounds` is set */
  dsm_box bounds;           /* the frame holds this box, whatever casters there are */
  double cache;             /* megabytes of tiles */
  char *save_file, *load_file;   /* owned; NULL: none */
};

extern const dsm_parameter settings_table[WORD_COUNT];

void settings_defaults(dsm_settings *settings);
/* The published functions; dsm.h says what they do. */
dsm_settings *settings_create(void);
dsm_result settings_set(dsm_settings *settings, uint32_t parameter, const char *choice, const double *numbers,
                        uint32_t count, char *why, uint64_t why_size);
const char *settings_text(const dsm_settings *settings, uint32_t parameter);
void settings_destroy(dsm_settings *settings);

#endif
