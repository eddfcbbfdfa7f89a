// SPDX-License-Identifier: AGPL-3.0-or-later
// A few camera rays before the image: they tell for each light whether a map would cost less than its shadow rays.

#ifndef POVRAY_BACKEND_SHADOWSURVEY_H
#define POVRAY_BACKEND_SHADOWSURVEY_H

#include <boost/scoped_ptr.hpp>

#include "backend/interior/media.h"
#include "backend/lighting/photons.h"
#include "backend/render/rendertask.h"
#include "backend/render/tracepixel.h"
#include "backend/shadow/shadowtally.h"

namespace pov
{

class ShadowContext;
class ShadowMaps;

/// How many camera rays an image pixel gets.
struct ShadowSampling
{
	unsigned int method; ///< of antialiasing; 0: none
	double threshold;
	unsigned int depth;

	/// On average. How much of an image is at edges can only be guessed.
	double RaysPerPixel() const;
	/// Pixels from one ray to the next.
	double Spacing() const;
};

/// Traces camera rays as the image does, and counts what their shadow rays cost. Has tracing objects, caches and random
/// numbers of its own, and leaves no trace in the image.
class ShadowSurvey : public TracePixel
{
	public:
		ShadowSurvey(ViewData *viewData, TraceThreadData *thread, CooperateFunctor& cooperate, MediaFunctor& media, RadiosityFunctor& radiosity, double spacing);

		/// @param[in]      counted     else the pixel only fills the caches that its neighbour's rays will find
		void TracePixelAt(int x, int y, bool counted);
		void BeginSample();

		ShadowTally& Tally(size_t map) { return tallies[map]; }

		/// A shadow ray is traced by the survey itself: it is not to be asked about once more.
		bool Tracing() const { return tracing; }

		/// A look-up in a map that wants to know the picture.
		void Explore(size_t map, const dsm_receiver& receiver);

		/// A shadow ray towards a light that has a choice. To be called by the look-up.
		void Request(size_t map, const dsm_receiver& receiver, const LightSource& light, double depth, const Ray& ray, const Vector3d& point, RGBColour& colour, TraceTicket& ticket);
	private:
		ViewData *viewData;
		TraceThreadData *thread;
		vector<ShadowTally> tallies;
		bool tracing, counting;

		static void Want(void *tally, const dsm_tiles *tiles);
};

/// Media as the image has them. Their random numbers take more time than the rest of a survey, and most scenes have none.
class ShadowSurveyMedia : public Trace::MediaFunctor
{
	public:
		ShadowSurveyMedia(TraceThreadData *t, Trace *s, PhotonGatherer *g) : thread(t), survey(s), gatherer(g) { }

		virtual void ComputeMedia(vector<Media>& source, const Ray& ray, Intersection& isect, Colour& colour, Trace::TraceTicket& ticket);
		virtual void ComputeMedia(const RayInteriorVector& source, const Ray& ray, Intersection& isect, Colour& colour, Trace::TraceTicket& ticket);
		virtual void ComputeMedia(MediaVector& source, const Ray& ray, Intersection& isect, Colour& colour, Trace::TraceTicket& ticket);
	private:
		TraceThreadData *thread;
		Trace *survey;
		PhotonGatherer *gatherer;
		boost::scoped_ptr<MediaFunction> made;

		MediaFunction& Made();
};

class ShadowSurveyTask : public RenderTask
{
	public:
		ShadowSurveyTask(ViewData *viewData, const ShadowSampling& sampling);
	protected:
		virtual void Run();
		virtual void Stopped() { }
		virtual void Finish() { }
	private:
		class CooperateFunction : public Trace::CooperateFunctor
		{
			public:
				explicit CooperateFunction(Task& t) : task(t) { }
				virtual void operator()() { task.Cooperate(); }
			private:
				Task& task;
		};

		const ShadowSampling sampling;
		ShadowSurvey survey;
		CooperateFunction cooperate;
		ShadowSurveyMedia media;
		Trace::RadiosityFunctor radiosity; ///< none: its rays would be kept in the scene
		PhotonGatherer photonGatherer;

		void Bake(size_t map, unsigned int most);
		void Judge(size_t map, unsigned int taken, double confidence);
};

}

#endif
