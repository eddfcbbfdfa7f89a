// SPDX-License-Identifier: AGPL-3.0-or-later

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/interior/media.h"
#include "backend/math/vector.h"
#include "backend/texture/pigment.h"
#include "backend/shadow/shadowmedia.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// Every span begins with this many steps, so that a density with several maxima is not mistaken for a flat one.
const int kFirstSteps = 8;

/// A step is halved at most this often: the edge of a density with a jump is found to 2^-10 of the first step.
const int kMostHalvings = 10;

/// Light that is left below this is not worth a step.
const double kDark = 1.0e-4;

double Largest(const DblRGBColour& c)
{
	return max(c.red(), max(c.green(), c.blue()));
}

double LargestDifference(const DblRGBColour& a, const DblRGBColour& b)
{
	return max(fabs(a.red() - b.red()), max(fabs(a.green() - b.green()), fabs(a.blue() - b.blue())));
}

}

ShadowMedia::ShadowMedia(const dsm_ray& r, double t, TraceThreadData *td, Sink& s) :
	ray(r), tolerance(t), thread(td), sink(s), media(NULL)
{
}

DblRGBColour ShadowMedia::Extinction(double depth) const
{
	const Vector3d point(ray.origin[X] + depth * ray.direction[X], ray.origin[Y] + depth * ray.direction[Y], ray.origin[Z] + depth * ray.direction[Z]);
	DblRGBColour sum;

	for(vector<const Media *>::const_iterator i(media->begin()); i != media->end(); i++)
	{
		if((*i)->Density == NULL)
			sum += DblRGBColour((*i)->Extinction);
		else
		{
			RGBColour density;
			Evaluate_Density_Pigment((*i)->Density, point, density, thread);
			sum += DblRGBColour(density) * DblRGBColour((*i)->Extinction);
		}
	}
	return sum;
}

double ShadowMedia::Integrate(const vector<const Media *>& list, double front, double back, double visible)
{
	bool constant = true;

	media = &list;
	for(vector<const Media *>::const_iterator i(list.begin()); i != list.end(); i++)
		constant = constant && (((*i)->Density == NULL) || ((*i)->Density->Type == PLAIN_PATTERN));

	if(list.empty() || !(back > front))
		return visible;
	if(constant)
		return Emit(front, back, Extinction(0.5 * (front + back)) * (back - front), visible);

	const double step = (back - front) / kFirstSteps;
	DblRGBColour atFront(Extinction(front));
	for(int i = 0; (i < kFirstSteps) && (visible > kDark); i++)
	{
		const double begin = front + i * step;
		const double end = (i + 1 < kFirstSteps) ? begin + step : back;
		const DblRGBColour atEnd(Extinction(end));
		visible = Refine(begin, end, atFront, atEnd, tolerance / kFirstSteps, visible, 0);
		atFront = atEnd;
	}
	return visible;
}

/// Adaptive Simpson: halves a step while the middle changes its trapezoid by more than is allowed, as seen through the
/// light that is left. Both halves share the allowance, so that the errors of a span add up to the tolerance at most.
double ShadowMedia::Refine(double front, double back, const DblRGBColour& atFront, const DblRGBColour& atBack, double allowed, double visible, int level)
{
	const double middle = 0.5 * (front + back);
	const double half = middle - front;
	const DblRGBColour atMiddle(Extinction(middle));
	const DblRGBColour coarse((atFront + atBack) * half);
	const DblRGBColour first((atFront + atMiddle) * (0.5 * half));
	const DblRGBColour second((atMiddle + atBack) * (0.5 * half));
	const DblRGBColour fine(first + second);

	if((level < kMostHalvings) && (LargestDifference(fine, coarse) * visible > allowed))
	{
		visible = Refine(front, middle, atFront, atMiddle, 0.5 * allowed, visible, level + 1);
		if(visible <= kDark)
			return visible;
		return Refine(middle, back, atMiddle, atBack, 0.5 * allowed, visible, level + 1);
	}

	// Richardson's correction, a third of the difference, goes in equal parts to both halves
	const DblRGBColour correction((fine - coarse) * (1.0 / 6.0));
	visible = Emit(front, middle, first + correction, visible);
	return Emit(middle, back, second + correction, visible);
}

double ShadowMedia::Emit(double front, double back, const DblRGBColour& depth, double visible)
{
	// densities below 0, and a correction that overshoots, must not make light
	const DblRGBColour transmittance(exp(-max(depth.red(), 0.0)), exp(-max(depth.green(), 0.0)), exp(-max(depth.blue(), 0.0)));

	sink.Span(front, back, transmittance);
	return visible * Largest(transmittance);
}

}
