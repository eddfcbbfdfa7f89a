/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Saving and loading as a renderer does it, with scenes of known shapes. */
#define _XOPEN_SOURCE 700   /* mkdtemp */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "../oracle/oracle.h"
#include "made_map.h"
#include "store/saved_map.h"

enum { MOST_SHAPES = 12 };

/* Two spheres, coloured glass, fog, and a light in front of or among them. */
static int make_scene(int coloured, shape shapes[MOST_SHAPES]) {
  int n = 0;
  shapes[n++] = sphere_at(0, 0, 5, 0.8, 0);
  shapes[n++] = sphere_at(0.7, -0.4, 4, 0.4, 0.5);
  shapes[n++] = fog_in((dsm_box){{-1.5, -1.5, 3}, {1, 1, 6}}, 0.5, 0.5, 0.5, 0.3);
  if (coloured) shapes[n++] = sheet_at(6.5, 1, 0.9, 0.5, 0.2);
  return n;
}

static const char *const words[] = {"resolution 64", "samples 4", NULL};

static dsm_light light_of_kind(int kind) {
  return kind == 0 ? spot_at(0, 0, -3, 0, 0, 1, 30) : kind == 1 ? point_at(-0.8, 0.6, 3.6) : parallel_at(0, 0, -2, 0.1, 0, 1);
}

static void bake_all(stage *s) {
  double share = -1, last = 0;
  dsm_result result;
  while ((result = dsm_api.bake_next(s->worker, &share)) == DSM_OK) {
    assert_true(share >= last && share <= 1);
    last = share;
  }
  assert_int_equal(result, DSM_DONE);
}

static int told_shares;
static double last_share;

static void take_share(void *data, double share) {
  (void)data;
  assert_true(share >= last_share && share <= 1);
  last_share = share;
  ++told_shares;
}

static void save(stage *s, const char *path) {
  if (dsm_api.save_begin(s->worker, path) != DSM_OK) fail_msg("%s", s->w.last);
  bake_all(s);
  told_shares = 0;
  last_share = 0;
  if (dsm_api.save_end(s->worker, take_share) != DSM_OK) fail_msg("%s", s->w.last);
  assert_true(told_shares > 0);
}

/* A file of the scene under the first light. */
static void save_scene(const shape *shapes, int count, const char *path) {
  stage s;
  stage_open(&s, shapes, count, light_of_kind(0), words);
  save(&s, path);
  stage_close(&s);
}

static dsm_receiver somewhere(rng *r) {
  dsm_receiver receiver = {.point = {rng_between(r, -2, 2), rng_between(r, -2, 2), rng_between(r, 2, 9)}};
  receiver.plane_count = rng_below(r, 2);
  receiver.planes[0] = (dsm_plane){{0, 0, -1}, 0};
  receiver.has_footprint = rng_below(r, 2);
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 3; ++k) receiver.footprint[i][k] = rng_below(r, 2) ? 0 : rng_between(r, -0.2, 0.2);
  return receiver;
}

/* Every look-up has the same bits, or the same refusal. */
static void assert_same_answers(stage *a, stage *b, uint64_t seed) {
  rng r = rng_seeded(seed);
  for (uint64_t i = 0; i < most_cases(4000); ++i) {
    dsm_receiver receiver = somewhere(&r);
    double x[3] = {-1, -1, -1}, y[3] = {-1, -1, -1};
    dsm_result one = dsm_api.lookup(a->worker, &receiver, x), two = dsm_api.lookup(b->worker, &receiver, y);
    assert_seeded(&r, one == two && memcmp(x, y, sizeof x) == 0);
  }
}

static void a_loaded_map_answers_alike(void **state) {
  (void)state;
  for (int kind = 0; kind < 3; ++kind)
    for (int coloured = 0; coloured < 2; ++coloured) {
      shape shapes[MOST_SHAPES];
      int count = make_scene(coloured, shapes);
      const char *path = made_path("map.exr");
      stage baked, saved, loaded;
      stage_open(&baked, shapes, count, light_of_kind(kind), words);   /* has nothing to do with files */
      stage_open(&saved, shapes, count, light_of_kind(kind), words);
      save(&saved, path);
      stage_open(&loaded, shapes, count, light_of_kind(kind), words);
      if (dsm_api.load(loaded.worker, path) != DSM_OK) fail_msg("%s", loaded.w.last);
      loaded.w.fail_with = DSM_NO_MEMORY;   /* not a ray more */
      assert_same_answers(&baked, &loaded, 1);
      assert_same_answers(&saved, &loaded, 2);
      dsm_statistics s = {.size = sizeof s};
      dsm_api.statistics(loaded.map, &s);
      assert_true(s.tiles_read > 0 && s.tiles_baked == 0 && s.tiles_failed == 0);
      for (uint64_t i = 0; i < saved.map->store.tile_count; ++i) {   /* what no look-up has met, too */
        tile_key key = tile_store_key(&saved.map->store, i);
        const tile *x, *y;
        worker_enter(saved.worker);
        worker_enter(loaded.worker);
        assert_int_equal(worker_tile(saved.worker, &key, &x), DSM_OK);
        assert_int_equal(worker_tile(loaded.worker, &key, &y), DSM_OK);
        assert_true(same_tiles(x, y));
        worker_leave(loaded.worker);
        worker_leave(saved.worker);
      }
      stage_close(&loaded);
      stage_close(&saved);
      stage_close(&baked);
      assert_int_equal(made_folder_files(1), 1);
    }
}

/* With next to no cache tiles are evicted all the time: while saving they are baked again, afterwards read. */
static void a_small_cache_saves_the_same(void **state) {
  (void)state;
  static const char *const tight[] = {"resolution 64", "samples 4", "cache 0.01", NULL};
  shape shapes[MOST_SHAPES];
  int count = make_scene(1, shapes);
  stage roomy, small;
  stage_open(&roomy, shapes, count, light_of_kind(0), words);
  stage_open(&small, shapes, count, light_of_kind(0), tight);
  save(&roomy, made_path("roomy.exr"));
  save(&small, made_path("small.exr"));
  size_t sizes[2];
  unsigned char *bytes[2];
  for (int i = 0; i < 2; ++i) {
    FILE *f = fopen(made_path(i ? "small.exr" : "roomy.exr"), "rb");
    assert_non_null(f);
    fseek(f, 0, SEEK_END);
    sizes[i] = (size_t)ftell(f);
    rewind(f);
    bytes[i] = malloc(sizes[i]);
    assert_int_equal(fread(bytes[i], 1, sizes[i], f), sizes[i]);
    fclose(f);
  }
  assert_true(sizes[0] == sizes[1] && memcmp(bytes[0], bytes[1], sizes[0]) == 0);
  free(bytes[0]);
  free(bytes[1]);
  small.w.fail_with = DSM_NO_MEMORY;   /* not a ray more */
  assert_same_answers(&roomy, &small, 3);
  dsm_statistics s = {.size = sizeof s};
  dsm_api.statistics(small.map, &s);
  assert_true(s.tiles_evicted > 0 && s.tiles_read > 0 && s.tiles_failed == 0);
  stage_close(&small);
  stage_close(&roomy);
  made_folder_files(1);
}

/* Loads a file into a map of its own, which must be refused with a sentence that says so, and then still bakes. */
static void assert_not_loaded(const char *path, const shape *shapes, int count, dsm_light light, const char *const *settings,
                              const char *says) {
  stage s;
  stage_open(&s, shapes, count, light, settings);
  dsm_result result = dsm_api.load(s.worker, path);
  if (result != DSM_REFUSED) fail_msg("load: %d, but should say: %s", (int)result, says);
  if (!strstr(s.w.last, says) || !strstr(s.w.last, path)) fail_msg("\"%s\" does not say: %s", s.w.last, says);
  assert_int_equal(s.w.sentences, 1);
  assert_int_equal(s.w.last[strlen(s.w.last) - 1], '.');
  light_of(&s, in_air(0, 0, 8), 0);
  stage_close(&s);
}

static void a_stale_map_is_refused(void **state) {
  (void)state;
  shape shapes[MOST_SHAPES];
  int count = make_scene(0, shapes);
  const char *path = made_path("map.exr");
  save_scene(shapes, count, path);

  assert_not_loaded(path, shapes, count, light_of_kind(2), words, "of a spotlight, and this is a parallel light");
  assert_not_loaded(path, shapes, count, spot_at(0, 0, -3.5, 0, 0, 1, 30), words, "its origin was <0, 0, -3>, and is <0, 0, -3.5>");
  assert_not_loaded(path, shapes, count, spot_at(0, 0, -3, 0, 0.01, 1, 30), words, "its direction was <0, 0, 1>");
  assert_not_loaded(path, shapes, count, spot_at(0, 0, -3, 0, 0, 1, 31), words, "half angle in degrees was 30, and is 31");

  static const struct { const char *word, *says; } settings[] = {
    {"resolution 65", "'resolution' was 64, and is 65"}, {"resolution 64 64", "'resolution' was 64, and is <64, 64>"},
    {"samples 5", "'samples' was 4, and is 5"}, {"tolerance 0.01", "'tolerance' was automatic, and is 0.01"},
    {"filter triangle", "'filter' was \"box\", 1, and is \"triangle\", 2"}, {"filter box 2", "'filter' was \"box\", 1, and is \"box\", 2"},
    {"bounds -9 -9 0 9 9 9", "'bounds' was none, and is <-9, -9, 0>, <9, 9, 9>"},
  };
  for (size_t i = 0; i < sizeof settings / sizeof *settings; ++i)
    assert_not_loaded(path, shapes, count, light_of_kind(0), (const char *const[]){words[0], words[1], settings[i].word, NULL},
                      settings[i].says);

  shapes[1] = sphere_at(0.7, -0.4, 4.001, 0.4, 0.5);   /* moved */
  assert_not_loaded(path, shapes, count, light_of_kind(0), words, "objects that cast shadows are not where they were");
  make_scene(0, shapes);
  shapes[1].pass[0] = 0.51;                            /* as it was, but of another colour */
  assert_not_loaded(path, shapes, count, light_of_kind(0), words, "light rays meet something else");
  make_scene(0, shapes);
  assert_not_loaded(path, shapes, count - 1, light_of_kind(0), words, "objects that cast shadows");
  made_folder_files(1);
}

/* What does not change the pixels may change. */
static void other_settings_do_not_matter(void **state) {
  (void)state;
  shape shapes[MOST_SHAPES];
  int count = make_scene(0, shapes);
  const char *path = made_path("map.exr");
  stage s;
  save_scene(shapes, count, path);
  static const char *const free_words[] = {"bias 0.1", "blur 0.05", "cache 2"};
  for (size_t i = 0; i < 3; ++i) {
    stage_open(&s, shapes, count, light_of_kind(0), (const char *const[]){words[0], words[1], free_words[i], NULL});
    if (dsm_api.load(s.worker, path) != DSM_OK) fail_msg("%s: %s", free_words[i], s.w.last);
    stage_close(&s);
  }
  made_folder_files(1);
}

/* A map of several scenes, as merging makes it, belongs to each of them. */
static void any_of_its_scenes_will_do(void **state) {
  (void)state;
  map_header wanted, file;
  rng r = rng_seeded(1);
  file = random_header(&r, 1, 20, 0);
  free(file.scenes);
  file.scene_count = 3;
  file.scenes = calloc(3, sizeof *file.scenes);
  for (int i = 0; i < 3; ++i) {
    random_print(&r, file.scenes[i].casters);
    random_print(&r, file.scenes[i].probes);
  }
  char text[MAP_REASON_SIZE];
  map_reason why = {text, sizeof text};
  scene_print scene;
  wanted = file;
  wanted.scene_count = 1;
  wanted.scenes = &scene;
  for (int i = 0; i < 3; ++i) {
    scene = file.scenes[i];
    assert_int_equal(map_header_compare(&wanted, &file, "x", &why), DSM_OK);
    memcpy(scene.probes, file.scenes[(i + 1) % 3].probes, DIGEST_CHARS);   /* of another one of them */
    assert_int_equal(map_header_compare(&wanted, &file, "x", &why), DSM_REFUSED);
    assert_non_null(strstr(text, "light rays meet something else"));
  }
  map_header_free(&file);
}

static void accuracy_has_no_file(void **state) {
  (void)state;
  shape shapes[MOST_SHAPES];
  int count = make_scene(0, shapes);
  const char *path = made_path("map.exr");
  stage s;
  save_scene(shapes, count, path);
  stage_open(&s, shapes, count, light_of_kind(0), (const char *const[]){"accuracy 0.02", NULL});
  assert_int_equal(dsm_api.load(s.worker, path), DSM_REFUSED);
  assert_non_null(strstr(s.w.last, "with accuracy can be neither saved nor loaded"));
  assert_int_equal(dsm_api.save_begin(s.worker, made_path("other.exr")), DSM_REFUSED);
  assert_int_equal(s.w.sentences, 2);
  light_of(&s, in_air(0, 0, 8), 0);   /* it still bakes */
  stage_close(&s);
  assert_int_equal(made_folder_files(1), 1);
}

static void files_that_are_no_maps(void **state) {
  (void)state;
  shape shapes[MOST_SHAPES];
  int count = make_scene(0, shapes);
  FILE *f = fopen(made_path("text.exr"), "w");
  fputs("no map", f);
  fclose(f);
  assert_not_loaded(made_path("none.exr"), shapes, count, light_of_kind(0), words, "There is no shadow map");
  assert_not_loaded(made_path("text.exr"), shapes, count, light_of_kind(0), words, "is not an OpenEXR file");
  made_folder_files(1);
}

/* Damage that shows only when a tile is read: its points are left to the ray tracer, the host is told once. */
static void a_damaged_tile_is_ray_traced(void **state) {
  (void)state;
  shape shapes[MOST_SHAPES];
  int count = make_scene(0, shapes);
  const char *path = made_path("map.exr");
  stage s, whole;
  stage_open(&whole, shapes, count, light_of_kind(0), words);
  save(&whole, path);
  stage_open(&s, shapes, count, light_of_kind(0), words);
  assert_int_equal(dsm_api.load(s.worker, path), DSM_OK);
  FILE *f = fopen(path, "r+b");   /* behind its back */
  fseek(f, 0, SEEK_END);
  long size = ftell(f);
  for (long at = size / 4; at < size; at += 50) {
    fseek(f, at, SEEK_SET);
    fputc(0x55, f);
  }
  fclose(f);
  rng r = rng_seeded(4);
  int traced = 0;
  for (int i = 0; i < 4000; ++i) {
    dsm_receiver receiver = somewhere(&r);
    receiver.has_footprint = 0;   /* or a narrower one would do, see lookup.c */
    double x[3] = {-1, -1, -1}, y[3] = {-1, -1, -1};
    dsm_result one = dsm_api.lookup(whole.worker, &receiver, x), two = dsm_api.lookup(s.worker, &receiver, y);
    if (two == DSM_TRACE && one != DSM_TRACE) ++traced;
    else assert_seeded(&r, one == two && memcmp(x, y, sizeof x) == 0);
  }
  assert_true(traced > 0);
  assert_int_equal(s.w.sentences, 1);
  assert_non_null(strstr(s.w.last, "is damaged at tile"));
  assert_non_null(strstr(s.w.last, "ray-traced."));
  stage_close(&s);
  stage_close(&whole);
  made_folder_files(1);
}

static void saving_can_fail_early(void **state) {
  (void)state;
  shape shapes[MOST_SHAPES];
  int count = make_scene(0, shapes);
  stage s;
  stage_open(&s, shapes, count, light_of_kind(0), words);
  assert_int_equal(dsm_api.save_begin(s.worker, made_path("no/map.exr")), DSM_REFUSED);
  assert_non_null(strstr(s.w.last, "cannot be written"));
  assert_int_equal(dsm_api.save_end(s.worker, NULL), DSM_INVALID);
  s.w.stop = 1;
  assert_int_equal(dsm_api.save_begin(s.worker, made_path("map.exr")), DSM_CANCELLED);
  s.w.stop = 0;
  s.w.fail_with = DSM_NO_MEMORY;
  assert_int_equal(dsm_api.save_begin(s.worker, made_path("map.exr")), DSM_NO_MEMORY);
  stage_close(&s);
  assert_int_equal(made_folder_files(0), 0);
}

/* A bake that is stopped, or that has failed somewhere, leaves no file, or the one that was there. */
static void an_unfinished_map_is_not_saved(void **state) {
  (void)state;
  shape shapes[MOST_SHAPES];
  int count = make_scene(0, shapes);
  stage s;
  double share;
  stage_open(&s, shapes, count, light_of_kind(0), words);
  assert_int_equal(dsm_api.save_begin(s.worker, made_path("map.exr")), DSM_OK);
  assert_int_equal(dsm_api.bake_next(s.worker, &share), DSM_OK);
  stage_close(&s);
  assert_int_equal(made_folder_files(0), 0);

  stage_open(&s, shapes, count, light_of_kind(0), words);
  assert_int_equal(dsm_api.save_begin(s.worker, made_path("map.exr")), DSM_OK);
  s.w.fail_with = DSM_NO_MEMORY;
  dsm_api.bake_next(s.worker, &share);
  s.w.fail_with = DSM_OK;
  bake_all(&s);
  assert_int_equal(dsm_api.save_end(s.worker, NULL), DSM_REFUSED);
  assert_non_null(strstr(s.w.last, "could not be baked"));
  stage_close(&s);
  assert_int_equal(made_folder_files(0), 0);

  stage_open(&s, shapes, count, light_of_kind(0), words);
  assert_int_equal(dsm_api.save_begin(s.worker, made_path("map.exr")), DSM_OK);
  bake_all(&s);
  s.w.stop = 1;
  assert_int_equal(dsm_api.save_end(s.worker, NULL), DSM_CANCELLED);
  assert_int_equal(made_folder_files(0), 0);
  s.w.stop = 0;
  assert_int_equal(dsm_api.save_end(s.worker, NULL), DSM_OK);   /* later then */
  assert_int_equal(made_folder_files(1), 1);
  stage_close(&s);
}

/* No casters, no tiles, and still a file. */
static void a_map_of_nothing(void **state) {
  (void)state;
  const char *path = made_path("map.exr");
  for (int load = 0; load < 2; ++load) {
    stage s;
    stage_open(&s, NULL, 0, light_of_kind(0), words);
    if (load) assert_int_equal(dsm_api.load(s.worker, path), DSM_OK);
    else if (dsm_api.save_begin(s.worker, path) != DSM_OK || (bake_all(&s), dsm_api.save_end(s.worker, NULL)) != DSM_OK)
      fail_msg("%s", s.w.last);
    assert_true(light_of(&s, in_air(0, 0, 5), 0) == 1);
    stage_close(&s);
  }
  made_folder_files(1);
}

/* A tool has the file and nothing else. */
static void a_tool_needs_no_scene(void **state) {
  (void)state;
  shape shapes[MOST_SHAPES];
  int count = make_scene(1, shapes);
  const char *path = made_path("map.exr");
  stage s, tool;
  stage_open(&s, shapes, count, light_of_kind(1), words);
  save(&s, path);
  memset(&tool, 0, sizeof tool);
  map_header header;
  char text[MAP_REASON_SIZE];
  map_reason why = {text, sizeof text};
  dsm_host host = host_of(&tool.w);
  host.trace = NULL;
  if (saved_map_open(path, &host, &header, &tool.map, &why) != DSM_OK) fail_msg("%s", text);
  assert_int_equal(worker_create(tool.map, &tool.w, NULL, &tool.worker), DSM_OK);
  assert_true(header.coloured && header.vertices > 0 && header.samples == 4);
  assert_same_answers(&s, &tool, 5);
  worker_destroy(tool.worker);
  map_destroy(tool.map);
  map_header_free(&header);
  stage_close(&s);
  assert_int_equal(saved_map_open(made_path("gone.exr"), &host, &header, &tool.map, &why), DSM_REFUSED);
  assert_null(tool.map);
  made_folder_files(1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_loaded_map_answers_alike),
    cmocka_unit_test(a_small_cache_saves_the_same),
    cmocka_unit_test(a_stale_map_is_refused),
    cmocka_unit_test(other_settings_do_not_matter),
    cmocka_unit_test(any_of_its_scenes_will_do),
    cmocka_unit_test(accuracy_has_no_file),
    cmocka_unit_test(files_that_are_no_maps),
    cmocka_unit_test(a_damaged_tile_is_ray_traced),
    cmocka_unit_test(saving_can_fail_early),
    cmocka_unit_test(an_unfinished_map_is_not_saved),
    cmocka_unit_test(a_map_of_nothing),
    cmocka_unit_test(a_tool_needs_no_scene),
  };
  return cmocka_run_group_tests(tests, made_folder_open, made_folder_close);
}
