/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Each allocation of the library is refused once, in a map's life of its own: no crash, no leak, and no answer but the right one or the
 * advice to trace the ray. Linked with --wrap, so that the library's calls come here, and with operator new of failing_new.cpp, so that
 * those of deepshadow_files.so do; what OpenImageIO itself allocates never fails here.
 *
 * Allocations that the same CALLS functions have led to are on one route. From the first on each route on, all are refused as well.
 * DSM_MOST_CASES: how many allocations and how many routes of each kind of life, for tools under which each takes seconds.
 */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <dlfcn.h>
#include <execinfo.h>
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
  long in_files;  /* calls of operator new from deepshadow_files.so */
  void *blocks[10000];
} memory = {.left = -1};

/* The functions that have led to an allocation, the innermost first. */
enum { CALLS = 8, MOST_ROUTES = 2000 };
typedef struct {
  void *calls[CALLS];
  long first;   /* of the allocations of one life */
  int done;
} route;
static struct {
  route all[MOST_ROUTES];
  int count;
  int listing;
  long next;          /* allocation of this life */
} routes;

static __attribute__((noinline)) void note_route(void) {
  enum { OURS = 3 };   /* this function and the two that call it here */
  void *calls[OURS + CALLS] = {0};
  int i = 0;
  backtrace(calls, OURS + CALLS);
  while (i < routes.count && memcmp(routes.all[i].calls, calls + OURS, sizeof routes.all[i].calls) != 0) ++i;
  assert_true(i < MOST_ROUTES);
  if (i == routes.count) {
    memcpy(routes.all[i].calls, calls + OURS, sizeof routes.all[i].calls);
    routes.all[i].first = routes.next;
    ++routes.count;
  }
  ++routes.next;
}

static __attribute__((noinline)) int fails(void) {
  if (routes.listing) note_route();
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

/* Whether code is of the library that hides OpenImageIO. */
static int is_of_files(void *code) {
  static uintptr_t begin, size;
  Dl_info info;
  if (!size && dladdr(code, &info) && strstr(info.dli_fname, "deepshadow_files")) {
    struct stat file;
    begin = (uintptr_t)info.dli_fbase;
    size = stat(info.dli_fname, &file) == 0 ? (uintptr_t)file.st_size : 0;   /* its code is loaded as it lies in the file */
  }
  return (uintptr_t)code - begin < size;
}

void *new_block(size_t size, void *caller);

void *new_block(size_t size, void *caller) {
  if (!is_of_files(caller)) return __real_malloc(size ? size : 1);
  ++memory.in_files;
  return fails() ? NULL : counted(__real_malloc(size ? size : 1));
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
  uint64_t evicted;
} answers;

/* All over the map, so that several tiles are asked. */
static dsm_receiver place(int i) {
  double x = -1.9 + 3.8 * (i % SIDE) / (SIDE - 1), y = -1.9 + 3.8 * (i / SIDE) / (SIDE - 1);
  dsm_receiver r = {.point = {x, y, 4.5}, .has_footprint = i % 2 != 0, .footprint = {{0.3, 0, 0}, {0, 0.2, 0}}};
  return r;
}

/* Goes on behind a failure for as many points. */
enum { GO_ON = 3 };

static void ask(dsm_worker *worker, int stride, answers *a) {
  int left = GO_ON;
  for (int i = 0; i < SIDE * SIDE && left > 0; i += stride) {
    left -= memory.failed && !memory.for_good;
    dsm_receiver r = place(i);
    dsm_result result = dsm_api.lookup(worker, &r, a->light[i]);
    a->known[i] = result == DSM_OK || result == DSM_OUTSIDE;
    assert_true(a->known[i] || result == DSM_TRACE || result == DSM_NO_MEMORY);
  }
}

/* Maps to make. With `accuracy`, a small one; and one of few tiles on two levels that are baked, and on some that are averages, whose life
 * has too many allocations to refuse each. */
typedef enum { DEEP, ACCURATE, WIDE, DEPTHS, KINDS } kind;
static int has_accuracy(kind k) { return k == ACCURATE || k == WIDE; }

static void set_word(dsm_settings *settings, uint32_t block, const char *word, const double *numbers, uint32_t count) {
  char why[200];
  uint32_t row = 0;
  while (strcmp(dsm_api.blocks[block].parameters[row].name, word) != 0) ++row;
  assert_int_equal(dsm_api.settings_set(settings, row, NULL, numbers, count, why, sizeof why), DSM_OK);
}

typedef enum { ON_DEMAND, SAVED, LOADED } way;

static dsm_settings *settings_for(kind k, way how, double cache) {
  uint32_t block = k == DEPTHS;
  dsm_settings *settings = dsm_api.settings_create(block);
  if (!settings) return NULL;
  set_word(settings, block, "cache", &cache, 1);
  set_word(settings, block, "samples", &(double){has_accuracy(k) ? 16 : 4}, 1);
  if (has_accuracy(k)) {
    set_word(settings, block, "accuracy", &(double){0.002}, 1);
    set_word(settings, block, "resolution", (double[]){k == WIDE ? 130 : 66, 18}, 2);
  } else {
    set_word(settings, block, "resolution", &(double){how == ON_DEMAND ? 22 : 20}, 1);
  }
  return settings;
}

/* Of so many points one is asked, with and without footprints in turn: of all, where that leads to few allocations. */
static int stride_of(kind k, double cache) { return k == DEPTHS || (k == DEEP && cache > 1) ? 1 : k == WIDE || cache > 1 ? 3 : k == DEEP ? 7 : 9; }

static dsm_result work(dsm_worker *worker, way how, int stride, answers *a) {
  double share;
  dsm_result result = DSM_OK;
  if (how == LOADED) result = dsm_api.load(worker, path);
  if (how == SAVED) {
    result = dsm_api.save_begin(worker, path);
    while (result == DSM_OK) result = dsm_api.bake_next(worker, &share);
    if (result == DSM_DONE) result = dsm_api.save_end(worker, NULL);
  }
  if (result == DSM_OK) ask(worker, stride, a);
  return result;
}

/* A map's whole life. What cannot be made is left out, as a host would. */
static void live(kind k, way how, double cache, answers *a) {
  world w = {.shapes = shapes, .count = SHAPES};
  dsm_host host = host_of(&w);
  dsm_light light = spot_at(0, 0, 0, 0, 0, 1, 30);
  dsm_map *map = NULL;
  dsm_worker *worker = NULL;
  light.casters = boxes;
  light.caster_count = SHAPES;
  dsm_settings *settings = settings_for(k, how, cache);
  dsm_result result = settings ? dsm_api.map_create(&host, &light, settings, &map) : DSM_NO_MEMORY;
  if (result == DSM_OK) result = dsm_api.worker_create(map, &w, &worker);
  if (result == DSM_OK) result = work(worker, how, stride_of(k, cache), a);
  assert_true(result == DSM_OK || result == DSM_NO_MEMORY || result == DSM_REFUSED || (how == SAVED && result == DSM_TRACE));
  if (how == LOADED && strstr(w.last, "damaged")) fail_msg("of a file that is whole: %s", w.last);
  if (map) {
    dsm_statistics statistics = {.size = sizeof statistics};
    dsm_api.statistics(map, &statistics);
    a->evicted = statistics.tiles_evicted;
  }
  dsm_api.worker_destroy(worker);
  dsm_api.map_destroy(map);
  dsm_api.settings_destroy(settings);
}

/* Where a coarse tile has failed, a finer one answers: the same light, averaged over less. */
static int is_right(kind k, int i, const double light[3], const double truth[3]) {
  if (!has_accuracy(k) && !place(i).has_footprint) return memcmp(light, truth, 3 * sizeof *light) == 0;
  for (int c = 0; c < 3; ++c)
    if (!(fabs(light[c] - truth[c]) < 0.1)) return 0;
  return 1;
}

static void check(kind k, const answers *a, const answers *truth, const char *when) {
  for (int i = 0; i < SIDE * SIDE; ++i)
    if (a->known[i] && !is_right(k, i, a->light[i], truth->light[i]))
      fail_msg("%s: point %d gets %.9g and not %.9g", when, i, a->light[i][0], truth->light[i][0]);
}

/* Nothing fails; lists on what routes allocations come. */
static void live_and_list(kind k, way how, double cache, answers *a) {
  routes.next = 0;
  routes.listing = 1;
  live(k, how, cache, a);
  routes.listing = 0;
}

static void fail_at(kind k, way how, double cache, const answers *truth, long n, int for_good) {
  answers a = {.known = {0}};
  int before = memory.live;
  memory.for_good = for_good;
  memory.left = n;
  live(k, how, cache, &a);
  memory.left = -1;
  assert_true(memory.failed);
  memory.failed = 0;
  if (memory.live != before) fail_msg("allocation %ld: %d blocks leak", n, memory.live - before);
  check(k, &a, truth, for_good ? "failed for good" : "failed once");
}

static long most_others(void) {
  const char *most = getenv("DSM_MOST_CASES");
  return most ? atol(most) : 1000000;
}

/* Each allocation of a life, and all from the first on each route on that no life before has had. */
static void fail_each(kind k, way how, double cache, const answers *truth) {
  answers same = {.known = {0}};
  int ways = 0;
  live_and_list(k, how, cache, &same);
  check(k, &same, truth, "without a failure");
  if (cache < 1) assert_true(same.evicted > 0);
  long count = routes.next, step = k == WIDE ? count : 1 + count / most_others(), tried = 0;
  for (long n = 0; n < count; n += step, ++tried) fail_at(k, how, cache, truth, n, 0);
  for (int i = 0; i < routes.count; ++i) {
    route *r = &routes.all[i];
    if (r->done) continue;
    r->done = 1;
    if (ways++ % (1 + routes.count / most_others()) != 0) continue;
    if (step > 1) fail_at(k, how, cache, truth, r->first, 0);
    fail_at(k, how, cache, truth, r->first, 1);
  }
  print_message("map %d, way %d, cache %g: %ld of %ld allocations, %d new routes\n", k, how, cache, tried, count, ways);
}

static void allocations_fail(void **state) {
  (void)state;
  for (kind k = DEEP; k < KINDS; ++k) {
    answers truth = {.known = {0}};
    live(k, ON_DEMAND, 1024, &truth);
    for (int i = 0; i < SIDE * SIDE; i += stride_of(k, 1024)) assert_true(truth.known[i]);
    fail_each(k, ON_DEMAND, 1024, &truth);
    fail_each(k, ON_DEMAND, 0.001, &truth);   /* tiles come and go */
  }
}

static void allocations_fail_with_files(void **state) {
  (void)state;
  assert_non_null(mkdtemp(folder));
  snprintf(path, sizeof path, "%s/map.exr", folder);
  for (kind k = DEEP; k < KINDS; ++k) {
    if (has_accuracy(k)) continue;   /* such a map is only as fine as what has been asked of it */
    answers truth = {.known = {0}};
    live(k, SAVED, 1024, &truth);
    for (int i = 0; i < SIDE * SIDE; i += stride_of(k, 1024)) assert_true(truth.known[i]);
    fail_each(k, LOADED, 1024, &truth);
    fail_each(k, SAVED, 0.001, &truth);
    unlink(path);
  }
  assert_int_equal(rmdir(folder), 0);   /* nothing else is left behind */
  assert_true(memory.in_files > 0 || getenv("DSM_MOST_CASES"));   /* valgrind has an operator new of its own */
}

int main(void) {
  fill_scene();
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(allocations_fail),
    cmocka_unit_test(allocations_fail_with_files),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
