/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The part of dsmtool info that tells what a map of depths holds. */
#ifndef DSM_TOOL_INFO_DEPTHS_H
#define DSM_TOOL_INFO_DEPTHS_H

#include "tool/open_map.h"

/* Returns the exit status. */
int info_depths(const open_map *map);

#endif
