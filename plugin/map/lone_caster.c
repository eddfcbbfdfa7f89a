/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include "map/lone_caster.h"

#include <math.h>
#include <stdlib.h>

#include "core/box_outline.h"

/* With more casters than that, looking at all their boxes would cost more than it spares. */
enum { MOST_BOXES = 2000 };

/* Hosts round boxes outwards, as floats: this share of their coordinates may stand out of a surface that lies on them. */
static const double ROUNDING = 2e-6, LEAST_ROUNDING = 2e-9;

dsm_result lone_casters_create(dsm_map *map)
{
  uint64_t casters = map->light.caster_count;
  if (casters == 0 || casters > MOST_BOXES || map->first_level > 0 || map_has_depths(map))
    return DSM_OK;
  map->lone_casters = calloc(map->store.tile_count + 1, sizeof *map->lone_casters);   /* all bits zero: LONE_NOT_LOOKED */
  return map->lone_casters ? DSM_OK : DSM_NO_MEMORY;
}

void lone_casters_destroy(dsm_map *map)
{
  free((void *)map->lone_casters);
}

/* What the tile's pixels see, and some more. */
static rectangle area_of(const dsm_map *map, const tile_key *key)
{
  const face *f = &map->projection.faces[key->face];
  double size = ldexp(TILE_SIDE, (int)key->level), reach = map->settings.filter_width;
  return (rectangle){f->u0 + (key->x * size - reach) * f->pixel_u, f->v0 + (key->y * size - reach) * f->pixel_v,
                     f->u0 + ((key->x + 1) * size + reach) * f->pixel_u, f->v0 + ((key->y + 1) * size + reach) * f->pixel_v};
}

static uint32_t look(const dsm_map *map, const tile_key *key)
{
  const projection *p = &map->projection;
  rectangle area = area_of(map, key);
  uint32_t found = LONE_NONE;
  for (uint32_t i = 0; i < map->light.caster_count && found != LONE_SEVERAL; i++) {
    outline seen = OUTLINE_EMPTY;
    outline_add(&seen, p->origin, &p->faces[key->face].axes, p->perspective, &area, &map->light.casters[i]);
    if (seen.area.u0 <= seen.area.u1)
      found = found == LONE_NONE ? LONE_FIRST + i : LONE_SEVERAL;
  }
  return found;
}

/* Whether no part of the box stands out of the plane. */
static int is_behind(const dsm_box *box, const double point[3], const double normal[3])
{
  double farthest = 0, slack = LEAST_ROUNDING;
  for (int i = 0; i < 3; i++) {
    double n = normal[i];
    farthest += n * ((n > 0 ? box->high[i] : box->low[i]) - point[i]);
    slack += ROUNDING * fabs(n) * (fabs(box->low[i]) + fabs(box->high[i]));
  }
  return farthest <= slack;   /* not where it is no number */
}

int lone_caster_look(const dsm_map *map, const tile_key *key, const dsm_receiver *receiver)
{
  _Atomic uint32_t *known = &map->lone_casters[tile_store_number(&map->store, key)];
  uint32_t caster = atomic_load_explicit(known, memory_order_relaxed);
  if (caster == LONE_NOT_LOOKED) {
    caster = look(map, key);   /* whoever looks finds the same */
    atomic_store_explicit(known, caster, memory_order_relaxed);
  }
  if (caster < LONE_FIRST)
    return caster == LONE_NONE;
  return receiver->plane_count > 0 && is_behind(&map->light.casters[caster - LONE_FIRST], receiver->point, receiver->planes[0].normal);
}
