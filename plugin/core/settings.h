/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The words of a deep_shadow { } or shadow_map { } block: the published tables, and the checked values that a map is
 * built with. */
#ifndef DSM_CORE_SETTINGS_H
#define DSM_CORE_SETTINGS_H

#include "dsm.h"

typedef enum { FILTER_BOX, FILTER_TRIANGLE, FILTER_GAUSSIAN } filter_kind;   /* as the table orders them */

/* Where in the region of a look-up its samples lie (RSC figure 3): in its bounding box, one to each part of it, or anywhere
 * with equal density, or more in the middle; or in the parts of the region itself. As the table orders them. */
typedef enum { PATTERN_JITTERED, PATTERN_UNIFORM, PATTERN_GAUSSIAN, PATTERN_INSIDE } sample_pattern;

/* The kinds of map: deep ones, and those with one depth a pixel. */
typedef enum { BLOCK_DEEP_SHADOW, BLOCK_SHADOW_MAP, BLOCK_COUNT } block_kind;

/* Up to WORD_COUNT, indices into settings_table; the others are words of shadow_map alone. */
enum {
  WORD_ACCURACY, WORD_RESOLUTION, WORD_SAMPLES, WORD_TOLERANCE, WORD_FILTER, WORD_BLUR, WORD_BIAS, WORD_BOUNDS, WORD_SAVE_FILE,
  WORD_LOAD_FILE, WORD_CACHE, WORD_COUNT,
  WORD_MIN_SAMPLES = WORD_COUNT, WORD_SIZE_FACTOR, WORD_MIN_SIZE, WORD_DEPTH_BIAS, WORD_DEPTH_SAMPLES, WORD_PATTERN
};

#define SETTING_AUTOMATIC (-1.0)   /* of tolerance and bias, which are never negative */

struct dsm_settings {
  block_kind block;
  double accuracy;          /* error to aim at; 0: `resolution` and `samples` hold everywhere, and are not bounds */
  uint32_t resolution[2];   /* [1] is 0: square pixels, resolution[0] of them along the longer side */
  uint32_t samples;         /* deep: rays a pixel; shadow_map: depths a look-up */
  int chosen_resolution, chosen_samples;   /* by the scene */
  double tolerance;         /* or SETTING_AUTOMATIC */
  filter_kind filter;
  double filter_width;      /* full width of the filter's support in map pixels */
  double blur;              /* full width of the look-up's own filter as a share of the map */
  double bias;              /* scene units, or SETTING_AUTOMATIC */
  int bounded;              /* `bounds` is set */
  dsm_box bounds;           /* the frame holds this box, whatever casters there are */
  double cache;             /* megabytes of tiles */

  /* shadow_map alone, by RSC's names: MinSamples, ResFactor, MinSize, Bias0 and Bias1 */
  uint32_t min_samples;
  double size_factor, min_size;
  double depth_bias[2];     /* scene units, or both SETTING_AUTOMATIC */
  int jittered;             /* a pixel's ray goes anywhere in it, not through its middle */
  sample_pattern pattern;
  char *save_file, *load_file;   /* owned; NULL: none */
};

extern const dsm_parameter settings_table[WORD_COUNT];   /* of deep_shadow */
extern const dsm_block settings_blocks[BLOCK_COUNT];

/* WORD_… of a row of that block's table. */
uint32_t settings_word(block_kind block, uint32_t row);

void settings_defaults(dsm_settings *settings);              /* of deep_shadow */
void settings_complete(dsm_settings *settings);              /* with `accuracy`, what the scene leaves open is a wide bound */
void settings_shadow_map_defaults(dsm_settings *settings);
/* The published functions; dsm.h says what they do. */
dsm_settings *settings_create(uint32_t block);
dsm_result settings_set(dsm_settings *settings, uint32_t parameter, const char *choice, const double *numbers,
                        uint32_t count, char *why, uint64_t why_size);
const char *settings_text(const dsm_settings *settings, uint32_t parameter);
void settings_destroy(dsm_settings *settings);

#endif
