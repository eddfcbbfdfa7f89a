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

namespace
{

const char kRule[] = "----------------------------------------------------------------------------\n";

/// Lights that are named. The front end takes no more than 4096 characters.
const size_t kMostChoices = 16;

/// What all maps of one kind have in common.
struct Sum
{
	dsm_statistics maps;
	size_t count;
	POV_ULONG lookUps, rayTraced;

	Sum() : maps(), count(0), lookUps(0), rayTraced(0) { }

	void Add(const dsm_statistics& s)
	{
		count++;
		maps.faces += s.faces;
		maps.tiles_baked += s.tiles_baked;
		maps.tiles_failed += s.tiles_failed;
		maps.pixels += s.pixels;
		maps.pixels_baked += s.pixels_baked;
		maps.pixels_marked += s.pixels_marked;
		maps.pixels_coloured += s.pixels_coloured;
		maps.rays += s.rays;
		maps.vertices_in += s.vertices_in;
		maps.vertices += s.vertices;
		maps.bytes += s.bytes;
		maps.bytes_most += s.bytes_most;
		maps.tiles_read += s.tiles_read;
		maps.tiles_evicted += s.tiles_evicted;
		maps.tiles_again += s.tiles_again;
		maps.bake_seconds += s.bake_seconds;
		maps.trace_seconds += s.trace_seconds;
		maps.samples += s.samples;
	}
};

}

string ShadowMaps::Statistics() const
{
	return Statistics(true) + Statistics(false) + Choices() + Comparison();
}

/// What was chosen for the lights that had a choice.
string ShadowMaps::Choices() const
{
	std::ostringstream text;
	size_t told = 0, more = 0;

	for(size_t i = 0; i < maps.size(); i++)
	{
		const ShadowMap& map = maps[i];

		if((map.choice != ShadowMap::kMap) && (map.choice != ShadowMap::kRays))
			continue;
		if(told == kMostChoices)
		{
			more++;
			continue;
		}
		text << std::left << std::setw(21) << ((told++ == 0) ? "Shadows by map/rays:" : "") << Name(*map.light)
		     << ((map.choice == ShadowMap::kMap) ? ": map" : ": rays");
		if(map.cost > 0.0)
			text << ", a map costs " << Times(map.cost) << " times the rays";
		text << "\n";
	}
	if(more > 0)
		text << std::setw(21) << "" << "and " << more << " more\n";
	return text.str();
}

/// Where both orders of light rays are tried: whether they hit the same.
string ShadowMaps::Comparison() const
{
	POV_ULONG compared = 0, different = 0;
	bool comparing = false;
	std::ostringstream text;

	for(vector<shared_ptr<ShadowContext> >::const_iterator i(contexts.begin()); i != contexts.end(); i++)
	{
		const ShadowHits *hits = (*i)->Hits();
		if(hits == NULL)
			continue;
		comparing = hits->Comparing();
		compared += hits->compared;
		different += hits->different;
	}
	if(comparing)
		text << "Rays in both orders: " << compared << ", different: " << different << "\n";
	if(different > 0)
		Tell(1, "light rays hit other surfaces object by object than they do one by one.");
	return text.str();
}

/// The section on maps of one kind; empty if there is none.
string ShadowMaps::Statistics(bool deep) const
{
	Sum sum;
	std::ostringstream text;

	for(size_t i = 0; i < maps.size(); i++)
	{
		dsm_statistics s = { 0 };

		if((maps[i].deep != deep) || (maps[i].choice == ShadowMap::kRays))
			continue;
		s.size = sizeof(s);
		ShadowPlugin::Api().statistics(maps[i].map.get(), &s);
		sum.Add(s);
		for(vector<shared_ptr<ShadowContext> >::const_iterator k(contexts.begin()); k != contexts.end(); k++)
		{
			sum.lookUps += (*k)->LookUps(i);
			sum.rayTraced += (*k)->RayTraced(i);
		}
	}
	if(sum.count == 0)
		return string();

	const dsm_statistics& all = sum.maps;
	const double baked = max(1.0, double(all.pixels_baked));
	text << std::fixed << std::setprecision(1)
	     << kRule << (deep ? "Deep Shadow Maps\n" : "Shadow Maps\n") << kRule
	     << "Maps:                " << sum.count << " (" << all.faces << " faces), ray-traced lights: " << rayTracedLights << "\n"
	     << "Pixels baked:        " << all.pixels_baked << " of " << all.pixels << " (" << 100.0 * all.pixels_baked / max(1.0, double(all.pixels)) << " percent)";
	if(deep)
		text << ", coloured: " << all.pixels_coloured << ", marked: " << all.pixels_marked;
	text << "\n"
	     << "Light rays:          " << all.rays << "\n"
	     << std::setprecision(2);
	if(deep)
		text << "Vertices per pixel:  " << all.vertices / baked << " (before compression " << all.vertices_in / baked << ")\n";
	else
		text << "Pixels with a depth: " << all.vertices << "\n";
	text << "Bytes:               " << all.bytes << "\n"
	     << "Look-ups:            " << sum.lookUps << ", ray-traced: " << sum.rayTraced << "\n";
	if(!deep)
		text << "Samples per look-up: " << all.samples / max(1.0, double(sum.lookUps)) << "\n";
	text << "Tiles:               " << all.tiles_baked << " baked, " << all.tiles_read << " read, " << all.tiles_evicted
	     << " given up, " << all.tiles_again << " of these baked again; most bytes " << all.bytes_most << "\n"
	     << "Bake time:           " << all.bake_seconds << " thread seconds (" << all.trace_seconds << " tracing light rays)\n";
	if(all.tiles_failed > 0)
		text << "Tiles failed:        " << all.tiles_failed << "\n";
	text << kRule;
	return text.str();
}

}
