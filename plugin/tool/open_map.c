/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "tool/open_map.h"

#include <string.h>

int trouble_because(dsm_result result, const map_reason *why)
{
  return result == DSM_NO_MEMORY ? trouble_memory() : trouble("%s", why->text);
}

int open_map_begin(open_map *map, const char *path)
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  memset(map, 0, sizeof *map);
  map->path = path;
  dsm_result result = map_file_open(path, &map->header, &map->file, &why);
  return result == DSM_OK ? STATUS_FINE : trouble_because(result, &why);
}

int open_map_begin_deep(open_map *map, const char *path)
{
  int status = open_map_begin(map, path);
  if (status != STATUS_FINE || !open_map_has_depths(map))
    return status;
  open_map_end(map);
  return trouble("%s is a shadow_map, with one depth a pixel; this command knows only deep shadow maps.", path);
}

void open_map_end(open_map *map)
{
  if (!map->file)
    return;
  map_file_close(map->file);
  map_header_free(&map->header);
  map->file = NULL;
}

int with_open_map(map_opener *begin, const char *path, map_work *work, void *data)
{
  open_map map;
  int status = begin(&map, path);
  if (status == STATUS_FINE)
    status = work(&map, data);
  open_map_end(&map);
  return status;
}

int open_map_tile(const open_map *map, const tile_key *key, const tile **out)
{
  char text[MAP_REASON_SIZE] = "";
  map_reason why = {text, sizeof text};
  dsm_result result = map_file_tile(map->file, key, out, &why);
  return result == DSM_OK ? STATUS_FINE : trouble_because(result, &why);
}

static uint32_t tiles_for(uint32_t pixels)
{
  return (pixels + TILE_SIDE - 1) / TILE_SIDE;
}

int map_grid_of(const projection *p, uint32_t face_index, uint32_t level, map_grid *grid)
{
  const face *f = &p->faces[face_index];
  if (face_index >= p->count || level >= projection_levels(p, face_index))
    return 0;
  uint32_t width = level_pixels(f->width, level), height = level_pixels(f->height, level);
  *grid = (map_grid){face_index, level, width, height, tiles_for(width), tiles_for(height)};
  return 1;
}

int open_map_grid(const open_map *map, const place_choice *choice, map_grid *grid)
{
  const projection *p = &map->header.projection;
  uint32_t first = 0;
  while (first < p->count && !p->faces[first].width)
    first++;
  if (first >= p->count)
    return trouble("%s has no pixels: nothing casts a shadow there.", map->path);
  uint32_t wanted = choice->face < 0 ? first : (uint32_t)choice->face;
  if (wanted >= p->count || !p->faces[wanted].width)
    return trouble("%s has no face %u with pixels; dsmtool info lists its faces.", map->path, (unsigned)wanted);
  if (!map_grid_of(p, wanted, choice->level, grid))
    return trouble("Face %u of %s has the levels 0 to %u, but not %u.", (unsigned)wanted, map->path,
                   (unsigned)projection_levels(p, wanted) - 1, (unsigned)choice->level);
  return STATUS_FINE;
}

int next_tile(const projection *p, tile_key *key, int *more)
{
  map_grid grid;
  if (*more && map_grid_of(p, key->face, key->level, &grid)) {
    if (++key->x < grid.across)
      return 1;
    key->x = 0;
    if (++key->y < grid.up)
      return 1;
    key->y = 0;
    key->face++;
  }
  *more = 1;
  for (; key->level < MAX_LEVELS; key->level++, key->face = 0)
    for (; key->face < p->count; key->face++)
      if (map_grid_of(p, key->face, key->level, &grid))
        return 1;
  return 0;
}

int open_map_visit(const open_map *map, tile_visitor *visit, void *data)
{
  tile_key key = {0, 0, 0, 0};
  map_grid grid;
  for (int more = 0; next_tile(&map->header.projection, &key, &more);) {
    const tile *t;
    if (open_map_tile(map, &key, &t) != STATUS_FINE)
      return STATUS_TROUBLE;
    map_grid_of(&map->header.projection, key.face, key.level, &grid);
    visit(data, &grid, &key, t);
    tile_destroy(t);
  }
  return STATUS_FINE;
}

tile_extent tile_extent_of(const map_grid *grid, const tile_key *key)
{
  uint32_t across = grid->width - key->x * TILE_SIDE, up = grid->height - key->y * TILE_SIDE;
  return (tile_extent){across < TILE_SIDE ? across : TILE_SIDE, up < TILE_SIDE ? up : TILE_SIDE};
}
