/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A map's header in plain words, a line for each thing that it says; two headers compared line by line. */
#ifndef DSM_TOOL_HEADER_TEXT_H
#define DSM_TOOL_HEADER_TEXT_H

#include "store/map_header.h"

typedef enum { ABOUT_LIGHT, ABOUT_FRAME, ABOUT_SETTINGS, ABOUT_TOLERANCE, ABOUT_SCENE } header_topic;

typedef struct {
  header_topic topic;
  char name[24], text[300];   /* numbers as short as they can be without loss, so that equal text means equal values */
} header_line;

#define MAX_HEADER_LINES 48

uint32_t header_lines(const map_header *header, header_line lines[MAX_HEADER_LINES]);

/* The number as short as it can be without loss. Returns `text`. */
typedef struct { char text[32]; } number_text;
number_text number_as_text(double number);

#endif
