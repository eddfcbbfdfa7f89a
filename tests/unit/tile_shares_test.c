/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <stdatomic.h>
#include <string.h>
#include <time.h>

#include "map/tile_shares.h"

enum { MOST_THREADS = 3, PATIENCE = 10000 };   /* milliseconds */

static const tile_key KEY = {0, 0, 0, 0};

/* Work of which each thread is to make a share before anybody goes on: so all of them have to take part. `makers` are numbers of threads. */
typedef struct {
  tile_shares shares;   /* first */
  int threads;
  atomic_int made[MOST_SHARES], by[MOST_THREADS], fails[MOST_THREADS], present;
} work;

static void wait_until(atomic_int *number, int least) {
  for (int i = 0; i < PATIENCE && atomic_load(number) < least; ++i) nanosleep(&(struct timespec){0, 1000000}, NULL);
}

static dsm_result make_share(tile_shares *shares, struct tile_maker *maker, uint32_t share) {
  work *w = (work *)(void *)shares;
  int me = (int)(intptr_t)maker;
  if (atomic_fetch_add(&w->by[me], 1) == 0) atomic_fetch_add(&w->present, 1);
  wait_until(&w->present, w->threads);
  if (atomic_load(&w->fails[me])) return DSM_NO_MEMORY;
  atomic_fetch_add(&w->made[share], 1);
  return DSM_OK;
}

static struct tile_maker *number(int me) { return (struct tile_maker *)(intptr_t)me; }

typedef struct { tile_store *store; int me; const tile *got; dsm_result result, helped; } thread;

static int32_t help(void *data) {
  thread *t = data;
  dsm_result result = tile_shares_help(t->store, &KEY, number(t->me));
  if (result != DSM_OK) t->helped = result;
  return 0;
}

static void *wait_for_tile(void *data) {
  thread *t = data;
  tile_claim claim;
  tile_holder holder;
  t->result = tile_store_join(t->store, &holder);
  if (t->result == DSM_OK) t->result = tile_store_claim(t->store, &KEY, &claim, &holder, help, t, &t->got);
  if (t->result == DSM_OK && !t->got) tile_store_publish(t->store, &claim, &holder, &tile_failed);
  tile_store_leave(t->store, &holder);
  return NULL;
}

static tile_store open_store(void) {
  projection p;
  memset(&p, 0, sizeof p);
  p.count = 1;
  p.faces[0].width = p.faces[0].height = 16;
  tile_store store;
  assert_int_equal(tile_store_create(&store, &p, 1 << 20), DSM_OK);
  return store;
}

/* The first thread has the claim; the others wait for it, and help. `fails`: a thread that does, or -1. */
static void make_together(work *w, int threads, uint32_t count, int fails) {
  tile_store store = open_store();
  memset(w, 0, sizeof *w);
  w->shares = (tile_shares){.count = count, .make = make_share};
  w->threads = threads;
  if (fails >= 0) w->fails[fails] = 1;
  tile_holder holder;
  tile_claim claim;
  const tile *got;
  assert_int_equal(tile_store_join(&store, &holder), DSM_OK);
  assert_int_equal(tile_store_claim(&store, &KEY, &claim, &holder, NULL, NULL, &got), DSM_OK);
  thread others[MOST_THREADS];
  pthread_t ids[MOST_THREADS];
  for (int i = 1; i < threads; ++i) {
    others[i] = (thread){.store = &store, .me = i};
    assert_int_equal(pthread_create(&ids[i], NULL, wait_for_tile, &others[i]), 0);
  }
  dsm_result result = tile_shares_do(&store, &KEY, &w->shares, number(0));
  assert_int_equal(result, fails == 0 ? DSM_NO_MEMORY : DSM_OK);
  assert_int_equal(w->shares.taken, 0);
  tile_store_publish(&store, &claim, &holder, &tile_lit);
  for (int i = 1; i < threads; ++i) {
    pthread_join(ids[i], NULL);
    assert_int_equal(others[i].result, DSM_OK);
    assert_int_equal(others[i].helped, i == fails ? DSM_NO_MEMORY : DSM_OK);
    assert_ptr_equal(others[i].got, &tile_lit);
  }
  assert_int_equal(w->present, threads);
  tile_store_leave(&store, &holder);
  tile_store_destroy(&store);
}

static void waiters_take_shares(void **state) {
  (void)state;
  work w;
  for (int threads = 1; threads <= MOST_THREADS; ++threads)
    for (uint32_t count = (uint32_t)threads; count <= MOST_SHARES; ++count) {
      make_together(&w, threads, count, -1);
      for (uint32_t k = 0; k < MOST_SHARES; ++k) assert_int_equal(w.made[k], k < count);
    }
}

/* What a helper leaves, others make. */
static void a_helper_may_fail(void **state) {
  (void)state;
  work w;
  make_together(&w, MOST_THREADS, MOST_SHARES, 2);
  for (uint32_t k = 0; k < MOST_SHARES; ++k) assert_int_equal(w.made[k], 1);
}

/* Then the work has failed, after all have left it. */
static void the_owner_may_fail(void **state) {
  (void)state;
  work w;
  make_together(&w, MOST_THREADS, MOST_SHARES, 0);
  for (uint32_t k = 0; k < MOST_SHARES; ++k) assert_true(w.made[k] <= 1);
}

static void there_may_be_nothing_to_help_with(void **state) {
  (void)state;
  tile_store store = open_store();
  assert_int_equal(tile_shares_help(&store, &KEY, number(0)), DSM_OK);
  tile_holder holder;
  tile_claim claim;
  const tile *got;
  assert_int_equal(tile_store_join(&store, &holder), DSM_OK);
  assert_int_equal(tile_store_claim(&store, &KEY, &claim, &holder, NULL, NULL, &got), DSM_OK);
  assert_int_equal(tile_shares_help(&store, &KEY, number(0)), DSM_OK);
  tile_store_abandon(&store, &claim);
  tile_store_leave(&store, &holder);
  tile_store_destroy(&store);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(waiters_take_shares),
    cmocka_unit_test(a_helper_may_fail),
    cmocka_unit_test(the_owner_may_fail),
    cmocka_unit_test(there_may_be_nothing_to_help_with),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
