/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/stored_tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "map/check_tile.h"
#include "map/depth_tile.h"
#include "map/tile_words.h"

const tile_record record_of_lit = {0, -1, 0};

uint64_t checksum_add(uint64_t sum, const void *bytes, size_t size)
{
  const unsigned char *b = bytes;
  while (size) {
    uint64_t word = 0;
    size_t n = size < sizeof word ? size : sizeof word;
    memcpy(&word, b, n);
    sum = (sum ^ word ^ (uint64_t)n << 59) * 0x9E3779B97F4A7C15u;   /* an odd multiplier: no two words give one sum */
    sum ^= sum >> 32;
    b += n;
    size -= n;
  }
  return sum;
}

/* How many there are; 0 if they are not where this kind of map has them. */
static size_t words_of(const deep_tile *deep, stored_kind kind)
{
  for (uint32_t i = 1; i < TILE_PIXELS; i++)
    if (deep->count[i] != (kind == STORED_DEPTHS))
      return 0;
  return kind == STORED_DEPTHS ? (deep->count[0] == 1) * TILE_PIXELS : deep->count[0];
}

static uint32_t checksum_of(const tile_record *record, const uint32_t *words, size_t count, uint64_t number)
{
  uint64_t sum = checksum_add(0, &number, sizeof number);
  sum = checksum_add(sum, record, offsetof(tile_record, checksum));
  sum = checksum_add(sum, words, count * sizeof *words);
  sum = checksum_add(sum, &number, sizeof number);   /* mixes in the top bit of what came last */
  return (uint32_t)(sum ^ sum >> 32);
}

tile_record tile_record_of(const tile *t, const deep_tile *deep, uint64_t number)
{
  tile_record record = {t->near_depth, t->tolerance, 0};
  record.checksum = checksum_of(&record, deep->words, words_of(deep, tile_has_depths(t) ? STORED_DEPTHS : STORED_GREY), number);
  return record;
}

static dsm_result make_room(deep_tile *deep, size_t words)
{
  if (deep->room >= words)
    return DSM_OK;
  free(deep->words);
  deep->words = malloc(words * sizeof *deep->words);
  deep->room = deep->words ? words : 0;
  return deep->words ? DSM_OK : DSM_NO_MEMORY;
}

static dsm_result store_depths(const tile *t, deep_tile *deep)
{
  if (make_room(deep, TILE_PIXELS) != DSM_OK)
    return DSM_NO_MEMORY;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    float depth = t->kind == TILE_STORED ? depths_of(t)->depth[i] : INFINITY;
    deep->count[i] = 1;
    memcpy(&deep->words[i], &depth, sizeof depth);
  }
  return DSM_OK;
}

dsm_result store_tile(const tile *t, stored_kind kind, deep_tile *deep)
{
  if (kind == STORED_DEPTHS)
    return store_depths(t, deep);
  memset(deep->count, 0, sizeof deep->count);
  if (t->kind != TILE_STORED)
    return DSM_OK;
  if (!tile_is_sound(t) || (t->layout & TILE_COLOURED && kind != STORED_COLOURED))
    return DSM_INVALID;
  size_t words = tile_words_count(t);
  if (words > UINT32_MAX)
    return DSM_INVALID;
  if (make_room(deep, words) != DSM_OK)
    return DSM_NO_MEMORY;
  deep->count[0] = (uint32_t)words;
  tile_to_words(t, deep->words);
  return DSM_OK;
}

/* Depths are not below 0, and one is 0: that of the near depth. */
static dsm_result restore_depths(const uint32_t *words, double near_depth, const tile **out)
{
  float depth[TILE_PIXELS], least = INFINITY;
  memcpy(depth, words, sizeof depth);
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    least = fminf(least, depth[i]);
    if (!(depth[i] >= 0))
      return DSM_REFUSED;
  }
  return least == 0 ? depth_tile_unpack(near_depth, depth, out) : DSM_REFUSED;
}

dsm_result restore_tile(const deep_tile *deep, stored_kind kind, const tile_record *record, uint64_t number, const tile **out)
{
  size_t words = words_of(deep, kind);
  *out = NULL;
  if (words == 0 || checksum_of(record, deep->words, words, number) != record->checksum)
    return DSM_REFUSED;
  if (kind == STORED_DEPTHS)
    return restore_depths(deep->words, record->near_depth, out);
  dsm_result result = tile_from_words(deep->words, words, record->near_depth, record->tolerance, out);
  if (result == DSM_OK && (*out)->layout & TILE_COLOURED && kind != STORED_COLOURED) {
    tile_destroy(*out);
    *out = NULL;
    result = DSM_REFUSED;
  }
  return result;
}
