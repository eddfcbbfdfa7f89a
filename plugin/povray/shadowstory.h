// SPDX-License-Identifier: AGPL-3.0-or-later
// What dims one light ray, before the library is told.

#ifndef POVRAY_BACKEND_SHADOWSTORY_H
#define POVRAY_BACKEND_SHADOWSTORY_H

#include "backend/shadow/shadowmedia.h"
#include "backend/shadow/shadowplugin.h"

namespace pov
{

/// Surfaces and spans of one ray, nearest first. Scratch memory: a thread keeps it between rays.
class ShadowStory : public ShadowMedia::Sink
{
	public:
		void Clear();
		void Surface(double depth, const double transmittance[3]);
		void Span(double front, double back, const double transmittance[3]);
		virtual void Span(double front, double back, const DblRGBColour& transmittance) { media = true; Span(front, back, *transmittance); }
		void Mark() { marked = true; }

		/// Whether media dim the ray.
		bool HasMedia() const { return media; }

		/// Hands all on.
		dsm_result Tell(unsigned int ray, dsm_sink *sink) const;

		/// Whether the mean of a few rays, each of which fills as much of one map pixel, is certain enough: its standard
		/// error is not above `error` at any of some depths where none of the rays has ended. Told by those that follow
		/// each other.
		static bool Agree(const ShadowStory stories[], int count, double error);
	private:
		struct Event
		{
			double front, back;
			double transmittance[3];
		};

		vector<Event> events;
		bool media, marked;
		bool overlapping; ///< spans

		double End() const;
		void Follow(const double depths[], double (*visible)[3]) const;
};

}

#endif
