/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/tile_shares.h"

static uint32_t next_open(const tile_shares *shares)
{
  uint32_t k = 0;
  while (k < shares->count && shares->state[k] != SHARE_OPEN)
    k++;
  return k;
}

/* Under the mutex, but not while making. */
static dsm_result take_shares(tile_store *store, tile_shares *shares, struct tile_maker *maker)
{
  dsm_result result = DSM_OK;
  for (uint32_t k; result == DSM_OK && (k = next_open(shares)) < shares->count;) {
    shares->state[k] = SHARE_TAKEN;
    shares->taken++;
    pthread_mutex_unlock(&store->mutex);
    result = shares->make(shares, maker, k);
    pthread_mutex_lock(&store->mutex);
    shares->state[k] = result == DSM_OK ? SHARE_DONE : SHARE_OPEN;
    shares->taken--;
  }
  return result;
}

dsm_result tile_shares_do(tile_store *store, const tile_key *key, tile_shares *shares, struct tile_maker *maker)
{
  pthread_mutex_lock(&store->mutex);
  tile_claim *claim = tile_store_claimed(store, key);
  assert(claim && !claim->shares && shares->count <= MOST_SHARES);
  claim->shares = shares;
  pthread_cond_broadcast(&store->changed);
  dsm_result result;
  do {
    result = take_shares(store, shares, maker);
    if (result != DSM_OK)
      shares->count = 0;   /* nobody shall take more */
    while (shares->taken > 0)
      tile_store_wait(store);
  } while (next_open(shares) < shares->count);
  claim->shares = NULL;
  pthread_mutex_unlock(&store->mutex);
  return result;
}

dsm_result tile_shares_help(tile_store *store, const tile_key *key, struct tile_maker *maker)
{
  dsm_result result = DSM_OK;
  pthread_mutex_lock(&store->mutex);
  tile_claim *claim = tile_store_claimed(store, key);
  if (claim && claim->shares) {
    result = take_shares(store, claim->shares, maker);
    pthread_cond_broadcast(&store->changed);
  }
  pthread_mutex_unlock(&store->mutex);
  return result;
}
