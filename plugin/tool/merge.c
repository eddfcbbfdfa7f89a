/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* dsmtool merge: motion blur (LV 5.5). Maps baked at several clock values, averaged. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tool/built_map.h"
#include "tool/header_text.h"
#include "tool/merge_tile.h"
#include "tool/open_map.h"

typedef struct {
  const char *output;
  const char **paths;
  uint32_t count;
  double tolerance;   /* negative: half of the inputs' own */
} arguments;

typedef struct {
  tile_maker base;
  const open_map *maps;
  const tile **tiles;
  merge_input in;
  merge_scratch scratch;
} merger;

static dsm_result make(tile_maker *base, const tile_key *key, const wanted_pixels *wanted, const tile **out, tile_tally *tally)
{
  merger *m = (merger *)base;
  (void)wanted;
  dsm_result result = DSM_OK;
  uint32_t got = 0;
  for (; got < m->in.count && result == DSM_OK; got++)
    if (open_map_tile(&m->maps[got], key, &m->tiles[got]) != STATUS_FINE) {
      result = DSM_REFUSED;
      break;
    }
  if (result == DSM_OK)
    result = merge_tiles(&m->in, &m->scratch, out);
  for (uint32_t i = 0; i < got; i++)
    tile_destroy(m->tiles[i]);
  if (result == DSM_OK)
    built_tile_count(*out, tally);
  if (result == DSM_NO_MEMORY)
    trouble_memory();
  return result;
}

static void destroy(tile_maker *base)
{
  merger *m = (merger *)base;
  merge_scratch_free(&m->scratch);
}

/* Says what keeps two maps from being merged. */
static int check_alike(const open_map *a, const open_map *b)
{
  static const char *const what[] = {"lights", "frames", "settings"};
  header_line of_a[MAX_HEADER_LINES], of_b[MAX_HEADER_LINES];
  uint32_t count_a = header_lines(&a->header, of_a), count_b = header_lines(&b->header, of_b);
  for (uint32_t i = 0; i < count_a && i < count_b; i++) {
    if (!strcmp(of_a[i].name, of_b[i].name) && !strcmp(of_a[i].text, of_b[i].text))
      continue;
    if (of_a[i].topic == of_b[i].topic && of_a[i].topic > ABOUT_SETTINGS)
      continue;   /* tolerances may differ, and scenes do */
    return trouble("%s and %s cannot be merged, as their %s differ (%s: %s; %s: %s).%s", a->path, b->path,
                   what[of_a[i].topic < ABOUT_SETTINGS ? of_a[i].topic : ABOUT_SETTINGS], of_a[i].name, of_a[i].text,
                   of_b[i].name, of_b[i].text, of_a[i].topic == ABOUT_FRAME
                     ? " Give `bounds` in deep_shadow, with a box that holds whatever moves, and bake them again." : "");
  }
  return STATUS_FINE;
}

/* The scenes of all maps one after the other. */
static int join_scenes(const open_map *maps, uint32_t count, map_header *header)
{
  uint32_t total = 0;
  for (uint32_t i = 0; i < count; i++)
    total += maps[i].header.scene_count;
  header->scenes = malloc(total * sizeof *header->scenes);
  header->scene_count = 0;
  if (!header->scenes)
    return trouble_memory();
  for (uint32_t i = 0; i < count; i++) {
    memcpy(header->scenes + header->scene_count, maps[i].header.scenes, maps[i].header.scene_count * sizeof(scene_print));
    header->scene_count += maps[i].header.scene_count;
  }
  return STATUS_FINE;
}

/* The inputs' tolerance, a map that has been merged before weighing as much as what went into it; automatic if any is. */
static double mean_tolerance(const open_map *maps, const double *weights, uint32_t count)
{
  double mean = 0;
  for (uint32_t i = 0; i < count; i++) {
    if (maps[i].header.tolerance < 0)
      return SETTING_AUTOMATIC;
    mean += weights[i] * maps[i].header.tolerance;
  }
  return mean;
}

static int write_merged(const arguments *given, const open_map *maps, double *weights, const tile **tiles)
{
  map_header header = maps[0].header;
  if (join_scenes(maps, given->count, &header) != STATUS_FINE)
    return STATUS_TROUBLE;
  for (uint32_t i = 0; i < given->count; i++)
    weights[i] = (double)maps[i].header.scene_count / header.scene_count;
  double error = mean_tolerance(maps, weights, given->count);
  merger m = {.base = {make, destroy}, .maps = maps, .tiles = tiles,
              .in = {tiles, weights, given->count, error, given->tolerance}};
  double added = given->tolerance >= 0 ? given->tolerance : 0.5 * error;
  header.tolerance = error >= 0 ? error + added : SETTING_AUTOMATIC;
  int status = built_map_write(given->output, &header, &m.base);
  if (status == STATUS_FINE && error >= 0)
    printf("%s: %u scenes, within %g of their exact average.\n", given->output, (unsigned)header.scene_count,
           header.tolerance);
  else if (status == STATUS_FINE)
    printf("%s: %u scenes; each tile records how near it is to their exact average (see dsmtool info).\n", given->output,
           (unsigned)header.scene_count);
  free(header.scenes);
  return status;
}

static int run(const arguments *given)
{
  uint32_t opened = 0;
  int status = STATUS_FINE;
  open_map *maps = calloc(given->count, sizeof *maps);
  double *weights = calloc(given->count, sizeof *weights);
  const tile **tiles = calloc(given->count, sizeof *tiles);
  if (!maps || !weights || !tiles)
    status = trouble_memory();
  for (; status == STATUS_FINE && opened < given->count; opened++) {
    status = open_map_begin_deep(&maps[opened], given->paths[opened]);
    if (status == STATUS_FINE && opened)
      status = check_alike(&maps[0], &maps[opened]);
  }
  if (status == STATUS_FINE)
    status = write_merged(given, maps, weights, tiles);
  for (uint32_t i = 0; i < opened; i++)
    open_map_end(&maps[i]);
  free(maps);
  free(weights);
  free(tiles);
  return status;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
  arguments *given = state->input;
  if (key == 'o')
    given->output = text;
  else if (key == 't')
    given->tolerance = number_argument(state, "--tolerance", text, 0, 0.5);
  else if (key == ARGP_KEY_ARG)
    given->paths[given->count++] = text;
  else if (key == ARGP_KEY_END && (!given->count || !given->output))
    argp_error(state, "Maps to merge and -o MAP are needed.");
  else
    return ARGP_ERR_UNKNOWN;
  return 0;
}

int merge_run(int argc, char **argv)
{
  static const struct argp_option options[] = {
    {"output", 'o', "MAP", 0, "the map to write", 0},
    {"tolerance", 't', "T", 0, "error of visibility that compressing the average may add (half of the inputs' own; less where that is automatic)", 0},
    {0}};
  static const struct argp parser = {options, parse, "-o MAP MAP...", "Averages maps of one light that were baked at "
    "several clock values: the shadow of what moves is blurred as by an open shutter. All must have the same light, frame "
    "and settings; `bounds` in deep_shadow holds the frame still. A map that was merged before weighs as much as the maps "
    "that went into it.", NULL, NULL, NULL};
  arguments given = {.tolerance = SETTING_AUTOMATIC, .paths = calloc((size_t)argc, sizeof *given.paths)};
  if (!given.paths)
    return trouble_memory();
  parse_arguments(&parser, argc, argv, &given);
  int status = run(&given);
  free(given.paths);
  return status;
}
