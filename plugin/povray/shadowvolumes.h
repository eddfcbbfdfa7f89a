// SPDX-License-Identifier: AGPL-3.0-or-later
// The media of a scene's shadow casters, with what is known of each before any ray asks.

#ifndef POVRAY_BACKEND_SHADOWVOLUMES_H
#define POVRAY_BACKEND_SHADOWVOLUMES_H

#include <map>

#include "backend/shadow/shadowdensity.h"

namespace pov
{

class Media;

/// One medium that takes light: its densities multiply, and scale its extinction.
class ShadowMedium
{
	public:
		/// @param[in]      step        scene units: the first step where nothing tells a better one
		ShadowMedium(const Media& media, double step);

		double Step() const { return step; }
		/// An object that has the medium too may ask for shorter steps.
		void Shorten(double length) { step = min(step, length); }

		/// Extinction a scene unit. Densities below 0 are what they are.
		DblRGBColour Extinction(const Vector3d& point, TraceThreadData *thread) const;

		/// The only density that is not constant, if it is mapped: then extinction is Scale() times its transfer function.
		const ShadowDensity *Mapped() const { return mapped; }
		const DblRGBColour& Scale() const { return scale; }
		/// Whether the mapped density's extinction is below 0 anywhere.
		bool MayGrow() const { return grows; }

		/// The densities that are not constant.
		const vector<ShadowDensity>& Densities() const { return densities; }
	private:
		const PIGMENT *pigment;
		DblRGBColour extinction;
		DblRGBColour scale; ///< extinction times the constant densities
		vector<ShadowDensity> densities;
		const ShadowDensity *mapped;
		bool grows;
		double step;

		ShadowMedium(const ShadowMedium&);
		ShadowMedium& operator=(const ShadowMedium&);
};

/// Read-only once all objects are added, and shared by all threads.
class ShadowVolumes
{
	public:
		/// Adds the media of an object and of its parts.
		void Add(const ObjectBase *object);

		/// NULL: the medium belongs to no object that was added.
		const ShadowMedium *Find(const Media *media) const;
	private:
		std::map<const Media *, boost::shared_ptr<ShadowMedium> > media;
};

}

#endif
