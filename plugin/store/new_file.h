/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* A file that replaces another one as a whole, or not at all. */
#ifndef DSM_STORE_NEW_FILE_H
#define DSM_STORE_NEW_FILE_H

#include "store/map_reason.h"

typedef struct {
  char *target;      /* what will be replaced; a symbolic link to a file is followed */
  char *temporary;   /* beside it; nobody else's */
} new_file;

/* Makes an empty file under the temporary name. DSM_REFUSED, with a sentence: the target exists but is no file or may not be
 * written, or its folder takes no new file. On DSM_OK one of the two below must follow. */
dsm_result new_file_create(const char *path, new_file *file, map_reason *why);

/* Gets the temporary file onto the disk, and renames it. On failure it is removed, and the target is as it was. */
dsm_result new_file_keep(new_file *file, map_reason *why);
void new_file_discard(new_file *file);

#endif
