/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The words of the two blocks, as parser, documentation and tools know them. */
#include "core/settings.h"

#include <float.h>
#include <stddef.h>

const dsm_parameter settings_table[WORD_COUNT] = {
  [WORD_ACCURACY] = {"accuracy", DSM_NUMBERS, 1, 1, 0, 0, 0.5, 1, 1, NULL, "off",
    "error of the shadow to aim at: chooses resolution and samples place by place, up to those given (8192 and 1024)"},
  [WORD_RESOLUTION] = {"resolution", DSM_NUMBERS, 1, 2, 1, 1, 16384, 0, 0, NULL, "512",
    "map pixels of a face: along its longer side, or <across, up>"},
  [WORD_SAMPLES] = {"samples", DSM_NUMBERS, 1, 1, 1, 1, 4096, 0, 0, NULL, "16",
    "rays traced for a map pixel"},
  [WORD_TOLERANCE] = {"tolerance", DSM_NUMBERS, 1, 1, 0, 0, 0.5, 0, 1, NULL, "automatic",
    "largest error of visibility, at any depth, that compression may add"},
  [WORD_FILTER] = {"filter", DSM_CHOICE, 0, 1, 0, 0, 16, 1, 0, "box triangle gaussian", "\"box\", 1",
    "filter of a map pixel and its full width in map pixels"},
  [WORD_BLUR] = {"blur", DSM_NUMBERS, 1, 1, 0, 0, 1, 0, 0, NULL, "0",
    "width of an extra filter of the look-up, as a share of the map"},
  [WORD_BIAS] = {"bias", DSM_NUMBERS, 1, 1, 0, 0, DBL_MAX, 0, 0, NULL, "automatic",
    "scene units by which a surface is moved toward the light before its shadow is looked up"},
  [WORD_BOUNDS] = {"bounds", DSM_NUMBERS, 6, 6, 0, -1e150, 1e150, 0, 0, NULL, "none",
    "two corners of a box that the map holds in any case: maps of moving objects then share one frame"},
  [WORD_SAVE_FILE] = {"save_file", DSM_TEXT, 0, 0, 0, 0, 0, 0, 0, NULL, "none",
    "bake the whole map first, and write it to this file"},
  [WORD_LOAD_FILE] = {"load_file", DSM_TEXT, 0, 0, 0, 0, 0, 0, 0, NULL, "none",
    "read the map from this file instead of baking it"},
  [WORD_CACHE] = {"cache", DSM_NUMBERS, 1, 1, 0, 0, 1e9, 1, 0, NULL, "1024",
    "megabytes that the map's tiles may hold in memory"},
};

static const dsm_parameter shadow_map_table[] = {
  {"resolution", DSM_NUMBERS, 1, 2, 1, 1, 16384, 0, 0, NULL, "1024",
    "map pixels of a face: along its longer side, or <across, up>"},
  {"samples", DSM_NUMBERS, 1, 1, 1, 1, 4096, 0, 0, NULL, "16",
    "depths compared in a look-up: about so many, and not more than pixels in a small region"},
  {"min_samples", DSM_NUMBERS, 1, 1, 1, 1, 64, 0, 0, NULL, "3",
    "least number of samples along each side of the region"},
  {"size_factor", DSM_NUMBERS, 1, 1, 0, 0, 1000, 0, 0, NULL, "3",
    "the region reaches so many of its own widths to each side of the point: softness"},
  {"min_size", DSM_NUMBERS, 1, 1, 0, 0, 1000, 0, 0, NULL, "2",
    "map pixels that the region reaches at least to each side of the point"},
  {"bias", DSM_NUMBERS, 1, 2, 0, 0, DBL_MAX, 0, 0, NULL, "automatic",
    "scene units added to a pixel's depth, for each sample at random between two bounds"},
  {"depth_samples", DSM_CHOICE, 0, 0, 0, 0, 0, 0, 0, "regular jittered", "\"regular\"",
    "where a pixel's one light ray goes: through its middle, or anywhere in it"},
  {"pattern", DSM_CHOICE, 0, 0, 0, 0, 0, 0, 0, "jittered uniform gaussian inside", "\"jittered\"",
    "where in the region the samples lie"},
  {"bounds", DSM_NUMBERS, 6, 6, 0, -1e150, 1e150, 0, 0, NULL, "none",
    "two corners of a box that the map holds in any case: maps of moving objects then share one frame"},
  {"save_file", DSM_TEXT, 0, 0, 0, 0, 0, 0, 0, NULL, "none",
    "bake the whole map first, and write it to this file"},
  {"load_file", DSM_TEXT, 0, 0, 0, 0, 0, 0, 0, NULL, "none",
    "read the map from this file instead of baking it"},
  {"cache", DSM_NUMBERS, 1, 1, 0, 0, 1e9, 1, 0, NULL, "1024",
    "megabytes that the map's tiles may hold in memory"},
};

enum { SHADOW_MAP_ROWS = sizeof shadow_map_table / sizeof *shadow_map_table };

static const unsigned char shadow_map_words[] = {
  WORD_RESOLUTION, WORD_SAMPLES, WORD_MIN_SAMPLES, WORD_SIZE_FACTOR, WORD_MIN_SIZE, WORD_DEPTH_BIAS, WORD_DEPTH_SAMPLES,
  WORD_PATTERN, WORD_BOUNDS, WORD_SAVE_FILE, WORD_LOAD_FILE, WORD_CACHE
};
_Static_assert(sizeof shadow_map_words == SHADOW_MAP_ROWS, "a word for each row");

const dsm_block settings_blocks[BLOCK_COUNT] = {
  [BLOCK_DEEP_SHADOW] = {"deep_shadow", settings_table, WORD_COUNT},
  [BLOCK_SHADOW_MAP] = {"shadow_map", shadow_map_table, SHADOW_MAP_ROWS},
};

uint32_t settings_word(block_kind block, uint32_t row)
{
  return block == BLOCK_SHADOW_MAP ? shadow_map_words[row] : row;
}
