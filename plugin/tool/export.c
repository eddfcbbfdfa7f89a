/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* dsmtool export: a level of a map as a standard deep image. */
#include <stdio.h>
#include <stdlib.h>

#include "tool/deep_samples.h"
#include "tool/image_frame.h"
#include "tool/open_map.h"

typedef struct {
  const char *path, *output;
  double tolerance;
  place_choice place;
} arguments;

typedef struct {
  const open_map *map;
  map_grid grid;
  double tolerance;
  const tile **row;       /* the tiles of one row */
  vertices function;
  deep_samples samples;   /* of one row of pixels */
  size_t *first;          /* of each of its pixels */
  uint64_t marked;
} exporter;

static int read_tiles(exporter *e, uint32_t y)
{
  for (uint32_t x = 0; x < e->grid.across; x++) {
    tile_key key = {e->grid.face, e->grid.level, x, y};
    tile_destroy(e->row[x]);
    e->row[x] = NULL;
    if (open_map_tile(e->map, &key, &e->row[x]) != STATUS_FINE)
      return STATUS_TROUBLE;
  }
  return STATUS_FINE;
}

static dsm_result convert_row(exporter *e, uint32_t y, int channels)
{
  e->samples.count = 0;
  for (uint32_t x = 0; x < e->grid.width; x++) {
    const tile *t = e->row[x / TILE_SIDE];
    uint32_t place = y % TILE_SIDE * TILE_SIDE + x % TILE_SIDE;
    e->first[x] = e->samples.count;
    e->function.count = 0;
    e->marked += t->kind == TILE_STORED && tile_is_marked(t, place);
    dsm_result result = read_pixel(t, place, &e->function);
    if (result == DSM_OK)
      result = deep_samples_of(e->function.data, e->function.count, channels, e->tolerance, &e->samples);
    if (result != DSM_OK)
      return result;
  }
  e->first[e->grid.width] = e->samples.count;
  return DSM_OK;
}

/* Image rows from the top, map rows from the highest down. */
static int write_rows(exporter *e, image_writer *writer, int channels, map_reason *why)
{
  for (uint32_t y = e->grid.height; y-- > 0;) {
    if ((y + 1 == e->grid.height || y % TILE_SIDE == TILE_SIDE - 1) && read_tiles(e, y / TILE_SIDE) != STATUS_FINE)
      return STATUS_TROUBLE;
    if (convert_row(e, y, channels) != DSM_OK)
      return trouble_memory();
    dsm_result result = image_writer_row(writer, e->samples.data, e->first, why);
    if (result != DSM_OK)
      return trouble_because(result, why);
  }
  return STATUS_FINE;
}

static int open_writer(const exporter *e, const char *path, const image_size *size, image_writer **writer,
                       map_reason *why)
{
  map_header header = e->map->header;
  attribute_list list;
  image_frame_of(&header.projection, e->grid.face, e->grid.level);
  dsm_result result = image_frame_write(&header, &list);
  if (result == DSM_OK)
    result = image_writer_open(path, size, list.items, list.count, writer, why);
  attribute_list_free(&list);
  return result == DSM_OK ? STATUS_FINE : trouble_because(result, why);
}

static int write_image(exporter *e, const char *path)
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  image_size size = {e->grid.width, e->grid.height, e->map->header.coloured};
  image_writer *writer;
  int status = open_writer(e, path, &size, &writer, &why);
  if (status != STATUS_FINE)
    return status;
  status = write_rows(e, writer, size.coloured ? 3 : 1, &why);
  if (image_writer_close(writer, status == STATUS_FINE, &why) != DSM_OK)
    status = trouble("%s", text);
  if (status == STATUS_FINE && e->marked)
    fprintf(stderr, "dsmtool: %llu pixels are marked (light can grow there): the map stores nothing for them, and they "
            "are empty in %s.\n", (unsigned long long)e->marked, path);
  return status;
}

static int run(const open_map *map, void *data)
{
  const arguments *given = data;
  exporter e = {.map = map, .tolerance = given->tolerance};
  if (open_map_grid(map, &given->place, &e.grid) != STATUS_FINE)
    return STATUS_TROUBLE;
  e.row = calloc(e.grid.across, sizeof *e.row);
  e.first = calloc((size_t)e.grid.width + 1, sizeof *e.first);
  int status = e.row && e.first ? write_image(&e, given->output) : trouble_memory();
  for (uint32_t x = 0; e.row && x < e.grid.across; x++)
    tile_destroy(e.row[x]);
  free(e.row);
  free(e.first);
  vertices_free(&e.function);
  deep_samples_free(&e.samples);
  return status;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
  arguments *given = state->input;
  if (place_option(&given->place, key, text, state))
    return 0;
  if (key == 'o')
    given->output = text;
  else if (key == 't')
    given->tolerance = number_argument(state, "--tolerance", text, 1e-5, 0.5);
  else if (key == ARGP_KEY_ARG && state->arg_num == 0)
    given->path = text;
  else if (key == ARGP_KEY_END && (!given->path || !given->output))
    argp_error(state, "A map and -o IMAGE are needed.");
  else
    return ARGP_ERR_UNKNOWN;
  return 0;
}

int export_run(int argc, char **argv)
{
  static const struct argp_option options[] = {
    {"output", 'o', "IMAGE", 0, "the deep image to write, .exr", 0},
    {"tolerance", 't', "T", 0, "how far OpenEXR's exponential reading may be from the map's own (0.001)", 0},
    PLACE_OPTIONS, {0}};
  static const struct argp parser = {options, parse, "MAP -o IMAGE", "Writes one level of one face as a standard deep "
    "OpenEXR image: scanlines, Z and ZBack in scene units from the light (from its plane, if it is parallel), A or AR, AG "
    "and AB, and black R, G and B; tidy, as seen from the light. Within a sample OpenEXR has light fall exponentially and "
    "the map linearly, so that samples are as short as the tolerance asks for. dsmtool import reads the image back.",
    NULL, NULL, NULL};
  arguments given = {.tolerance = 0.001, .place = {-1, 0}};
  parse_arguments(&parser, argc, argv, &given);
  return with_open_map(open_map_begin_deep, given.path, run, &given);
}
