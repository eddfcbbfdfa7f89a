// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <cmath>
#include <typeinfo>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/shape/boxes.h"
#include "backend/shape/cones.h"
#include "backend/shape/discs.h"
#include "backend/shape/spheres.h"
#include "backend/shape/triangle.h"
#include "backend/shadow/shadowoutline.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// A bounding box of floats is off by no more than this part of its coordinates.
const double kBoxRounding = 1.0e-6;

/// A vector of an object's own space, as the frame sees it.
void Axis(const ShadowFrame& frame, const TRANSFORM *transform, int axis, double scale, double out[3])
{
	if(transform != NULL)
		frame.Vector(transform->matrix[axis], out);
	else
	{
		const double unit[3] = { double(axis == 0), double(axis == 1), double(axis == 2) };
		frame.Vector(unit, out);
	}
	for(int i = 0; i < 3; i++)
		out[i] *= scale;
}

/// A point of an object's own space, as the frame sees it.
void Place(const ShadowFrame& frame, const TRANSFORM *transform, const double point[3], double out[3])
{
	if(transform == NULL)
	{
		frame.Point(point, out);
		return;
	}
	double world[3];
	for(int i = 0; i < 3; i++)
		world[i] = point[0] * transform->matrix[0][i] + point[1] * transform->matrix[1][i] + point[2] * transform->matrix[2][i] + transform->matrix[3][i];
	frame.Point(world, out);
}

}

/// How a frame sees the points q + sum of e[i] axes[i], |e| <= 1: a disc, or an ellipsoid. The ellipse is the set of u, v
/// whose rays cross it, found from the planes through the origin that touch it (its dual conic).
struct ShadowOutline::Ellipse
{
	double q[3];
	double axes[3][3];
	int axisCount;
	double centre[2], form[3]; ///< support along a unit vector n: centre.n + sqrt(n.form.n)
	double slack;              ///< what the outline grows by, in u and v

	/// @return     false if it does not lie in front of the origin
	bool Project(const ShadowFrame& frame)
	{
		double tangent[2] = { 0.0, 0.0 }, depth2 = 0.0, size = 0.0, bend[2] = { 0.0, 0.0 };

		for(int i = 0; i < axisCount; i++)
		{
			depth2 += Sqr(axes[i][2]);
			size += fabs(axes[i][0]) + fabs(axes[i][1]) + fabs(axes[i][2]);
		}
		slack = frame.slack + kGrowth * size;

		double scale2 = 1.0;
		if(frame.perspective)
		{
			const double nearest = q[2] - sqrt(depth2) - slack;
			if(!(nearest > 1.0e-3 * size))
				return false;
			tangent[0] = q[0] / q[2];
			tangent[1] = q[1] / q[2];
			scale2 = 1.0 / (Sqr(q[2]) - depth2);
			slack *= (1.0 + fabs(tangent[0]) + fabs(tangent[1])) / nearest;
		}

		// seen from straight ahead: a shear takes the centre there, and cancels what would swamp a small far object
		form[0] = form[1] = form[2] = 0.0;
		for(int i = 0; i < axisCount; i++)
		{
			const double x = axes[i][0] - tangent[0] * axes[i][2], y = axes[i][1] - tangent[1] * axes[i][2];
			bend[0] -= x * axes[i][2];
			bend[1] -= y * axes[i][2];
			form[0] += x * x;
			form[1] += x * y;
			form[2] += y * y;
		}
		if(frame.perspective)
		{
			bend[0] *= scale2;
			bend[1] *= scale2;
			form[0] = form[0] * scale2 + bend[0] * bend[0];
			form[1] = form[1] * scale2 + bend[0] * bend[1];
			form[2] = form[2] * scale2 + bend[1] * bend[1];
			centre[0] = tangent[0] + bend[0];
			centre[1] = tangent[1] + bend[1];
		}
		else
		{
			centre[0] = q[0];
			centre[1] = q[1];
		}
		return true;
	}

	double Support(double a, double b) const
	{
		return a * centre[0] + b * centre[1] + sqrt(max(0.0, a * a * form[0] + 2.0 * a * b * form[1] + b * b * form[2])) + slack;
	}

	/// How far the points reach along a direction of space.
	double Reach(const double n[3]) const
	{
		double sum = 0.0;
		for(int i = 0; i < axisCount; i++)
			sum += Sqr(ShadowDot(n, axes[i]));
		return sqrt(sum);
	}
};

ShadowShape ShadowShapeOf(const ObjectBase *object, ShadowRod& rod)
{
	const std::type_info& type = typeid(*object);

	if(type == typeid(Cone))
		return rod.Make(*static_cast<const Cone *>(object)) ? kRodShape : kConeShape;
	if(type == typeid(Sphere))
		return kSphereShape;
	if(type == typeid(Disc))
		return kDiscShape;
	if((type == typeid(Triangle)) || (type == typeid(SmoothTriangle)))
		return kTriangleShape;
	return (type == typeid(Box)) ? kBoxShape : kBoxedShape;
}

bool ShadowOutline::Draw(const ShadowFrame& frame, ShadowShape shape, const ObjectBase *object)
{
	round = false;
	sideCount = 0;
	switch(shape)
	{
		case kRodShape:
		case kConeShape:
			return DrawCone(frame, object);
		case kSphereShape:
		{
			const Sphere *sphere = static_cast<const Sphere *>(object);
			double middle[3], axes[3][3];
			Place(frame, sphere->Trans, sphere->Center, middle);
			for(int i = 0; i < 3; i++)
				Axis(frame, sphere->Trans, i, sphere->Radius, axes[i]);
			return DrawEllipsoid(frame, middle, axes);
		}
		case kDiscShape:
			return DrawDisc(frame, object);
		case kTriangleShape:
			return DrawTriangle(frame, object);
		case kBoxShape:
		case kBoxedShape:
			break;
	}

	const Box *solid = (shape == kBoxShape) ? static_cast<const Box *>(object) : NULL;
	const TRANSFORM *transform = (solid != NULL) ? solid->Trans : NULL;
	double middle[3], axes[3][3];
	for(int i = 0; i < 3; i++)
	{
		const double low = (solid != NULL) ? solid->bounds[0][i] : object->BBox.Lower_Left[i];
		const double length = (solid != NULL) ? solid->bounds[1][i] - low : object->BBox.Lengths[i];
		const double slack = (solid != NULL) ? 0.0 : kBoxRounding * (fabs(low) + fabs(length));
		middle[i] = low + 0.5 * length;
		Axis(frame, transform, i, 0.5 * length + slack, axes[i]);
	}
	Place(frame, transform, middle, middle);
	return DrawBox(frame, middle, axes);
}

void ShadowOutline::SetSide(int side, double a, double b, const Ellipse *ellipses, int count)
{
	double c = -HUGE_VAL;
	for(int i = 0; i < count; i++)
		c = max(c, ellipses[i].Support(a, b));
	const Side s = { a, b, c };
	sides[side] = s;
}

/// A cone's hull is that of its two end discs: two sides touch both, two cut off the ends.
bool ShadowOutline::DrawCone(const ShadowFrame& frame, const ObjectBase *object)
{
	const Cone *cone = static_cast<const Cone *>(object);
	const bool cylinder = Test_Flag(cone, CYLINDER_FLAG);
	const double at[2] = { cylinder ? 0.0 : cone->dist, 1.0 };
	double base[3], across[2][3], along[3];
	Ellipse ends[2];

	const double zero[3] = { 0.0, 0.0, 0.0 };
	Place(frame, cone->Trans, zero, base);
	for(int i = 0; i < 2; i++)
		Axis(frame, cone->Trans, i, 1.0, across[i]);
	Axis(frame, cone->Trans, 2, 1.0, along);
	for(int e = 0; e < 2; e++)
	{
		const double radius = cylinder ? 1.0 : at[e];
		ends[e].axisCount = 2;
		for(int i = 0; i < 3; i++)
		{
			ends[e].q[i] = base[i] + at[e] * along[i];
			ends[e].axes[0][i] = radius * across[0][i];
			ends[e].axes[1][i] = radius * across[1][i];
		}
		if(!ends[e].Project(frame))
			return false;
	}

	double e[2] = { ends[1].centre[0] - ends[0].centre[0], ends[1].centre[1] - ends[0].centre[1] };
	const double length = sqrt(e[0] * e[0] + e[1] * e[1]);
	e[0] = (length > 0.0) ? e[0] / length : 1.0;
	e[1] = (length > 0.0) ? e[1] / length : 0.0;
	double width[2];
	for(int i = 0; i < 2; i++)
		width[i] = sqrt(max(0.0, e[1] * e[1] * ends[i].form[0] - 2.0 * e[0] * e[1] * ends[i].form[1] + e[0] * e[0] * ends[i].form[2]));
	const double taper = (length > 0.0) ? max(-0.9, min(0.9, (width[0] - width[1]) / length)) : 0.0;
	const double lean = sqrt(1.0 - taper * taper);
	SetSide(0, -e[1] * lean + e[0] * taper, e[0] * lean + e[1] * taper, ends, 2);
	SetSide(1, e[1] * lean + e[0] * taper, -e[0] * lean + e[1] * taper, ends, 2);
	SetSide(2, e[0], e[1], ends, 2);
	SetSide(3, -e[0], -e[1], ends, 2);
	sideCount = 4;

	double nearest = HUGE_VAL;
	for(int k = 0; k < 2; k++)
	{
		rect.low[k] = HUGE_VAL;
		rect.high[k] = -HUGE_VAL;
		for(int i = 0; i < 2; i++)
		{
			const double half = sqrt(ends[i].form[2 * k]) + ends[i].slack;
			rect.low[k] = min(rect.low[k], ends[i].centre[k] - half);
			rect.high[k] = max(rect.high[k], ends[i].centre[k] + half);
		}
		nearest = min(nearest, ends[k].q[2] - sqrt(Sqr(ends[k].axes[0][2]) + Sqr(ends[k].axes[1][2])));
	}
	rect.nearness = frame.Nearness(nearest - frame.slack - kGrowth * fabs(nearest));

	double normal[3];
	plane[0] = plane[1] = 0.0;
	plane[2] = rect.nearness;
	if(FaceAxis(frame, ends[0].q, along, normal))
		SetPlane(frame, normal, min(ShadowDot(normal, ends[0].q) - ends[0].Reach(normal), ShadowDot(normal, ends[1].q) - ends[1].Reach(normal)));
	return true;
}

bool ShadowOutline::DrawEllipsoid(const ShadowFrame& frame, const double middle[3], const double axes[3][3])
{
	Ellipse whole;

	whole.axisCount = 3;
	for(int i = 0; i < 3; i++)
	{
		whole.q[i] = middle[i];
		for(int k = 0; k < 3; k++)
			whole.axes[i][k] = axes[i][k];
	}
	if(!whole.Project(frame))
		return false;

	// grown so that it holds all that is within `slack` of it: (h + s)^2 <= (1 + l) h^2 + (1 + 1/l) s^2
	const double l = 1.0e-3, s2 = (1.0 + 1.0 / l) * Sqr(whole.slack);
	const double f0 = (1.0 + l) * whole.form[0] + s2, f1 = (1.0 + l) * whole.form[1], f2 = (1.0 + l) * whole.form[2] + s2;
	const double determinant = f0 * f2 - f1 * f1;
	round = determinant > 1.0e-9 * f0 * f2;
	if(round)
	{
		form[0] = f2 / determinant;
		form[1] = -f1 / determinant;
		form[2] = f0 / determinant;
	}
	else // seen edge-on: as thick as a side of the box around it
	{
		const double angle = 0.5 * atan2(2.0 * f1, f0 - f2), a = cos(angle), b = sin(angle);
		SetSide(0, a, b, &whole, 1);
		SetSide(1, -a, -b, &whole, 1);
		SetSide(2, -b, a, &whole, 1);
		SetSide(3, b, -a, &whole, 1);
		sideCount = 4;
	}
	const double half[2] = { sqrt(f0), sqrt(f2) };
	for(int k = 0; k < 2; k++)
	{
		centre[k] = whole.centre[k];
		rect.low[k] = whole.centre[k] - half[k];
		rect.high[k] = whole.centre[k] + half[k];
	}
	const double ahead[3] = { 0.0, 0.0, 1.0 };
	const double nearest = middle[2] - whole.Reach(ahead);
	rect.nearness = frame.Nearness(nearest - frame.slack - kGrowth * fabs(nearest));
	plane[0] = plane[1] = 0.0;
	plane[2] = rect.nearness;
	return true;
}

bool ShadowOutline::DrawDisc(const ShadowFrame& frame, const ObjectBase *object)
{
	const Disc *disc = static_cast<const Disc *>(object);
	const double radius = sqrt(disc->oradius2), zero[3] = { 0.0, 0.0, 0.0 };
	double middle[3], axes[3][3] = { { 0.0 } };

	Place(frame, disc->Trans, zero, middle);
	for(int i = 0; i < 2; i++)
		Axis(frame, disc->Trans, i, radius, axes[i]);
	return DrawEllipsoid(frame, middle, axes);
}

bool ShadowOutline::DrawTriangle(const ShadowFrame& frame, const ObjectBase *object)
{
	const Triangle *triangle = static_cast<const Triangle *>(object);
	const double *corners[3] = { triangle->P1, triangle->P2, triangle->P3 };
	Ellipse points[3];
	double size = 0.0, nearest = HUGE_VAL;

	for(int i = 0; i < 3; i++)
	{
		points[i].axisCount = 0;
		frame.Point(corners[i], points[i].q);
		for(int k = 0; k < 3; k++)
			size = max(size, fabs(points[i].q[k] - points[0].q[k]));
		nearest = min(nearest, points[i].q[2]);
	}
	const double grown = frame.slack + kGrowth * size;
	if(frame.perspective && !(nearest - grown > 1.0e-3 * size))
		return false;

	for(int k = 0; k < 2; k++)
	{
		rect.low[k] = HUGE_VAL;
		rect.high[k] = -HUGE_VAL;
	}
	for(int i = 0; i < 3; i++)
	{
		points[i].Project(frame);
		points[i].slack = frame.perspective ? grown * (1.0 + fabs(points[i].centre[0]) + fabs(points[i].centre[1])) / (nearest - grown) : grown;
		for(int k = 0; k < 2; k++)
		{
			rect.low[k] = min(rect.low[k], points[i].centre[k] - points[i].slack);
			rect.high[k] = max(rect.high[k], points[i].centre[k] + points[i].slack);
		}
	}
	const double turn = (points[1].centre[0] - points[0].centre[0]) * (points[2].centre[1] - points[0].centre[1]) -
	                    (points[1].centre[1] - points[0].centre[1]) * (points[2].centre[0] - points[0].centre[0]);
	for(int i = 0; i < 3; i++)
	{
		const double *from = points[i].centre, *to = points[(i + 1) % 3].centre;
		double a = to[1] - from[1], b = from[0] - to[0];
		const double length = (turn < 0.0 ? -1.0 : 1.0) * sqrt(a * a + b * b);
		if(length != 0.0)
			SetSide(sideCount++, a / length, b / length, points, 3);
	}
	rect.nearness = frame.Nearness(nearest - grown);
	plane[0] = plane[1] = 0.0;
	plane[2] = rect.nearness;
	return true;
}

/// Six sides, along the projected edges.
bool ShadowOutline::DrawBox(const ShadowFrame& frame, const double middle[3], const double axes[3][3])
{
	double corners[8][2], size = 0.0, depth = 0.0;

	for(int i = 0; i < 3; i++)
	{
		depth += fabs(axes[i][2]);
		size += fabs(axes[i][0]) + fabs(axes[i][1]) + fabs(axes[i][2]);
	}
	const double grown = frame.slack + kGrowth * size, nearest = middle[2] - depth - grown;
	double slack = grown, tangent[2] = { 0.0, 0.0 };
	if(frame.perspective)
	{
		if(!(nearest > 1.0e-3 * size))
			return false;
		for(int k = 0; k < 2; k++)
			tangent[k] = middle[k] / middle[2];
	}

	for(int k = 0; k < 2; k++)
	{
		rect.low[k] = HUGE_VAL;
		rect.high[k] = -HUGE_VAL;
	}
	double most = 0.0;
	for(int i = 0; i < 8; i++)
	{
		double point[3];
		for(int k = 0; k < 3; k++)
			point[k] = middle[k] + ((i & 1) ? axes[0][k] : -axes[0][k]) + ((i & 2) ? axes[1][k] : -axes[1][k]) + ((i & 4) ? axes[2][k] : -axes[2][k]);
		const double scale = frame.perspective ? 1.0 / point[2] : 1.0;
		for(int k = 0; k < 2; k++)
		{
			corners[i][k] = point[k] * scale;
			most = max(most, fabs(corners[i][k]));
			rect.low[k] = min(rect.low[k], corners[i][k]);
			rect.high[k] = max(rect.high[k], corners[i][k]);
		}
	}
	if(frame.perspective)
		slack *= (1.0 + 2.0 * most) / nearest;

	for(int i = 0; i < 3; i++)
	{
		double a = tangent[1] * axes[i][2] - axes[i][1], b = axes[i][0] - tangent[0] * axes[i][2];
		const double length = sqrt(a * a + b * b);
		if(!(length > 0.0))
			continue;
		a /= length;
		b /= length;
		double low = HUGE_VAL, high = -HUGE_VAL;
		for(int k = 0; k < 8; k++)
		{
			const double at = a * corners[k][0] + b * corners[k][1];
			low = min(low, at);
			high = max(high, at);
		}
		const Side one = { a, b, high + slack }, other = { -a, -b, slack - low };
		sides[sideCount++] = one;
		sides[sideCount++] = other;
	}
	for(int k = 0; k < 2; k++)
	{
		rect.low[k] -= slack;
		rect.high[k] += slack;
	}
	rect.nearness = frame.Nearness(nearest);
	plane[0] = plane[1] = 0.0;
	plane[2] = rect.nearness;
	return true;
}

}
