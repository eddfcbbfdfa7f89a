/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "store/map_header.h"

#include <stdlib.h>

uint32_t map_header_format(const map_header *header)
{
  return header->block == BLOCK_SHADOW_MAP ? DEPTHS_FORMAT : DEEP_FORMAT;
}

stored_kind map_header_kind(const map_header *header)
{
  return header->block == BLOCK_SHADOW_MAP ? STORED_DEPTHS : header->coloured ? STORED_COLOURED : STORED_GREY;
}

void map_header_free(map_header *header)
{
  free(header->scenes);
  header->scenes = NULL;
  header->scene_count = 0;
}
