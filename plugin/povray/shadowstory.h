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
		virtual void Span(double front, double back, const DblRGBColour& transmittance) { Span(front, back, *transmittance); }
		virtual void Mark() { marked = true; }

		/// The ray passes media, even if they take no light.
		void Media() { media = true; }
		bool HasMedia() const { return media; }

		/// Hands all on.
		dsm_result Tell(unsigned int ray, dsm_sink *sink) const;

		/// Rays of a map pixel that may stand for all of it.
		enum { kFew = 4 };

		/// What tells how far a few rays of a pixel are from changing linearly across it.
		struct Contrast
		{
			explicit Contrast(const dsm_ray *const rays[kFew]);
			double weight[kFew]; ///< squares add up to 1
		};

		/// Whether the mean of a few rays, each of which fills as much of one map pixel, is certain enough: its standard
		/// error is not above `error` at any of some depths where none of the rays has ended. Light that changes linearly
		/// across the pixel has the same mean whether few rays tell or many; what counts is how far it is from that.
		static bool Agree(const ShadowStory stories[kFew], const Contrast& contrast, double error);
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
