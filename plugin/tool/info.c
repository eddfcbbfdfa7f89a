/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* dsmtool info: what a map says of itself, and what its levels hold. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "tool/header_text.h"
#include "tool/info_depths.h"
#include "tool/open_map.h"

enum { BINS = 16 };   /* 0, 1, 2, 3 to 4, 5 to 8, … vertices */

typedef struct {
  uint64_t stored, lit;                         /* tiles */
  uint64_t pixels, dimmed, coloured, marked;    /* dimmed: has vertices */
  uint64_t vertices, bytes;
  double squares;                               /* of the stored tiles' tolerances */
  uint64_t bins[BINS];                          /* pixels by their number of vertices */
} level_sum;

static uint32_t bin_of(uint32_t count)
{
  uint32_t bin = 0;
  for (uint64_t high = 1; count && bin < BINS - 1; high *= 2) {
    bin++;
    if (count <= high)
      break;
  }
  return bin;
}

static void add_tile(void *data, const map_grid *grid, const tile_key *key, const tile *t)
{
  level_sum *sum = (level_sum *)data + key->level;
  tile_extent extent = tile_extent_of(grid, key);
  uint32_t pixels = extent.across * extent.up;
  sum->pixels += pixels;
  sum->bytes += sizeof(tile *);
  if (t->kind != TILE_STORED) {
    sum->lit++;
    sum->bins[0] += pixels;
    return;
  }
  sum->stored++;
  sum->bytes += t->size;
  sum->squares += (double)t->tolerance * t->tolerance;
  for (uint32_t i = 0; i < pixels; i++) {
    uint32_t place = i / extent.across * TILE_SIDE + i % extent.across;
    visibility v = tile_visibility(t, place);
    sum->marked += tile_is_marked(t, place) != 0;
    sum->coloured += v.channels == 3;
    sum->dimmed += v.count > 0;
    sum->vertices += v.count;
    sum->bins[bin_of(v.count)]++;
  }
}

static double ratio(double a, double b)
{
  return b > 0 ? a / b : 0;
}

static void print_levels(const map_file *file, const level_sum *sums)
{
  uint64_t total = 0;
  printf("\n%5s %12s %10s %10s %12s %12s %14s %10s %14s\n", "level", "pixels", "stored", "lit tiles", "vertices", "a pixel",
         "bytes", "a vertex", "in the file");
  for (int level = 0; level < MAX_LEVELS && sums[level].pixels; level++) {
    const level_sum *s = &sums[level];
    printf("%5d %12llu %10llu %10llu %12llu %12.2f %14llu %10.2f %14llu\n", level, (unsigned long long)s->pixels,
           (unsigned long long)s->stored, (unsigned long long)s->lit, (unsigned long long)s->vertices,
           ratio((double)s->vertices, (double)s->dimmed), (unsigned long long)s->bytes,
           ratio((double)s->bytes, (double)s->vertices), (unsigned long long)map_file_level_bytes(file, (uint32_t)level));
    total += s->bytes;
  }
  printf("All levels together take %llu bytes in memory, %.2f times the finest. Pixels that are lit do not count in\n"
         "\"a pixel\".\n", (unsigned long long)total, ratio((double)total, (double)sums[0].bytes));
}

static void print_histogram(const level_sum *s)
{
  printf("\nPixels of level 0 by their number of vertices:\n");
  uint64_t most = 1;
  int last = 0;
  for (int i = 0; i < BINS; i++)
    if (s->bins[i]) {
      last = i;
      most = s->bins[i] > most ? s->bins[i] : most;
    }
  for (int i = 0; i <= last; i++) {
    char range[40];
    unsigned long low = i < 2 ? (unsigned long)i : (1ul << (i - 2)) + 1, high = i < 1 ? 0 : 1ul << (i - 1);
    if (i == BINS - 1)
      snprintf(range, sizeof range, "%lu or more", low);
    else
      snprintf(range, sizeof range, low == high ? "%lu" : "%lu to %lu", low, high);
    int bar = (int)(50 * ratio((double)s->bins[i], (double)most) + 0.5);
    printf("%16s %7.3f %% %.*s\n", range, 100 * ratio((double)s->bins[i], (double)s->pixels), bar,
           "##################################################");
  }
}

static void print_header(const open_map *map)
{
  header_line lines[MAX_HEADER_LINES];
  uint32_t count = header_lines(&map->header, lines);
  struct stat file;
  if (!stat(map->path, &file))
    printf("%-12s %s, %lld bytes, format %u\n", "file", map->path, (long long)file.st_size,
           (unsigned)map_header_format(&map->header));
  for (uint32_t i = 0; i < count; i++)
    printf("%-12s %s\n", i && !strcmp(lines[i].name, lines[i - 1].name) ? "" : lines[i].name, lines[i].text);
  for (uint32_t i = 0; i < map->header.scene_count; i++)
    printf("%-12s casters %s, light rays %s\n", i ? "" : "fingerprint", map->header.scenes[i].casters,
           map->header.scenes[i].probes);
}

static int print_map(const open_map *map, void *unused)
{
  (void)unused;
  if (open_map_has_depths(map)) {
    print_header(map);
    return info_depths(map);
  }
  level_sum sums[MAX_LEVELS];
  memset(sums, 0, sizeof sums);
  if (open_map_visit(map, add_tile, sums) != STATUS_FINE)
    return STATUS_TROUBLE;
  print_header(map);
  const level_sum *finest = &sums[0];
  printf("%-12s %.4g, root mean square over the tiles of level 0 that store anything\n", "compression",
         sqrt(ratio(finest->squares, (double)finest->stored)));
  printf("%-12s %llu of %llu at level 0 store three channels, %llu are marked (ray-traced, as light can grow there)\n",
         "pixels", (unsigned long long)finest->coloured, (unsigned long long)finest->pixels,
         (unsigned long long)finest->marked);
  print_levels(map->file, sums);
  print_histogram(finest);
  return STATUS_FINE;
}

int info_run(int argc, char **argv)
{
  static const struct argp parser = {NULL, one_path, "MAP", "Says in plain words what a shadow map is: its light, frame "
    "and settings, and for every level its pixels, tiles, vertices, and bytes in memory and in the file.", NULL, NULL, NULL};
  const char *path = NULL;
  parse_arguments(&parser, argc, argv, &path);
  return with_open_map(open_map_begin, path, print_map, NULL);
}
