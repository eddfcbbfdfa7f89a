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

static void free_grids(tile_store *store)
{
  for (uint32_t i = 0; i < store->grid_count; i++) {
    tile_grid *grid = &store->grids[i];
    if (grid->slots)
      for (size_t k = 0; k < (size_t)grid->across * grid->up; k++)
        tile_destroy(atomic_load_explicit(&grid->slots[k], memory_order_relaxed));
    free((void *)grid->slots);
  }
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

dsm_result tile_store_create(tile_store *store, const projection *p)
{
  memset(store, 0, sizeof *store);
  store->grid_count = p->count;
  for (uint32_t i = 0; i < p->count; i++) {
    tile_grid *grid = &store->grids[i];
    grid->across = tiles_for(p->faces[i].width);
    grid->up = tiles_for(p->faces[i].height);
    size_t count = (size_t)grid->across * grid->up;
    if (count == 0)
      continue;
    grid->slots = calloc(count, sizeof *grid->slots);   /* all bits zero is NULL on every POSIX system */
    if (!grid->slots) {
      free_grids(store);
      return DSM_NO_MEMORY;
    }
  }
  if (!create_locks(store)) {
    free_grids(store);
    return DSM_NO_MEMORY;
  }
  return DSM_OK;
}

void tile_store_destroy(tile_store *store)
{
  assert(!store->claims);
  free_grids(store);
  pthread_cond_destroy(&store->changed);
  pthread_mutex_destroy(&store->mutex);
}

static int same_tile(const tile_key *a, const tile_key *b)
{
  return a->face == b->face && a->level == b->level && a->x == b->x && a->y == b->y;
}

static int is_claimed(const tile_store *store, const tile_key *key)
{
  for (const tile_claim *c = store->claims; c; c = c->next)
    if (same_tile(&c->key, key))
      return 1;
  return 0;
}

static void wait_for_change(tile_store *store)
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

dsm_result tile_store_claim(tile_store *store, const tile_key *key, tile_claim *claim,
                            int32_t (*pause)(void *data), void *data, const tile **out)
{
  for (;;) {
    pthread_mutex_lock(&store->mutex);
    *out = tile_store_peek(store, key);
    if (*out) {
      pthread_mutex_unlock(&store->mutex);
      return DSM_OK;
    }
    if (!is_claimed(store, key)) {
      claim->key = *key;
      claim->next = store->claims;
      store->claims = claim;
      pthread_mutex_unlock(&store->mutex);
      return DSM_OK;
    }
    wait_for_change(store);
    pthread_mutex_unlock(&store->mutex);
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

void tile_store_publish(tile_store *store, tile_claim *claim, const tile *t)
{
  assert(t);
  pthread_mutex_lock(&store->mutex);
  atomic_store_explicit(tile_store_slot(store, &claim->key), t, memory_order_release);
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
