/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "core/settings.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const dsm_parameter settings_table[WORD_COUNT] = {
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

/* Widths in map pixels where a scene names a filter without one: a box tiles the map, the others overlap by
 * half, as RenderMan's 2 x 2 default. */
static const double default_width[] = { [FILTER_BOX] = 1, [FILTER_TRIANGLE] = 2, [FILTER_GAUSSIAN] = 2 };

void settings_defaults(dsm_settings *settings)
{
  *settings = (dsm_settings){ .resolution = {512, 0}, .samples = 16, .tolerance = SETTING_AUTOMATIC,
    .filter = FILTER_BOX, .filter_width = default_width[FILTER_BOX], .bias = SETTING_AUTOMATIC,
    .cache = 1024 };
}

dsm_settings *settings_create(void)
{
  dsm_settings *settings = malloc(sizeof *settings);
  if (settings)
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

static char **text_of(dsm_settings *settings, uint32_t parameter)
{
  return parameter == WORD_SAVE_FILE ? &settings->save_file
       : parameter == WORD_LOAD_FILE ? &settings->load_file : NULL;
}

const char *settings_text(const dsm_settings *settings, uint32_t parameter)
{
  char **text = settings ? text_of((dsm_settings *)(size_t)settings, parameter) : NULL;
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
  if (n > 0)
    s->used += (uint64_t)n;
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
    if (n == length && n > 0 && memcmp(choices, word, n) == 0)
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
    say(why, "'%s' was given %u numbers; ", row->name, (unsigned)count);
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

dsm_result settings_set(dsm_settings *settings, uint32_t parameter, const char *choice, const double *numbers,
                        uint32_t count, char *text, uint64_t text_size)
{
  sentence why = {text, text_size, 0};
  if (text && text_size)
    text[0] = '\0';
  if (!settings || parameter >= WORD_COUNT) {
    say(&why, "There is no parameter number %u.", (unsigned)parameter);
    return DSM_INVALID;
  }
  int chosen = 0;
  dsm_result result = check(&settings_table[parameter], choice, numbers, count, &chosen, &why);
  if (result != DSM_OK)
    return result;
  switch (parameter) {
    case WORD_RESOLUTION:
      settings->resolution[0] = (uint32_t)numbers[0];
      settings->resolution[1] = count > 1 ? (uint32_t)numbers[1] : 0;
      break;
    case WORD_SAMPLES:
      settings->samples = (uint32_t)numbers[0];
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
    case WORD_SAVE_FILE:
    case WORD_LOAD_FILE:
      return set_text(text_of(settings, parameter), choice, &why);
  }
  return DSM_OK;
}
