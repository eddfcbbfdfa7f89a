// SPDX-License-Identifier: AGPL-3.0-or-later
// What one light's shadows would cost, ray-traced or from a map: what a few camera rays ask for, and what becomes of it
// in the whole image.

#ifndef POVRAY_BACKEND_SHADOWTALLY_H
#define POVRAY_BACKEND_SHADOWTALLY_H

#include <map>

#include "backend/shadow/shadowplugin.h"

namespace pov
{

class ShadowTally
{
	public:
		ShadowTally() : requests(0), rays(0.0), rest(0.0), baked(0), bakeWork(0.0), sample(0) { }

		/// What the requests so far belong to: tiles are counted once a sample.
		void BeginSample() { sample++; }

		/// Tiles that a look-up wants.
		void Want(const dsm_tiles& tiles);

		/// A shadow ray that was traced.
		/// @param[in]      rays        work of tracing it
		/// @param[in]      rest        work that would be left with a map
		void AddRequest(double rays, double rest);

		/// A tile that was baked to learn what it costs.
		void AddBaked(double work);

		POV_ULONG Requests() const { return requests; }
		unsigned int Baked() const { return baked; }

		/// One of the finest tiles that are wanted, and that has not been picked before.
		/// @return                     false if there is none
		bool Pick(dsm_tiles& tile);

		/// Work for an image.
		/// @param[in]      scale       samples of this kind that the image has, for each one taken
		double RaysWork(double scale) const { return rays * scale; }
		/// @param[in]      frameTiles  the finest tiles that there are
		double MapWork(double scale, double frameTiles) const;
		/// Of one tile: what those that were baked have cost, or else a guess that is low.
		double TileWork() const;
		/// Of the first tile that will be baked.
		double LikelyTileWork() const;
	private:
		/// Finest tile, or tile of a coarser level.
		struct Key
		{
			unsigned int face, level, y, x;
			bool operator<(const Key& o) const
			{
				return (level != o.level) ? (level < o.level) : (face != o.face) ? (face < o.face) : (y != o.y) ? (y < o.y) : (x < o.x);
			}
		};

		/// How often it was wanted.
		struct Wish
		{
			unsigned int samples, lastSample;
			bool picked;
			Wish() : samples(0), lastSample(0), picked(false) { }
		};
		typedef std::map<Key, Wish> Wishes;

		POV_ULONG requests;
		double rays, rest;
		unsigned int baked;
		double bakeWork;
		unsigned int sample; ///< the current one
		Wishes finest, coarse;

		bool Count(Wish& wish) const;
		double Tiles(double frameTiles) const;
};

}

#endif
