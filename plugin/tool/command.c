/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "tool/command.h"

#include <errno.h>
#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/projection.h"

int trouble(const char *format, ...)
{
  va_list arguments;
  fflush(stdout);
  fputs("dsmtool: ", stderr);
  va_start(arguments, format);
  vfprintf(stderr, format, arguments);
  va_end(arguments);
  fputc('\n', stderr);
  return STATUS_TROUBLE;
}

int trouble_memory(void)
{
  return trouble("There is too little memory.");
}

double number_argument(struct argp_state *state, const char *what, const char *text, double low, double high)
{
  char *end;
  errno = 0;
  double number = strtod(text, &end);
  int wrong = end == text || *end || errno == ERANGE || !(number >= low && number <= high);
  if (wrong && high == DBL_MAX)
    argp_error(state, "%s must be a number of at least %g, not '%s'.", what, low, text);
  else if (wrong)
    argp_error(state, "%s must be a number from %g to %g, not '%s'.", what, low, high, text);
  return number;
}

uint32_t whole_argument(struct argp_state *state, const char *what, const char *text, uint32_t high)
{
  char *end;
  errno = 0;
  long long number = strtoll(text, &end, 10);
  if (end == text || *end || errno == ERANGE || number < 0 || number > high)
    argp_error(state, "%s must be a whole number from 0 to %u, not '%s'.", what, (unsigned)high, text);
  return (uint32_t)number;
}

int place_option(place_choice *choice, int key, char *text, struct argp_state *state)
{
  if (key == 'f')
    choice->face = (int)whole_argument(state, "--face", text, MAX_FACES - 1);
  else if (key == 'l')
    choice->level = whole_argument(state, "--level", text, MAX_LEVELS - 1);
  else
    return 0;
  return 1;
}

error_t one_path(int key, char *text, struct argp_state *state)
{
  const char **path = state->input;
  if (key == ARGP_KEY_NO_ARGS)
    argp_usage(state);
  if (key != ARGP_KEY_ARG || *path)
    return ARGP_ERR_UNKNOWN;
  *path = text;
  return 0;
}

void parse_arguments(const struct argp *parser, int argc, char **argv, void *data)
{
  argp_err_exit_status = STATUS_TROUBLE;
  if (argp_parse(parser, argc, argv, 0, NULL, data))
    exit(trouble_memory());
}
