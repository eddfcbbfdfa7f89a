/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/settings.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Widths in map pixels where a scene names a filter without one: a box tiles the map, the others overlap by
 * half, as RenderMan's 2 x 2 default. */
static const double default_width[] = { [FILTER_BOX] = 1, [FILTER_TRIANGLE] = 2, [FILTER_GAUSSIAN] = 2 };

void settings_defaults(dsm_settings *settings)
{
  *settings = (dsm_settings){ .resolution = {512, 0}, .samples = 16, .tolerance = SETTING_AUTOMATIC,
    .filter = FILTER_BOX, .filter_width = default_width[FILTER_BOX], .bias = SETTING_AUTOMATIC,
    .cache = 1024 };
}

void settings_complete(dsm_settings *settings)
{
  if (!(settings->accuracy > 0))
    return;
  if (!settings->chosen_resolution)
    settings->resolution[0] = 8192;
  if (!settings->chosen_samples)
    settings->samples = 1024;
}

/* RSC use 16 samples, a factor of 2 to 4, and at least 2 or 3 samples and 2 pixels along a side (4.2). */
void settings_shadow_map_defaults(dsm_settings *settings)
{
  settings_defaults(settings);
  settings->block = BLOCK_SHADOW_MAP;
  settings->resolution[0] = 1024;
  settings->min_samples = 3;
  settings->size_factor = 3;
  settings->min_size = 2;
  settings->depth_bias[0] = settings->depth_bias[1] = SETTING_AUTOMATIC;
}

dsm_settings *settings_create(uint32_t block)
{
  dsm_settings *settings = block < BLOCK_COUNT ? malloc(sizeof *settings) : NULL;
  if (!settings)
    return NULL;
  if (block == BLOCK_SHADOW_MAP)
    settings_shadow_map_defaults(settings);
  else
    settings_defaults(settings);
  return settings;
}

void settings_destroy(dsm_settings *settings)
{
  if (!settings)
    return;
  free(settings->save_file);
  free(settings->load_file);
  free(settings);
}

static char **text_of(dsm_settings *settings, uint32_t word)
{
  return word == WORD_SAVE_FILE ? &settings->save_file : word == WORD_LOAD_FILE ? &settings->load_file : NULL;
}

const char *settings_text(const dsm_settings *settings, uint32_t parameter)
{
  if (!settings || parameter >= settings_blocks[settings->block].parameter_count)
    return NULL;
  char **text = text_of((dsm_settings *)(size_t)settings, settings_word(settings->block, parameter));
  return text ? *text : NULL;
}

typedef struct { char *text; uint64_t size, used; } sentence;

__attribute__((format(printf, 2, 3)))
static void say(sentence *s, const char *format, ...)
{
  if (!s->text || s->used >= s->size)
    return;
  va_list arguments;
  va_start(arguments, format);
  int n = vsnprintf(s->text + s->used, s->size - s->used, format, arguments);
  va_end(arguments);
  s->used += (uint64_t)n;   /* also of what did not fit; nothing is said after that */
}

/* "1 or 2 whole numbers from 1 to 16384" */
static void say_range(sentence *s, const dsm_parameter *row)
{
  if (row->min_count < row->max_count && row->type == DSM_NUMBERS)
    say(s, "%u to %u ", (unsigned)row->min_count, (unsigned)row->max_count);
  else
    say(s, "%u ", (unsigned)row->max_count);
  say(s, "%s%s ", row->integral ? "whole " : "", row->max_count == 1 ? "number" : "numbers");
  if (row->high == DBL_MAX)
    say(s, row->low_open ? "above %g" : "of at least %g", row->low);
  else if (row->low_open)
    say(s, row->high_open ? "above %g and below %g" : "above %g, at most %g", row->low, row->high);
  else
    say(s, row->high_open ? "from %g to below %g" : "from %g to %g", row->low, row->high);
}

static void say_takes(sentence *s, const dsm_parameter *row)
{
  say(s, "'%s' takes ", row->name);
  if (row->type == DSM_TEXT) {
    say(s, "the name of a file.");
    return;
  }
  if (row->type == DSM_CHOICE) {
    say(s, "one of the words %s", row->choices);
    if (row->max_count == 0) {
      say(s, ".");
      return;
    }
    say(s, row->min_count ? ", then " : ", then at most ");
  }
  say_range(s, row);
  say(s, ".");
}

/* The place of `word` in a list separated by single spaces, or -1. */
static int choice_index(const char *choices, const char *word)
{
  size_t length = strlen(word);
  for (int i = 0; ; i++) {
    const char *end = strchr(choices, ' ');
    size_t n = end ? (size_t)(end - choices) : strlen(choices);
    if (n == length && memcmp(choices, word, n) == 0)
      return i;
    if (!end)
      return -1;
    choices = end + 1;
  }
}

/* Written so that NaN is out of every range. */
static int in_range(const dsm_parameter *row, double x)
{
  return (row->low_open ? x > row->low : x >= row->low) && (row->high_open ? x < row->high : x <= row->high)
      && (!row->integral || x == floor(x));
}

static dsm_result check(const dsm_parameter *row, const char *word, const double *numbers, uint32_t count,
                        int *chosen, sentence *why)
{
  if (row->type == DSM_TEXT) {
    if (word && *word && count == 0)
      return DSM_OK;
    say_takes(why, row);
    return DSM_INVALID;
  }
  if (row->type == DSM_CHOICE) {
    *chosen = word ? choice_index(row->choices, word) : -1;
    if (*chosen < 0) {
      if (word)
        say(why, "'%s \"%s\"' is unknown; ", row->name, word);
      say_takes(why, row);
      return DSM_INVALID;
    }
  }
  else if (word) {
    say(why, "'%s' takes no word, but was given \"%s\"; ", row->name, word);
    say_takes(why, row);
    return DSM_INVALID;
  }
  if (count < row->min_count || count > row->max_count || (count && !numbers)) {
    say(why, "'%s' was given %u number%s; ", row->name, (unsigned)count, count == 1 ? "" : "s");
    say_takes(why, row);
    return DSM_INVALID;
  }
  for (uint32_t i = 0; i < count; i++)
    if (!in_range(row, numbers[i])) {
      say(why, "'%s %.10g' is out of range; ", row->name, numbers[i]);
      say_takes(why, row);
      return DSM_INVALID;
    }
  return DSM_OK;
}

static dsm_result set_text(char **text, const char *word, sentence *why)
{
  char *copy = strdup(word);
  if (!copy) {
    say(why, "There is no memory for the name of a file.");
    return DSM_NO_MEMORY;
  }
  free(*text);
  *text = copy;
  return DSM_OK;
}

static dsm_box box_between(const double corners[6])
{
  dsm_box b;
  for (int i = 0; i < 3; i++) {
    b.low[i] = fmin(corners[i], corners[3 + i]);
    b.high[i] = fmax(corners[i], corners[3 + i]);
  }
  return b;
}

/* What has been checked. */
static void apply(dsm_settings *settings, uint32_t word, int chosen, const double *numbers, uint32_t count)
{
  switch (word) {
    case WORD_ACCURACY:
      settings->accuracy = numbers[0];
      break;
    case WORD_RESOLUTION:
      settings->resolution[0] = (uint32_t)numbers[0];
      settings->resolution[1] = count > 1 ? (uint32_t)numbers[1] : 0;
      settings->chosen_resolution = 1;
      break;
    case WORD_SAMPLES:
      settings->samples = (uint32_t)numbers[0];
      settings->chosen_samples = 1;
      break;
    case WORD_TOLERANCE:
      settings->tolerance = numbers[0];
      break;
    case WORD_FILTER:
      settings->filter = (filter_kind)chosen;
      settings->filter_width = count ? numbers[0] : default_width[chosen];
      break;
    case WORD_BLUR:
      settings->blur = numbers[0];
      break;
    case WORD_BIAS:
      settings->bias = numbers[0];
      break;
    case WORD_BOUNDS:
      settings->bounded = 1;
      settings->bounds = box_between(numbers);
      break;
    case WORD_CACHE:
      settings->cache = numbers[0];
      break;
    case WORD_MIN_SAMPLES:
      settings->min_samples = (uint32_t)numbers[0];
      break;
    case WORD_SIZE_FACTOR:
      settings->size_factor = numbers[0];
      break;
    case WORD_MIN_SIZE:
      settings->min_size = numbers[0];
      break;
    case WORD_DEPTH_BIAS:
      settings->depth_bias[0] = numbers[0];
      settings->depth_bias[1] = numbers[count - 1];
      break;
    case WORD_DEPTH_SAMPLES:
      settings->jittered = chosen;
      break;
    case WORD_PATTERN:
      settings->pattern = (sample_pattern)chosen;
      break;
  }
}

dsm_result settings_set(dsm_settings *settings, uint32_t parameter, const char *choice, const double *numbers,
                        uint32_t count, char *text, uint64_t text_size)
{
  sentence why = {text, text_size, 0};
  if (text && text_size)
    text[0] = '\0';
  if (!settings || parameter >= settings_blocks[settings->block].parameter_count) {
    say(&why, "There is no parameter number %u.", (unsigned)parameter);
    return DSM_INVALID;
  }
  int chosen = 0;
  dsm_result result = check(&settings_blocks[settings->block].parameters[parameter], choice, numbers, count, &chosen, &why);
  if (result != DSM_OK)
    return result;
  uint32_t word = settings_word(settings->block, parameter);
  char **text_place = text_of(settings, word);
  if (text_place)
    return set_text(text_place, choice, &why);
  apply(settings, word, chosen, numbers, count);
  return DSM_OK;
}
