/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "map/spool.h"
#include "plain_tile.h"
#include "random.h"

enum { COUNT = 500 };

static char directory[] = "/tmp/spool-test-XXXXXX", path[sizeof directory + 5];

static int make_directory(void **state) {
  (void)state;
  if (!mkdtemp(directory)) return -1;
  return snprintf(path, sizeof path, "%s/file", directory) < 0;
}

static int remove_directory(void **state) {
  (void)state;
  return rmdir(directory);   /* fails unless it is empty */
}

/* Of all layouts, with every byte of the pixels drawn. */
static tile *any_tile(rng *r) {
  tile_plan plan = {.count = {0}};
  uint32_t most = rng_below(r, 20) ? 30 : 900;
  for (int i = 0; i < TILE_PIXELS; ++i) {
    plan.count[i] = rng_below(r, most);
    plan.coloured[i] = rng_below(r, 9) == 0;
    plan.marked[i] = most > 30 && rng_below(r, 9) == 0;
  }
  tile *t = tile_create(&plan);
  assert_non_null(t);
  t->near_depth = rng_unit(r);
  t->tolerance = (float)rng_unit(r);
  for (size_t i = t->codes.records; i < t->size; ++i) ((unsigned char *)t)[i] = (unsigned char)rng_bits(r);
  return t;
}

static int same_bytes(const tile *a, const tile *b) {
  size_t used = offsetof(tile, used);
  return a->size == b->size && !memcmp(a, b, used) && !memcmp((const char *)a + used + 1, (const char *)b + used + 1, a->size - used - 1);
}

static void tiles_come_back(void **state) {
  (void)state;
  rng r = rng_seeded(1);
  spool *s;
  assert_int_equal(spool_create(path, COUNT, &s), DSM_OK);
  tile *tiles[COUNT] = {NULL};
  for (int k = 0; k < 5 * COUNT; ++k) {
    uint32_t n = rng_below(&r, COUNT);
    const tile *got = &tile_lit;
    if (rng_below(&r, 3) == 0) {
      if (!tiles[n]) tiles[n] = any_tile(&r);
      assert_int_equal(spool_write(s, n, tiles[n]), DSM_OK);
    }
    assert_int_equal(spool_read(s, n, &got), DSM_OK);
    assert_seeded(&r, !got == !tiles[n]);
    if (!got) continue;
    assert_seeded(&r, got != tiles[n] && same_bytes(got, tiles[n]) && got->used == 0);
    tile_destroy(got);
  }
  assert_false(spool_is_full(s));
  for (int i = 0; i < COUNT; ++i) tile_destroy(tiles[i]);
  spool_destroy(s);
}

/* Nothing is left of it if the program is killed. */
static void the_file_has_no_name(void **state) {
  (void)state;
  rng r = rng_seeded(2);
  spool *s;
  assert_int_equal(spool_create(path, COUNT, &s), DSM_OK);
  tile *t = any_tile(&r);
  assert_int_equal(spool_write(s, 0, t), DSM_OK);
  DIR *d = opendir(directory);
  assert_non_null(d);
  for (struct dirent *e; (e = readdir(d)) != NULL;) assert_int_equal(e->d_name[0], '.');
  closedir(d);
  tile_destroy(t);
  spool_destroy(s);
  spool_destroy(NULL);
}

static void no_such_directory(void **state) {
  (void)state;
  spool *s = (spool *)1;
  assert_int_equal(spool_create("/dev/null/file", COUNT, &s), DSM_REFUSED);
  assert_null(s);
  s = (spool *)1;
  assert_int_equal(spool_create(path, UINT64_MAX / 2, &s), DSM_NO_MEMORY);
  assert_null(s);
}

/* A limit on the size of files is a full disk to whoever writes: what does not fit whole is not there at all. */
static void a_full_disk(void **state) {
  (void)state;
  rng r = rng_seeded(3);
  spool *s;
  assert_int_equal(spool_create(path, COUNT, &s), DSM_OK);
  struct rlimit before, narrow;
  signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  narrow = (struct rlimit){200001, before.rlim_max};
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &narrow), 0);
  tile *tiles[COUNT];
  int kept = 0, full = 0;
  for (int i = 0; i < COUNT; ++i) {
    tiles[i] = any_tile(&r);
    dsm_result result = spool_write(s, (uint64_t)i, tiles[i]);
    assert_int_equal(result, full || result != DSM_OK ? DSM_REFUSED : DSM_OK);
    full |= result != DSM_OK;
    kept += result == DSM_OK;
    assert_int_equal(spool_is_full(s), full);
  }
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  assert_true(full && kept > 2);
  for (int i = 0; i < COUNT; ++i) {
    const tile *got = &tile_lit;
    assert_int_equal(spool_read(s, (uint64_t)i, &got), DSM_OK);
    assert_true(i < kept ? same_bytes(got, tiles[i]) : got == NULL);
    tile_destroy(got);
    tile_destroy(tiles[i]);
  }
  spool_destroy(s);
}

/* The descriptor of the one open file that has no name, which is the spool's. */
static int descriptor(void) {
  struct stat about;
  int file = 3;
  while (file < 100 && !(fstat(file, &about) == 0 && S_ISREG(about.st_mode) && about.st_nlink == 0)) ++file;
  assert_true(file < 100);
  return file;
}

/* What cannot be read whole is not read at all: a file that somebody has cut, and one that cannot be read. */
static void a_file_that_cannot_be_read(void **state) {
  (void)state;
  rng r = rng_seeded(4);
  spool *s;
  assert_int_equal(spool_create(path, COUNT, &s), DSM_OK);
  tile *tiles[2] = {any_tile(&r), any_tile(&r)};
  for (uint64_t i = 0; i < 2; ++i) assert_int_equal(spool_write(s, i, tiles[i]), DSM_OK);
  int file = descriptor();
  assert_int_equal(ftruncate(file, (off_t)tiles[0]->size + 10), 0);
  const tile *got = NULL;
  assert_int_equal(spool_read(s, 0, &got), DSM_OK);
  assert_true(got && same_bytes(got, tiles[0]));
  tile_destroy(got);
  got = &tile_lit;
  assert_int_equal(spool_read(s, 1, &got), DSM_REFUSED);
  assert_null(got);
  int other = open("/dev/null", O_WRONLY);
  assert_true(other >= 0 && dup2(other, file) == file);
  close(other);
  got = &tile_lit;
  assert_int_equal(spool_read(s, 0, &got), DSM_REFUSED);
  assert_null(got);
  for (int i = 0; i < 2; ++i) tile_destroy(tiles[i]);
  spool_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(tiles_come_back),
    cmocka_unit_test(the_file_has_no_name),
    cmocka_unit_test(no_such_directory),
    cmocka_unit_test(a_full_disk),
    cmocka_unit_test(a_file_that_cannot_be_read),
  };
  return cmocka_run_group_tests(tests, make_directory, remove_directory);
}
