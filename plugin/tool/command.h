/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* What a command of dsmtool is, and what the commands share: exit status, sentences, numbers among the arguments. */
#ifndef DSM_TOOL_COMMAND_H
#define DSM_TOOL_COMMAND_H

#include <argp.h>
#include <stdint.h>

/* As diff(1) has it: same, different, trouble. Commands that compare nothing give the first or the last. */
enum { STATUS_FINE = 0, STATUS_DIFFERENT = 1, STATUS_TROUBLE = 2 };

typedef struct {
  const char *name;
  const char *summary;                 /* one line, without a full stop */
  int (*run)(int argc, char **argv);   /* argv[0] is "dsmtool NAME"; returns the exit status */
} command;

int check_run(int argc, char **argv);
int diff_run(int argc, char **argv);
int export_run(int argc, char **argv);
int import_run(int argc, char **argv);
int info_run(int argc, char **argv);
int merge_run(int argc, char **argv);
int plot_run(int argc, char **argv);
int slice_run(int argc, char **argv);

/* Prints "dsmtool: " and the sentence to the standard error output. Returns STATUS_TROUBLE. */
int trouble(const char *format, ...) __attribute__((format(printf, 1, 2)));
int trouble_memory(void);

/* The number that an option or argument called `what` stands for. Ends the program with a sentence if it is none, or outside
 * `low` to `high`. */
double number_argument(struct argp_state *state, const char *what, const char *text, double low, double high);
uint32_t whole_argument(struct argp_state *state, const char *what, const char *text, uint32_t high);

/* What of a map a command looks at: --face and --level. */
typedef struct { int face; uint32_t level; } place_choice;   /* face -1: the first that has pixels */

#define PLACE_OPTIONS \
  {"face", 'f', "N", 0, "which face of a cube, 0 to 5 (the first that has pixels)", 0}, \
  {"level", 'l', "N", 0, "which level, 0 is the finest (0)", 0}

/* Nonzero: the key was --face or --level. */
int place_option(place_choice *choice, int key, char *text, struct argp_state *state);

/* An argp_parser_t for commands that take one file and no option; their input is a const char *. */
error_t one_path(int key, char *text, struct argp_state *state);

/* Parses with `data` as the parser's input; ends the program on wrong arguments and after --help. */
void parse_arguments(const struct argp *parser, int argc, char **argv, void *data);

#endif
