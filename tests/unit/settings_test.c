/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/settings.h"

static dsm_settings set;
static char why[200];

static dsm_result give(uint32_t word, const char *choice, uint32_t count, double a, double b) {
  double numbers[6] = {a, b, 0, -1, -2, -3};
  return settings_set(&set, word, choice, numbers, count, why, sizeof why);
}

static void defaults_are_those_of_the_table(void **state) {
  (void)state;
  settings_defaults(&set);
  assert_int_equal(set.resolution[0], 512);
  assert_int_equal(set.resolution[1], 0);
  assert_int_equal(set.samples, 16);
  assert_true(set.tolerance == SETTING_AUTOMATIC && set.bias == SETTING_AUTOMATIC);
  assert_true(set.filter == FILTER_BOX && set.filter_width == 1);
  assert_true(set.blur == 0 && !set.bounded && set.cache == 1024 && !set.save_file && !set.load_file);
  for (int i = 0; i < WORD_COUNT; ++i) {
    const dsm_parameter *row = &settings_table[i];
    assert_non_null(row->name);
    assert_non_null(row->default_text);
    assert_non_null(row->meaning);
    assert_true(row->min_count <= row->max_count && row->low <= row->high);
    assert_true((row->type == DSM_CHOICE) == (row->choices != NULL));
  }
}

static void good_values_are_taken(void **state) {
  (void)state;
  settings_defaults(&set);
  assert_int_equal(give(WORD_RESOLUTION, NULL, 1, 16384, 0), DSM_OK);
  assert_true(set.resolution[0] == 16384 && set.resolution[1] == 0);
  assert_int_equal(give(WORD_RESOLUTION, NULL, 2, 1, 7), DSM_OK);
  assert_true(set.resolution[0] == 1 && set.resolution[1] == 7);
  assert_int_equal(give(WORD_SAMPLES, NULL, 1, 4096, 0), DSM_OK);
  assert_int_equal(set.samples, 4096);
  assert_int_equal(give(WORD_TOLERANCE, NULL, 1, 0, 0), DSM_OK);
  assert_true(set.tolerance == 0);
  assert_int_equal(give(WORD_TOLERANCE, NULL, 1, nextafter(0.5, 0), 0), DSM_OK);
  assert_int_equal(give(WORD_FILTER, "gaussian", 1, 16, 0), DSM_OK);
  assert_true(set.filter == FILTER_GAUSSIAN && set.filter_width == 16);
  assert_int_equal(give(WORD_FILTER, "triangle", 0, 0, 0), DSM_OK);
  assert_true(set.filter == FILTER_TRIANGLE && set.filter_width == 2);
  assert_int_equal(give(WORD_FILTER, "box", 1, 1e-9, 0), DSM_OK);
  assert_int_equal(give(WORD_BIAS, NULL, 1, 1e6, 0), DSM_OK);
  assert_true(set.bias == 1e6);
  assert_int_equal(give(WORD_BLUR, NULL, 1, 1, 0), DSM_OK);
  assert_true(set.blur == 1);
  assert_int_equal(give(WORD_ACCURACY, NULL, 1, 0.01, 0), DSM_OK);
  assert_true(set.accuracy == 0.01);
  assert_int_equal(give(WORD_CACHE, NULL, 1, 0.5, 0), DSM_OK);
  assert_true(set.cache == 0.5);
  /* two corners in any order */
  assert_int_equal(give(WORD_BOUNDS, NULL, 6, -5, 7), DSM_OK);
  assert_true(set.bounded && set.bounds.low[0] == -5 && set.bounds.high[0] == -1);
  assert_true(set.bounds.low[1] == -2 && set.bounds.high[1] == 7 && set.bounds.low[2] == -3 && set.bounds.high[2] == 0);
}

/* The last text given is kept, and gone with the settings (a leak checker sees whether). */
static void texts(void **state) {
  (void)state;
  dsm_settings *s = settings_create(BLOCK_DEEP_SHADOW);
  char name[] = "one.exr";
  assert_non_null(s);
  assert_null(settings_text(s, WORD_SAVE_FILE));
  assert_int_equal(settings_set(s, WORD_SAVE_FILE, name, NULL, 0, why, sizeof why), DSM_OK);
  name[0] = 'x';
  assert_string_equal(settings_text(s, WORD_SAVE_FILE), "one.exr");
  assert_int_equal(settings_set(s, WORD_SAVE_FILE, "", NULL, 0, why, sizeof why), DSM_INVALID);
  assert_string_equal(settings_text(s, WORD_SAVE_FILE), "one.exr");
  assert_int_equal(settings_set(s, WORD_SAVE_FILE, "two.exr", NULL, 0, why, sizeof why), DSM_OK);
  assert_string_equal(settings_text(s, WORD_SAVE_FILE), "two.exr");
  assert_null(settings_text(s, WORD_LOAD_FILE));
  assert_null(settings_text(s, WORD_SAMPLES));
  assert_null(settings_text(s, WORD_COUNT));
  settings_destroy(s);
  settings_destroy(NULL);
}

/* A refusal names the word, the value and the range, and changes nothing. */
static void refused(uint32_t word, const char *choice, uint32_t count, double a, double b, const char *value,
                    const char *range) {
  dsm_settings before = set;
  memset(why, 'x', sizeof why);
  assert_int_equal(give(word, choice, count, a, b), DSM_INVALID);
  assert_memory_equal(&before, &set, sizeof set);
  if (word < WORD_COUNT) assert_non_null(strstr(why, settings_table[word].name));
  if (!strstr(why, value) || !strstr(why, range)) fail_msg("no '%s' and '%s' in: %s", value, range, why);
  assert_true(why[strlen(why) - 1] == '.');
}

static void bad_values_are_refused(void **state) {
  (void)state;
  settings_defaults(&set);
  refused(WORD_ACCURACY, NULL, 1, 0, 0, "0", "above 0 and below 0.5");
  refused(WORD_ACCURACY, NULL, 1, 0.5, 0, "0.5", "1 number");
  refused(WORD_RESOLUTION, NULL, 1, 0, 0, "0", "1 to 2 whole numbers from 1 to 16384");
  refused(WORD_RESOLUTION, NULL, 2, 5, 16385, "16385", "16384");
  refused(WORD_RESOLUTION, NULL, 1, 1.5, 0, "1.5", "whole");
  refused(WORD_RESOLUTION, NULL, 3, 1, 1, "3 numbers", "1 to 2");
  refused(WORD_RESOLUTION, "box", 1, 1, 0, "box", "1 to 2");
  refused(WORD_SAMPLES, NULL, 1, 4097, 0, "4097", "from 1 to 4096");
  refused(WORD_SAMPLES, NULL, 0, 0, 0, "0 numbers", "1 whole number");
  refused(WORD_SAMPLES, NULL, 1, NAN, 0, "nan", "from 1");
  refused(WORD_TOLERANCE, NULL, 1, 0.5, 0, "0.5", "from 0 to below 0.5");
  refused(WORD_TOLERANCE, NULL, 1, -1, 0, "-1", "0.5");
  refused(WORD_FILTER, "sinc", 0, 0, 0, "sinc", "box triangle gaussian");
  refused(WORD_FILTER, "bo", 0, 0, 0, "bo", "box triangle gaussian");
  refused(WORD_FILTER, "box triangle", 0, 0, 0, "box triangle", "gaussian");
  refused(WORD_FILTER, "", 0, 0, 0, "", "box triangle gaussian");
  refused(WORD_FILTER, NULL, 1, 1, 0, "", "box triangle gaussian");
  refused(WORD_FILTER, "box", 1, 0, 0, "0", "above 0, at most 16");
  refused(WORD_FILTER, "box", 1, 17, 0, "17", "16");
  refused(WORD_BIAS, NULL, 1, -0.1, 0, "-0.1", "at least 0");
  refused(WORD_BIAS, NULL, 1, INFINITY, 0, "inf", "at least 0");
  refused(WORD_BLUR, NULL, 1, 1.5, 0, "1.5", "from 0 to 1");
  refused(WORD_BOUNDS, NULL, 3, 1, 1, "3 numbers", "6 numbers");
  refused(WORD_BOUNDS, NULL, 6, INFINITY, 1, "inf", "1e+150");
  refused(WORD_SAVE_FILE, NULL, 1, 1, 0, "save_file", "name of a file");
  refused(WORD_LOAD_FILE, "", 0, 0, 0, "load_file", "name of a file");
  refused(WORD_LOAD_FILE, "map.exr", 1, 0, 0, "load_file", "name of a file");
  refused(WORD_CACHE, NULL, 1, 0, 0, "0", "above 0");
  refused(WORD_COUNT, NULL, 1, 1, 0, "11", "parameter");
}

static void sentence_fits_or_is_left_out(void **state) {
  (void)state;
  double bad = 0;
  char small[8] = "1234567";
  assert_int_equal(settings_set(&set, WORD_SAMPLES, NULL, &bad, 1, small, 4), DSM_INVALID);
  assert_true(strlen(small) == 3 && small[4] == '5');
  assert_int_equal(settings_set(&set, WORD_SAMPLES, NULL, &bad, 1, NULL, 0), DSM_INVALID);
  assert_int_equal(settings_set(&set, WORD_SAMPLES, NULL, NULL, 1, NULL, 0), DSM_INVALID);
}

static void without_settings(void **state) {
  (void)state;
  double one = 1;
  char sentence[60] = "as it was";
  assert_int_equal(settings_set(NULL, WORD_SAMPLES, NULL, &one, 1, sentence, 0), DSM_INVALID);
  assert_string_equal(sentence, "as it was");
  assert_int_equal(settings_set(NULL, WORD_SAMPLES, NULL, &one, 1, sentence, sizeof sentence), DSM_INVALID);
  assert_string_equal(sentence, "There is no parameter number 2.");
  assert_null(settings_text(NULL, WORD_SAVE_FILE));
  assert_null(settings_text(&set, WORD_SAMPLES));
  settings_destroy(NULL);
}

/* With `accuracy`, numbers that the scene gives are bounds; those that it leaves open are wide ones. */
static void accuracy_opens_what_the_scene_leaves_open(void **state) {
  (void)state;
  for (int given = 0; given < 8; ++given) {
    settings_defaults(&set);
    if (given & 1) assert_int_equal(give(WORD_ACCURACY, NULL, 1, 0.02, 0), DSM_OK);
    if (given & 2) assert_int_equal(give(WORD_RESOLUTION, NULL, 1, 300, 0), DSM_OK);
    if (given & 4) assert_int_equal(give(WORD_SAMPLES, NULL, 1, 5, 0), DSM_OK);
    settings_complete(&set);
    assert_int_equal(set.resolution[0], given & 2 ? 300 : given & 1 ? 8192 : 512);
    assert_int_equal(set.samples, given & 4 ? 5 : given & 1 ? 1024 : 16);
  }
}

/* The row of a word of shadow_map. */
static uint32_t row_of(const char *name) {
  const dsm_block *block = &settings_blocks[BLOCK_SHADOW_MAP];
  for (uint32_t i = 0; i < block->parameter_count; ++i)
    if (strcmp(block->parameters[i].name, name) == 0) return i;
  fail_msg("no word %s", name);
  return 0;
}

static dsm_result give_map(dsm_settings *s, const char *name, const char *choice, uint32_t count, double a, double b) {
  double numbers[6] = {a, b, 0, -1, -2, -3};
  return settings_set(s, row_of(name), choice, numbers, count, why, sizeof why);
}

static void words_of_shadow_map(void **state) {
  (void)state;
  const dsm_block *block = &settings_blocks[BLOCK_SHADOW_MAP];
  assert_string_equal(settings_blocks[BLOCK_DEEP_SHADOW].name, "deep_shadow");
  assert_string_equal(block->name, "shadow_map");
  dsm_settings *s = settings_create(BLOCK_SHADOW_MAP);
  assert_non_null(s);
  assert_null(settings_create(BLOCK_COUNT));
  /* what the table says of the defaults is so */
  assert_true(s->resolution[0] == 1024 && s->samples == 16 && s->min_samples == 3 && s->size_factor == 3 && s->min_size == 2);
  assert_true(s->depth_bias[0] == SETTING_AUTOMATIC && s->depth_bias[1] == SETTING_AUTOMATIC && s->pattern == PATTERN_JITTERED);
  assert_true(s->filter == FILTER_BOX && s->filter_width == 1 && s->blur == 0 && !s->jittered && s->cache == 1024);
  const char *names[] = {"resolution", "samples", "min_samples", "size_factor", "min_size"};
  const double numbers[] = {1024, 16, 3, 3, 2};
  for (int i = 0; i < 5; ++i) assert_true(strtod(block->parameters[row_of(names[i])].default_text, NULL) == numbers[i]);
  /* each word sets its own */
  assert_int_equal(give_map(s, "resolution", NULL, 2, 300, 200), DSM_OK);
  assert_int_equal(give_map(s, "samples", NULL, 1, 400, 0), DSM_OK);
  assert_int_equal(give_map(s, "min_samples", NULL, 1, 2, 0), DSM_OK);
  assert_int_equal(give_map(s, "size_factor", NULL, 1, 0.5, 0), DSM_OK);
  assert_int_equal(give_map(s, "min_size", NULL, 1, 0, 0), DSM_OK);
  assert_int_equal(give_map(s, "bias", NULL, 2, 0.3, 0.4), DSM_OK);
  assert_true(s->depth_bias[0] == 0.3 && s->depth_bias[1] == 0.4);
  assert_int_equal(give_map(s, "bias", NULL, 1, 0.25, 9), DSM_OK);
  assert_true(s->depth_bias[0] == 0.25 && s->depth_bias[1] == 0.25);
  assert_int_equal(give_map(s, "depth_samples", "jittered", 0, 0, 0), DSM_OK);
  assert_int_equal(give_map(s, "pattern", "inside", 0, 0, 0), DSM_OK);
  assert_int_equal(give_map(s, "bounds", NULL, 6, 1, 2), DSM_OK);
  assert_int_equal(give_map(s, "cache", NULL, 1, 3, 0), DSM_OK);
  assert_int_equal(give_map(s, "save_file", "map.exr", 0, 0, 0), DSM_OK);
  assert_true(s->resolution[0] == 300 && s->resolution[1] == 200 && s->samples == 400 && s->min_samples == 2);
  assert_true(s->size_factor == 0.5 && s->min_size == 0 && s->jittered && s->pattern == PATTERN_INSIDE && s->cache == 3 && s->bounded);
  assert_string_equal(settings_text(s, row_of("save_file")), "map.exr");
  assert_null(settings_text(s, row_of("load_file")));
  assert_null(settings_text(s, block->parameter_count));
  /* and refuses what it cannot be */
  assert_int_equal(give_map(s, "pattern", "outside", 0, 0, 0), DSM_INVALID);
  assert_non_null(strstr(why, "jittered uniform gaussian inside."));
  assert_int_equal(give_map(s, "pattern", "uniform", 1, 2, 0), DSM_INVALID);
  assert_int_equal(give_map(s, "bias", NULL, 2, 0.3, -0.1), DSM_INVALID);
  assert_int_equal(give_map(s, "bias", NULL, 3, 0.3, 0.1), DSM_INVALID);
  assert_int_equal(give_map(s, "min_samples", NULL, 1, 0, 0), DSM_INVALID);
  assert_int_equal(settings_set(s, block->parameter_count, NULL, NULL, 0, why, sizeof why), DSM_INVALID);
  settings_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(defaults_are_those_of_the_table),
    cmocka_unit_test(good_values_are_taken),
    cmocka_unit_test(texts),
    cmocka_unit_test(bad_values_are_refused),
    cmocka_unit_test(sentence_fits_or_is_left_out),
    cmocka_unit_test(without_settings),
    cmocka_unit_test(accuracy_opens_what_the_scene_leaves_open),
    cmocka_unit_test(words_of_shadow_map),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
