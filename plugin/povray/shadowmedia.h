// SPDX-License-Identifier: AGPL-3.0-or-later
// How much light media take along a piece of a light ray: the integral of the scene's own densities.

#ifndef POVRAY_BACKEND_SHADOWMEDIA_H
#define POVRAY_BACKEND_SHADOWMEDIA_H

#include "backend/shadow/shadowvolumes.h"

namespace pov
{

/// Integrates extinction between two depths of a ray and hands on spans in which light falls exponentially. POV-Ray's own
/// three sampling methods are not used: they only approach this integral (method 3, the default, never samples the light
/// end).
///
/// Where the densities' structure is known, the ray goes from piece to piece: what is empty or constant takes no
/// evaluation at all, and the rest is sampled where it bends. Elsewhere steps are halved until a cubic through the samples
/// agrees with a straight line. Between samples a mapped density is integrated through its map, which is exact however
/// steep the map is; so what has to be smooth is the pattern and not the density.
class ShadowMedia
{
	public:
		class Sink
		{
			public:
				virtual ~Sink() { }
				virtual void Span(double front, double back, const DblRGBColour& transmittance) = 0;
				/// The light grows somewhere on the way, which no span tells.
				virtual void Mark() = 0;
		};

		/// Scratch memory for one thread.
		explicit ShadowMedia(TraceThreadData *thread);

		/// The media that the next integrals are of.
		void Clear();
		void Add(const ShadowMedium& medium);
		bool Empty() const { return media.empty(); }

		/// @param[in]      visible     largest channel of the light that is left at `front`: the less, the coarser the steps
		/// @param[in]      tolerance   of light at any depth
		/// @param[in]      slackness   how many times as wrong a step may be where nothing makes neighbouring steps and rays err
		///                             to the same side
		/// @return                     what is visible at `back`
		double Integrate(const dsm_ray& ray, double front, double back, double visible, double tolerance, double slackness, Sink& sink);

		mutable POV_ULONG evaluations; ///< of all densities at a point
	private:
		/// Media beyond these many are sampled without their maps.
		enum { kMostMapped = 3 };

		struct Sample
		{
			double depth;
			bool known;                ///< the rest is set
			double value[kMostMapped]; ///< of the mapped media's patterns
			DblRGBColour other;        ///< extinction of all other media
		};

		struct Point
		{
			double depth;
			DblRGBColour thickness;    ///< optical depth from where the integral began
			double visible;            ///< largest channel of the light that is left
		};

		/// A density on the way.
		struct Part
		{
			const ShadowMedium *medium;
			const ShadowDensity *density;
			ShadowDensity::Line line;
			ShadowDensity::Piece piece; ///< in force up to its end
			bool even;
		};

		/// A part of the way in which all densities keep to their pieces.
		struct Stretch
		{
			double end;
			bool even;                 ///< extinction is constant, as good as
			DblRGBColour extinction;   ///< if it is
			double step;               ///< the first steps, if not
			bool grid;                 ///< they are a density file's
		};

		TraceThreadData *thread;
		vector<const ShadowMedium *> media;
		vector<const ShadowMedium *> mapped, others; ///< the same media, by how they are sampled
		bool grey;                    ///< all of them: one channel tells
		mutable bool grows;           ///< extinction below 0 was met

		// of the integral under way
		const dsm_ray *ray;
		double visibleAtFront;
		double allowed;               ///< error of light in one step
		double allowedSmooth;         ///< with slackness
		double firstStep;             ///< where nothing is known
		vector<Part> parts;           ///< in the order of the media
		vector<Point> points;

		// of a run: a part of the way that has to be sampled
		vector<Sample> planned;       ///< nearest first
		vector<Sample> passed, ahead; ///< the nearest to the end of what is passed last in both
		double allowedInRun;
		double shortest;

		void Begin(double front, double back);
		void Look(double depth, double back, Stretch& stretch);
		bool IsEven(const DblRGBColour& least, const DblRGBColour& most) const;
		void Plan(double depth, double step, bool forced);
		void Know(Sample& sample) const;
		void Run(double dark);
		template<int kChannels>
		double Bend(const Sample *before, const Sample& from, const Sample& to, const Sample *after, DblRGBColour halves[2]) const;
		void Advance(double depth, const DblRGBColour& thickness);
		template<int kChannels> void Emit(double tolerance, Sink& sink) const;
};

}

#endif
