// SPDX-License-Identifier: AGPL-3.0-or-later
// The section of the render statistics on shadow maps.

#include <iomanip>
#include <sstream>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/shadow/shadowcontext.h"
#include "backend/shadow/shadowmaps.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

string ShadowMaps::Statistics() const
{
	dsm_statistics sum = { 0 };
	POV_ULONG lookUps = 0, rayTraced = 0, compared = 0, different = 0;
	bool comparing = false;
	std::ostringstream text;

	if(maps.empty())
		return string();

	for(vector<ShadowMap>::const_iterator i(maps.begin()); i != maps.end(); i++)
	{
		dsm_statistics s = { 0 };
		s.size = sizeof(s);
		ShadowPlugin::Api().statistics(i->map.get(), &s);
		sum.faces += s.faces;
		sum.tiles += s.tiles;
		sum.tiles_baked += s.tiles_baked;
		sum.tiles_failed += s.tiles_failed;
		sum.pixels += s.pixels;
		sum.pixels_baked += s.pixels_baked;
		sum.pixels_marked += s.pixels_marked;
		sum.pixels_coloured += s.pixels_coloured;
		sum.rays += s.rays;
		sum.vertices_in += s.vertices_in;
		sum.vertices += s.vertices;
		sum.bytes += s.bytes;
		sum.bytes_most += s.bytes_most;
		sum.tiles_read += s.tiles_read;
		sum.tiles_evicted += s.tiles_evicted;
		sum.bake_seconds += s.bake_seconds;
		sum.trace_seconds += s.trace_seconds;
	}
	for(vector<shared_ptr<ShadowContext> >::const_iterator i(contexts.begin()); i != contexts.end(); i++)
	{
		lookUps += (*i)->lookUps;
		rayTraced += (*i)->rayTraced;
		comparing = (*i)->Hits().Comparing();
		compared += (*i)->Hits().compared;
		different += (*i)->Hits().different;
	}

	const double baked = max(1.0, double(sum.pixels_baked));
	text << std::fixed << std::setprecision(1)
	     << "Maps:                " << maps.size() << " (" << sum.faces << " faces), ray-traced lights: " << rayTracedLights << "\n"
	     << "Pixels baked:        " << sum.pixels_baked << " of " << sum.pixels << " (" << 100.0 * sum.pixels_baked / max(1.0, double(sum.pixels)) << " percent), coloured: "
	     << sum.pixels_coloured << ", marked: " << sum.pixels_marked << "\n"
	     << "Light rays:          " << sum.rays << "\n"
	     << std::setprecision(2)
	     << "Vertices per pixel:  " << sum.vertices / baked << " (before compression " << sum.vertices_in / baked << ")\n"
	     << "Bytes:               " << sum.bytes << "\n"
	     << "Look-ups:            " << lookUps << ", ray-traced: " << rayTraced << "\n"
	     << "Tiles:               " << sum.tiles_baked << " baked, " << sum.tiles_read << " read, " << sum.tiles_evicted
	     << " given up; most bytes " << sum.bytes_most << "\n"
	     << "Bake time:           " << sum.bake_seconds << " thread seconds (" << sum.trace_seconds << " tracing light rays)\n";
	if(sum.tiles_failed > 0)
		text << "Tiles failed:        " << sum.tiles_failed << "\n";
	if(comparing)
		text << "Rays in both orders: " << compared << ", different: " << different << "\n";
	if(different > 0)
		Tell(1, "light rays hit other surfaces object by object than they do one by one.");
	return text.str();
}

}
