// SPDX-License-Identifier: AGPL-3.0-or-later
// How much light media take along a piece of a light ray: the integral of the scene's own densities.

#ifndef POVRAY_BACKEND_SHADOWMEDIA_H
#define POVRAY_BACKEND_SHADOWMEDIA_H

#include "backend/shadow/shadowplugin.h"

namespace pov
{

class Media;

/// Integrates extinction between two depths of a ray with steps that follow the density, and hands on pieces in which
/// light falls exponentially. Constant media take one step. POV-Ray's own three sampling methods are not used: they
/// only approach this integral (method 3, the default, never samples the light end).
class ShadowMedia
{
	public:
		class Sink
		{
			public:
				virtual ~Sink() { }
				virtual void Span(double front, double back, const DblRGBColour& transmittance) = 0;
		};

		ShadowMedia(const dsm_ray& ray, double tolerance, TraceThreadData *thread, Sink& sink);

		/// @param[in]      visible     largest channel of the light that is left at `front`: the less, the coarser the steps
		/// @return                     the same at `back`
		double Integrate(const vector<const Media *>& media, double front, double back, double visible);
	private:
		const dsm_ray& ray;
		const double tolerance;
		TraceThreadData *thread;
		Sink& sink;
		const vector<const Media *> *media;

		DblRGBColour Extinction(double depth) const;
		double Refine(double front, double back, const DblRGBColour& atFront, const DblRGBColour& atBack, double allowed, double visible, int level);
		double Emit(double front, double back, const DblRGBColour& depth, double visible);
};

}

#endif
