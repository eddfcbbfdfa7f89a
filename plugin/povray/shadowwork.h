// SPDX-License-Identifier: AGPL-3.0-or-later
// What tracing costs, counted instead of timed: the same on every machine, in every run, for any number of threads.

#ifndef POVRAY_BACKEND_SHADOWWORK_H
#define POVRAY_BACKEND_SHADOWWORK_H

#include "backend/support/statistics.h"
#include "backend/shadow/shadowplugin.h"

namespace pov
{

class ShadowEvents;

/// Work is in units of about a nanosecond of a processor of 2020. The weights are means over POV-Ray's distribution scenes;
/// a single scene may be off by half. What counts is the ratio of works of one kind.
///
/// Calibrated so: `Trace Time` in CPU seconds, of Shadow_Method=raytraced less that of none, against the same differences of
/// the counters in the statistics; and `Bake time` of a map, with and without tracing, against its light rays, events and vertices.

/// Of POV-Ray's own ray tracing, by its statistics.
double ShadowWorkOf(const RenderStatistics& stats);

/// Of finding what dims light rays, beyond what POV-Ray counts itself.
double ShadowWorkOf(const ShadowEvents& events);

/// Of the library's share in a map: what becomes of light rays.
double ShadowWorkOf(const dsm_statistics& map);

/// Of one look-up in a map, on average.
extern const double kShadowLookUpWork;

/// Of a tile that nothing shadows. No tile takes less.
extern const double kShadowLeastTileWork;

}

#endif
