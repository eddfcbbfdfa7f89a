// SPDX-License-Identifier: AGPL-3.0-or-later
// The surface that is being shaded: a map's own answer for it depends on where the surface lies, and on how much of it
// the camera's sample stands for.

#ifndef POVRAY_BACKEND_SHADOWRECEIVER_H
#define POVRAY_BACKEND_SHADOWRECEIVER_H

#include "backend/shadow/shadowplugin.h"

namespace pov
{

class ShadowContext;
class ShadowSurvey;

struct ShadowSurface
{
	const ObjectBase *object; ///< NULL: no surface
	const ObjectBase *csg;    ///< the outermost CSG object it is part of, or NULL
	Vector3d normal;          ///< unperturbed, either side
	bool seenByCamera;        ///< it is what `ShadowReceiver::cameraRay` has hit

	/// What the look-ups to all lights have in common. The first of them finds it.
	enum Kind
	{
		kUnknown,
		kUnmapped, ///< it is in no map
		kBoxed,    ///< its box bounds it
		kRod       ///< it is a cone or cylinder
	};
	Kind kind;
	Vector3d axis;            ///< of a rod; unit length
	double radius;            ///< of its larger end, scene units

	ShadowSurface() : object(NULL), csg(NULL), seenByCamera(false), kind(kUnknown), radius(0.0) { }
};

/// A camera ray's place in the image, pixels.
struct ShadowSample
{
	DBL x, y, width, height;
};

/// Part of every Trace object. Without a surface while media are lit.
struct ShadowReceiver
{
	ShadowSurface surface;
	ShadowSurvey *survey;     ///< that the Trace object belongs to, or NULL
	ShadowContext *context;   ///< of the thread that the Trace object works in; NULL before its first look-up

	const Ray *cameraRay;     ///< the camera ray that is being traced; NULL if it stands for no known part of the image
	ShadowSample sample;      ///< of cameraRay
	bool footprintKnown;
	dsm_receiver asked;       ///< by the last look-up; its footprint is that of cameraRay on what it has hit, if that is known

	ShadowReceiver() : survey(NULL), context(NULL), cameraRay(NULL), footprintKnown(false) { }
};

/// Sets the receiver for as long as a surface is shaded, or clears it, and puts the last one back.
class ShadowReceiverScope
{
	public:
		ShadowReceiverScope(ShadowReceiver& r, const Intersection& isect, const Vector3d& normal, const Ray *ray = NULL) :
			surface(r.surface), saved(r.surface)
		{
			surface.object = isect.Object;
			surface.csg = isect.Csg;
			surface.normal = normal;
			surface.seenByCamera = (ray != NULL) && (ray == r.cameraRay);
			surface.kind = ShadowSurface::kUnknown;
		}
		explicit ShadowReceiverScope(ShadowReceiver& r) : surface(r.surface), saved(r.surface) { surface = ShadowSurface(); }
		~ShadowReceiverScope() { surface = saved; }
	private:
		ShadowSurface& surface;
		const ShadowSurface saved;
};

/// Names the camera ray for as long as it is traced.
class ShadowCameraScope
{
	public:
		ShadowCameraScope(ShadowReceiver& r, const Ray& ray, DBL x, DBL y, DBL width, DBL height) : receiver(r)
		{
			const ShadowSample sample = { x, y, width, height };

			receiver.cameraRay = &ray;
			receiver.sample = sample;
			receiver.footprintKnown = false;
		}
		~ShadowCameraScope() { receiver.cameraRay = NULL; }
	private:
		ShadowReceiver& receiver;
};

}

#endif
