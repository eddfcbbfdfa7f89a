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

/// From the point to where a neighbour of its camera ray meets the tangent plane. In the plane, and finite, at any angle.
void FootprintSide(double distance, const Ray& neighbour, const Vector3d& point, const Vector3d& normal, double side[3])
{
	const Vector3d direction(neighbour.Direction);
	const Vector3d across(Vector3d(neighbour.Origin) + direction * distance - point);
	const double towards = dot(direction, normal);
	const double slope = max(fabs(towards), 1.0 / kMostStretch) * ((towards < 0.0) ? -1.0 : 1.0);
	const Vector3d slid(across - direction * (dot(across, normal) / slope));
	const Vector3d flat(slid - normal * dot(slid, normal)); // nothing to flatten, but where the slope was bounded

	const bool finite = (flat.lengthSqr() < MAX_DISTANCE * MAX_DISTANCE); // NaN is not
	for(int i = 0; i < 3; i++)
		side[i] = finite ? flat[i] : 0.0;
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

	const double distance = (point - Vector3d(shadowReceiver.cameraRay->Origin)).length();
	Ray neighbour;
	for(int i = 0; i < 2; i++)
	{
		for(int k = 0; k < 3; k++)
			shadowReceiver.footprint[i][k] = 0.0;
		if(CameraRayBeside(i == 1, neighbour))
			FootprintSide(distance, neighbour, point, shadowReceiver.surface.normal, shadowReceiver.footprint[i]);
	}
}

}
