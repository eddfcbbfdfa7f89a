/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Vertices a pixel after the greedy algorithm and after the minimal one, on the pixels of a real map.
 *
 *   vertices MAP TOLERANCE
 *
 * The map was saved with tolerance 0, so that its finest level holds the averages as they were sampled. Counts are means over
 * the pixels that store anything; "gap" is that of colour to the largest of the three optima of single channels.
 */
#include <stdio.h>
#include <stdlib.h>

#include "core/compress.h"
#include "map/read_tile.h"
#include "map/tile_store.h"
#include "store/map_file.h"

typedef struct { uint64_t pixels, exact, greedy, minimal, coloured, bound; } sums;

static void count_pixel(const vertices *exact, int channels, double tolerance, vertices *out, sums *s)
{
  s->pixels++;
  s->exact += exact->count;
  out->count = 0;
  compress_greedy(exact->data, exact->count, channels, tolerance, out);
  s->greedy += out->count;
  out->count = 0;
  compress_minimal(exact->data, exact->count, channels, tolerance, out);
  s->minimal += out->count;
  if (channels == 1)
    return;
  size_t most = 0;
  s->coloured += out->count;
  vertices one = {0};
  for (int c = 0; c < 3; c++) {
    one.count = out->count = 0;
    for (size_t i = 0; i < exact->count; i++)
      vertices_push(&one, exact->data[i].z, rgb_grey(exact->data[i].v.c[c]));
    compress_minimal(one.data, one.count, 1, tolerance, out);
    most = out->count > most ? out->count : most;
  }
  s->bound += most;
  vertices_free(&one);
}

int main(int argc, char **argv)
{
  char text[500] = "";
  map_reason why = {text, sizeof text};
  map_header header;
  map_file *file;
  tile_store layout;
  if (argc != 3) {
    fprintf(stderr, "usage: vertices MAP TOLERANCE\n");
    return 2;
  }
  if (map_file_open(argv[1], &header, &file, &why) != DSM_OK) {
    fprintf(stderr, "%s\n", text);
    return 2;
  }
  if (header.tolerance != 0 || tile_store_create(&layout, &header.projection, UINT64_MAX) != DSM_OK) {
    fprintf(stderr, "%s was not saved with tolerance 0.\n", argv[1]);
    return 2;
  }
  double tolerance = atof(argv[2]);
  sums s = {0};
  vertices exact = {0}, out = {0};
  for (uint64_t n = 0; n < layout.tile_count; n++) {
    tile_key key = tile_store_key(&layout, n);
    const tile *t;
    if (key.level > 0)
      break;
    if (map_file_tile(file, &key, &t, &why) != DSM_OK) {
      fprintf(stderr, "%s\n", text);
      return 2;
    }
    for (uint32_t i = 0; i < TILE_PIXELS && t->kind == TILE_STORED; i++) {
      exact.count = 0;
      read_pixel(t, i, &exact);
      if (exact.count)
        count_pixel(&exact, tile_is_coloured(t, i) ? 3 : 1, tolerance, &out, &s);
    }
    tile_destroy(t);
  }
  double pixels = s.pixels ? (double)s.pixels : 1;
  printf("%10.2f %10.2f %10.2f %10.3f", (double)s.exact / pixels, (double)s.greedy / pixels, (double)s.minimal / pixels,
         s.greedy ? (double)s.minimal / (double)s.greedy : 1);
  if (s.bound)
    printf("   gap %.3f", (double)s.coloured / (double)s.bound);
  printf("\n");
  vertices_free(&exact);
  vertices_free(&out);
  tile_store_destroy(&layout);
  map_file_close(file);
  map_header_free(&header);
  return 0;
}
