/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/stored_tile.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "map/compact_tile.h"
#include "map/depth_tile.h"

const tile_record record_of_lit = {0, -1, 0};

const char *const grey_channels[GREY_CHANNELS] = {"Z", "V"};
const char *const coloured_channels[COLOURED_CHANNELS] = {"Z", "VR", "VG", "VB"};

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

/* Of depths as floats, two in a word, then of values, four in a word: whatever codes the tile has for them. */
static uint64_t add_pixel(uint64_t sum, const visibility *v)
{
  float depths[2];
  uint16_t values[4];
  uint32_t numbers = v->count * v->channels;
  for (uint32_t i = 0; i < v->count; i += 2) {
    uint32_t n = v->count - i < 2 ? v->count - i : 2;
    for (uint32_t k = 0; k < n; k++)
      depths[k] = (float)visibility_depth(v, i + k);
    sum = checksum_add(sum, depths, n * sizeof *depths);
  }
  for (uint32_t i = 0; i < numbers; i += 4) {
    uint32_t n = numbers - i < 4 ? numbers - i : 4;
    for (uint32_t k = 0; k < n; k++)
      values[k] = (uint16_t)visibility_stored(v, (i + k) / v->channels, (i + k) % v->channels);
    sum = checksum_add(sum, values, n * sizeof *values);
  }
  return sum;
}

tile_record tile_record_of(const tile *t, uint64_t number)
{
  tile_record record = {t->near_depth, t->tolerance, 0};
  uint64_t sum = checksum_add(0, &number, sizeof number);
  sum = checksum_add(sum, &record, offsetof(tile_record, checksum));
  for (uint32_t i = 0; i < TILE_PIXELS && !tile_has_depths(t); i++) {
    visibility v = tile_visibility(t, i);
    uint32_t shape[3] = {v.count, v.channels, (uint32_t)tile_is_marked(t, i)};
    sum = checksum_add(sum, shape, sizeof shape);
    sum = add_pixel(sum, &v);
  }
  if (tile_has_depths(t))
    sum = checksum_add(sum, depths_of(t)->depth, sizeof depths_of(t)->depth);
  sum = checksum_add(sum, &number, sizeof number);   /* mixes in the top bit of what came last */
  record.checksum = (uint32_t)(sum ^ sum >> 32);
  return record;
}

/* The nearest 65536th, within 2^-17: its float ends in zeros, which pack well. The 65535ths of the upper half are moved up by
 * one, so that none is lost and only 1/2 is left out. */
static float value_to_float(uint16_t k)
{
  return (float)(k + (k >> 15)) / 65536;
}

/* A grey pixel has one value for all channels. */
static float stored_value(const visibility *v, uint32_t vertex, uint32_t channel)
{
  return value_to_float((uint16_t)visibility_stored(v, vertex, v->channels == 3 ? channel : 0));
}

/* Of what value_to_float gives. */
static uint16_t value_of_float(float v)
{
  uint32_t n = (uint32_t)(v * 65536);
  return (uint16_t)(n - (n > 32768));
}

/* NaN is none. */
static int is_value(float v)
{
  return v >= 0 && v <= 1 && value_to_float(value_of_float(v)) == v;
}

static void put_float(uint32_t **word, float x)
{
  memcpy((*word)++, &x, sizeof x);
}

static float get_float(const uint32_t *word)
{
  float x;
  memcpy(&x, word, sizeof x);
  return x;
}

/* Reading takes a pixel for coloured if its channels differ anywhere. */
static int reads_as_packed(const visibility *v, uint32_t channels)
{
  if (v->channels == 1)
    return 1;
  for (uint32_t k = 0; k < v->count; k++)
    if (visibility_stored(v, k, 0) != visibility_stored(v, k, 1) || visibility_stored(v, k, 1) != visibility_stored(v, k, 2))
      return channels == 4;
  return v->count == 0;
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

static dsm_result depths_to_flat(const tile *t, deep_tile *deep)
{
  if (make_room(deep, TILE_PIXELS) != DSM_OK)
    return DSM_NO_MEMORY;
  uint32_t *word = deep->words;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    deep->count[i] = 1;
    put_float(&word, t->kind == TILE_STORED ? depths_of(t)->depth[i] : INFINITY);
  }
  return DSM_OK;
}

/* Depths are not below 0, and one is 0: that of the near depth. */
static dsm_result depths_from_flat(const deep_tile *deep, const tile_record *record, uint64_t number, const tile **out)
{
  float depth[TILE_PIXELS], least = INFINITY;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    if (deep->count[i] != 1)
      return DSM_REFUSED;
    depth[i] = get_float(&deep->words[i]);
    least = fminf(least, depth[i]);
    if (!(depth[i] >= 0))
      return DSM_REFUSED;
  }
  dsm_result result = least == 0 ? depth_tile_unpack(record->near_depth, depth, out) : DSM_REFUSED;
  if (result == DSM_OK && tile_record_of(*out, number).checksum != record->checksum) {
    tile_destroy(*out);
    *out = NULL;
    result = DSM_REFUSED;
  }
  return result;
}

dsm_result tile_to_deep(const tile *t, uint32_t channels, deep_tile *deep)
{
  if (channels == DEPTH_CHANNELS)
    return depths_to_flat(t, deep);
  size_t samples = 0;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    visibility v = tile_visibility(t, i);
    if (!reads_as_packed(&v, channels))
      return DSM_INVALID;
    deep->count[i] = tile_is_marked(t, i) ? 1 : v.count;
    samples += deep->count[i];
  }
  if (make_room(deep, samples * channels) != DSM_OK)
    return DSM_NO_MEMORY;
  uint32_t *word = deep->words;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    int marked = tile_is_marked(t, i);
    visibility v = tile_visibility(t, i);
    for (uint32_t k = 0; k < deep->count[i]; k++) {
      put_float(&word, marked ? 0 : (float)visibility_depth(&v, k));
      for (uint32_t c = 0; c + 1 < channels; c++)
        put_float(&word, marked ? MARKED_VALUE : stored_value(&v, k, c));
    }
  }
  return DSM_OK;
}

/* Whether a sample can follow another one, or be the first: depths never fall, values never grow. */
static int may_follow(const uint32_t *word, const uint32_t *before, uint32_t channels)
{
  float depth = get_float(word);
  if (!(depth >= (before ? get_float(before) : 0) && depth < INFINITY) || signbit(depth))
    return 0;
  for (uint32_t c = 1; c < channels; c++) {
    float value = get_float(word + c);
    if (!is_value(value) || (before && value > get_float(before + c)))
      return 0;
  }
  return 1;
}

static int is_marked(const uint32_t *word, uint32_t count, uint32_t channels)
{
  if (count != 1 || get_float(word) != 0)
    return 0;
  for (uint32_t c = 1; c < channels; c++)
    if (get_float(word + c) != MARKED_VALUE)
      return 0;
  return 1;
}

/* Checks every sample, and finds out what pixels there are. 0: no tile. */
static int plan_tile(const deep_tile *deep, uint32_t channels, tile_plan *plan)
{
  const uint32_t *word = deep->words;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    plan->coloured[i] = 0;
    plan->marked[i] = is_marked(word, deep->count[i], channels) != 0;
    plan->count[i] = plan->marked[i] ? 0 : deep->count[i];
    for (uint32_t k = 0; k < plan->count[i]; k++) {
      const uint32_t *w = word + (size_t)k * channels;
      if (!may_follow(w, k ? w - channels : NULL, channels))
        return 0;
      plan->coloured[i] |= channels == 4 && (w[1] != w[2] || w[2] != w[3]);
    }
    word += (size_t)deep->count[i] * channels;
  }
  return 1;
}

static void fill_tile(tile *t, const deep_tile *deep, uint32_t channels)
{
  const uint32_t *word = deep->words;
  for (uint32_t i = 0; i < TILE_PIXELS; i++) {
    visibility v = tile_visibility(t, i);
    for (uint32_t k = 0; k < v.count; k++) {
      const uint32_t *w = word + (size_t)k * channels;
      for (uint32_t c = 0; c < v.channels; c++)
        tile_put(t, i, k, c, get_float(w), value_of_float(get_float(w + 1 + c)));
    }
    word += (size_t)deep->count[i] * channels;
  }
}

dsm_result tile_from_deep(const deep_tile *deep, uint32_t channels, const tile_record *record, uint64_t number,
                          const tile **out)
{
  tile_plan plan = {.count = {0}};
  *out = NULL;
  if (channels == DEPTH_CHANNELS)
    return depths_from_flat(deep, record, number, out);
  if (!plan_tile(deep, channels, &plan))
    return DSM_REFUSED;
  tile *t = tile_create(&plan);
  if (!t)
    return DSM_NO_MEMORY;
  t->near_depth = record->near_depth;
  t->tolerance = record->tolerance;
  fill_tile(t, deep, channels);
  if (tile_record_of(t, number).checksum != record->checksum) {
    tile_destroy(t);
    return DSM_REFUSED;
  }
  *out = tile_compact(t);
  return DSM_OK;
}
