/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/tile.h"

#include <stdlib.h>
#include <string.h>

/* marked as used for good: nobody writes to them */
const tile tile_lit = {.size = sizeof(tile), .kind = TILE_LIT, .used = 1};
const tile tile_failed = {.size = sizeof(tile), .kind = TILE_FAILED, .used = 1};

enum { BITS = TILE_PIXELS / 8 };

static uint64_t words_of(const tile_plan *plan, int place)
{
  uint64_t n = plan->count[place];
  return n + (n * (plan->coloured[place] ? 3 : 1) + 1) / 2;
}

static void set_bits(tile *t, size_t offset, const unsigned char *flags)
{
  for (int i = 0; i < TILE_PIXELS; i++)
    if (flags[i])
      ((unsigned char *)t)[offset + i / 8] |= (unsigned char)(1 << i % 8);
}

/* Wide tables and bitmaps are there only where they are needed. */
static uint8_t layout_of(const tile_plan *plan, uint64_t words)
{
  uint8_t layout = words > UINT16_MAX ? TILE_WIDE : 0;
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

tile *tile_create(const tile_plan *plan)
{
  uint64_t words = 0;
  for (int i = 0; i < TILE_PIXELS; i++)
    words += words_of(plan, i);
  uint8_t layout = layout_of(plan, words);
  size_t table = layout & TILE_WIDE ? (TILE_PIXELS + 1) * sizeof(uint32_t) : (TILE_PIXELS + 2) * sizeof(uint16_t);
  size_t data = sizeof(tile) + table + (layout & TILE_COLOURED ? BITS : 0) + (layout & TILE_MARKED ? BITS : 0);
  uint64_t size = data + 4 * words + (layout & TILE_REFINED ? TILE_PIXELS : 0);
  tile *t = size <= UINT32_MAX ? calloc(1, size) : NULL;
  if (!t)
    return NULL;
  t->size = (uint32_t)size;
  t->words = (uint16_t)data;
  t->kind = TILE_STORED;
  t->layout = layout;
  if (layout & TILE_MARKED)
    set_bits(t, data - BITS, plan->marked);
  if (layout & TILE_COLOURED)
    set_bits(t, data - (layout & TILE_MARKED ? 2 : 1) * BITS, plan->coloured);
  if (layout & TILE_REFINED)
    memcpy((char *)t + size - TILE_PIXELS, plan->need, TILE_PIXELS);
  uint32_t first = 0;
  for (int i = 0; i <= TILE_PIXELS; i++) {
    void *begins = t + 1;
    if (layout & TILE_WIDE)
      ((uint32_t *)begins)[i] = first;
    else
      ((uint16_t *)begins)[i] = (uint16_t)first;
    if (i < TILE_PIXELS)
      first += (uint32_t)words_of(plan, i);
  }
  return t;
}

void tile_destroy(const tile *t)
{
  if (t && t->kind == TILE_STORED)
    free((void *)(size_t)t);
}
