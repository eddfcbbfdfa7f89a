/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* dsmtool: looks into deep shadow maps, compares and merges them, and takes them to other programs and back. */
#include <stdio.h>
#include <string.h>

#include "dsm.h"
#include "tool/command.h"

static const command commands[] = {
  {"info", "says what a map is: light, frame, settings, levels, sizes", info_run},
  {"plot", "draws the visibility function of one pixel", plot_run},
  {"slice", "writes the map, seen at one depth, as an image", slice_run},
  {"diff", "tells how far two maps are from each other", diff_run},
  {"check", "reads all of a map and says what is wrong with it", check_run},
  {"merge", "averages maps of several clock values: motion blur", merge_run},
  {"export", "writes a standard deep OpenEXR image for compositors", export_run},
  {"import", "makes a map of a standard deep OpenEXR image", import_run},
};

enum { COMMANDS = sizeof commands / sizeof *commands };

static void print_help(FILE *to)
{
  fputs("usage: dsmtool COMMAND ARGUMENTS...\n\nLooks into deep shadow maps and works on them.\n\n", to);
  for (int i = 0; i < COMMANDS; i++)
    fprintf(to, "  %-8s %s\n", commands[i].name, commands[i].summary);
  fputs("\ndsmtool COMMAND --help tells more; dsmtool --version prints the version. The exit status is 2 where something\n"
        "could not be done. Pixels are counted from the left and from the top, as slice and export show them.\n", to);
}

int main(int argc, char **argv)
{
  const char *word = argc > 1 ? argv[1] : "";
  if (!strcmp(word, "--help") || !strcmp(word, "-h") || !strcmp(word, "help")) {
    print_help(stdout);
    return STATUS_FINE;
  }
  if (!strcmp(word, "--version") || !strcmp(word, "-V")) {
    printf("dsmtool %s\n", dsm_api.version);
    return STATUS_FINE;
  }
  for (int i = 0; i < COMMANDS; i++)
    if (!strcmp(word, commands[i].name)) {
      char name[32];
      snprintf(name, sizeof name, "dsmtool %s", word);
      argv[1] = name;
      return commands[i].run(argc - 1, argv + 1);
    }
  if (argc > 1)
    trouble("There is no command '%s'; see dsmtool --help.", word);
  else
    print_help(stderr);
  return STATUS_TROUBLE;
}
