/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * The reader of maps without OpenEXR: any attributes and any words where a file's would come, many times faster than read_map.c. Built
 * and run by run.sh. The guard before OpenEXR, which has a target of its own, lets everything pass.
 */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "fuzzed_map.h"
#include "fuzzed_words.h"
#include "store/exr_layout.h"

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size);

struct deep_reader { char unused; };
struct exr_layout { char unused; };

enum { MOST_LINES = 64 };

static struct { const char *name, *text; size_t length; } lines[MOST_LINES];
static size_t line_count;
static char *head;                            /* what the lines point into */
static const unsigned char *bytes_left;
static size_t left;
static const deep_part *all_parts;            /* of the map that is open */

dsm_result exr_layout_open(const char *path, exr_layout **out) {
  static exr_layout none;
  (void)path;
  *out = &none;
  return DSM_OK;
}

void exr_layout_close(exr_layout *layout) { (void)layout; }

int exr_layout_tile(const exr_layout *layout, uint32_t part, uint32_t x, uint32_t y) {
  (void)layout, (void)part, (void)x, (void)y;
  return 1;
}

static deep_reader *open_any(const char *path, deep_error *error) {
  static deep_reader one;
  (void)path, (void)error;
  return &one;
}

static const char *attribute(deep_reader *reader, const char *name) {
  size_t length = strlen(name);
  (void)reader;
  for (size_t i = 0; i < line_count; ++i)
    if (lines[i].length == length && memcmp(lines[i].name, name, length) == 0) return lines[i].text;
  return NULL;
}

static int has_parts(deep_reader *reader, const deep_part *parts, uint32_t count, deep_error *error) {
  (void)reader, (void)count, (void)error;
  all_parts = parts;
  return 1;
}

/* Zeros behind the end. */
static uint32_t take(size_t bytes) {
  uint32_t number = 0;
  for (size_t i = 0; i < bytes && left; ++i, --left) number |= (uint32_t)*bytes_left++ << 8 * i;
  return number;
}

/* No more samples than there are bytes for, as behind the guard of a file's layout. */
static size_t take_counts(deep_tile *tile, const deep_part *part) {
  size_t sum = 0;
  for (uint32_t i = 0; i < DEEP_PIXELS;) {
    uint32_t run = take(1), samples = take(RUN_BYTES - 1);
    if (run == 0 || run > DEEP_PIXELS - i) run = DEEP_PIXELS - i;
    for (; run; --run, ++i) {
      size_t room = left / (WORD_BYTES * part->channel_count);
      tile->count[i] = part->flat ? 1 : sum + samples <= room ? samples : 0;
      sum += tile->count[i];
    }
  }
  return sum;
}

static int read_tile(deep_reader *reader, uint32_t part, uint32_t x, uint32_t y, deep_tile *tile, deep_error *error) {
  (void)reader, (void)x, (void)y, (void)error;
  if (!left) return 0;
  size_t words = take_counts(tile, &all_parts[part]) * all_parts[part].channel_count;
  free(tile->words);   /* of the exact size, so that a word too many is seen */
  tile->words = malloc(words ? words * sizeof *tile->words : 1);
  tile->room = words;
  if (!tile->words) abort();
  for (size_t i = 0; i < words; ++i) tile->words[i] = take(WORD_BYTES);
  return 1;
}

static void close_any(deep_reader *reader) { (void)reader; }

const deep_exr *deep_exr_load(deep_error *error) {
  static const deep_exr table = {.size = sizeof table, .open = open_any, .attribute = attribute, .has_parts = has_parts,
                                 .read = read_tile, .close = close_any};
  (void)error;
  return &table;
}

static char path[64];

static void forget_file(void) { unlink(path); }

/* What the reader looks at before it asks for the table: the first bytes of a file, and its size, which bounds the number of tiles. */
static void make_file(void) {
  static const char first[] = "\x76\x2f\x31\x01\0dsm:";
  if (path[0]) return;
  snprintf(path, sizeof path, "/dev/shm/deep-shadow-words-%ld.exr", (long)getpid());
  FILE *file = fopen(path, "wb");
  if (!file || fwrite(first, sizeof first, 1, file) != 1 || fclose(file) || truncate(path, 4000)) abort();
  atexit(forget_file);
}

static void split_head(const unsigned char *bytes, size_t size) {
  const unsigned char *end = memchr(bytes, 0, size);
  size_t length = end ? (size_t)(end - bytes) : size;
  head = malloc(length + 1);
  if (!head) abort();
  memcpy(head, bytes, length);
  head[length] = 0;
  bytes_left = bytes + length;
  left = size - length;
  take(1);
  line_count = 0;
  for (char *line = head, *after; line_count < MOST_LINES && *line; line = after) {
    size_t size_of_line = strcspn(line, "\n"), size_of_name = strcspn(line, " \n");
    after = line + size_of_line + (line[size_of_line] != 0);
    line[size_of_line] = 0;
    if (size_of_name == size_of_line) continue;
    lines[line_count].name = line;
    lines[line_count].length = size_of_name;
    lines[line_count++].text = line + size_of_name + 1;
  }
}

int LLVMFuzzerTestOneInput(const unsigned char *bytes, size_t size) {
  if (!size) return 0;
  make_file();
  split_head(bytes, size);
  read_whole_map(path);
  free(head);
  return 0;
}
