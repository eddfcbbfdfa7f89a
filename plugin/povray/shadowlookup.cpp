// SPDX-License-Identifier: AGPL-3.0-or-later
// The look-up: what Trace::TraceShadowRay asks before it traces.

#include <typeinfo>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/matrices.h"
#include "backend/math/vector.h"
#include "backend/render/trace.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/scene/threaddata.h"
#include "backend/shape/cones.h"
#include "backend/shadow/shadowcontext.h"
#include "backend/shadow/shadowmaps.h"
#include "backend/shadow/shadowsurvey.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

const double kSameHit = 1.0e-3; // as SHADOW_TOLERANCE in trace.cpp

struct BeyondSameHit : public RayObjectCondition
{
	virtual bool operator()(const Ray&, const ObjectBase*, double depth) const { return depth > kSameHit; }
};

/// Without volumes, as long as it lives.
class WithoutVolumes
{
	public:
		explicit WithoutVolumes(unsigned int& q) : quality(q), saved(q) { quality &= ~Q_VOLUME; }
		~WithoutVolumes() { quality = saved; }
	private:
		unsigned int& quality;
		const unsigned int saved;
};

/// What is the same for all lights.
void FindKind(ShadowSurface& surface, const ShadowMaps& maps)
{
	// Only the object of the scene's top level decides what a map holds. A part of a union does not tell whose it is.
	const ObjectBase *top = (surface.csg != NULL) ? surface.csg : surface.object;

	if((Test_Flag(top, NO_SHADOW_FLAG) && !(top->Type & IS_CHILD_OBJECT)) || maps.Casters().IsUnmapped(top))
		surface.kind = ShadowSurface::kUnmapped;
	else if(typeid(*surface.object) == typeid(Cone))
	{
		const VECTOR kAxis = { 0.0, 0.0, 1.0 }, kRadius = { 1.0, 0.0, 0.0 };
		const TRANSFORM *trans = surface.object->Trans;
		Vector3d radius;

		MTransDirection(*surface.axis, kAxis, trans);
		MTransDirection(*radius, kRadius, trans); // the larger end's
		surface.axis.normalize();
		surface.radius = radius.length();
		surface.kind = ShadowSurface::kRod;
	}
	else
		surface.kind = ShadowSurface::kBoxed;
}

/// The plane of a thin rod's surface that needs the least bias: it holds the rod's axis, whatever the normal at the
/// point is; the rod rises over it by the part of its radius that is nearer to the light.
bool RodPlane(const ShadowSurface& rod, const Vector3d& toLight, const Vector3d& normal, dsm_plane& plane)
{
	Vector3d across(toLight - rod.axis * dot(toLight, rod.axis));
	const double slope = across.length();
	if(!(slope > 1.0e-3))
		return false;
	across *= 1.0 / slope;

	for(int i = 0; i < 3; i++)
		plane.normal[i] = across[i];
	plane.rise = rod.radius * max(0.0, 1.0 - dot(normal, across)) / slope;
	return true;
}

/// No part of an object is nearer to the light than its box.
void BoxPlane(const BBOX& box, const Vector3d& point, const Vector3d& toLight, dsm_plane& plane)
{
	double rise = 0.0;

	for(int i = 0; i < 3; i++)
	{
		const double low = box.Lower_Left[i] - point[i];
		const double high = low + box.Lengths[i];
		rise += max(low * toLight[i], high * toLight[i]);
		plane.normal[i] = toLight[i];
	}
	plane.rise = max(rise, 0.0);
}

}

/// Where the receiver's own surface can be. Surfaces that are in no map need no bias at all.
static void DescribeReceiver(ShadowSurface& receiver, const ShadowMaps& maps, const Vector3d& point, const Vector3d& toLight, dsm_receiver& out)
{
	for(int i = 0; i < 3; i++)
		out.point[i] = point[i];
	out.plane_count = 0;

	if(receiver.object == NULL)
		return;
	if(receiver.kind == ShadowSurface::kUnknown)
		FindKind(receiver, maps);
	if(receiver.kind == ShadowSurface::kUnmapped)
		return;

	const Vector3d normal((dot(receiver.normal, toLight) < 0.0) ? -receiver.normal : receiver.normal);
	for(int i = 0; i < 3; i++)
		out.planes[0].normal[i] = normal[i];
	out.planes[0].rise = 0.0;

	if((receiver.kind != ShadowSurface::kRod) || !RodPlane(receiver, toLight, normal, out.planes[1]))
		BoxPlane(receiver.object->BBox, point, toLight, out.planes[1]);
	out.plane_count = 2;
}

/// Multiplies `colour` by the share of the light that reaches the point, if the light has a map that knows.
/// @return     false if the ray has to be traced; `colour` is then as it was
bool Trace::LookUpShadow(const LightSource& lightsource, double depth, const Ray& lightsourceray, const Vector3d& point, RGBColour& colour, TraceTicket& ticket)
{
	ShadowMaps& maps = *sceneData->shadowMaps;

	// a survey leaves out what it need not know
	const size_t index = maps.Find(lightsource);
	ShadowSurvey *survey = shadowReceiver.survey;
	if(index == ShadowMaps::kNone)
		return maps.Unshadowed() || ((survey != NULL) && !survey->Tracing());
	if((survey != NULL) && survey->Tracing())
		return false;
	if((survey != NULL) && !maps.IsUndecided(index) && !maps[index].explores)
		return true;

	const ShadowMap& map = maps[index];
	if(!lightsourceray.IsHollowRay() ||
	   (!(qualityFlags & Q_VOLUME) && (maps.Casters().HasVolumes() || map.atmosphere)) ||
	   (map.photons && sceneData->photonSettings.photonsEnabled && (sceneData->surfacePhotonMap.numPhotons > 0) && !threadData->litObjectIgnoresPhotons))
		return survey != NULL;

	if(shadowReceiver.context == NULL)
		shadowReceiver.context = maps.Current();

	dsm_receiver& receiver = shadowReceiver.asked; // a footprint is found once, and serves all lights
	double rgb[3];
	DescribeReceiver(shadowReceiver.surface, maps, point, Vector3d(lightsourceray.Direction), receiver);
	receiver.has_footprint = shadowReceiver.surface.seenByCamera;
	if(receiver.has_footprint)
		FindShadowFootprint(point);
	if((survey != NULL) && map.explores)
	{
		survey->Explore(index, receiver);
		return true;
	}
	if(survey != NULL)
	{
		survey->Request(index, receiver, lightsource, depth, lightsourceray, point, colour, ticket);
		return true;
	}
	if(shadowReceiver.context->LookUp(index, receiver, rgb) == DSM_TRACE)
		return false;

	colour.red() *= rgb[0];
	colour.green() *= rgb[1];
	colour.blue() *= rgb[2];
	if(maps.Casters().MayMeetUnmapped(lightsourceray, depth))
		TraceUnmappedCasters(maps.Casters().Unmapped(), lightsource, depth, lightsourceray, colour, ticket);
	if(map.atmosphere && (depth > kSameHit))
	{
		ShadowAir air(lightsourceray, depth);
		ComputeShadowMedia(air.ray, air.end, colour, true, ticket);
	}
	return true;
}

/// The casters that no map holds, each by itself; they have no volumes, and their order does not matter.
void Trace::TraceUnmappedCasters(const vector<ObjectPtr>& casters, const LightSource& lightsource, double depth, const Ray& lightsourceray, RGBColour& colour, TraceTicket& ticket)
{
	const WithoutVolumes without(qualityFlags);
	const BeyondSameHit condition;
	Ray ray(lightsourceray.Origin, lightsourceray.Direction, Ray::OtherRay, true); // no copy of 4 KB of interiors, which do not matter

	for(vector<ObjectPtr>::const_iterator caster(casters.begin()); caster != casters.end(); caster++)
	{
		double left = depth;
		Intersection isect;

		Assign_Vector(ray.Origin, lightsourceray.Origin);
		while(!((fabs(colour.red()) < EPSILON) && (fabs(colour.green()) < EPSILON) && (fabs(colour.blue()) < EPSILON)) &&
		      FindIntersection(*caster, isect, ray, condition, left) && (isect.Depth < left - kSameHit))
		{
			left -= isect.Depth;
			ray.ClearInteriors();
			ComputeShadowColour(lightsource, isect, ray, colour, ticket);
			Assign_Vector(ray.Origin, isect.IPoint);
			isect = Intersection();
		}
	}
}

}
