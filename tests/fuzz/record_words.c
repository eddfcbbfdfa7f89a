/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* record_words MAP.exr >SEED: what the reader is told of a map, as read_words.c wants it (see fuzzed_words.h). Run by run.sh. */
#include <stdio.h>
#include <string.h>

#include "fuzzed_map.h"
#include "fuzzed_words.h"

static const deep_part *all_parts;
static char names[4000];          /* of the attributes that are written, each with a space on either side */
static FILE *tiles;               /* to stand behind the attributes */

static const char *attribute(deep_reader *reader, const char *name) {
  const char *text = deep_exr_table.attribute(reader, name);
  char word[80];
  snprintf(word, sizeof word, " %s ", name);
  if (!text || strstr(names, word)) return text;
  strncat(names, word, sizeof names - strlen(names) - 1);
  printf("%s %s\n", name, text);
  return text;
}

static int has_parts(deep_reader *reader, const deep_part *parts, uint32_t count, deep_error *error) {
  all_parts = parts;
  return deep_exr_table.has_parts(reader, parts, count, error);
}

static void put(uint32_t number, size_t bytes) {
  for (size_t i = 0; i < bytes; ++i) fputc((int)(number >> 8 * i & 255), tiles);
}

static int read_tile(deep_reader *reader, uint32_t part, uint32_t x, uint32_t y, deep_tile *tile, deep_error *error) {
  if (!deep_exr_table.read(reader, part, x, y, tile, error)) return 0;
  size_t samples = 0;
  for (uint32_t i = 0, run; i < DEEP_PIXELS; i += run) {
    for (run = 1; i + run < DEEP_PIXELS && tile->count[i + run] == tile->count[i];) ++run;
    int rest = i + run == DEEP_PIXELS;
    if (!rest && run > 255) run = 255;
    samples += (size_t)run * tile->count[i];
    put(rest ? 0 : run, 1);
    put(tile->count[i], RUN_BYTES - 1);
  }
  for (size_t i = 0; i < samples * all_parts[part].channel_count; ++i) put(tile->words[i], WORD_BYTES);
  return 1;
}

const deep_exr *deep_exr_load(deep_error *error) {
  static deep_exr table;
  (void)error;
  table = deep_exr_table;
  table.attribute = attribute;
  table.has_parts = has_parts;
  table.read = read_tile;
  return &table;
}

int main(int count, char **words) {
  int byte;
  tiles = tmpfile();
  if (count != 2 || !tiles || !read_whole_map(words[1])) return 1;
  putchar(0);
  rewind(tiles);
  while ((byte = fgetc(tiles)) != EOF) putchar(byte);
  fclose(tiles);
  return fflush(stdout) != 0;
}
