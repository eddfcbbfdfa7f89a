// SPDX-License-Identifier: AGPL-3.0-or-later
// Where an object can lie as the rays of one light see it: a convex outline, and how near to the light it can come.

#ifndef POVRAY_BACKEND_SHADOWOUTLINE_H
#define POVRAY_BACKEND_SHADOWOUTLINE_H

#include <cfloat>
#include <cmath>

#include "backend/shadow/shadowplugin.h"

namespace pov
{

class Cone;

/// Outlines grow by this part of an object's size: transforms are not exactly the inverse of their inverse.
const double kGrowth = 1.0e-8;

/// A float not above `x`, and one not below: a step or two beside the nearest.
inline float ShadowFloatBelow(double x)
{
	const float near = float(x), step = fabsf(near) * FLT_EPSILON + FLT_MIN;
	return (step < HUGE_VALF) ? near - step : near;
}
inline float ShadowFloatAbove(double x) { return -ShadowFloatBelow(-x); }

inline double ShadowDot(const double a[3], const double b[3])
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// What a bundle of light rays measures points with. A point has the coordinates x, y, w along right, up and forward
/// from the origin; the rays that can hit it have u = x/w, v = y/w (u = x, v = y if they are parallel).
/// Nearness orders points along all rays alike, and is linear on each plane of space: 1/w (-w if they are parallel).
struct ShadowFrame
{
	double origin[3], right[3], up[3], forward[3];
	bool perspective;
	double slack; ///< what rounding may move a point by, scene units

	void Vector(const double in[3], double out[3]) const
	{
		out[0] = in[0] * right[0] + in[1] * right[1] + in[2] * right[2];
		out[1] = in[0] * up[0] + in[1] * up[1] + in[2] * up[2];
		out[2] = in[0] * forward[0] + in[1] * forward[1] + in[2] * forward[2];
	}
	void Point(const double in[3], double out[3]) const
	{
		const double from[3] = { in[0] - origin[0], in[1] - origin[1], in[2] - origin[2] };
		Vector(from, out);
	}
	double Nearness(double w) const { return perspective ? 1.0 / w : -w; }
};

/// A rectangle of u, v that nothing of the object lies outside of, and the largest nearness of it.
struct ShadowRect
{
	double low[2], high[2];
	double nearness;
};

/// How an object is outlined.
enum ShadowShape
{
	kBoxedShape, ///< by its bounding box
	kRodShape,   ///< a cone or cylinder that is long and thin, by the hull of two balls
	kConeShape, kSphereShape, kDiscShape, kTriangleShape, kBoxShape
};

/// A rod in short, so that the many that are hidden or missed cost no walk through POV-Ray's objects.
struct ShadowRod
{
	float ends[2][3];
	float radii[2]; ///< with room for all that is rounded

	/// @return     false if the cone is not long and thin, or too small for floats
	bool Make(const Cone& cone);
};

/// @param[out]     rod         set for kRodShape
ShadowShape ShadowShapeOf(const ObjectBase *object, ShadowRod& rod);

/// Holds all points of an object, and a little more than rounding and POV-Ray's intersection tests can be off by.
struct ShadowOutline
{
	/// A side lets through a u + b v <= c; (a, b) has unit length.
	struct Side
	{
		double a, b, c;
	};
	enum { kMostSides = 6 };

	ShadowRect rect;
	Side sides[kMostSides];
	int sideCount;
	bool round;                     ///< an ellipse instead of sides
	double centre[2], form[3];      ///< form[0] du du + 2 form[1] du dv + form[2] dv dv <= 1
	double plane[3];                ///< nothing of the object is nearer than plane[0] u + plane[1] v + plane[2]

	/// @return     false if the object does not lie in front of the origin: it can be anywhere
	bool Draw(const ShadowFrame& frame, ShadowShape shape, const ObjectBase *object);
	bool Draw(const ShadowFrame& frame, const ShadowRod& rod);

	/// Sets the plane of a rod that has been drawn: few of those that are drawn are in any ray's way.
	void Face(const ShadowFrame& frame, const ShadowRod& rod);

	bool Holds(double u, double v) const
	{
		if(round)
		{
			const double du = u - centre[0], dv = v - centre[1];
			return form[0] * du * du + 2.0 * form[1] * du * dv + form[2] * dv * dv <= 1.0;
		}
		for(int i = 0; i < sideCount; i++)
			if(sides[i].a * u + sides[i].b * v > sides[i].c)
				return false;
		return true;
	}
	private:
		struct Ellipse;

		static bool FaceAxis(const ShadowFrame& frame, const double from[3], const double axis[3], double normal[3]);
		bool DrawCone(const ShadowFrame& frame, const ObjectBase *object);
		bool DrawEllipsoid(const ShadowFrame& frame, const double centre[3], const double axes[3][3]);
		bool DrawTriangle(const ShadowFrame& frame, const ObjectBase *object);
		bool DrawBox(const ShadowFrame& frame, const double centre[3], const double axes[3][3]);
		bool DrawDisc(const ShadowFrame& frame, const ObjectBase *object);
		void SetSide(int side, double a, double b, const Ellipse *ellipses, int count);
		void SetPlane(const ShadowFrame& frame, const double normal[3], double distance);
};

}

#endif
