/* SPDX-License-Identifier: AGPL-3.0-or-later */
/*
 * Tiles that a look-up need not make: their light meets one caster at most, and that lies behind the surface that is asked about.
 *
 *       \   light   \         A floor is lit wherever nothing stands between, and most of a floor is. To make a tile tells that, too,
 *        \           \        but with as many rays as where there is something to see.
 *   ______\___________\____
 *  |  caster    P          |  a plane through P with the light on one side: nothing on the other side takes light from P
 */
#ifndef DSM_MAP_LONE_CASTER_H
#define DSM_MAP_LONE_CASTER_H

#include "map/map.h"

/* Room to remember the casters of a map's tiles; none where nobody knows their boxes, or these are too many to look at. DSM_NO_MEMORY. */
dsm_result lone_casters_create(dsm_map *map);
void lone_casters_destroy(dsm_map *map);

/* What is remembered of a tile; LONE_FIRST is the first caster. */
enum { LONE_NOT_LOOKED = 0, LONE_SEVERAL, LONE_NONE, LONE_FIRST };

/* [any] As lone_caster_is_behind, where it is not known at once. */
int lone_caster_look(const dsm_map *map, const tile_key *key, const dsm_receiver *receiver);

/* [any] Whether the receiver's surface is lit as far as this tile can tell, whatever light does behind that. */
static inline int lone_caster_is_behind(const dsm_map *map, const tile_key *key, const dsm_receiver *receiver)
{
  if (!map->lone_casters || map->source)
    return 0;
  const _Atomic uint32_t *known = &map->lone_casters[tile_store_number(&map->store, key)];
  return atomic_load_explicit(known, memory_order_relaxed) != LONE_SEVERAL && lone_caster_look(map, key, receiver);
}

#endif
