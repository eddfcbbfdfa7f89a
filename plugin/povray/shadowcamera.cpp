// SPDX-License-Identifier: AGPL-3.0-or-later
// The camera's part in a look-up: how much of a surface one camera sample stands for.

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/render/tracepixel.h"
#include "backend/scene/scene.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// A grazing footprint is stretched at most this many times its width across the ray: far along the surface the tangent
/// plane says little, and another pixel's sample is there.
const double kMostStretch = 16.0;

/// What one instruction works on: a number of each neighbour.
typedef double Pair __attribute__((vector_size(16)));
typedef long long PairMask __attribute__((vector_size(16)));

inline Pair Dot(const Pair a[3], const Vector3d& b)
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// From the point to where the neighbours of its camera ray meet a plane. In the plane, and finite, at any angle.
void FootprintSides(const Pair across[3], const Pair directions[3], const Vector3d& normal, double sides[2][3])
{
	const Pair zero = { 0.0, 0.0 }, steepest = zero + 1.0 / kMostStretch;
	Pair slid[3], flat[3];

	const Pair towards = Dot(directions, normal);
	const Pair up = (towards > steepest) ? towards : steepest, down = (towards < -steepest) ? towards : -steepest;
	const Pair slope = (towards < zero) ? down : up;
	const Pair along = Dot(across, normal) / slope;
	for(int k = 0; k < 3; k++)
		slid[k] = across[k] - directions[k] * along;
	const Pair off = Dot(slid, normal); // nothing to flatten, but where the slope was bounded
	for(int k = 0; k < 3; k++)
		flat[k] = slid[k] - normal[k] * off;

	const Pair square = flat[0] * flat[0] + flat[1] * flat[1] + flat[2] * flat[2];
	const PairMask finite = (square < zero + MAX_DISTANCE * MAX_DISTANCE); // NaN is not
	for(int k = 0; k < 3; k++)
	{
		const Pair side = finite ? flat[k] : zero;
		sides[0][k] = side[0];
		sides[1][k] = side[1];
	}
}

/// The ribbon that a rod shows to the camera, if the rod is thinner than the camera's samples are wide: the plane at the point ends within
/// the rod's radius, so that its slope says nothing.
/// @return     false if it is not, or is seen from its end
bool FindRibbon(const ShadowSurface& surface, const Pair across[3], const Vector3d& ray, Vector3d& normal)
{
	const Pair square = across[0] * across[0] + across[1] * across[1] + across[2] * across[2];

	if((surface.kind != ShadowSurface::kRod) || !(4.0 * Sqr(surface.radius) < min(square[0], square[1])))
		return false;
	normal = ray - surface.axis * dot(surface.axis, ray);
	const double slope = normal.length();
	normal *= 1.0 / slope;
	return slope > 1.0e-3;
}

}

/// A ray of no camera has no neighbours.
bool Trace::CameraRayBeside(bool, Ray&)
{
	return false;
}

/// The camera ray of the next sample to the right, or below: the image's edge may have none on that side.
/// @return     false where neighbouring rays have nothing to do with each other
bool TracePixel::CameraRayBeside(bool below, Ray& ray)
{
	const ShadowSample& sample = shadowReceiver.sample;

	// a mesh's neighbours may be anywhere, and a normal may scatter rays at random
	if((camera.Type == MESH_CAMERA) || (camera.Tnormal != NULL))
		return false;

	// the usual camera's rays are worth a shorter way to the same numbers
	if((camera.Type == PERSPECTIVE_CAMERA) && !useFocalBlur)
	{
		const DBL x = sample.x + (below ? 0.0 : sampleSpacing) + 0.5;
		const DBL y = sample.y + (below ? sampleSpacing : 0.0) - 0.5;

		Assign_Vector(ray.Origin, *cameraLocation);
		VLinComb3(ray.Direction, 1.0, *cameraDirection, x / sample.width - 0.5, *cameraRight, ((sample.height - 1) - y) / sample.height - 0.5, *cameraUp);
		VNormalize(ray.Direction, ray.Direction);
		return true;
	}

	neighbourRay = true;
	bool created = false;
	for(int side = 1; (side >= -1) && !created; side -= 2)
	{
		const DBL x = sample.x + (below ? 0.0 : side * sampleSpacing);
		const DBL y = sample.y + (below ? side * sampleSpacing : 0.0);

		created = CreateCameraRay(ray, x, y, sample.width, sample.height, 0);
	}
	neighbourRay = false;
	return created;
}

/// What the camera's sample covers of the surface that is being shaded; nothing where no camera ray has hit it. Found once
/// for a camera ray, and only if a map is asked.
void Trace::FindShadowFootprint(const Vector3d& point)
{
	if(shadowReceiver.footprintKnown)
		return;
	shadowReceiver.footprintKnown = true;

	const ShadowSurface& surface = shadowReceiver.surface;
	const Ray& cameraRay = *shadowReceiver.cameraRay;
	const double distance = (point - Vector3d(cameraRay.Origin)).length();
	Pair across[3], directions[3];
	Ray neighbour;
	for(int i = 0; i < 2; i++)
	{
		// one that is not there is infinitely far away, and leaves the footprint no side
		const bool created = CameraRayBeside(i == 1, neighbour);
		for(int k = 0; k < 3; k++)
		{
			directions[k][i] = neighbour.Direction[k];
			across[k][i] = created ? neighbour.Origin[k] + neighbour.Direction[k] * distance - point[k] : HUGE_VAL;
		}
	}

	Vector3d normal;
	const bool ribbon = FindRibbon(surface, across, Vector3d(cameraRay.Direction), normal);
	FootprintSides(across, directions, ribbon ? normal : surface.normal, shadowReceiver.asked.footprint);
}

}
