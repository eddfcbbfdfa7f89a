/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "tool/image_frame.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void image_frame_of(projection *p, uint32_t face_index, uint32_t level)
{
  for (uint32_t i = 0; i < p->count; i++)
    if (i != face_index)
      p->faces[i].width = p->faces[i].height = 0;
  face *f = &p->faces[face_index];
  double scale = (double)(1u << level);
  f->width = level_pixels(f->width, level);
  f->height = level_pixels(f->height, level);
  f->pixel_u *= scale;
  f->pixel_v *= scale;
  f->per_u /= scale;
  f->per_v /= scale;
}

static const char prefix[] = "dsm-export:", own[] = "dsm:";   /* ours, and that of a map's header */

dsm_result image_frame_write(const map_header *header, attribute_list *list)
{
  dsm_result result = map_header_write(header, list);
  for (uint32_t i = 0; i < list->count && result == DSM_OK; i++) {
    const char *name = list->items[i].name;
    size_t size = sizeof prefix + strlen(name);
    char *longer = malloc(size);
    if (!longer)
      return DSM_NO_MEMORY;
    snprintf(longer, size, "%s%s", prefix, name + strlen(own));
    free((char *)(size_t)name);
    list->items[i].name = longer;
  }
  return result;
}

static const char *get(void *data, const char *name)
{
  char longer[80];
  snprintf(longer, sizeof longer, "%s%s", prefix, name + strlen(own));
  return image_reader_attribute(data, longer);
}

dsm_result image_frame_read(const image_reader *reader, const image_size *size, const char *path, int *found,
                            map_header *header, uint32_t *face_index, map_reason *why)
{
  image_reader *data = (image_reader *)(size_t)reader;
  *found = get(data, "dsm:format") != NULL;
  if (!*found)
    return DSM_OK;
  dsm_result result = map_header_read(get, data, path, header, why);
  if (result != DSM_OK)
    return result;
  for (uint32_t i = 0; i < header->projection.count; i++) {
    const face *f = &header->projection.faces[i];
    *face_index = i;
    if (f->width == size->width && f->height == size->height)
      return DSM_OK;
  }
  map_header_free(header);
  *found = 0;
  return DSM_OK;
}
