/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/attribute_list.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static dsm_result grow(attribute_list *list)
{
  uint32_t room = list->room ? 2 * list->room : 64;
  deep_attribute *items = realloc(list->items, room * sizeof *items);
  if (!items)
    return DSM_NO_MEMORY;
  list->items = items;
  list->room = room;
  return DSM_OK;
}

dsm_result put_attribute(attribute_list *list, const char *name, const char *format, ...)
{
  char text[ATTRIBUTE_CHARS];
  va_list arguments;
  va_start(arguments, format);
  int length = vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (length < 0 || length >= ATTRIBUTE_CHARS || (list->count == list->room && grow(list) != DSM_OK))
    return DSM_NO_MEMORY;
  deep_attribute item = {strdup(name), strdup(text)};
  list->items[list->count++] = item;
  return item.name && item.text ? DSM_OK : DSM_NO_MEMORY;
}

void attribute_list_free(attribute_list *list)
{
  for (uint32_t i = 0; i < list->count; i++) {
    free((char *)(size_t)list->items[i].name);
    free((char *)(size_t)list->items[i].text);
  }
  free(list->items);
  *list = (attribute_list){NULL, 0, 0};
}
