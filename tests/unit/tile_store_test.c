/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>
#include <time.h>

#include "map/tile_store.h"

static projection two_faces(void) {
  projection p;
  memset(&p, 0, sizeof p);
  p.count = MAX_FACES;
  p.faces[0].width = 33;
  p.faces[0].height = 16;
  p.faces[3].width = 1;
  p.faces[3].height = 1;
  return p;
}

static int32_t never(void *data) { return (void)data, 0; }

static void slots_cover_the_faces(void **state) {
  (void)state;
  tile_store store;
  projection p = two_faces();
  assert_int_equal(tile_store_create(&store, &p), DSM_OK);
  assert_true(store.grids[0].across == 3 && store.grids[0].up == 1);
  assert_true(store.grids[1].across == 0 && store.grids[3].across == 1 && store.grids[3].up == 1);
  tile_store_destroy(&store);
}

static void absent_claimed_ready(void **state) {
  (void)state;
  tile_store store;
  projection p = two_faces();
  assert_int_equal(tile_store_create(&store, &p), DSM_OK);
  tile_key a = {0, 0, 2, 0}, b = {3, 0, 0, 0};
  tile_claim claim, other;
  const tile *got = &tile_lit;
  assert_null(tile_store_peek(&store, &a));
  assert_int_equal(tile_store_claim(&store, &a, &claim, never, NULL, &got), DSM_OK);
  assert_null(got);
  assert_null(tile_store_peek(&store, &a));
  /* another tile is free meanwhile; claims end in any order */
  assert_int_equal(tile_store_claim(&store, &b, &other, never, NULL, &got), DSM_OK);
  assert_null(got);
  tile *t = tile_create(5);
  tile_store_publish(&store, &claim, t);
  assert_ptr_equal(tile_store_peek(&store, &a), t);
  assert_null(tile_store_peek(&store, &b));
  tile_store_abandon(&store, &other);
  assert_int_equal(tile_store_claim(&store, &b, &other, never, NULL, &got), DSM_OK);
  assert_null(got);
  tile_store_publish(&store, &other, &tile_failed);
  assert_int_equal(tile_store_claim(&store, &b, &other, never, NULL, &got), DSM_OK);
  assert_ptr_equal(got, &tile_failed);
  assert_int_equal(tile_store_claim(&store, &a, &claim, NULL, NULL, &got), DSM_OK);
  assert_ptr_equal(got, t);
  tile_store_destroy(&store);
}

static int32_t third_time(void *data) { return ++*(int *)data == 3; }

static void waiting_asks_the_host(void **state) {
  (void)state;
  tile_store store;
  projection p = two_faces();
  assert_int_equal(tile_store_create(&store, &p), DSM_OK);
  tile_key key = {0, 0, 0, 0};
  tile_claim claim, mine;
  const tile *got;
  assert_int_equal(tile_store_claim(&store, &key, &claim, never, NULL, &got), DSM_OK);
  int asked = 0;
  assert_int_equal(tile_store_claim(&store, &key, &mine, third_time, &asked, &got), DSM_CANCELLED);
  assert_int_equal(asked, 3);
  tile_store_abandon(&store, &claim);
  tile_store_destroy(&store);
}

typedef struct { tile_store *store; tile_key key; const tile *got; dsm_result result; int asked; } waiter;

static int32_t count_only(void *data) { return ++((waiter *)data)->asked < 0; }

static void *wait_for_tile(void *data) {
  waiter *w = data;
  tile_claim claim;
  w->result = tile_store_claim(w->store, &w->key, &claim, count_only, w, &w->got);
  if (w->result == DSM_OK && !w->got) tile_store_publish(w->store, &claim, &tile_lit);
  return NULL;
}

/* Whoever waits gets what is published; if the claim is given up instead, one of them takes it over. */
static void waiters_are_woken(void **state) {
  (void)state;
  for (int give_up = 0; give_up < 2; ++give_up) {
    tile_store store;
    projection p = two_faces();
    assert_int_equal(tile_store_create(&store, &p), DSM_OK);
    tile_key key = {0, 0, 1, 0};
    tile_claim claim;
    const tile *got;
    assert_int_equal(tile_store_claim(&store, &key, &claim, never, NULL, &got), DSM_OK);
    waiter waiters[4];
    pthread_t ids[4];
    for (int i = 0; i < 4; ++i) {
      waiters[i] = (waiter){.store = &store, .key = key};
      assert_int_equal(pthread_create(&ids[i], NULL, wait_for_tile, &waiters[i]), 0);
    }
    nanosleep(&(struct timespec){0, 50000000}, NULL);   /* most wait by now; the outcome is the same if not */
    if (give_up) tile_store_abandon(&store, &claim);
    else tile_store_publish(&store, &claim, &tile_failed);
    int bakers = 0;
    for (int i = 0; i < 4; ++i) {
      pthread_join(ids[i], NULL);
      assert_int_equal(waiters[i].result, DSM_OK);
      bakers += waiters[i].got == NULL;
      assert_true(waiters[i].got == NULL || waiters[i].got == (give_up ? &tile_lit : &tile_failed));
    }
    assert_int_equal(bakers, give_up);
    tile_store_destroy(&store);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(slots_cover_the_faces),
    cmocka_unit_test(absent_claimed_ready),
    cmocka_unit_test(waiting_asks_the_host),
    cmocka_unit_test(waiters_are_woken),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
