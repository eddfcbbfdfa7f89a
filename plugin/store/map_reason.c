/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/map_reason.h"

#include <stdarg.h>
#include <stdio.h>

dsm_result map_refused(map_reason *why, const char *format, ...)
{
  if (why && why->size) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why->text, why->size, format, arguments);
    va_end(arguments);
  }
  return DSM_REFUSED;
}

dsm_result map_no_memory(map_reason *why)
{
  map_refused(why, "There is no memory for the file of a shadow map.");
  return DSM_NO_MEMORY;
}
