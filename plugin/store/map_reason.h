/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* Where a sentence goes that says why something was refused. */
#ifndef DSM_STORE_MAP_REASON_H
#define DSM_STORE_MAP_REASON_H

#include <stddef.h>

#include "dsm.h"

typedef struct { char *text; size_t size; } map_reason;

enum { MAP_REASON_SIZE = 1000 };   /* room for any sentence about a path of ordinary length; longer ones are cut */

/* Both write a whole sentence and return what the caller is to return. `why` may be NULL. */
__attribute__((format(printf, 2, 3)))
dsm_result map_refused(map_reason *why, const char *format, ...);    /* DSM_REFUSED */
dsm_result map_no_memory(map_reason *why);                           /* DSM_NO_MEMORY */

#endif
