// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/shadow/shadowtally.h"
#include "backend/shadow/shadowwork.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// Tiles that were wanted by more samples than this are all alike to the estimate.
const unsigned int kOften = 3;

/// Light rays of a tile, and what each takes at least of a shadow ray's work.
const double kTileRays = 4096.0, kLeastShare = 0.1;

/// What a light ray takes as likely as not: a part of its own, and a share of a shadow ray's work. From tiles of the scenes in scenes/ and
/// of a scene whose shadow rays take little; each is within a factor of 3, where volumes are deep it is less.
const double kOwnWork = 700.0, kLikelyShare = 0.25;

/// Tiles are picked from all over the map: this share of the wanted ones further on each time, the golden section's.
const double kPickStep = 0.6180339887498949;

}

/// @return     false if nothing can be learned from it any more
bool ShadowTally::Count(Wish& wish) const
{
	if((wish.lastSample == sample) || (wish.samples >= kOften))
		return false;
	wish.lastSample = sample;
	wish.samples++;
	return true;
}

void ShadowTally::Want(const dsm_tiles& tiles)
{
	Key key = { tiles.face, tiles.level, tiles.y, tiles.x };

	// a coarse tile is made of many, so it is better not to go through them again and again
	if((tiles.level > 0) && !Count(coarse[key]))
		return;
	key.level = 0;
	for(key.y = tiles.y; key.y < tiles.past_y; key.y++)
		for(key.x = tiles.x; key.x < tiles.past_x; key.x++)
			Count(finest[key]);
}

void ShadowTally::AddRequest(double r, double left)
{
	requests++;
	rays += r;
	rest += left;
}

void ShadowTally::AddBaked(double work)
{
	baked++;
	bakeWork += work;
}

bool ShadowTally::Pick(dsm_tiles& tile)
{
	if(finest.empty())
		return false;
	const double at = (baked + 0.5) * kPickStep;
	Wishes::iterator i(finest.begin());
	std::advance(i, size_t((at - floor(at)) * finest.size()));
	if(i->second.picked)
		return false;
	i->second.picked = true;
	tile.face = i->first.face;
	tile.level = 0;
	tile.x = i->first.x;
	tile.y = i->first.y;
	tile.past_x = tile.x + 1;
	tile.past_y = tile.y + 1;
	return true;
}

/// Tiles that the whole image wants: those seen, and by Chao's estimate (1984) from those seen once or twice as many
/// as have not been seen.
double ShadowTally::Tiles(double frameTiles) const
{
	double once = 0.0, twice = 0.0;

	for(Wishes::const_iterator i(finest.begin()); i != finest.end(); i++)
	{
		once += (i->second.samples == 1) ? 1.0 : 0.0;
		twice += (i->second.samples == 2) ? 1.0 : 0.0;
	}
	return min(frameTiles, finest.size() + once * (once - 1.0) / (2.0 * (twice + 1.0)));
}

double ShadowTally::TileWork() const
{
	if(baked > 0)
		return bakeWork / baked;
	return kShadowLeastTileWork + ((requests > 0) ? kTileRays * kLeastShare * rays / requests : 0.0);
}

double ShadowTally::LikelyTileWork() const
{
	return kShadowLeastTileWork + ((requests > 0) ? kTileRays * (kOwnWork + kLikelyShare * rays / requests) : 0.0);
}

double ShadowTally::MapWork(double scale, double frameTiles) const
{
	return (requests * kShadowLookUpWork + rest) * scale + Tiles(frameTiles) * TileWork();
}

}
