/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The attributes of a file, one after the other. */
#ifndef DSM_STORE_ATTRIBUTE_LIST_H
#define DSM_STORE_ATTRIBUTE_LIST_H

#include "dsm.h"
#include "store/deep_exr.h"

typedef struct {
  deep_attribute *items;     /* names and texts are owned */
  uint32_t count, room;
} attribute_list;

enum { ATTRIBUTE_CHARS = 600 };   /* of a text, with its end */

/* Appends one. DSM_NO_MEMORY, or a text that is too long: the list can only be freed. */
__attribute__((format(printf, 3, 4)))
dsm_result put_attribute(attribute_list *list, const char *name, const char *format, ...);
void attribute_list_free(attribute_list *list);

#endif
