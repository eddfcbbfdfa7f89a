// SPDX-License-Identifier: AGPL-3.0-or-later
// Everything that dims one light ray, found with POV-Ray's own shapes, textures and densities.

#ifndef POVRAY_BACKEND_SHADOWEVENTS_H
#define POVRAY_BACKEND_SHADOWEVENTS_H

#include "backend/render/trace.h"
#include "backend/shadow/shadowhits.h"
#include "backend/shadow/shadowstory.h"

namespace pov
{

class ShadowEvents : public Trace
{
	public:
		ShadowEvents(shared_ptr<SceneData> scene, TraceThreadData *thread, unsigned int quality, const ShadowCasters& casters);

		/// Reports a batch of rays of one light. Stops at the current task's pause points.
		/// @return     what the library's sink said first that was not DSM_OK
		dsm_result TraceRays(const LightSource& light, const dsm_ray *rays, unsigned int count, double tolerance, dsm_sink *sink);

		const ShadowHits& Hits() const { return hits; }
		POV_ULONG Shaded() const { return shaded; }              ///< surfaces
		POV_ULONG Evaluations() const { return media.evaluations; } ///< of densities
	private:
		const ShadowCasters& casters;
		CooperateFunctor noCooperate;
		MediaFunctor noMedia;
		RadiosityFunctor noRadiosity;
		const bool volumes;
		double slackness; ///< of a step of an integral, see ShadowMedia::Integrate
		POV_ULONG shaded;

		const LightSource *containersOf; ///< the light that `containers` belongs to
		vector<ObjectPtr> containers;    ///< hold the light itself, or the point of its plane where the ray begins

		// scratch, kept between rays; a Ray is too big for the stack of every caller
		ShadowHits hits;
		Ray shade;
		vector<Interior *> inside;
		ShadowMedia media;
		ShadowStory story, stories[ShadowStory::kFew];
		vector<ShadowHits::Hit> first; ///< those of a pixel's first ray

		void FindContainers(const LightSource& light);
		void EnterContainers(const LightSource& light, const dsm_ray& ray);
		void Toggle(Interior *interior);
		RGBColour ShadeSurface(const LightSource& light, const dsm_ray& ray, Intersection& isect);
		dsm_result ReportRay(const LightSource& light, const dsm_ray *rays, unsigned int ray, double tolerance, dsm_sink *sink, unsigned int offset);
		dsm_result ReportPixel(const LightSource& light, const dsm_ray *rays, unsigned int begin, unsigned int count, double tolerance, dsm_sink *sink, unsigned int offset);
		bool AllMeetTheSame(unsigned int begin, unsigned int count);
		void Follow(const LightSource& light, const dsm_ray& ray, const vector<ShadowHits::Hit>& found, double tolerance, ShadowStory& story);
		bool IsOpen(const dsm_ray& ray, const ShadowHits::Hit *last);
		void Fade(const Interior& interior, double front, double back, double tolerance, ShadowStory& story);
		double PassMedia(const dsm_ray& ray, double front, double back, double visible, double tolerance, ShadowStory& story);
};

}

#endif
