/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/tile.h"

#include <stdlib.h>
#include <string.h>

/* marked as used for good: nobody writes to them */
const tile tile_lit = {.size = sizeof(tile), .kind = TILE_LIT, .used = 1};
const tile tile_failed = {.size = sizeof(tile), .kind = TILE_FAILED, .used = 1};

enum { BITS = TILE_PIXELS / 8 };

static uint64_t records_of(const tile_plan *plan, int place)
{
  return plan->count[place] * (plan->coloured[place] ? 2ull : 1ull);
}

static void set_bits(tile *t, size_t offset, const unsigned char *flags)
{
  for (int i = 0; i < TILE_PIXELS; i++)
    if (flags[i])
      ((unsigned char *)t)[offset + i / 8] |= (unsigned char)(1 << i % 8);
}

/* The narrow table has 16 bits for the records in front of eight pixels, and a byte for those of one. */
static int is_wide(const tile_plan *plan)
{
  uint64_t first = 0;
  for (int i = 0; i < TILE_PIXELS; i++) {
    uint64_t records = records_of(plan, i);
    if ((i % 8 == 0 && first > UINT16_MAX) || records > UINT8_MAX)
      return 1;
    first += records;
  }
  return 0;
}

/* Wide tables and bitmaps are there only where they are needed. */
static uint8_t layout_of(const tile_plan *plan)
{
  uint8_t layout = is_wide(plan) ? TILE_WIDE : 0;
  for (int i = 0; i < TILE_PIXELS; i++) {
    if (plan->coloured[i])
      layout |= TILE_COLOURED;
    if (plan->marked[i])
      layout |= TILE_MARKED;
    if (plan->need[i])
      layout |= TILE_REFINED;
  }
  return layout;
}

static void fill_table(tile *t, const tile_plan *plan)
{
  uint32_t *wide = (uint32_t *)(void *)(t + 1), first = 0;
  uint16_t *starts = (uint16_t *)(void *)(t + 1);
  unsigned char *counts = (unsigned char *)(starts + TILE_PIXELS / 8);
  for (int i = 0; i < TILE_PIXELS; i++) {
    uint32_t records = (uint32_t)records_of(plan, i);
    if (t->layout & TILE_WIDE)
      wide[i] = first;
    else {
      if (i % 8 == 0)
        starts[i / 8] = (uint16_t)first;
      counts[i] = (unsigned char)records;
    }
    first += records;
  }
  if (t->layout & TILE_WIDE)
    wide[TILE_PIXELS] = first;
}

static size_t bytes_of_table(uint8_t layout)
{
  return layout & TILE_WIDE ? (TILE_PIXELS + 1) * sizeof(uint32_t) : TILE_PIXELS / 8 * sizeof(uint16_t) + TILE_PIXELS;
}

static size_t bytes_before_records(uint8_t layout)
{
  return sizeof(tile) + bytes_of_table(layout) + (layout & TILE_COLOURED ? BITS : 0) + (layout & TILE_MARKED ? BITS : 0);
}

static uint64_t bytes_as(const tile_plan *plan, uint8_t layout, uint32_t record_bits, uint32_t padding)
{
  uint64_t records = 0;
  for (int i = 0; i < TILE_PIXELS; i++)
    records += records_of(plan, i);
  return bytes_before_records(layout) + (record_bits * records + 7) / 8 + padding + (layout & TILE_REFINED ? TILE_PIXELS : 0);
}

uint64_t tile_bytes(const tile_plan *plan, uint32_t record_bits, uint32_t padding)
{
  return bytes_as(plan, layout_of(plan), record_bits, padding);
}

tile *tile_create_empty(const tile_plan *plan, uint32_t record_bits, uint32_t padding)
{
  uint8_t layout = layout_of(plan);
  size_t data = bytes_before_records(layout);
  uint64_t size = bytes_as(plan, layout, record_bits, padding);
  tile *t = size <= UINT32_MAX ? calloc(1, size) : NULL;
  if (!t)
    return NULL;
  t->codes.records = (uint16_t)data;
  t->size = (uint32_t)size;
  t->kind = TILE_STORED;
  t->layout = layout;
  if (layout & TILE_MARKED)
    set_bits(t, data - BITS, plan->marked);
  if (layout & TILE_COLOURED)
    set_bits(t, data - (layout & TILE_MARKED ? 2 : 1) * BITS, plan->coloured);
  if (layout & TILE_REFINED)
    memcpy((char *)t + size - TILE_PIXELS, plan->need, TILE_PIXELS);
  fill_table(t, plan);
  return t;
}

void tile_destroy(const tile *t)
{
  if (t && t->kind == TILE_STORED)
    free((void *)(size_t)t);
}
