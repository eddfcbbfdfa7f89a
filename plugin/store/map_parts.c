/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/map_parts.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TABLE_ACROSS = 32, RECORD_WORDS = 4 };

static const char *const depth_channel = "Z", *const words_channel = "words";
static const char *const record_channels[RECORD_WORDS] = {"nearHigh", "nearLow", "tolerance", "checksum"};
enum { TOLERANCE = 2, CHECKSUM = 3 };

static deep_part part_with(const char *const *channels, uint32_t channel_count, uint64_t across, uint64_t up)
{
  deep_part part;
  memset(&part, 0, sizeof part);
  part.across = (uint32_t)across;
  part.up = (uint32_t)up;
  part.channel_count = channel_count;
  for (uint32_t c = 0; c < channel_count; c++)
    part.channels[c] = channels[c];
  return part;
}

static uint32_t tiles_for(uint32_t pixels, uint32_t level)
{
  return (level_pixels(pixels, level) + TILE_SIDE - 1) / TILE_SIDE;
}

void map_parts_lay(map_parts *m, const projection *p, stored_kind kind)
{
  int flat = kind == STORED_DEPTHS;
  memset(m, 0, sizeof *m);
  for (uint32_t level = 0; level < MAX_LEVELS; level++)
    for (uint32_t i = 0; i < p->count; i++) {
      const face *f = &p->faces[i];
      if (level >= projection_levels(p, i))
        continue;
      deep_part *part = &m->parts[m->count];
      *part = part_with(flat ? &depth_channel : &words_channel, 1, tiles_for(f->width, level), tiles_for(f->height, level));
      part->flat = flat;
      part->integers = !flat;
      snprintf(part->name, sizeof part->name, flat ? "f%u" : "f%u.l%u", (unsigned)i, (unsigned)level);
      m->part_of[i][level] = m->count;
      m->first[m->count] = m->tile_count;
      m->keys[m->count] = (tile_key){i, level, 0, 0};
      m->tile_count += (uint64_t)part->across * part->up;
      m->count++;
    }
  uint64_t blocks = (m->tile_count + 1 + DEEP_PIXELS - 1) / DEEP_PIXELS;   /* the seal is one more */
  uint64_t across = blocks < TABLE_ACROSS ? blocks : TABLE_ACROSS;
  deep_part *table = &m->parts[m->count++];
  *table = part_with(record_channels, RECORD_WORDS, across, (blocks + across - 1) / across);
  table->flat = flat;
  table->integers = ((1u << RECORD_WORDS) - 1) & ~(1u << TOLERANCE);
  snprintf(table->name, sizeof table->name, "tiles");
}

uint64_t map_seal(const deep_attribute *attributes, uint32_t attribute_count, const tile_record *records,
                  uint64_t tile_count)
{
  uint64_t sum = checksum_add(0, &tile_count, sizeof tile_count);
  for (uint32_t i = 0; i < attribute_count; i++) {
    sum = checksum_add(sum, attributes[i].name, strlen(attributes[i].name) + 1);
    sum = checksum_add(sum, attributes[i].text, strlen(attributes[i].text) + 1);
  }
  return checksum_add(sum, records, tile_count * sizeof *records);
}

static void put_double(uint32_t *high_low, double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  high_low[0] = (uint32_t)(bits >> 32);
  high_low[1] = (uint32_t)bits;
}

static double get_double(const uint32_t *high_low)
{
  uint64_t bits = (uint64_t)high_low[0] << 32 | high_low[1];
  double x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

static void put_record(const tile_record *r, uint32_t *word)
{
  put_double(word, r->near_depth);
  memcpy(word + TOLERANCE, &r->tolerance, sizeof *word);
  word[CHECKSUM] = r->checksum;
}

/* 0: no record. In a flat table lit tiles have one, too. */
static int get_record(const uint32_t *word, int flat, tile_record *r)
{
  r->near_depth = get_double(word);
  memcpy(&r->tolerance, word + TOLERANCE, sizeof *word);
  r->checksum = word[CHECKSUM];
  if (flat && r->near_depth == 0 && r->tolerance == -1 && r->checksum == 0)
    return 1;
  return r->near_depth >= 0 && r->near_depth < INFINITY && r->tolerance >= 0 && r->tolerance <= 1;
}

/* The seal has the shape of a record: the checksum of all in place of a depth, and the number of tiles. */
static void put_seal(uint64_t tile_count, uint64_t seal, uint32_t *word)
{
  word[0] = (uint32_t)(seal >> 32);
  word[1] = (uint32_t)seal;
  word[TOLERANCE] = 0;
  word[CHECKSUM] = (uint32_t)tile_count;
}

int tile_table_write(const deep_exr *exr, deep_writer *writer, const map_parts *m, const tile_record *records,
                     uint64_t seal, deep_error *error)
{
  uint32_t words[DEEP_PIXELS * RECORD_WORDS];
  const deep_part *table = &m->parts[m->count - 1];
  for (uint64_t block = 0; block < (uint64_t)table->across * table->up; block++) {
    deep_tile deep = {.words = words, .room = DEEP_PIXELS * RECORD_WORDS};
    uint32_t *word = words;
    for (uint32_t i = 0; i < DEEP_PIXELS; i++) {
      uint64_t number = block * DEEP_PIXELS + i;
      int sealed = number == m->tile_count;
      const tile_record *record = number < m->tile_count ? &records[number] : &record_of_lit;
      deep.count[i] = sealed || table->flat || record->tolerance >= 0;
      if (sealed)
        put_seal(m->tile_count, seal, word);
      else if (deep.count[i])
        put_record(record, word);
      word += deep.count[i] * RECORD_WORDS;
    }
    if (!exr->write(writer, m->count - 1, (uint32_t)(block % table->across), (uint32_t)(block / table->across), &deep, error))
      return 0;
  }
  return 1;
}

/* One tile of the table. 0: it makes no sense. */
static int take_block(const deep_tile *deep, uint64_t first, const map_parts *m, tile_record *records, uint64_t *seal)
{
  const uint32_t *word = deep->words;
  for (uint32_t i = 0; i < DEEP_PIXELS; i++) {
    uint64_t number = first + i;
    int flat = m->parts[m->count - 1].flat != 0;
    if (deep->count[i] > (flat || number <= m->tile_count) || (number == m->tile_count && deep->count[i] != 1))
      return 0;
    if (number < m->tile_count) {
      records[number] = record_of_lit;
      if (deep->count[i] && !get_record(word, flat, &records[number]))
        return 0;
    }
    else if (number == m->tile_count) {
      uint32_t expected[RECORD_WORDS];
      *seal = (uint64_t)word[0] << 32 | word[1];
      put_seal(m->tile_count, *seal, expected);
      if (memcmp(word, expected, sizeof expected) != 0)
        return 0;
    }
    word += deep->count[i] * RECORD_WORDS;
  }
  return 1;
}

int tile_table_read(const deep_exr *exr, deep_reader *reader, const map_parts *m, tile_record *records,
                    uint64_t *seal, deep_error *error)
{
  const deep_part *table = &m->parts[m->count - 1];
  deep_tile deep = {.words = NULL};
  int good = 1;
  for (uint64_t block = 0; block < (uint64_t)table->across * table->up && good; block++) {
    good = exr->read(reader, m->count - 1, (uint32_t)(block % table->across), (uint32_t)(block / table->across), &deep, error);
    if (good && !take_block(&deep, block * DEEP_PIXELS, m, records, seal)) {
      snprintf(error->text, sizeof error->text, "its table of tiles makes no sense");
      good = 0;
    }
  }
  free(deep.words);
  return good;
}
