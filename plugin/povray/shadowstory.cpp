// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <limits>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/shadow/shadowstory.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// Depths at which rays are compared.
const int kDepths = 8;

/// Twice the area of a triangle, as the light sees it.
double Area(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& direction)
{
	return dot(cross(b - a, c - a), direction);
}

}

void ShadowStory::Clear()
{
	events.clear();
	media = marked = overlapping = false;
}

void ShadowStory::Surface(double depth, const double transmittance[3])
{
	const Event event = { depth, depth, { transmittance[0], transmittance[1], transmittance[2] } };
	events.push_back(event);
}

void ShadowStory::Span(double front, double back, const double transmittance[3])
{
	const Event event = { front, back, { transmittance[0], transmittance[1], transmittance[2] } };
	overlapping = overlapping || (!events.empty() && (events.back().back > front));
	events.push_back(event);
}

dsm_result ShadowStory::Tell(unsigned int ray, dsm_sink *sink) const
{
	const dsm_api_table& api = ShadowPlugin::Api();
	dsm_result result = DSM_OK;

	for(vector<Event>::const_iterator i(events.begin()); (i != events.end()) && (result == DSM_OK); i++)
		result = api.sink_span(sink, ray, i->front, i->back, i->transmittance);
	return (marked && (result == DSM_OK)) ? api.sink_mark(sink, ray) : result;
}

/// Where light is gone at once, or nothing more happens.
double ShadowStory::End() const
{
	return events.empty() ? 0.0 : events.back().back;
}

/// Visibility at some depths, in order. Within a span it is taken for straight.
void ShadowStory::Follow(const double depths[], double (*visible)[3]) const
{
	double now[3] = { 1.0, 1.0, 1.0 };
	vector<Event>::const_iterator i(events.begin());

	for(int d = 0; d < kDepths; d++)
	{
		for(; (i != events.end()) && (i->back <= depths[d]); i++)
			for(int k = 0; k < 3; k++)
				now[k] *= i->transmittance[k];

		const double share = ((i != events.end()) && (i->front < depths[d])) ? (depths[d] - i->front) / (i->back - i->front) : 0.0;
		for(int k = 0; k < 3; k++)
			visible[d][k] = (share > 0.0) ? now[k] * (1.0 - share * (1.0 - i->transmittance[k])) : now[k];
	}
}

/// Values that change linearly across the light's view cancel out if each is weighed by the area of the triangle of the other three
/// rays, with the sign that makes the weights of a square's corners + - + -.
ShadowStory::Contrast::Contrast(const dsm_ray *const rays[kFew])
{
	const Vector3d direction(rays[0]->direction);
	Vector3d at[kFew];
	double squares = 0.0;

	for(int i = 0; i < kFew; i++) // the rays of a point light share their origin, those of a parallel one the direction
		at[i] = Vector3d(rays[i]->origin) - Vector3d(rays[0]->origin) + Vector3d(rays[i]->direction);
	for(int i = 0; i < kFew; i++)
	{
		weight[i] = ((i & 1) ? -1.0 : 1.0) * Area(at[(i == 0) ? 1 : 0], at[(i <= 1) ? 2 : 1], at[(i <= 2) ? 3 : 2], direction);
		squares += weight[i] * weight[i];
	}
	for(int i = 0; i < kFew; i++)
		weight[i] /= sqrt(squares); // NaN, if all are on one line: then nothing agrees
}

bool ShadowStory::Agree(const ShadowStory stories[], const Contrast& contrast, double error)
{
	double visible[kFew][kDepths][3], depths[kDepths];
	double begin = std::numeric_limits<double>::max(), end = begin;

	for(int i = 0; i < kFew; i++)
	{
		if(stories[i].marked || stories[i].overlapping || stories[i].events.empty())
			return false;
		begin = min(begin, stories[i].events.front().front);
		end = min(end, stories[i].End());
	}
	for(int d = 0; d < kDepths; d++)
		depths[d] = begin + (end - begin) * ((d + 1.0) / kDepths - 1.0e-6); // in front of what ends there
	for(int i = 0; i < kFew; i++)
		stories[i].Follow(depths, visible[i]);

	// a ray's own deviation adds this share of itself to the mean's
	const double most = sqrt(double(kFew)) * error;
	for(int d = 0; d < kDepths; d++)
		for(int k = 0; k < 3; k++)
		{
			double deviation = 0.0;
			for(int i = 0; i < kFew; i++)
				deviation += contrast.weight[i] * visible[i][d][k];
			if(!(fabs(deviation) <= most))
				return false;
		}
	return true;
}

}
