/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* dsmtool slice: the light that is left at one depth, as an image. */
#include <float.h>
#include <stdlib.h>

#include "map/depth_tile.h"
#include "tool/image_file.h"
#include "tool/open_map.h"

typedef struct {
  const char *path, *output;
  double depth;
  place_choice place;
} arguments;

typedef struct {
  map_grid grid;
  double depth;
  uint32_t colours, channels;   /* 1 or 3; with alpha, where the map has marked pixels */
  float *values;
} slice;

/* Marked pixels stay transparent black. */
static void draw_tile(const slice *s, const tile_key *key, const tile *t)
{
  tile_extent extent = tile_extent_of(&s->grid, key);
  for (uint32_t i = 0; i < extent.across * extent.up; i++) {
    uint32_t x = i % extent.across, y = i / extent.across, place = y * TILE_SIDE + x, hint = 0;
    uint32_t row = s->grid.height - 1 - (key->y * TILE_SIDE + y);
    float *pixel = s->values + ((size_t)row * s->grid.width + key->x * TILE_SIDE + x) * s->channels;
    rgb light = rgb_grey(1);
    if (t->kind == TILE_STORED && tile_has_depths(t))
      light = rgb_grey(s->depth <= t->near_depth + (double)depths_of(t)->depth[place]);
    else if (t->kind == TILE_STORED) {
      if (tile_is_marked(t, place))
        continue;
      visibility v = tile_visibility(t, place);
      if (v.count)
        light = visibility_at(&v, s->depth - t->near_depth, &hint);
    }
    for (uint32_t c = 0; c < s->colours; c++)
      pixel[c] = (float)light.c[c];
    if (s->channels > s->colours)
      pixel[s->colours] = 1;
  }
}

static int draw(const open_map *map, slice *s)
{
  tile_key key = {s->grid.face, s->grid.level, 0, 0};
  for (key.y = 0; key.y < s->grid.up; key.y++)
    for (key.x = 0; key.x < s->grid.across; key.x++) {
      const tile *t;
      if (open_map_tile(map, &key, &t) != STATUS_FINE)
        return STATUS_TROUBLE;
      draw_tile(s, &key, t);
      tile_destroy(t);
    }
  return STATUS_FINE;
}

static int run(const open_map *map, void *data)
{
  const arguments *given = data;
  slice s = {.depth = given->depth};
  if (open_map_grid(map, &given->place, &s.grid) != STATUS_FINE)
    return STATUS_TROUBLE;
  s.colours = map->header.coloured ? 3 : 1;
  s.channels = s.colours + (map->header.pixels_marked > 0);
  s.values = calloc((size_t)s.grid.width * s.grid.height * s.channels, sizeof *s.values);
  if (!s.values)
    return trouble_memory();
  int status = draw(map, &s);
  if (status == STATUS_FINE) {
    char text[MAP_REASON_SIZE] = "";
    map_reason why = {text, sizeof text};
    if (flat_image_write(given->output, s.grid.width, s.grid.height, s.channels, s.values, &why) != DSM_OK)
      status = trouble("%s", text);
  }
  free(s.values);
  return status;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
  arguments *given = state->input;
  if (place_option(&given->place, key, text, state))
    return 0;
  if (key == 'o')
    given->output = text;
  else if (key == ARGP_KEY_ARG && state->arg_num == 0)
    given->path = text;
  else if (key == ARGP_KEY_ARG && state->arg_num == 1)
    given->depth = number_argument(state, "DEPTH", text, 0, DBL_MAX);
  else if (key == ARGP_KEY_END && (state->arg_num < 2 || !given->output))
    argp_error(state, "A map, a depth and -o IMAGE are needed.");
  else
    return ARGP_ERR_UNKNOWN;
  return 0;
}

int slice_run(int argc, char **argv)
{
  static const struct argp_option options[] = {
    {"output", 'o', "IMAGE", 0, "the image to write; its ending names the format (.exr keeps all digits)", 0},
    PLACE_OPTIONS, {0}};
  static const struct argp parser = {options, parse, "MAP DEPTH -o IMAGE", "Writes the share of light that is left at one "
    "depth (scene units from the light, or from its plane), a pixel of the map each, as seen from the light. An alpha "
    "channel is written where pixels are marked (light can grow there, and the map has no answer).", NULL, NULL, NULL};
  arguments given = {.place = {-1, 0}};
  parse_arguments(&parser, argc, argv, &given);
  return with_open_map(open_map_begin, given.path, run, &given);
}
