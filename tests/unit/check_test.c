/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Maps whose checksums are right, but not what they hold. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "plain_tile.h"
#include "store/map_file.h"
#include "tool/command.h"

enum { SIDE = 20, PLACE = 2 * TILE_SIDE + 3 };   /* pixels of the face; the pixel that is spoilt */

/* One face of 2 x 2 tiles. */
static map_header small_header(scene_print *scene) {
  map_header h;
  memset(&h, 0, sizeof h);
  memset(scene, '0', sizeof *scene);
  scene->casters[DIGEST_CHARS - 1] = scene->probes[DIGEST_CHARS - 1] = 0;
  h.light = (dsm_light){.size = sizeof h.light, .kind = DSM_LIGHT_PARALLEL, .direction = {0, 0, 1}};
  h.projection.count = 1;
  h.projection.axes = frame_along(h.light.direction);
  h.projection.faces[0] = (face){.axes = h.projection.axes, .pixel_u = 1, .pixel_v = 1, .per_u = 1, .per_v = 1,
                                 .near_depth = 4, .far_depth = 8, .width = SIDE, .height = SIDE};
  h.resolution[0] = SIDE;
  h.samples = 16;
  h.filter_width = 1;
  h.tolerance = 0.01;
  h.scene_count = 1;
  h.scenes = scene;
  return h;
}

typedef struct {
  tile *tiles[2];        /* that at the lower left corner of level 0, and that at the upper right */
} content;

/* Three vertices in the pixel that is to be spoilt; in the other tile, of which only 4 x 4 pixels are on the face, one in
 * another pixel. */
static void make_content(content *c) {
  tile_plan plan = {.count = {0}};
  memset(&plan, 0, sizeof plan);
  plan.count[PLACE] = 3;
  c->tiles[0] = tile_create(&plan);
  assert_non_null(c->tiles[0]);
  c->tiles[0]->near_depth = 5;
  static const float depths[] = {0, 1, 2};
  static const uint16_t values[] = {65535, 30000, 10000};
  for (uint32_t k = 0; k < 3; ++k) tile_put(c->tiles[0], PLACE, k, 0, depths[k], values[k]);
  memset(&plan, 0, sizeof plan);
  plan.count[0] = 1;
  c->tiles[1] = tile_create(&plan);
  assert_non_null(c->tiles[1]);
  c->tiles[1]->near_depth = 6;
}

static void free_content(content *c) {
  tile_destroy(c->tiles[0]);
  tile_destroy(c->tiles[1]);
}

static dsm_result give(void *data, const tile_key *key, const tile **out) {
  const content *c = data;
  *out = &tile_lit;
  if (key->level == 0 && key->x == key->y) *out = c->tiles[key->x];
  return DSM_OK;
}

static void flip_byte(const char *path, double share) {
  FILE *f = fopen(path, "r+b");
  assert_non_null(f);
  assert_int_equal(fseek(f, 0, SEEK_END), 0);
  long at = (long)(share * (double)ftell(f));
  assert_int_equal(fseek(f, at, SEEK_SET), 0);
  int was = fgetc(f);
  assert_int_equal(fseek(f, at, SEEK_SET), 0);
  assert_true(was != EOF && fputc(was ^ 0x55, f) != EOF);
  assert_int_equal(fclose(f), 0);
}

/* Writes the map, checks it, and returns the exit status; `said` is what was printed to the error output. `flipped`: how far
 * behind the file's beginning a byte is damaged before, as a share of its size; or -1. */
static int check(content *c, char *said, size_t size, double flipped) {
  char path[] = "check_test_XXXXXX", log[] = "check_log_XXXXXX", name[] = "dsmtool check", text[MAP_REASON_SIZE] = "";
  char *words[] = {name, path, NULL};
  map_reason why = {text, sizeof text};
  scene_print scene;
  map_header header = small_header(&scene);
  int map = mkstemp(path), errors = mkstemp(log), before = dup(STDERR_FILENO);
  assert_true(map >= 0 && errors >= 0 && before >= 0);
  close(map);
  if (map_file_write(path, &header, give, c, NULL, &why) != DSM_OK) fail_msg("%s", text);
  if (flipped >= 0) flip_byte(path, flipped);
  fflush(stderr);
  dup2(errors, STDERR_FILENO);
  int status = check_run(2, words);
  fflush(stderr);
  dup2(before, STDERR_FILENO);
  ssize_t got = pread(errors, said, size - 1, 0);
  said[got > 0 ? got : 0] = 0;
  close(errors);
  close(before);
  unlink(path);
  unlink(log);
  return status;
}

static void a_good_map(void **state) {
  (void)state;
  content c;
  char said[2000];
  make_content(&c);
  assert_int_equal(check(&c, said, sizeof said, -1), STATUS_FINE);
  assert_string_equal(said, "");
  free_content(&c);
}

static void expect(content *c, const char *sentence) {
  char said[4000];
  int status = check(c, said, sizeof said, -1);
  if (status != STATUS_TROUBLE || !strstr(said, sentence)) fail_msg("status %d, wanted '%s', said '%s'", status, sentence, said);
  assert_non_null(strstr(said, "is damaged: 1 of "));
  free_content(c);
}

/* The pixel's row is counted from the top. */
#define SPOILT "pixel 3, 17 of face 0, level 0 "

static void what_is_wrong_with_a_pixel(void **state) {
  (void)state;
  content c;
  make_content(&c);
  tile_put(c.tiles[0], PLACE, 2, 0, 3.25f, 10000);
  expect(&c, SPOILT "has a depth behind the casters.");
  make_content(&c);
  tile_put(c.tiles[0], PLACE, 1, 0, 0, 30000);
  tile_put(c.tiles[0], PLACE, 2, 0, 0, 10000);
  expect(&c, SPOILT "has three vertices at one depth.");
  make_content(&c);
  c.tiles[0]->near_depth = 3;
  expect(&c, SPOILT "has a depth in front of the casters.");
}

/* Whatever is damaged in the file is a tile that is named, or the whole map. */
static void a_damaged_tile_is_named(void **state) {
  (void)state;
  content c;
  char said[4000];
  int named = 0;
  make_content(&c);
  for (int i = 0; i < 60; ++i) {
    if (check(&c, said, sizeof said, 0.3 + 0.0116 * i) == STATUS_FINE) continue;
    assert_true(strstr(said, "is damaged") || strstr(said, "is not a shadow map"));
    named += strstr(said, "is damaged at tile 0, 0 of level 0 of face 0") != NULL;
  }
  assert_true(named > 0);
  free_content(&c);
}

static void nothing_lies_outside_a_face(void **state) {
  (void)state;
  content c;
  make_content(&c);
  tile_destroy(c.tiles[1]);
  tile_plan plan = {.count = {0}};
  memset(&plan, 0, sizeof plan);
  plan.count[TILE_PIXELS - 1] = 1;
  c.tiles[1] = tile_create(&plan);
  assert_non_null(c.tiles[1]);
  c.tiles[1]->near_depth = 6;
  expect(&c, "stores something, but lies outside the face.");
}

int main(void) {
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_good_map),
    cmocka_unit_test(what_is_wrong_with_a_pixel),
    cmocka_unit_test(a_damaged_tile_is_named),
    cmocka_unit_test(nothing_lies_outside_a_face),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
