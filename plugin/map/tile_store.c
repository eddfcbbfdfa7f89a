/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/tile_store.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static const long WAIT_NS = 20 * 1000 * 1000;   /* dsm_host.pause is to be asked at least this often */

static uint32_t tiles_for(uint32_t pixels)
{
  return (pixels + TILE_SIDE - 1) / TILE_SIDE;
}

static int create_locks(tile_store *store)
{
  pthread_condattr_t attributes;
  if (pthread_condattr_init(&attributes))
    return 0;
  /* the monotonic clock: nobody sets it back while a thread waits */
  int ok = !pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC)
        && !pthread_cond_init(&store->changed, &attributes);
  pthread_condattr_destroy(&attributes);
  if (ok && pthread_mutex_init(&store->mutex, NULL)) {
    pthread_cond_destroy(&store->changed);
    ok = 0;
  }
  return ok;
}

static void lay_grid(tile_store *store, const projection *p, uint32_t face_index, uint32_t level)
{
  const face *f = &p->faces[face_index];
  tile_grid *grid = &store->grids[face_index][level];
  grid->first = store->tile_count;
  if (level >= projection_levels(p, face_index))
    return;
  grid->across = tiles_for(level_pixels(f->width, level));
  grid->up = tiles_for(level_pixels(f->height, level));
  store->tile_count += (uint64_t)grid->across * grid->up;
  if (level >= store->level_count)
    store->level_count = level + 1;
}

dsm_result tile_store_create(tile_store *store, const projection *p, uint64_t budget)
{
  memset(store, 0, sizeof *store);
  store->face_count = p->count;
  for (uint32_t level = 0; level < MAX_LEVELS; level++)
    for (uint32_t i = 0; i < p->count; i++)
      lay_grid(store, p, i, level);
  if (tile_cache_create(&store->cache, store->tile_count, budget) != DSM_OK)
    return DSM_NO_MEMORY;
  for (uint32_t level = 0; level < MAX_LEVELS; level++)
    for (uint32_t i = 0; i < p->count; i++)
      store->grids[i][level].slots = store->cache.slots + store->grids[i][level].first;
  if (!create_locks(store)) {
    tile_cache_destroy(&store->cache);
    return DSM_NO_MEMORY;
  }
  return DSM_OK;
}

void tile_store_destroy(tile_store *store)
{
  assert(!store->claims);
  tile_cache_destroy(&store->cache);
  pthread_cond_destroy(&store->changed);
  pthread_mutex_destroy(&store->mutex);
}

dsm_result tile_store_join(tile_store *store, tile_holder *holder)
{
  pthread_mutex_lock(&store->mutex);
  dsm_result result = tile_cache_join(&store->cache, holder);
  pthread_mutex_unlock(&store->mutex);
  return result;
}

void tile_store_leave(tile_store *store, tile_holder *holder)
{
  pthread_mutex_lock(&store->mutex);
  tile_cache_leave(&store->cache, holder);
  pthread_mutex_unlock(&store->mutex);
}

uint64_t tile_store_number(const tile_store *store, const tile_key *key)
{
  const tile_grid *grid = &store->grids[key->face][key->level];
  return grid->first + (uint64_t)key->y * grid->across + key->x;
}

tile_key tile_store_key(const tile_store *store, uint64_t number)
{
  tile_key key = {0, 0, 0, 0};
  for (uint32_t level = 0; level < store->level_count; level++)
    for (uint32_t i = 0; i < store->face_count; i++) {
      const tile_grid *grid = &store->grids[i][level];
      uint64_t within = number - grid->first;
      if (number >= grid->first && within < (uint64_t)grid->across * grid->up) {
        key = (tile_key){i, level, (uint32_t)(within % grid->across), (uint32_t)(within / grid->across)};
        return key;
      }
    }
  return key;
}

static int same_tile(const tile_key *a, const tile_key *b)
{
  return a->face == b->face && a->level == b->level && a->x == b->x && a->y == b->y;
}

tile_claim *tile_store_claimed(const tile_store *store, const tile_key *key)
{
  tile_claim *c = store->claims;
  while (c && !same_tile(&c->key, key))
    c = c->next;
  return c;
}

void tile_store_wait(tile_store *store)
{
  struct timespec until;
  clock_gettime(CLOCK_MONOTONIC, &until);
  until.tv_nsec += WAIT_NS;
  if (until.tv_nsec >= 1000000000L) {
    until.tv_nsec -= 1000000000L;
    until.tv_sec++;
  }
  pthread_cond_timedwait(&store->changed, &store->mutex, &until);
}

/* Under the mutex. Nonzero: the wait is over, with *out the tile or with the claim. */
static int try_claim(tile_store *store, const tile_key *key, tile_claim *claim, tile_holder *holder, const tile **out)
{
  *out = tile_cache_hold(tile_store_slot(store, key), holder);
  if (*out)
    return 1;
  if (tile_store_claimed(store, key))
    return 0;
  *claim = (tile_claim){.key = *key, .next = store->claims};
  store->claims = claim;
  return 1;
}

dsm_result tile_store_claim(tile_store *store, const tile_key *key, tile_claim *claim, tile_holder *holder,
                            int32_t (*pause)(void *data), void *data, const tile **out)
{
  *out = NULL;
  for (int asked = 0;; asked = 1) {
    pthread_mutex_lock(&store->mutex);
    dsm_result result = tile_holder_make_room(holder);
    int done = result != DSM_OK || try_claim(store, key, claim, holder, out);
    if (!done && asked)
      tile_store_wait(store);
    pthread_mutex_unlock(&store->mutex);
    if (done)
      return result;
    /* not under the lock: a host may suspend the thread in here for as long as its user likes */
    if (pause && pause(data))
      return DSM_CANCELLED;
  }
}

static void end_claim(tile_store *store, tile_claim *claim)
{
  tile_claim **link = &store->claims;
  while (*link && *link != claim)
    link = &(*link)->next;
  assert(*link == claim);
  *link = claim->next;
  claim->next = NULL;
}

void tile_store_publish(tile_store *store, tile_claim *claim, tile_holder *holder, const tile *t)
{
  pthread_mutex_lock(&store->mutex);
  tile_cache_put(&store->cache, tile_store_number(store, &claim->key), t, holder);
  end_claim(store, claim);
  pthread_cond_broadcast(&store->changed);
  pthread_mutex_unlock(&store->mutex);
}

void tile_store_abandon(tile_store *store, tile_claim *claim)
{
  pthread_mutex_lock(&store->mutex);
  end_claim(store, claim);
  pthread_cond_broadcast(&store->changed);
  pthread_mutex_unlock(&store->mutex);
}
