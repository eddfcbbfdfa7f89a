// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <cstdlib>
#include <cstring>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/scene/threaddata.h"
#include "backend/support/task.h"
#include "backend/shadow/shadowhits.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// How far in front of an object's box its ray starts. Shapes ignore hits near a ray's origin (SMALL_TOLERANCE), so the
/// start keeps well clear of the surface, yet close enough that a far light costs no precision.
const double kRunUp = 0.01;

/// A hit counts up to so far in front of its object's box. It follows that a box that begins farther than this behind a
/// ray's end need not be looked into, whoever came first.
const double kAhead = 1.0e-4;

/// A surface is asked for further hits from this far behind its last one (see MIN_ISECT_DEPTH).
const double kStepOn = 1.0e-6;

/// Fewer casters than this are looked through as fast ray by ray.
const size_t kFewCasters = 8;

/// Fewer rays than this are no beam.
const unsigned int kFewRays = 16;

/// Nodes and boxes that a beam may cost, a ray. A walk of one ray alone costs some more.
const size_t kBudget = 32;

/// So many objects, and a few more, are looked at side by side. Waiting for memory is most of what one costs alone; but
/// they do not hide each other.
const size_t kTogether = 16;

/// Surfaces that let light through, kept for one batch: about 14 MB.
const size_t kMostSurfaces = 65536;

}

ShadowHits::ShadowHits(const ShadowCasters& c, TraceThreadData *t) :
	compared(0), different(0), asks(0), drawn(0), walks(0),
	casters(c), thread(t), order(kObjects), rays(NULL), byObject(false), source(kRays), asked(0),
	probe(Ray::OtherRay, true)
{
	const char *wish = getenv("DEEP_SHADOW_ORDER");

	if((wish != NULL) && (strcmp(wish, "rays") == 0))
		order = kRays;
	else if((wish != NULL) && (strcmp(wish, "both") == 0))
		order = kBoth;
}

unsigned int ShadowHits::Find(const dsm_ray *r, unsigned int count)
{
	casters.Prepare();
	rays = r;
	byObject = false;
	if((order == kRays) || (count < kFewRays) || ((order == kObjects) && (casters.Boxes().size() < kFewCasters)))
		return count;

	while(count > 0)
	{
		const Result result = FindByObject(count);
		byObject = (result == kDone);
		if((result != kTooMany) || (count < 2))
			break;
		count /= 2;
	}
	return count;
}

void ShadowHits::Start(Track& track, const dsm_ray& ray)
{
	track.end = ray.far_depth;
	track.opaque = false;
	track.caster = track.number = 0;
	track.veil = kNoVeil;
}

ShadowHits::Result ShadowHits::FindByObject(unsigned int count)
{
	// the beam may look this much farther than a ray, so that its rounding costs no hit
	if(!beam.Aim(rays, count, 2.0 * kAhead))
		return kNoBeam;
	tracks.resize(count);
	for(unsigned int i = 0; i < count; i++)
		Start(tracks[i], rays[i]);
	found[kObjects].veils.clear();
	found[kObjects].surfaces.clear();

	ShadowTree::Sweep sweep(casters.Tree(), beam, path, kBudget * count);
	for(bool more = true; more; )
	{
		unsigned int first, end;

		places.clear();
		while((places.size() < kTogether) && (more = sweep.Next(first, end)))
			for(unsigned int place = first; place < end; place++)
			{
				casters.FetchDrawing(place);
				places.push_back(place);
			}
		FindTogether();
		if((found[kObjects].surfaces.size() > kMostSurfaces) && (count > 1))
			return kTooMany;
	}
	return sweep.GaveUp() ? kNoBeam : kDone;
}

/// All hits of the objects at some places of the tree. What each step needs is fetched from memory in the step before.
void ShadowHits::FindTogether()
{
	selected.clear();
	wanted.clear();
	for(vector<unsigned int>::const_iterator place(places.begin()); place != places.end(); place++)
	{
		const Wanted one = { *place, selected.size() };

		SelectRays(*place);
		if(selected.size() == one.first)
			continue;
		wanted.push_back(one);
		__builtin_prefetch(casters.ObjectAt(*place));
	}
	const Wanted none = { 0, selected.size() };
	wanted.push_back(none);
	for(size_t i = 0; i + 1 < wanted.size(); i++)
		casters.FetchObject(wanted[i].place);
	for(size_t i = 0; i + 1 < wanted.size(); i++)
		AskSelected(wanted[i].place, wanted[i].first, wanted[i + 1].first);
}

/// Adds the rays that the object at a place of the tree may be hit by.
void ShadowHits::SelectRays(unsigned int place)
{
	drawn++;
	if(!casters.Draw(place, beam.Frame(), outline))
		beam.SelectAll(selected);
	else if(!beam.Hides(outline.rect))
	{
		const size_t before = selected.size();

		beam.Select(outline, selected);
		if(selected.size() == before)
			return;
		casters.Face(place, beam.Frame(), outline);
		beam.Drop(outline.plane, before, selected);
	}
}

/// All hits of the object at a place of the tree, with some of the selected rays.
void ShadowHits::AskSelected(unsigned int place, size_t first, size_t end)
{
	const Caster caster = { casters.ObjectAt(place), casters.Tree().Box(place) };

	for(size_t slot = first; slot < end; slot++)
	{
		const unsigned int i = beam.Ray(selected[slot]);
		Track& track = tracks[i];
		double enter, leave;

		if(!casters.Tree().Cross(rays[i], place, enter, leave) || !(enter <= track.end + kAhead))
			continue;
		const double before = track.end;
		Ask(caster, rays[i], enter, leave, track, found[kObjects]);
		if(track.end < before)
			beam.Shorten(selected[slot], track.end);
	}
}

void ShadowHits::FindByRay(const dsm_ray& ray, vector<Hit>& out)
{
	ShadowTree::Walk walk(casters.Tree(), ray, stack);
	Track track;
	double enter, leave;
	unsigned int caster;

	walks++;
	Start(track, ray);
	found[kRays].veils.clear();
	found[kRays].surfaces.clear();
	while(walk.Next(track.end + kAhead, caster, enter, leave))
	{
		const Caster one = { casters.Object(caster), caster };
		Ask(one, ray, enter, leave, track, found[kRays]);
	}
	Collect(track, found[kRays], out);
}

/// One object's surfaces. Many shapes report only their first hit outside CSG, so an object that is not opaque is asked
/// again from just behind its last hit until nothing is left. Where it is asked from does not depend on what other
/// objects have been found, nor do the hits in front of the ray's end.
void ShadowHits::Ask(const Caster& caster, const dsm_ray& ray, double enter, double leave, Track& track, Found& out)
{
	const ObjectPtr object = caster.object;
	// what lies at the light itself is not in its way; how near that is, is stock's, but for scenes smaller than a unit
	const double first = SMALL_TOLERANCE * min(1.0, ray.far_depth);
	const bool atLight = (enter <= kRunUp);
	double start = (first < SMALL_TOLERANCE) ? enter - kRunUp : max(0.0, enter - kRunUp);
	double last = start;
	unsigned int number = 0;
	IStack answers(thread->stackPool);

	do
	{
		bool more = false, behind = false;

		asks++;
		if((asked++ & 0x0f) == 0)
			Task::CurrentTaskCooperate();
		for(int i = 0; i < 3; i++)
		{
			probe.Origin[i] = ray.origin[i] + start * ray.direction[i];
			probe.Direction[i] = ray.direction[i];
		}
		probe.ClearInteriors();

		if((!object->Bound.empty() && !Ray_In_Bound(probe, object->Bound, thread)) ||
		   !object->All_Intersections(probe, answers, thread))
			break;

		for(; answers->size() > 0; answers->pop(), number++)
		{
			const Intersection& isect = answers->top();
			const double depth = start + isect.Depth;
			const bool opaque = Test_Flag(isect.Object, OPAQUE_FLAG);

			if((isect.Depth < MIN_ISECT_DEPTH) || !(enter <= depth + kAhead))
				continue;
			if(atLight && (depth < first))
			{
				behind = behind || (depth > last);
				last = max(last, depth);
				continue;
			}
			if(!opaque)
			{
				more = more || (depth > last);
				last = max(last, depth);
			}
			if(!(depth <= track.end))
				continue;

			const Hit hit = { depth, caster.number, number, opaque ? int(kOpaque) : int(out.surfaces.size()) };
			if(!opaque)
			{
				const Veil veil = { hit, track.veil };
				track.veil = out.veils.size();
				out.veils.push_back(veil);
				out.surfaces.push_back(isect);
				continue;
			}
			const Hit nearest = { track.end, track.caster, track.number, kOpaque };
			if(!track.opaque || (hit < nearest))
			{
				track.opaque = true;
				track.end = depth;
				track.caster = caster.number;
				track.number = number;
			}
		}

		if(!behind && (!more || Test_Flag(object, OPAQUE_FLAG)))
			break;
		start = last + kStepOn * max(1.0, fabs(last));
	}
	while(start < min(leave, track.end));
}

void ShadowHits::Collect(const Track& track, const Found& in, vector<Hit>& out) const
{
	const Hit opaque = { track.end, track.caster, track.number, kOpaque };

	out.clear();
	for(unsigned int i = track.veil; i != kNoVeil; i = in.veils[i].next)
	{
		const Hit& hit = in.veils[i].hit;
		if(track.opaque ? (hit < opaque) : (hit.depth <= track.end))
			out.push_back(hit);
	}
	if(out.size() > 1)
		std::sort(out.begin(), out.end());
	if(track.opaque)
		out.push_back(opaque);
}

const vector<ShadowHits::Hit>& ShadowHits::Of(unsigned int ray)
{
	source = byObject ? kObjects : kRays;
	if(byObject)
		Collect(tracks[ray], found[kObjects], hits);
	else
		FindByRay(rays[ray], hits);

	if(byObject && (order == kBoth))
	{
		FindByRay(rays[ray], others);
		compared++;
		if(!Agree())
			different++;
	}
	return hits;
}

/// Whether both orders have found the same.
bool ShadowHits::Agree() const
{
	if(hits.size() != others.size())
		return false;
	for(size_t i = 0; i < hits.size(); i++)
	{
		const Hit& one = hits[i];
		const Hit& other = others[i];

		if((one.depth != other.depth) || (one.caster != other.caster) || (one.number != other.number) || ((one.surface == kOpaque) != (other.surface == kOpaque)))
			return false;
		if((one.surface != kOpaque) && (found[kObjects].surfaces[one.surface].Object != found[kRays].surfaces[other.surface].Object))
			return false;
	}
	return true;
}

}
