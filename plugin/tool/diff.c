/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* dsmtool diff: how far two maps are from each other, and what they say differently of themselves. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tool/function_gap.h"
#include "tool/header_text.h"
#include "tool/open_map.h"

typedef struct { const char *paths[2]; } arguments;

typedef struct {
  uint64_t pixels, different, marked;   /* marked: in one map only */
  double largest, mean_squares;         /* the latter: sum over the pixels */
  uint32_t face, x, row;                /* where the largest is */
} level_gap;

typedef struct {
  const open_map *a, *b;
  vertices of_a, of_b;
  level_gap levels[MAX_LEVELS];
} comparison;

/* Lines that differ, of all topics. */
static int print_settings(const open_map *a, const open_map *b)
{
  header_line of_a[MAX_HEADER_LINES], of_b[MAX_HEADER_LINES];
  uint32_t count_a = header_lines(&a->header, of_a), count_b = header_lines(&b->header, of_b);
  int different = 0;
  for (uint32_t i = 0; i < count_a || i < count_b; i++) {
    if (i < count_a && i < count_b && !strcmp(of_a[i].name, of_b[i].name) && !strcmp(of_a[i].text, of_b[i].text))
      continue;
    if (i < count_a)
      printf("< %-12s %s\n", of_a[i].name, of_a[i].text);
    if (i < count_b)
      printf("> %-12s %s\n", of_b[i].name, of_b[i].text);
    different = 1;
  }
  for (uint32_t i = 0; i < a->header.scene_count && a->header.scene_count == b->header.scene_count; i++)
    if (memcmp(&a->header.scenes[i], &b->header.scenes[i], sizeof(scene_print))) {
      printf("The scenes differ.\n");
      return 1;
    }
  return different;
}

static int same_grids(const projection *a, const projection *b)
{
  int same = a->count == b->count && a->perspective == b->perspective;
  for (uint32_t i = 0; same && i < a->count; i++)
    same = a->faces[i].width == b->faces[i].width && a->faces[i].height == b->faces[i].height;
  return same;
}

static dsm_result compare_pixel(comparison *c, const tile_key *key, uint32_t place, const tile *a, const tile *b)
{
  level_gap *sum = &c->levels[key->level];
  const face *fa = &c->a->header.projection.faces[key->face], *fb = &c->b->header.projection.faces[key->face];
  double near_depth = fmin(fa->near_depth, fb->near_depth), far_depth = fmax(fa->far_depth, fb->far_depth);
  int marked_a = a->kind == TILE_STORED && tile_is_marked(a, place);
  int marked_b = b->kind == TILE_STORED && tile_is_marked(b, place);
  c->of_a.count = c->of_b.count = 0;
  sum->pixels++;
  if (marked_a || marked_b) {
    sum->marked += marked_a != marked_b;
    return DSM_OK;
  }
  dsm_result result = read_pixel(a, place, &c->of_a);
  if (result == DSM_OK)
    result = read_pixel(b, place, &c->of_b);
  if (result != DSM_OK)
    return result;
  function_gap gap = function_gap_of(c->of_a.data, c->of_a.count, c->of_b.data, c->of_b.count, near_depth, far_depth);
  sum->different += gap.largest > 0;
  sum->mean_squares += far_depth > near_depth ? gap.squares / (far_depth - near_depth) : 0;
  if (gap.largest > sum->largest) {
    map_grid grid;
    map_grid_of(&c->a->header.projection, key->face, key->level, &grid);
    sum->largest = gap.largest;
    sum->face = key->face;
    sum->x = key->x * TILE_SIDE + place % TILE_SIDE;
    sum->row = grid.height - 1 - (key->y * TILE_SIDE + place / TILE_SIDE);
  }
  return DSM_OK;
}

static int compare_tile(comparison *c, const tile_key *key)
{
  const tile *a = NULL, *b = NULL;
  map_grid grid;
  map_grid_of(&c->a->header.projection, key->face, key->level, &grid);
  tile_extent extent = tile_extent_of(&grid, key);
  int status = open_map_tile(c->a, key, &a);
  if (status == STATUS_FINE)
    status = open_map_tile(c->b, key, &b);
  for (uint32_t i = 0; i < extent.across * extent.up && status == STATUS_FINE; i++) {
    uint32_t place = i / extent.across * TILE_SIDE + i % extent.across;
    if (compare_pixel(c, key, place, a, b) != DSM_OK)
      status = trouble_memory();
  }
  tile_destroy(a);
  tile_destroy(b);
  return status;
}

static int print_levels(const comparison *c)
{
  int different = 0;
  for (int level = 0; level < MAX_LEVELS && c->levels[level].pixels; level++) {
    const level_gap *g = &c->levels[level];
    printf("level %d: largest difference %.6g, RMS %.6g, %llu of %llu pixels differ", level, g->largest,
           sqrt(g->mean_squares / (double)g->pixels), (unsigned long long)g->different, (unsigned long long)g->pixels);
    if (g->largest > 0)
      printf(", most at pixel %u %u of face %u", (unsigned)g->x, (unsigned)g->row, (unsigned)g->face);
    if (g->marked)
      printf(", %llu are marked in one map only", (unsigned long long)g->marked);
    printf("\n");
    different |= g->different || g->marked;
  }
  return different;
}

static int compare(const open_map *a, const open_map *b)
{
  int different = print_settings(a, b);
  if (!same_grids(&a->header.projection, &b->header.projection)) {
    printf("The pixels cannot be compared, as the frames differ.\n");
    return STATUS_DIFFERENT;
  }
  comparison c = {.a = a, .b = b};
  tile_key key = {0, 0, 0, 0};
  int status = STATUS_FINE;
  for (int more = 0; status == STATUS_FINE && next_tile(&a->header.projection, &key, &more);)
    status = compare_tile(&c, &key);
  vertices_free(&c.of_a);
  vertices_free(&c.of_b);
  if (status == STATUS_FINE)
    status = print_levels(&c) || different ? STATUS_DIFFERENT : STATUS_FINE;
  return status;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
  arguments *given = state->input;
  if (key == ARGP_KEY_ARG && state->arg_num < 2)
    given->paths[state->arg_num] = text;
  else if (key == ARGP_KEY_END && state->arg_num < 2)
    argp_error(state, "Two maps are needed.");
  else
    return ARGP_ERR_UNKNOWN;
  return 0;
}

int diff_run(int argc, char **argv)
{
  static const struct argp parser = {NULL, parse, "MAP MAP", "Prints what two maps say differently of themselves (< the "
    "first, > the second), and for each level the largest and the root mean square difference of visibility, over all "
    "pixels and all depths of the casters. The exit status is 0 where the maps are the same, 1 where they differ, 2 where "
    "they cannot be read.", NULL, NULL, NULL};
  arguments given = {{NULL, NULL}};
  parse_arguments(&parser, argc, argv, &given);
  open_map a = {0}, b = {0};
  int status = open_map_begin_deep(&a, given.paths[0]);
  if (status == STATUS_FINE)
    status = open_map_begin_deep(&b, given.paths[1]);
  if (status == STATUS_FINE)
    status = compare(&a, &b);
  open_map_end(&a);
  open_map_end(&b);
  return status;
}
