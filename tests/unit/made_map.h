/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Maps with random tiles, for the tests of files, and a folder to write them to. Include after cmocka.h. */
#ifndef TESTS_MADE_MAP_H
#define TESTS_MADE_MAP_H

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "map/depth_tile.h"
#include "made_tile.h"
#include "store/map_file.h"
#include "store/map_parts.h"

/* What a made map holds, where `coloured` is asked for: two kinds of deep map, and one of depths. */
enum { MADE_GREY, MADE_COLOURED, MADE_DEPTHS };

typedef struct {
  map_header header;
  map_parts parts;
  const tile **tiles;
  uint64_t fail_at;         /* number of a tile that is not given */
  dsm_result fail_with;
} made_map;

/* A folder of its own, gone at the end. */
static char made_folder[200];

static inline const char *made_path(const char *name) {
  static char paths[8][600];
  static int next;
  char *path = paths[next++ % 8];
  snprintf(path, sizeof paths[0], "%s/%s", made_folder, name);
  return path;
}

static inline int made_folder_open(void **state) {
  (void)state;
  const char *place = getenv("TMPDIR");
  snprintf(made_folder, sizeof made_folder, "%s/dsm_test.XXXXXX", place ? place : "/tmp");
  return mkdtemp(made_folder) ? 0 : -1;
}

/* How many files there are; removes them if asked to. */
static inline int made_folder_files(int remove_them) {
  DIR *folder = opendir(made_folder);
  assert_non_null(folder);
  int count = 0;
  for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
    if (entry->d_name[0] == '.') continue;
    ++count;
    if (remove_them) remove(made_path(entry->d_name));
  }
  closedir(folder);
  return count;
}

static inline int made_folder_close(void **state) {
  (void)state;
  made_folder_files(1);
  return rmdir(made_folder);
}

static inline void random_numbers(rng *r, double *out, int count) {
  for (int i = 0; i < count; ++i) out[i] = (rng_below(r, 2) ? 1 : -1) * rng_scale(r, 1e-12, 1e12);
}

static inline frame random_axes(rng *r) {
  frame f;
  random_numbers(r, f.right, 3);
  random_numbers(r, f.up, 3);
  random_numbers(r, f.forward, 3);
  return f;
}

static inline face random_face(rng *r, uint32_t most) {
  face f;
  memset(&f, 0, sizeof f);
  f.axes = random_axes(r);
  if (rng_below(r, 4) == 0) {   /* nothing there */
    f.near_depth = INFINITY;
    f.far_depth = -INFINITY;
    return f;
  }
  f.width = 1 + rng_below(r, most);
  f.height = 1 + rng_below(r, most);
  random_numbers(r, &f.u0, 1);
  random_numbers(r, &f.v0, 1);
  f.pixel_u = rng_scale(r, 1e-9, 1e9);
  f.pixel_v = rng_scale(r, 1e-9, 1e9);
  f.per_u = 1 / f.pixel_u;
  f.per_v = 1 / f.pixel_v;
  f.near_depth = rng_scale(r, 1e-9, 1e9);
  f.far_depth = f.near_depth * (1 + rng_unit(r));
  return f;
}

static inline void random_print(rng *r, char out[DIGEST_CHARS]) {
  for (int i = 0; i < DIGEST_CHARS - 1; ++i) out[i] = "0123456789ABCDEF"[rng_below(r, 16)];
  out[DIGEST_CHARS - 1] = '\0';
}

static inline map_header random_header(rng *r, uint32_t faces, uint32_t most_pixels, int coloured) {
  map_header h;
  memset(&h, 0, sizeof h);
  h.light.size = sizeof h.light;
  h.light.kind = rng_below(r, 3);
  random_numbers(r, h.light.origin, 3);
  if (h.light.kind != DSM_LIGHT_POINT) random_numbers(r, h.light.direction, 3);
  if (h.light.kind == DSM_LIGHT_SPOT) h.light.cos_angle = rng_between(r, -1, 1);
  if (h.light.kind == DSM_LIGHT_PARALLEL) h.light.radius = rng_scale(r, 1e-3, 1e3);
  projection *p = &h.projection;
  random_numbers(r, p->origin, 3);
  p->axes = random_axes(r);
  p->perspective = (int)rng_below(r, 2);
  p->count = faces;
  p->overlap = rng_unit(r);
  for (uint32_t i = 0; i < faces; ++i) p->faces[i] = random_face(r, most_pixels);
  h.resolution[0] = 1 + rng_below(r, 16384);
  h.resolution[1] = rng_below(r, 2) * h.resolution[0];
  h.samples = 1 + rng_below(r, 4096);
  h.filter = rng_below(r, 3);
  h.filter_width = rng_scale(r, 1e-3, 16);
  h.tolerance = rng_below(r, 2) ? SETTING_AUTOMATIC : rng_unit(r) / 2;
  h.bounded = (int)rng_below(r, 2);
  if (h.bounded) random_numbers(r, h.bounds.low, 6);
  h.block = coloured == MADE_DEPTHS ? BLOCK_SHADOW_MAP : BLOCK_DEEP_SHADOW;
  p->one_level = coloured == MADE_DEPTHS;
  h.jittered = (int)rng_below(r, 2);
  h.coloured = coloured == MADE_COLOURED;
  h.vertices = rng_bits(r) >> 12;
  h.pixels_marked = rng_bits(r) >> 40;
  h.scene_count = 1 + rng_below(r, 3);
  h.scenes = calloc(h.scene_count, sizeof *h.scenes);
  for (uint32_t i = 0; i < h.scene_count; ++i) {
    random_print(r, h.scenes[i].casters);
    random_print(r, h.scenes[i].probes);
  }
  return h;
}

/* Depths that never fall, and values that never grow, with plenty of steps, plateaus and ends of the range. */
static inline void fill_random(rng *r, tile *t) {
  for (uint32_t i = 0; i < TILE_PIXELS; ++i) {
    visibility v = tile_visibility(t, i);
    float z = rng_below(r, 2) ? 0 : (float)rng_scale(r, 1e-30, 1e3);
    uint16_t now[3];
    for (int c = 0; c < 3; ++c) now[c] = rng_below(r, 2) ? VALUE_STEPS : (uint16_t)rng_below(r, VALUE_STEPS + 1);
    for (uint32_t k = 0; k < v.count; ++k) {
      if (v.channels == 3 && k == 0 && now[0] == now[1]) now[1] = (uint16_t)(now[0] > 0 ? now[0] - 1 : 1);
      for (uint32_t c = 0; c < v.channels; ++c) tile_put(t, i, k, c, z, now[c]);
      if (rng_below(r, 3)) z += (float)rng_scale(r, 1e-6, 1e3);
      for (uint32_t c = 0; c < v.channels; ++c)
        if (rng_below(r, 3)) now[c] = (uint16_t)rng_below(r, now[c] + 1u);
    }
  }
}

static inline const tile *random_depths(rng *r) {
  float depth[TILE_PIXELS];
  const tile *t;
  int full = rng_below(r, 2) == 0;
  for (int i = 0; i < TILE_PIXELS; ++i) depth[i] = full || rng_below(r, 3) ? (float)rng_scale(r, 1e-30, 1e30) : INFINITY;
  depth[rng_below(r, TILE_PIXELS)] = 0;
  assert_int_equal(depth_tile_unpack(rng_scale(r, 1e-9, 1e9), depth, &t), DSM_OK);
  return t;
}

static inline const tile *random_tile(rng *r, int coloured, uint32_t most_vertices) {
  if (rng_below(r, 4) == 0) return &tile_lit;
  if (coloured == MADE_DEPTHS) return random_depths(r);
  tile_plan plan = {.count = {0}};
  int marks = rng_below(r, 4) == 0, colours = coloured && rng_below(r, 2);
  for (int i = 0; i < TILE_PIXELS; ++i) {
    plan.marked[i] = marks && rng_below(r, 10) == 0;
    plan.count[i] = plan.marked[i] || rng_below(r, 3) == 0 ? 0 : rng_below(r, most_vertices);
    plan.coloured[i] = colours && plan.count[i] && rng_below(r, 2);
  }
  tile *t = tile_create(&plan);
  assert_non_null(t);
  t->near_depth = rng_scale(r, 1e-9, 1e9);
  t->tolerance = (float)rng_unit(r);
  fill_random(r, t);
  return tile_compact(t);
}

static inline made_map made_map_random(rng *r, uint32_t faces, uint32_t most_pixels, int coloured, uint32_t most_vertices) {
  made_map m = {.header = random_header(r, faces, most_pixels, coloured), .fail_at = UINT64_MAX};
  map_parts_lay(&m.parts, &m.header.projection, map_header_kind(&m.header));
  m.tiles = calloc(m.parts.tile_count + 1, sizeof *m.tiles);
  for (uint64_t i = 0; i < m.parts.tile_count; ++i)
    m.tiles[i] = random_tile(r, coloured, rng_below(r, 20) == 0 ? 20 * most_vertices : most_vertices);
  return m;
}

static inline void made_map_free(made_map *m) {
  for (uint64_t i = 0; i < m->parts.tile_count; ++i) tile_destroy(m->tiles[i]);
  free(m->tiles);
  map_header_free(&m->header);
}

static inline dsm_result give_made(void *data, const tile_key *key, const tile **out) {
  const made_map *m = data;
  uint64_t number = map_parts_number(&m->parts, key);
  *out = m->tiles[number];
  return number == m->fail_at ? m->fail_with : DSM_OK;
}

/* The first tile that is not the same in the file; its number, or how many there are. */
static inline uint64_t made_map_differs(const made_map *m, map_file *file, dsm_result *result, map_reason *why) {
  for (uint32_t part = 0; part + 1 < m->parts.count; ++part) {
    tile_key key = m->parts.keys[part];
    for (key.y = 0; key.y < m->parts.parts[part].up; ++key.y)
      for (key.x = 0; key.x < m->parts.parts[part].across; ++key.x) {
        uint64_t number = map_parts_number(&m->parts, &key);
        const tile *t;
        *result = map_file_tile(file, &key, &t, why);
        if (*result != DSM_OK) return number;
        int same = same_tiles(t, m->tiles[number]);
        tile_destroy(t);
        if (!same) return number;
      }
  }
  return m->parts.tile_count;
}

#endif
