/* SPDX-License-Identifier: AGPL-3.0-or-later */
#include <stdio.h>

#include "store/map_header_words.h"
#include "store/plain_numbers.h"

/* 17 digits give a double back with the same bits. */
#define N "%.17g"
#define N3 N " " N " " N
#define THREE(v) (v)[0], (v)[1], (v)[2]
#define AXES(a) THREE((a).right), THREE((a).up), THREE((a).forward)

static dsm_result put_light(attribute_list *list, const dsm_light *light)
{
  dsm_result result = put_attribute(list, "dsm:light", "%s", light_words[light->kind]);
  if (result == DSM_OK)
    result = put_attribute(list, "dsm:origin", N3, THREE(light->origin));
  if (result == DSM_OK && light->kind != DSM_LIGHT_POINT)
    result = put_attribute(list, "dsm:direction", N3, THREE(light->direction));
  if (result == DSM_OK && light->kind == DSM_LIGHT_SPOT)
    result = put_attribute(list, "dsm:cos_angle", N, light->cos_angle);
  if (result == DSM_OK && light->kind == DSM_LIGHT_PARALLEL)
    result = put_attribute(list, "dsm:radius", N, light->radius);
  return result;
}

static dsm_result put_projection(attribute_list *list, const projection *p)
{
  dsm_result result = put_attribute(list, "dsm:projection", "%s", p->perspective ? "perspective" : "orthographic");
  if (result == DSM_OK)
    result = put_attribute(list, "dsm:frame", N3 " " N3 " " N3 " " N3, THREE(p->origin), AXES(p->axes));
  if (result == DSM_OK)
    result = put_attribute(list, "dsm:faces", "%u " N, (unsigned)p->count, p->overlap);
  for (uint32_t i = 0; i < p->count && result == DSM_OK; i++) {
    const face *f = &p->faces[i];
    char name[40];
    snprintf(name, sizeof name, "dsm:face%u", (unsigned)i);
    result = put_attribute(list, name, "%u %u  " N " " N "  " N " " N "  " N " " N "  " N " " N "  " N3 "  " N3 "  " N3,
                           (unsigned)f->width, (unsigned)f->height, f->u0, f->v0, f->pixel_u, f->pixel_v, f->per_u, f->per_v,
                           f->near_depth, f->far_depth, AXES(f->axes));
  }
  return result;
}

static dsm_result put_deep_settings(attribute_list *list, const map_header *h)
{
  dsm_result result = put_attribute(list, "dsm:samples", "%u", (unsigned)h->samples);
  if (result == DSM_OK)
    result = h->tolerance < 0 ? put_attribute(list, "dsm:tolerance", "automatic") : put_attribute(list, "dsm:tolerance", N, h->tolerance);
  if (result == DSM_OK)
    result = put_attribute(list, "dsm:filter", "%s " N, filter_words[h->filter], h->filter_width);
  return result;
}

static dsm_result put_settings(attribute_list *list, const map_header *h)
{
  dsm_result result = put_attribute(list, "dsm:resolution", "%u %u", (unsigned)h->resolution[0], (unsigned)h->resolution[1]);
  if (result == DSM_OK)
    result = h->block == BLOCK_SHADOW_MAP ? put_attribute(list, "dsm:depth_samples", "%s", depth_words[h->jittered != 0])
                                          : put_deep_settings(list, h);
  if (result == DSM_OK)
    result = h->bounded ? put_attribute(list, "dsm:bounds", N3 " " N3, THREE(h->bounds.low), THREE(h->bounds.high))
                        : put_attribute(list, "dsm:bounds", "none");
  return result;
}

static dsm_result put_deep_content(attribute_list *list, const map_header *h)
{
  dsm_result result = put_attribute(list, "dsm:colour", "%s", h->coloured ? "yes" : "no");
  if (result == DSM_OK)
    result = put_attribute(list, "dsm:vertices", "%llu", (unsigned long long)h->vertices);
  if (result == DSM_OK)
    result = put_attribute(list, "dsm:pixels_marked", "%llu", (unsigned long long)h->pixels_marked);
  return result;
}

static dsm_result put_content(attribute_list *list, const map_header *h)
{
  dsm_result result = h->block == BLOCK_SHADOW_MAP ? put_attribute(list, "dsm:depths", "%llu", (unsigned long long)h->vertices)
                                                   : put_deep_content(list, h);
  if (result == DSM_OK)
    result = put_attribute(list, "dsm:scenes", "%u", (unsigned)h->scene_count);
  for (uint32_t i = 0; i < h->scene_count && result == DSM_OK; i++) {
    char name[40];
    snprintf(name, sizeof name, "dsm:scene%u", (unsigned)i);
    result = put_attribute(list, name, "%s %s", h->scenes[i].casters, h->scenes[i].probes);
  }
  return result;
}

dsm_result map_header_write(const map_header *header, attribute_list *list)
{
  number_style style;
  *list = (attribute_list){NULL, 0, 0};
  if (!plain_numbers(&style))
    return DSM_NO_MEMORY;
  int depths = header->block == BLOCK_SHADOW_MAP;
  dsm_result result = put_attribute(list, "dsm:format", "%u", (unsigned)map_header_format(header));
  if (result == DSM_OK && depths)
    result = put_attribute(list, "dsm:map", "depths");
  if (result == DSM_OK)
    result = put_light(list, &header->light);
  if (result == DSM_OK)
    result = put_projection(list, &header->projection);
  if (result == DSM_OK)
    result = put_settings(list, header);
  if (result == DSM_OK)
    result = put_content(list, header);
  restore_numbers(&style);
  return result;
}
