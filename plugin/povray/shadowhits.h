// SPDX-License-Identifier: AGPL-3.0-or-later
// The surfaces that light rays hit, found object by object or ray by ray.

#ifndef POVRAY_BACKEND_SHADOWHITS_H
#define POVRAY_BACKEND_SHADOWHITS_H

#include "backend/shadow/shadowcasters.h"

namespace pov
{

/// Both orders ask the same objects about the same rays, and find the same hits to the last bit: which order is taken,
/// and which rays come together, is a matter of speed alone.
class ShadowHits
{
	public:
		/// A surface on a ray. Equal depths are in the order of the casters, and then of the object's own answers.
		struct Hit
		{
			double depth;
			unsigned int caster, number;
			int surface; ///< see Surface; kOpaque: nothing more is needed of it
			bool operator<(const Hit& other) const
			{
				if(depth != other.depth)
					return depth < other.depth;
				return (caster != other.caster) ? (caster < other.caster) : (number < other.number);
			}
		};
		enum { kOpaque = -1 };

		/// The environment's DEEP_SHADOW_ORDER says "objects" (or nothing), "rays", or "both": then each ray's hits are
		/// found twice and compared.
		ShadowHits(const ShadowCasters& casters, TraceThreadData *thread);

		/// Makes the first rays of a batch ready for Of. Stops at the current task's pause points.
		/// @return     how many: at least one
		unsigned int Find(const dsm_ray *rays, unsigned int count);

		/// A ray's hits up to the first opaque one, nearest first. Good until the next call.
		const vector<Hit>& Of(unsigned int ray);
		Intersection& Surface(const Hit& hit) { return found[source].surfaces[hit.surface]; }

		bool Comparing() const { return order == kBoth; }
		POV_ULONG compared, different; ///< rays
		POV_ULONG asks, drawn, walks;  ///< of objects, of outlines and of rays by themselves
	private:
		enum Order { kObjects, kRays, kBoth };

		/// What is known of a ray.
		struct Track
		{
			double end;    ///< of the light: the nearest opaque hit, or the far depth
			bool opaque;
			unsigned int caster, number; ///< of that hit
			unsigned int veil; ///< the ray's last entry in `veils`
		};

		/// A hit that lets light through. Those of a ray are a list.
		struct Veil
		{
			Hit hit;
			unsigned int next;
		};
		static const unsigned int kNoVeil = static_cast<unsigned int>(-1);

		/// Where hits are kept: in the one place those found by object, in the other those of one ray.
		struct Found
		{
			vector<Veil> veils;
			vector<Intersection> surfaces;
		};

		struct Caster
		{
			ObjectPtr object;
			unsigned int number; ///< of its box
		};

		/// An object that has rays from this one of `selected` on.
		struct Wanted
		{
			unsigned int place;
			size_t first;
		};

		const ShadowCasters& casters;
		TraceThreadData *thread;
		Order order;

		const dsm_ray *rays;
		bool byObject;
		Order source; ///< of the last answer
		unsigned int asked; ///< since the last pause point

		// scratch, kept between rays; a Ray is too big for the stack of every caller
		Found found[2];
		vector<Track> tracks;
		vector<Hit> hits, others;
		ShadowTree::Stack stack;
		ShadowTree::Path path;
		ShadowBeam beam;
		ShadowOutline outline;
		vector<unsigned int> places, selected;
		vector<Wanted> wanted;
		Ray probe;

		enum Result { kDone, kTooMany, kNoBeam };
		Result FindByObject(unsigned int count);
		void FindTogether();
		void SelectRays(unsigned int place);
		void AskSelected(unsigned int place, size_t first, size_t end);
		void FindByRay(const dsm_ray& ray, vector<Hit>& out);
		void Ask(const Caster& caster, const dsm_ray& ray, double enter, double leave, Track& track, Found& out);
		void Collect(const Track& track, const Found& in, vector<Hit>& out) const;
		bool Agree() const;
		static void Start(Track& track, const dsm_ray& ray);
};

}

#endif
