/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* dsmtool plot: the visibility function of one pixel, drawn by gnuplot. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "store/new_file.h"
#include "tool/open_map.h"

extern char **environ;

typedef struct {
  const char *path, *output, *terminal;
  uint32_t x, row;
  place_choice place;
} arguments;

/* Starts gnuplot with its input connected to *to and its output to a file. 0, or what went wrong as errno has it. */
static int start_gnuplot(const char *output, FILE **to, pid_t *child)
{
  char *words[] = {"gnuplot", NULL};
  int ends[2];
  if (pipe(ends))
    return errno;
  fcntl(ends[1], F_SETFD, FD_CLOEXEC);   /* or gnuplot would wait for itself to end its input */
  posix_spawn_file_actions_t actions;
  int failed = posix_spawn_file_actions_init(&actions);
  if (!failed) {
    failed = posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    if (!failed)
      failed = posix_spawn_file_actions_addclose(&actions, ends[0]);
    if (!failed)
      failed = posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output, O_WRONLY | O_TRUNC, 0666);
    if (!failed)
      failed = posix_spawnp(child, words[0], &actions, NULL, words, environ);
    posix_spawn_file_actions_destroy(&actions);
  }
  close(ends[0]);
  *to = failed ? NULL : fdopen(ends[1], "w");
  if (!*to)
    close(ends[1]);
  return failed;
}

/* In gnuplot's single quotes, which know one escape: a quote is doubled. */
static void put_quoted(FILE *to, const char *text)
{
  fputc('\'', to);
  for (; *text; text++) {
    if (*text == '\'')
      fputc('\'', to);
    fputc(*text, to);
  }
  fputc('\'', to);
}

static void put_curves(FILE *to, const vertices *v, int coloured, double from, double end)
{
  fprintf(to, "$visibility << E\n%.17g 1 1 1\n", from);
  if (v->count)
    fprintf(to, "%.17g 1 1 1\n", v->data[0].z);
  for (size_t i = 0; i < v->count; i++)
    fprintf(to, "%.17g %.9g %.9g %.9g\n", v->data[i].z, v->data[i].v.c[0], v->data[i].v.c[1], v->data[i].v.c[2]);
  rgb last = v->count ? v->data[v->count - 1].v : rgb_grey(1);
  fprintf(to, "%.17g %.9g %.9g %.9g\nE\n", end, last.c[0], last.c[1], last.c[2]);
  if (coloured)
    fputs("plot $visibility u 1:2 w lp pt 7 ps 0.4 lc rgb '#c02020' t 'red', $visibility u 1:3 w lp pt 7 ps 0.4 "
          "lc rgb '#209020' t 'green', $visibility u 1:4 w lp pt 7 ps 0.4 lc rgb '#2040c0' t 'blue'\n", to);
  else
    fputs("plot $visibility u 1:2 w lp pt 7 ps 0.4 lc rgb '#202020' notitle\n", to);
}

static void put_plot(FILE *to, const open_map *map, const arguments *given, const map_grid *grid, const vertices *v,
                     int coloured)
{
  const face *f = &map->header.projection.faces[grid->face];
  double from = f->near_depth, end = f->far_depth;
  if (v->count) {   /* what happens, and some of what is around it */
    double room = 0.1 * (v->data[v->count - 1].z - v->data[0].z);
    room = room > 0 ? room : 0.01 * (end - from);
    from = v->data[0].z - room;
    end = v->data[v->count - 1].z + room;
  }
  fprintf(to, "set terminal %s\nset title noenhanced ", given->terminal);
  char title[600];
  snprintf(title, sizeof title, "%s: pixel %u %u of face %u, level %u, %llu vertices", map->path, (unsigned)given->x,
           (unsigned)given->row, (unsigned)grid->face, (unsigned)grid->level, (unsigned long long)v->count);
  put_quoted(to, title);
  fputs("\nset ylabel 'visibility'\nset xlabel noenhanced ", to);
  put_quoted(to, map->header.projection.perspective ? "depth (scene units from the light)"
                                                    : "depth (scene units from the light's plane)");
  fprintf(to, "\nset xrange [%.17g:%.17g]\nset yrange [-0.02:1.02]\nset grid\n", from, end > from ? end : from + 1);
  put_curves(to, v, coloured, from, end);
}

static int draw_to(const char *file, const open_map *map, const arguments *given, const map_grid *grid,
                   const vertices *v, int coloured)
{
  FILE *to;
  pid_t child;
  int wrong = start_gnuplot(file, &to, &child), status;
  if (wrong == ENOENT)
    return trouble("The program gnuplot is not installed; it draws the plot (Debian: gnuplot-nox).");
  if (wrong)
    return trouble("The program gnuplot cannot be started: %s.", strerror(wrong));
  signal(SIGPIPE, SIG_IGN);   /* its exit status tells */
  if (to) {
    put_plot(to, map, given, grid, v, coloured);
    fclose(to);
  }
  while (waitpid(child, &status, 0) < 0 && errno == EINTR)
    ;
  if (!to || !WIFEXITED(status) || WEXITSTATUS(status))
    return trouble("The program gnuplot could not draw %s.", given->output);
  return STATUS_FINE;
}

static int draw(const open_map *map, const arguments *given, const map_grid *grid, const vertices *v, int coloured)
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  new_file file;
  dsm_result result = new_file_create(given->output, &file, &why);
  if (result == DSM_OK) {
    int status = draw_to(file.temporary, map, given, grid, v, coloured);
    if (status != STATUS_FINE) {
      new_file_discard(&file);
      return status;
    }
    result = new_file_keep(&file, &why);
  }
  return result == DSM_OK ? STATUS_FINE : trouble_because(result, &why);
}

static int run(const open_map *map, void *data)
{
  const arguments *given = data;
  map_grid grid;
  if (open_map_grid(map, &given->place, &grid) != STATUS_FINE)
    return STATUS_TROUBLE;
  if (given->x >= grid.width || given->row >= grid.height)
    return trouble("Level %u of face %u of %s has %u x %u pixels, and so no pixel %u %u.", (unsigned)grid.level,
                   (unsigned)grid.face, map->path, (unsigned)grid.width, (unsigned)grid.height, (unsigned)given->x,
                   (unsigned)given->row);
  uint32_t y = grid.height - 1 - given->row, place = y % TILE_SIDE * TILE_SIDE + given->x % TILE_SIDE;
  tile_key key = {grid.face, grid.level, given->x / TILE_SIDE, y / TILE_SIDE};
  const tile *t;
  if (open_map_tile(map, &key, &t) != STATUS_FINE)
    return STATUS_TROUBLE;
  vertices v = {0};
  int status;
  if (t->kind == TILE_STORED && tile_is_marked(t, place))
    status = trouble("Pixel %u %u of %s is marked: light can grow there, the map stores nothing, and shadows are "
                     "ray-traced.", (unsigned)given->x, (unsigned)given->row, map->path);
  else if (read_pixel(t, place, &v) != DSM_OK)
    status = trouble_memory();
  else
    status = draw(map, given, &grid, &v, t->kind == TILE_STORED && tile_is_coloured(t, place));
  vertices_free(&v);
  tile_destroy(t);
  return status;
}

static const char *terminal_for(const char *output)
{
  const char *ending = strrchr(output, '.');
  if (ending && !strcmp(ending, ".svg"))
    return "svg size 800,480 background '#ffffff'";
  return ending && !strcmp(ending, ".png") ? "pngcairo size 800,480" : NULL;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
  arguments *given = state->input;
  if (place_option(&given->place, key, text, state))
    return 0;
  if (key == 'o') {
    given->output = text;
    given->terminal = terminal_for(text);
    if (!given->terminal)
      argp_error(state, "The picture's name must end in .svg or .png, not as '%s' does.", text);
  }
  else if (key == ARGP_KEY_ARG && state->arg_num == 0)
    given->path = text;
  else if (key == ARGP_KEY_ARG && state->arg_num == 1)
    given->x = whole_argument(state, "X", text, UINT32_MAX);
  else if (key == ARGP_KEY_ARG && state->arg_num == 2)
    given->row = whole_argument(state, "Y", text, UINT32_MAX);
  else if (key == ARGP_KEY_END && (state->arg_num < 3 || !given->output))
    argp_error(state, "A map, X, Y and -o PICTURE are needed.");
  else
    return ARGP_ERR_UNKNOWN;
  return 0;
}

int plot_run(int argc, char **argv)
{
  static const struct argp_option options[] = {
    {"output", 'o', "PICTURE", 0, "the picture to write, .svg or .png", 0}, PLACE_OPTIONS, {0}};
  static const struct argp parser = {options, parse, "MAP X Y -o PICTURE", "Draws the visibility function of one pixel: "
    "the share of light that is left against the depth, with a dot for each vertex; red, green and blue apart where the "
    "pixel is coloured. X counts from the left, Y from the top. Needs the program gnuplot.", NULL, NULL, NULL};
  arguments given = {.place = {-1, 0}};
  parse_arguments(&parser, argc, argv, &given);
  return with_open_map(open_map_begin_deep, given.path, run, &given);
}
