/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/tile_cache.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 64 };                                        /* bytes of a cache line, which threads should not share */
enum { FIRST_ROOM = 2 * LINE / (int)sizeof(tile_slot) };   /* more than most look-ups need */

dsm_result tile_cache_create(tile_cache *cache, uint64_t count, uint64_t budget)
{
  memset(cache, 0, sizeof *cache);
  cache->count = count;
  cache->budget = budget;
  cache->slots = calloc(count + 1, sizeof *cache->slots);   /* all bits zero is NULL on every POSIX system */
  cache->made = calloc(count / 8 + 1, 1);
  if (cache->slots && cache->made)
    return DSM_OK;
  tile_cache_destroy(cache);
  return DSM_NO_MEMORY;
}

void tile_cache_destroy(tile_cache *cache)
{
  assert(!cache->holders);
  if (cache->slots)
    for (uint64_t i = 0; i < cache->count; i++)
      tile_destroy(atomic_load_explicit(&cache->slots[i], memory_order_relaxed));
  free((void *)cache->slots);
  free(cache->made);
  spool_destroy(cache->spool);
}

dsm_result tile_holder_make_room(tile_holder *holder)
{
  if (holder->held < holder->room)
    return DSM_OK;
  if (holder->room > UINT32_MAX / 2)
    return DSM_NO_MEMORY;
  uint32_t room = holder->room ? 2 * holder->room : FIRST_ROOM;
  tile_slot *places = aligned_alloc(LINE, room * sizeof *places);
  if (!places)
    return DSM_NO_MEMORY;
  for (uint32_t i = 0; i < room; i++)
    atomic_init(&places[i], i < holder->room ? atomic_load_explicit(&holder->places[i], memory_order_relaxed) : NULL);
  free((void *)holder->places);
  holder->places = places;
  holder->room = room;
  return DSM_OK;
}

dsm_result tile_cache_join(tile_cache *cache, tile_holder *holder)
{
  memset(holder, 0, sizeof *holder);
  dsm_result result = tile_holder_make_room(holder);
  if (result != DSM_OK)
    return result;
  holder->next = cache->holders;
  cache->holders = holder;
  return DSM_OK;
}

void tile_cache_leave(tile_cache *cache, tile_holder *holder)
{
  tile_holder **link = &cache->holders;
  while (*link && *link != holder)
    link = &(*link)->next;
  assert(*link == holder);
  *link = holder->next;
  free((void *)holder->places);
}

void tile_holder_release(tile_holder *holder, uint32_t held)
{
  for (uint32_t i = held; i < holder->room; i++)
    atomic_store_explicit(&holder->places[i], NULL, memory_order_release);
  holder->held = held;
}

static int is_held(const tile_cache *cache, const tile *t)
{
  for (const tile_holder *h = cache->holders; h; h = h->next)
    for (uint32_t i = 0; i < h->room; i++)
      if (atomic_load(&h->places[i]) == t)
        return 1;
  return 0;
}

static void evict(tile_cache *cache, uint64_t number, const tile *t)
{
  if (is_held(cache, t))
    return;   /* mostly known beforehand, and then no reader has to find its tile gone for a moment */
  atomic_store(&cache->slots[number], NULL);
  if (is_held(cache, t)) {
    atomic_store(&cache->slots[number], t);
    return;
  }
  if (cache->spool)
    spool_write(cache->spool, number, t);   /* or the tile is made again */
  cache->bytes -= t->size;
  cache->evicted++;
  tile_destroy(t);
}

/* Two turns of the hand at most: the first may find each tile used, the second only what is held. */
static void keep_within_budget(tile_cache *cache)
{
  for (uint64_t steps = 2 * cache->count; cache->bytes > cache->budget && steps > 0; steps--) {
    uint64_t number = cache->hand;
    cache->hand = number + 1 < cache->count ? number + 1 : 0;
    const tile *t = atomic_load_explicit(&cache->slots[number], memory_order_relaxed);
    if (!t || t->kind != TILE_STORED)
      continue;
    if (!atomic_exchange_explicit((atomic_uchar *)(size_t)&t->used, 0, memory_order_relaxed))
      evict(cache, number, t);
  }
}

void tile_cache_put(tile_cache *cache, uint64_t number, const tile *t, tile_holder *holder)
{
  assert(t && number < cache->count && holder->held < holder->room);
  assert(!atomic_load_explicit(&cache->slots[number], memory_order_relaxed));
  if (t->kind == TILE_STORED)
    ((tile *)(size_t)t)->serial = cache->serial += cache->serial == UINT32_MAX ? 2 : 1;   /* nobody else sees it yet */
  tile_touch(t);
  atomic_store(&holder->places[holder->held++], t);
  atomic_store(&cache->slots[number], t);
  cache->made[number / 8] |= (unsigned char)(1 << number % 8);
  if (t->kind != TILE_STORED)
    return;
  cache->bytes += t->size;
  keep_within_budget(cache);
  if (cache->bytes > cache->bytes_most)
    cache->bytes_most = cache->bytes;
}
