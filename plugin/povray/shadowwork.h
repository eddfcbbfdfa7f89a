// SPDX-License-Identifier: AGPL-3.0-or-later
// What tracing costs, counted instead of timed: the same on every machine, in every run, for any number of threads.

#ifndef POVRAY_BACKEND_SHADOWWORK_H
#define POVRAY_BACKEND_SHADOWWORK_H

#include "backend/support/statistics.h"
#include "backend/shadow/shadowplugin.h"

namespace pov
{

class ShadowEvents;

/// Work is in units of about a nanosecond of a processor of 2020. A single scene may be off by half or more: what counts is the
/// ratio of two works, and both sides test the same shapes and densities.
///
/// The weights of POV-Ray's own counters are rough: what such a test takes by its kind. Those of the library's share are from
/// `Bake time` less that of tracing, of sphere_plane.pov and glass.pov in scenes/, against light rays and vertices before compression.
/// As a check on all of them, the ratios of map to rays that come out for cloud_pipes.pov and hairball.pov, 0.2 and 0.3, are those of
/// the seconds measured, less those of Shadow_Method=none; for cloud.pov, where either is far from 1, the map's cost is twice too high.

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
