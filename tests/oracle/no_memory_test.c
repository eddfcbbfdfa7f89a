/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Every allocation of the library fails once, each in a run of its own, and then every one from there on: no crash, no leak, and no
 * answer but the right one or the advice to trace the ray. Linked with --wrap, so that the library's calls come here.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <sys/stat.h>
#include <unistd.h>

#include "oracle.h"

void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
char *__real_strdup(const char *text);
void __real_free(void *block);

static struct {
  long left;      /* calls until one fails; negative: none does */
  int for_good;   /* all after it fail, too */
  int failed;     /* one has */
  int live;       /* blocks not freed yet */
  void *blocks[10000];
} memory = {.left = -1};

static int fails(void) {
  if (memory.left < 0 || memory.left-- > 0) return 0;
  if (memory.for_good) memory.left = 0;
  memory.failed = 1;
  return 1;
}

static void *counted(void *block) {
  assert_true(memory.live < (int)(sizeof memory.blocks / sizeof *memory.blocks));
  if (block) memory.blocks[memory.live++] = block;
  return block;
}

/* 0: it came from elsewhere, as what the library of files has grown. */
static int forget(void *block) {
  int i = memory.live;
  while (i-- > 0)
    if (memory.blocks[i] == block) {
      memory.blocks[i] = memory.blocks[--memory.live];
      return 1;
    }
  return 0;
}

void *__wrap_malloc(size_t size) { return fails() ? NULL : counted(__real_malloc(size)); }
void *__wrap_calloc(size_t count, size_t size) { return fails() ? NULL : counted(__real_calloc(count, size)); }
void *__wrap_aligned_alloc(size_t alignment, size_t size) { return fails() ? NULL : counted(__real_aligned_alloc(alignment, size)); }
char *__wrap_strdup(const char *text) { return fails() ? NULL : counted(__real_strdup(text)); }

void *__wrap_realloc(void *block, size_t size) {
  if (fails()) return NULL;
  void *grown = __real_realloc(block, size);
  if (grown && (!block || forget(block))) counted(grown);
  return grown;
}

void __wrap_free(void *block) {
  forget(block);
  __real_free(block);
}

/* Glass, fog and opaque things, so that a tile holds pixels of every kind. */
enum { SHAPES = 4, SIDE = 5 };
static shape shapes[SHAPES];
static dsm_box boxes[SHAPES];
static char folder[] = "/tmp/deep-shadow-no-memory.XXXXXX", path[64];

static void fill_scene(void) {
  shapes[0] = sphere_at(0.2, 0.1, 2, 0.5, 0.5);
  shapes[0].pass[1] = 0.7;
  shapes[1] = fog_in((dsm_box){{-0.9, -0.9, 2.2}, {0.3, 0.9, 3}}, 0.5, 0.5, 0.5, 0.4);
  shapes[2] = sheet_at(3.5, 0.6, 0, 0, 0);
  shapes[3] = sheet_at(4, 1.2, 0.8, 0.6, 0.9);
  for (int i = 0; i < SHAPES; ++i) boxes[i] = shapes[i].box;
}

typedef struct {
  double light[SIDE * SIDE][3];
  int known[SIDE * SIDE];
} answers;

static dsm_receiver place(int i) {
  double x = -0.8 + 1.6 * (i % SIDE) / (SIDE - 1), y = -0.8 + 1.6 * (i / SIDE) / (SIDE - 1);
  dsm_receiver r = {.point = {x, y, 4.5}, .has_footprint = i % 2 != 0, .footprint = {{0.3, 0, 0}, {0, 0.2, 0}}};
  return r;
}

static void ask(dsm_worker *worker, answers *a) {
  for (int i = 0; i < SIDE * SIDE; ++i) {
    dsm_receiver r = place(i);
    dsm_result result = dsm_api.lookup(worker, &r, a->light[i]);
    a->known[i] = result == DSM_OK || result == DSM_OUTSIDE;
    assert_true(a->known[i] || result == DSM_TRACE || result == DSM_NO_MEMORY);
  }
}

enum { DEEP, DEPTHS };   /* blocks */

static void set_word(dsm_settings *settings, int kind, const char *word, double number) {
  char why[200];
  uint32_t row = 0;
  while (strcmp(dsm_api.blocks[kind].parameters[row].name, word) != 0) ++row;
  assert_int_equal(dsm_api.settings_set(settings, row, NULL, &number, 1, why, sizeof why), DSM_OK);
}

typedef enum { ON_DEMAND, SAVED, LOADED } way;

static dsm_result work(dsm_worker *worker, way how, answers *a) {
  double share;
  dsm_result result = DSM_OK;
  if (how == LOADED) result = dsm_api.load(worker, path);
  if (how == SAVED) {
    result = dsm_api.save_begin(worker, path);
    while (result == DSM_OK) result = dsm_api.bake_next(worker, &share);
    if (result == DSM_DONE) result = dsm_api.save_end(worker, NULL);
  }
  if (result == DSM_OK) ask(worker, a);
  return result;
}

/* A map's whole life. What cannot be made is left out, as a host would. */
static void live(int kind, way how, double cache, answers *a) {
  world w = {.shapes = shapes, .count = SHAPES};
  dsm_host host = host_of(&w);
  dsm_light light = spot_at(0, 0, 0, 0, 0, 1, 30);
  dsm_map *map = NULL;
  dsm_worker *worker = NULL;
  light.casters = boxes;
  light.caster_count = SHAPES;
  dsm_settings *settings = dsm_api.settings_create((uint32_t)kind);
  if (settings) {
    set_word(settings, kind, "resolution", 18);
    set_word(settings, kind, "samples", 4);
    set_word(settings, kind, "cache", cache);
  }
  dsm_result result = settings ? dsm_api.map_create(&host, &light, settings, &map) : DSM_NO_MEMORY;
  if (result == DSM_OK) result = dsm_api.worker_create(map, &w, &worker);
  if (result == DSM_OK) result = work(worker, how, a);
  assert_true(result == DSM_OK || result == DSM_NO_MEMORY || result == DSM_REFUSED || (how == SAVED && result == DSM_TRACE));
  dsm_api.worker_destroy(worker);
  dsm_api.map_destroy(map);
  dsm_api.settings_destroy(settings);
}

/* Where a coarse tile has failed, a finer one answers: the same light, averaged over less. */
static int is_right(int i, const double light[3], const double truth[3]) {
  if (!place(i).has_footprint) return memcmp(light, truth, 3 * sizeof *light) == 0;
  for (int c = 0; c < 3; ++c)
    if (!(fabs(light[c] - truth[c]) < 0.1)) return 0;
  return 1;
}

static void fail_each(int kind, way how, double cache, const answers *truth) {
  for (memory.for_good = 0; memory.for_good < 2; ++memory.for_good)
    for (long n = 0;; ++n) {
      answers a = {.known = {0}};
      int before = memory.live;
      memory.failed = 0;
      memory.left = n;
      live(kind, how, cache, &a);
      memory.left = -1;
      if (memory.live != before) fail_msg("allocation %ld: %d blocks leak", n, memory.live - before);
      for (int i = 0; i < SIDE * SIDE; ++i)
        if (a.known[i] && !is_right(i, a.light[i], truth->light[i]))
          fail_msg("allocation %ld: point %d gets %g and not %g", n, i, a.light[i][0], truth->light[i][0]);
      if (!memory.failed) break;
      assert_true(n < 100000);
    }
}

static void every_allocation_fails(void **state) {
  (void)state;
  for (int kind = DEEP; kind <= DEPTHS; ++kind) {
    answers truth = {.known = {0}};
    live(kind, ON_DEMAND, 1024, &truth);
    for (int i = 0; i < SIDE * SIDE; ++i) assert_true(truth.known[i]);
    fail_each(kind, ON_DEMAND, 1024, &truth);
    fail_each(kind, ON_DEMAND, 0.001, &truth);   /* tiles come and go */
  }
}

static void every_allocation_fails_with_files(void **state) {
  (void)state;
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/map.exr", folder);
  for (int kind = DEEP; kind <= DEPTHS; ++kind) {
    answers truth = {.known = {0}};
    live(kind, SAVED, 1024, &truth);
    for (int i = 0; i < SIDE * SIDE; ++i) assert_true(truth.known[i]);
    fail_each(kind, LOADED, 1024, &truth);
    fail_each(kind, SAVED, 0.001, &truth);
    unlink(path);
  }
  assert_int_equal(rmdir(folder), 0);   /* nothing else is left behind */
}

int main(void) {
  fill_scene();
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_allocation_fails),
    cmocka_unit_test(every_allocation_fails_with_files),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
