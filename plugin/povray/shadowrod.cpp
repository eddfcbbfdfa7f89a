// SPDX-License-Identifier: AGPL-3.0-or-later
// Outlines of what is long and thin: hair and grass, by the hundred thousand.

#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/shape/cones.h"
#include "backend/shadow/shadowoutline.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// A cone is a rod if it is this many times longer than wide.
const double kRodLength = 4.0;

/// An axis that is seen at least this much from the side (sine) has a near side worth a plane of its own.
const double kSideways = 0.1;

}

bool ShadowRod::Make(const Cone& cone)
{
	const MATRIX& m = cone.Trans->matrix;
	const bool cylinder = Test_Flag(&cone, CYLINDER_FLAG);
	const double first = cylinder ? 0.0 : cone.dist;
	const double across = sqrt(0.5 * (ShadowDot(m[0], m[0]) + ShadowDot(m[1], m[1])) + sqrt(0.25 * Sqr(ShadowDot(m[0], m[0]) - ShadowDot(m[1], m[1])) + Sqr(ShadowDot(m[0], m[1]))));
	const double length = (1.0 - first) * sqrt(ShadowDot(m[2], m[2]));

	if(!(length > 2.0 * kRodLength * across))
		return false;
	for(int i = 0; i < 2; i++)
	{
		const double at = (i == 0) ? first : 1.0, radius = across * ((cylinder || (i == 1)) ? 1.0 : first);
		double off = 1.0e-6 * across + kGrowth * length;
		for(int k = 0; k < 3; k++)
		{
			const double place = m[3][k] + at * m[2][k];
			ends[i][k] = float(place);
			off += fabs(place - ends[i][k]) + 1.0e-15 * fabs(place);
		}
		if(!(off < 0.1 * across))
			return false;
		radii[i] = ShadowFloatAbove(radius + off);
	}
	return true;
}

/// The plane of space through which no point of the object comes nearer to the light, as nearness over u and v.
/// @param[in]      normal      unit length, away from the light
/// @param[in]      distance    of the plane from the origin
void ShadowOutline::SetPlane(const ShadowFrame& frame, const double normal[3], double distance)
{
	distance -= frame.slack + kGrowth * fabs(distance);
	for(int i = 0; i < 3; i++)
		plane[i] = 0.0;
	if(frame.perspective && (distance > 0.0))
		for(int i = 0; i < 3; i++)
			plane[i] = normal[i] / distance;
	else if(!frame.perspective && (normal[2] > 1.0e-3))
	{
		plane[0] = normal[0] / normal[2];
		plane[1] = normal[1] / normal[2];
		plane[2] = -distance / normal[2];
	}
	else
		plane[2] = rect.nearness;
}

/// The direction across an axis that leads away from the light.
/// @return     false if the axis is seen from its end: there is none
bool ShadowOutline::FaceAxis(const ShadowFrame& frame, const double from[3], const double axis[3], double normal[3])
{
	const double ahead[3] = { 0.0, 0.0, 1.0 };
	const double *towards = frame.perspective ? from : ahead;
	const double part = ShadowDot(towards, axis) / ShadowDot(axis, axis);

	for(int i = 0; i < 3; i++)
		normal[i] = towards[i] - part * axis[i];
	const double length = sqrt(ShadowDot(normal, normal));
	if(!(length > kSideways * sqrt(ShadowDot(towards, towards))))
		return false;
	for(int i = 0; i < 3; i++)
		normal[i] /= length;
	return true;
}

bool ShadowOutline::Draw(const ShadowFrame& frame, const ShadowRod& rod)
{
	double q[2][3], radius[2], at[2][2], reach[2], nearest = HUGE_VAL;

	round = false;
	for(int i = 0; i < 2; i++)
	{
		const double end[3] = { rod.ends[i][0], rod.ends[i][1], rod.ends[i][2] };
		frame.Point(end, q[i]);
		radius[i] = rod.radii[i] + frame.slack;
		const double w = q[i][2] - radius[i];
		nearest = min(nearest, w);
		at[i][0] = q[i][0];
		at[i][1] = q[i][1];
		reach[i] = radius[i];
		if(frame.perspective)
		{
			if(!(w > radius[i]))
				return false;
			const double scale = 1.0 / q[i][2];
			at[i][0] *= scale;
			at[i][1] *= scale;
			// of a ball, r sqrt(1 + t^2) / (w - r)
			reach[i] *= (1.0 + 0.5 * (Sqr(at[i][0]) + Sqr(at[i][1]))) / w;
		}
	}

	double e[2] = { at[1][0] - at[0][0], at[1][1] - at[0][1] };
	const double length = sqrt(e[0] * e[0] + e[1] * e[1]);
	e[0] = (length > 0.0) ? e[0] / length : 1.0;
	e[1] = (length > 0.0) ? e[1] / length : 0.0;
	const double taper = (length > 0.0) ? max(-0.9, min(0.9, (reach[0] - reach[1]) / length)) : 0.0;
	const double lean = (taper == 0.0) ? 1.0 : sqrt(1.0 - taper * taper);
	const double normals[4][2] = { { e[0] * taper - e[1] * lean, e[1] * taper + e[0] * lean }, { e[0] * taper + e[1] * lean, e[1] * taper - e[0] * lean },
	                               { e[0], e[1] }, { -e[0], -e[1] } };
	for(int i = 0; i < 4; i++)
	{
		const double a = normals[i][0], b = normals[i][1];
		const Side side = { a, b, max(a * at[0][0] + b * at[0][1] + reach[0], a * at[1][0] + b * at[1][1] + reach[1]) };
		sides[i] = side;
	}
	sideCount = 4;
	for(int k = 0; k < 2; k++)
	{
		rect.low[k] = min(at[0][k] - reach[0], at[1][k] - reach[1]);
		rect.high[k] = max(at[0][k] + reach[0], at[1][k] + reach[1]);
	}
	rect.nearness = frame.Nearness(nearest);

	plane[0] = plane[1] = 0.0;
	plane[2] = rect.nearness;
	return true;
}

void ShadowOutline::Face(const ShadowFrame& frame, const ShadowRod& rod)
{
	double q[2][3], normal[3];

	for(int i = 0; i < 2; i++)
	{
		const double end[3] = { rod.ends[i][0], rod.ends[i][1], rod.ends[i][2] };
		frame.Point(end, q[i]);
	}
	const double axis[3] = { q[1][0] - q[0][0], q[1][1] - q[0][1], q[1][2] - q[0][2] };
	if(FaceAxis(frame, q[0], axis, normal))
		SetPlane(frame, normal, min(ShadowDot(normal, q[0]) - rod.radii[0], ShadowDot(normal, q[1]) - rod.radii[1]) - frame.slack);
}

}
