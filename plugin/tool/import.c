/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* dsmtool import: a map of a standard deep image. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/compress.h"
#include "core/transmittance.h"
#include "map/baked_pixel.h"
#include "map/pack_tile.h"
#include "tool/built_map.h"
#include "tool/image_frame.h"
#include "tool/open_map.h"

typedef struct {
  const char *path, *output, *like;
  double tolerance;
  place_choice place;
} arguments;

typedef struct {
  tile_maker base;
  const image_reader *image;
  image_size size;
  uint32_t face;       /* the one that has pixels */
  double tolerance;
  uint64_t dropped, clamped;   /* samples */
  dsm_ray rays[TILE_PIXELS];
  dsm_sink sink;
  vertices function, stored;
  baked_pixel pixels[TILE_PIXELS];
} importer;

/* Hands the tile's samples to a sink as if its pixels were rays: it puts right what is not tidy. */
static dsm_result gather(importer *m, const tile_key *key)
{
  dsm_result result = sink_begin(&m->sink, m->rays, TILE_PIXELS);
  for (uint32_t place = 0; place < TILE_PIXELS && result == DSM_OK; place++) {
    uint32_t x = key->x * TILE_SIDE + place % TILE_SIDE, y = key->y * TILE_SIDE + place / TILE_SIDE;
    if (x >= m->size.width || y >= m->size.height)
      continue;
    uint32_t row = m->size.height - 1 - y, count = image_reader_count(m->image, x, row);
    for (uint32_t i = 0; i < count && result == DSM_OK; i++) {
      deep_sample s = image_reader_sample(m->image, x, row, i);
      double pass[3];
      for (int c = 0; c < 3; c++)
        pass[c] = fmax(0, 1 - (double)s.alpha[c]);
      result = (double)s.z_back > (double)s.z
        ? sink_span(&m->sink, place, (double)s.z, (double)s.z_back, pass)
        : sink_surface(&m->sink, place, (double)s.z, pass);
    }
  }
  return result == DSM_OK ? sink_order(&m->sink) : result;
}

/* A quarter of the tolerance goes to turning exponentials into lines, the rest to compression. */
static dsm_result import_pixel(importer *m, uint32_t place)
{
  size_t first = m->sink.first[place], count = m->sink.first[place + 1] - first;
  baked_pixel *pixel = &m->pixels[place];
  *pixel = (baked_pixel){.first = m->stored.count, .marked = m->sink.marked[place] != 0, .tolerance = m->tolerance};
  if (!count || pixel->marked)
    return DSM_OK;
  m->function.count = 0;
  dsm_result result = transmittance_build(m->sink.ordered + first, count, m->tolerance, &m->function);
  for (size_t i = 0; i < m->function.count; i++)
    pixel->coloured |= !rgb_is_grey(m->function.data[i].v);
  if (result == DSM_OK)
    result = compress_minimal(m->function.data, m->function.count, pixel->coloured ? 3 : 1,
                             fmax(0, 0.75 * m->tolerance - VALUE_ROUNDING), &m->stored);
  pixel->count = m->stored.count - pixel->first;
  return result;
}

static dsm_result make(tile_maker *base, const tile_key *key, const wanted_pixels *wanted, const tile **out, tile_tally *tally)
{
  importer *m = (importer *)base;
  (void)wanted;
  m->stored.count = 0;
  const rounding rule = rounding_least();
  dsm_result result = gather(m, key);
  for (uint32_t place = 0; place < TILE_PIXELS && result == DSM_OK; place++)
    result = import_pixel(m, place);
  if (result == DSM_OK)
    result = pack_tile(m->pixels, &m->stored, &rule, out);
  if (result == DSM_OK)
    built_tile_count(*out, tally);
  if (result == DSM_NO_MEMORY)
    trouble_memory();
  m->dropped = m->sink.dropped;
  m->clamped = m->sink.clamped;
  return result;
}

static void destroy(tile_maker *base)
{
  importer *m = (importer *)base;
  sink_free(&m->sink);
  vertices_free(&m->function);
  vertices_free(&m->stored);
}

/* Widens the face's range of depths to the samples', as nothing in front of it is looked up. */
static void widen(const importer *m, face *f)
{
  for (uint32_t y = 0; y < m->size.height; y++)
    for (uint32_t x = 0; x < m->size.width; x++) {
      uint32_t count = image_reader_count(m->image, x, y);
      for (uint32_t i = 0; i < count; i++) {
        deep_sample s = image_reader_sample(m->image, x, y, i);
        if (isfinite(s.z) && s.z >= 0 && (double)s.z < f->near_depth)
          f->near_depth = (double)s.z;
        if (isfinite(s.z_back) && (double)s.z_back > f->far_depth)
          f->far_depth = (double)s.z_back;
      }
    }
}

/* The frame of another map's face, if its pixels are as many as the image's. */
static int take_frame(const arguments *given, const image_size *size, map_header *header, uint32_t *face_index)
{
  open_map like;
  map_grid grid;
  if (open_map_begin_deep(&like, given->like) != STATUS_FINE)
    return STATUS_TROUBLE;
  int status = open_map_grid(&like, &given->place, &grid);
  if (status == STATUS_FINE && (grid.width != size->width || grid.height != size->height))
    status = trouble("%s has %u x %u pixels, but level %u of face %u of %s has %u x %u.", given->path,
                     (unsigned)size->width, (unsigned)size->height, (unsigned)grid.level, (unsigned)grid.face, given->like,
                     (unsigned)grid.width, (unsigned)grid.height);
  if (status == STATUS_FINE) {
    *header = like.header;
    like.header.scenes = NULL;   /* moved */
    *face_index = grid.face;
    image_frame_of(&header->projection, grid.face, grid.level);
  }
  open_map_end(&like);
  return status;
}

static int find_frame(const arguments *given, const image_reader *image, const image_size *size, map_header *header,
                      uint32_t *face_index)
{
  if (given->like)
    return take_frame(given, size, header, face_index);
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  int found;
  dsm_result result = image_frame_read(image, size, given->path, &found, header, face_index, &why);
  if (result != DSM_OK)
    return trouble_because(result, &why);
  return found ? STATUS_FINE : trouble("%s does not say where its pixels are in the scene; give a map that has the same "
                                       "frame with --like.", given->path);
}

static int import_image(const arguments *given, const image_reader *image, const image_size *size)
{
  map_header header;
  importer *m = calloc(1, sizeof *m);
  if (!m)
    return trouble_memory();
  *m = (importer){.base = {make, destroy}, .image = image, .size = *size, .tolerance = given->tolerance};
  int status = find_frame(given, image, size, &header, &m->face);
  if (status == STATUS_FINE) {
    face *f = &header.projection.faces[m->face];
    widen(m, f);
    for (uint32_t i = 0; i < TILE_PIXELS; i++)
      m->rays[i] = (dsm_ray){.direction = {0, 0, 1}, .near_depth = f->near_depth, .far_depth = f->far_depth};
    header.tolerance = given->tolerance;
    status = built_map_write(given->output, &header, &m->base);
    map_header_free(&header);
  }
  if (status == STATUS_FINE && (m->dropped || m->clamped))
    fprintf(stderr, "dsmtool: %s has samples with impossible numbers: %llu were left out and %llu corrected.\n", given->path,
            (unsigned long long)m->dropped, (unsigned long long)m->clamped);
  free(m);
  return status;
}

static int run(const arguments *given)
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  image_reader *image;
  image_size size;
  dsm_result result = image_reader_open(given->path, &size, &image, &why);
  if (result != DSM_OK)
    return trouble_because(result, &why);
  int status = import_image(given, image, &size);
  image_reader_close(image);
  return status;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
  arguments *given = state->input;
  if (place_option(&given->place, key, text, state))
    return 0;
  if (key == 'o')
    given->output = text;
  else if (key == 'm')
    given->like = text;
  else if (key == 't')
    given->tolerance = number_argument(state, "--tolerance", text, 0, 0.5);
  else if (key == ARGP_KEY_ARG && state->arg_num == 0)
    given->path = text;
  else if (key == ARGP_KEY_END && (!given->path || !given->output))
    argp_error(state, "A deep image and -o MAP are needed.");
  else
    return ARGP_ERR_UNKNOWN;
  return 0;
}

int import_run(int argc, char **argv)
{
  static const struct argp_option options[] = {
    {"output", 'o', "MAP", 0, "the map to write", 0},
    {"tolerance", 't', "T", 0, "largest error of visibility that the map may add (0.001)", 0},
    {"like", 'm', "MAP", 0, "take light, frame and settings from this map, and not from what export wrote in the image", 0},
    PLACE_OPTIONS, {0}};
  static const struct argp parser = {options, parse, "IMAGE -o MAP", "Makes a map of a deep OpenEXR image: of its Z, ZBack "
    "(if it has it) and A, or AR, AG and AB. The map has one face, and coarser levels are made anew. --face and --level "
    "choose of the map that --like names what has the image's pixels.", NULL, NULL, NULL};
  arguments given = {.tolerance = 0.001, .place = {-1, 0}};
  parse_arguments(&parser, argc, argv, &given);
  return run(&given);
}
