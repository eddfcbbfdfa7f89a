/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <string.h>
#include <time.h>

#include "map/tile_store.h"
#include "plain_tile.h"
#include "random.h"

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

static const uint64_t PLENTY = 1 << 20;

/* Levels of 33 x 16 pixels: 3 x 1 tiles, 2 x 1, and a single tile down to the level of one pixel. */
static void grids_cover_faces_and_levels(void **state) {
  (void)state;
  tile_store store;
  projection p = two_faces();
  assert_int_equal(tile_store_create(&store, &p, PLENTY), DSM_OK);
  static const uint32_t across[] = {3, 2, 1, 1, 1, 1, 1, 0};
  for (uint32_t level = 0; level < 8; ++level) {
    assert_int_equal(store.grids[0][level].across, across[level]);
    assert_int_equal(store.grids[0][level].up, across[level] > 0);
    assert_int_equal(store.grids[1][level].across, 0);
    assert_int_equal(store.grids[3][level].across, level == 0);
  }
  assert_true(store.level_count == 7 && store.face_count == MAX_FACES && store.tile_count == 11);
  tile_store_destroy(&store);
}

/* Numbers go level by level, face by face, row by row, and back. */
static void numbers_and_keys(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < 100; ++seed) {
    rng r = rng_seeded(seed);
    projection p;
    memset(&p, 0, sizeof p);
    p.count = seed % 3 ? MAX_FACES : 1;
    for (uint32_t i = 0; i < p.count; ++i)
      if (rng_below(&r, 4)) {
        p.faces[i].width = (uint32_t)rng_scale(&r, 1, 700);
        p.faces[i].height = (uint32_t)rng_scale(&r, 1, 700);
      }
    tile_store store;
    assert_int_equal(tile_store_create(&store, &p, PLENTY), DSM_OK);
    uint64_t number = 0;
    for (uint32_t level = 0; level < MAX_LEVELS; ++level)
      for (uint32_t i = 0; i < p.count; ++i) {
        const tile_grid *grid = &store.grids[i][level];
        uint32_t width = level_pixels(p.faces[i].width, level), height = level_pixels(p.faces[i].height, level);
        int there = p.faces[i].width && level < face_levels(&p.faces[i]);
        assert_seeded(&r, grid->across == (there ? (width + 15) / 16 : 0) && grid->up == (there ? (height + 15) / 16 : 0));
        for (uint32_t y = 0; y < grid->up; ++y)
          for (uint32_t x = 0; x < grid->across; ++x, ++number) {
            tile_key key = {i, level, x, y}, back = tile_store_key(&store, number);
            assert_seeded(&r, tile_store_number(&store, &key) == number);
            assert_seeded(&r, back.face == i && back.level == level && back.x == x && back.y == y);
            assert_seeded(&r, tile_store_slot(&store, &key) == &store.cache.slots[number]);
          }
      }
    assert_seeded(&r, number == store.tile_count);
    tile_store_destroy(&store);
  }
}

static void absent_claimed_ready(void **state) {
  (void)state;
  tile_store store;
  projection p = two_faces();
  assert_int_equal(tile_store_create(&store, &p, PLENTY), DSM_OK);
  tile_holder holder;
  assert_int_equal(tile_store_join(&store, &holder), DSM_OK);
  tile_key a = {0, 1, 1, 0}, b = {3, 0, 0, 0}, same_place = {0, 0, 1, 0};
  tile_claim claim, other;
  const tile *got = &tile_lit;
  assert_null(tile_store_peek(&store, &a));
  assert_int_equal(tile_store_claim(&store, &a, &claim, &holder, never, NULL, &got), DSM_OK);
  assert_null(got);
  assert_null(tile_store_peek(&store, &a));
  /* others are free meanwhile, another level's at the same place too; claims end in any order */
  got = &tile_lit;
  assert_int_equal(tile_store_claim(&store, &same_place, &other, &holder, never, NULL, &got), DSM_OK);
  assert_null(got);
  tile_store_abandon(&store, &other);
  assert_int_equal(tile_store_claim(&store, &b, &other, &holder, never, NULL, &got), DSM_OK);
  assert_null(got);
  static const tile_plan plan = {.count = {5}};
  tile *t = tile_create(&plan);
  tile_store_publish(&store, &claim, &holder, t);
  assert_ptr_equal(tile_store_peek(&store, &a), t);
  assert_null(tile_store_peek(&store, &b));
  tile_store_abandon(&store, &other);
  assert_int_equal(tile_store_claim(&store, &b, &other, &holder, never, NULL, &got), DSM_OK);
  assert_null(got);
  tile_store_publish(&store, &other, &holder, &tile_failed);
  assert_int_equal(tile_store_claim(&store, &b, &other, &holder, never, NULL, &got), DSM_OK);
  assert_ptr_equal(got, &tile_failed);
  assert_int_equal(tile_store_claim(&store, &a, &claim, &holder, NULL, NULL, &got), DSM_OK);
  assert_ptr_equal(got, t);
  assert_int_equal(holder.held, 4);
  tile_store_leave(&store, &holder);
  tile_store_destroy(&store);
}

static int32_t third_time(void *data) { return ++*(int *)data == 3; }

static void waiting_asks_the_host(void **state) {
  (void)state;
  tile_store store;
  projection p = two_faces();
  assert_int_equal(tile_store_create(&store, &p, PLENTY), DSM_OK);
  tile_holder holder;
  assert_int_equal(tile_store_join(&store, &holder), DSM_OK);
  tile_key key = {0, 0, 0, 0};
  tile_claim claim, mine;
  const tile *got;
  assert_int_equal(tile_store_claim(&store, &key, &claim, &holder, never, NULL, &got), DSM_OK);
  int asked = 0;
  assert_int_equal(tile_store_claim(&store, &key, &mine, &holder, third_time, &asked, &got), DSM_CANCELLED);
  assert_int_equal(asked, 3);
  tile_store_abandon(&store, &claim);
  tile_store_leave(&store, &holder);
  tile_store_destroy(&store);
}

typedef struct { tile_store *store; tile_key key; const tile *got; dsm_result result; int asked; } waiter;

static int32_t count_only(void *data) { return ++((waiter *)data)->asked < 0; }

static void *wait_for_tile(void *data) {
  waiter *w = data;
  tile_claim claim;
  tile_holder holder;
  w->result = tile_store_join(w->store, &holder);
  if (w->result != DSM_OK) return NULL;
  w->result = tile_store_claim(w->store, &w->key, &claim, &holder, count_only, w, &w->got);
  if (w->result == DSM_OK && !w->got) tile_store_publish(w->store, &claim, &holder, &tile_lit);
  tile_store_leave(w->store, &holder);
  return NULL;
}

/* Whoever waits gets what is published; if the claim is given up instead, one of them takes it over. */
static void waiters_are_woken(void **state) {
  (void)state;
  for (int give_up = 0; give_up < 2; ++give_up) {
    tile_store store;
    projection p = two_faces();
    assert_int_equal(tile_store_create(&store, &p, PLENTY), DSM_OK);
    tile_holder holder;
    assert_int_equal(tile_store_join(&store, &holder), DSM_OK);
    tile_key key = {0, 0, 1, 0};
    tile_claim claim;
    const tile *got;
    assert_int_equal(tile_store_claim(&store, &key, &claim, &holder, never, NULL, &got), DSM_OK);
    waiter waiters[4];
    pthread_t ids[4];
    for (int i = 0; i < 4; ++i) {
      waiters[i] = (waiter){.store = &store, .key = key};
      assert_int_equal(pthread_create(&ids[i], NULL, wait_for_tile, &waiters[i]), 0);
    }
    nanosleep(&(struct timespec){0, 50000000}, NULL);   /* most wait by now; the outcome is the same if not */
    if (give_up) tile_store_abandon(&store, &claim);
    else tile_store_publish(&store, &claim, &holder, &tile_failed);
    int bakers = 0;
    for (int i = 0; i < 4; ++i) {
      pthread_join(ids[i], NULL);
      assert_int_equal(waiters[i].result, DSM_OK);
      bakers += waiters[i].got == NULL;
      assert_true(waiters[i].got == NULL || waiters[i].got == (give_up ? &tile_lit : &tile_failed));
    }
    assert_int_equal(bakers, give_up);
    tile_store_leave(&store, &holder);
    tile_store_destroy(&store);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(grids_cover_faces_and_levels),
    cmocka_unit_test(numbers_and_keys),
    cmocka_unit_test(absent_claimed_ready),
    cmocka_unit_test(waiting_asks_the_host),
    cmocka_unit_test(waiters_are_woken),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
