/* SPDX-License-Identifier: AGPL-3.0-or-later */
/* The one exported symbol. */
#include "bake/baker.h"
#include "core/events.h"
#include "core/settings.h"
#include "map/lookup.h"
#include "map/map.h"
#include "map/worker.h"

#ifndef PACKAGE_VERSION
#define PACKAGE_VERSION "0.1"   /* configure knows better */
#endif

__attribute__((visibility("default")))
const dsm_api_table dsm_api = {
  .abi = DSM_ABI,
  .size = sizeof(dsm_api_table),
  .version = PACKAGE_VERSION,
  .parameters = settings_table,
  .parameter_count = WORD_COUNT,
  .settings_create = settings_create,
  .settings_set = settings_set,
  .settings_destroy = settings_destroy,
  .map_create = map_create,
  .map_destroy = map_destroy,
  .worker_create = baker_worker_create,
  .worker_destroy = worker_destroy,
  .lookup = map_lookup,
  .statistics = map_statistics,
  .sink_surface = sink_surface,
  .sink_span = sink_span,
  .sink_mark = sink_mark,
};
