// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <typeinfo>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/interior/interior.h"
#include "backend/interior/media.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/shape/planes.h"
#include "backend/shadow/shadowcasters.h"
#include "backend/shadow/shadowthreads.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

const unsigned int kMostOutsized = 16;

/// A caster this many times larger than all smaller ones together stays out of the maps.
const double kOutsizedFactor = 10.0;

/// POV-Ray keeps boxes in floats and lets infinite objects have a box of this order.
const double kInfiniteLength = 1.0e9;

const double kSameSurface = 1.0e-3; // as SHADOW_TOLERANCE in trace.cpp

const size_t kCacheLine = 64; // bytes

/// So many objects are sketched by a thread at once.
const size_t kStretch = 4096;

bool BoxOf(const ObjectBase *object, dsm_box& box)
{
	for(int i = 0; i < 3; i++)
	{
		const double low = object->BBox.Lower_Left[i];
		const double length = object->BBox.Lengths[i];

		// not (x < y) also catches NaN
		if(!(length < kInfiniteLength) || !(fabs(low) < kInfiniteLength))
			return false;

		const double slack = 1.0e-6 * (fabs(low) + length) + 1.0e-9; // of float boxes
		box.low[i] = low - slack;
		box.high[i] = low + length + slack;
	}
	return true;
}

/// Whether an unmapped caster may be met between the ends of a ray. Most are grounds, and most light comes to them from one side.
bool MayMeet(const ObjectBase& caster, const Ray& ray, double depth)
{
	if((typeid(caster) != typeid(Plane)) || (caster.Trans != NULL))
		return true;

	const Plane& plane = static_cast<const Plane&>(caster);
	DBL height, climb;
	VDot(height, plane.Normal_Vector, ray.Origin);
	VDot(climb, plane.Normal_Vector, ray.Direction);
	height += plane.Distance;
	// half of what is the same hit: rounding must not decide
	return !((height + 0.5 * kSameSurface * climb) * (height + depth * climb) > 0.0);
}

double HalfDiagonal(const dsm_box& box)
{
	double sum = 0.0;
	for(int i = 0; i < 3; i++)
		sum += Sqr(box.high[i] - box.low[i]);
	return 0.5 * sqrt(sum);
}

/// Whether an object, or a part of it, takes light from its inside.
bool HasVolume(const ObjectBase *object)
{
	if(ShadowCasters::Dims(object->interior))
		return true;
	if(object->Type & IS_COMPOUND_OBJECT)
	{
		const CompoundObject *compound = static_cast<const CompoundObject *>(object);
		for(vector<ObjectPtr>::const_iterator child(compound->children.begin()); child != compound->children.end(); child++)
			if(HasVolume(*child))
				return true;
	}
	return false;
}

struct LargerFirst
{
	const vector<double>& size;
	explicit LargerFirst(const vector<double>& s) : size(s) { }
	bool operator()(unsigned int a, unsigned int b) const { return (size[a] != size[b]) ? (size[a] > size[b]) : (a < b); }
};

}

bool ShadowCasters::Dims(const Interior *interior)
{
	if(interior == NULL)
		return false;
	if((interior->Fade_Power > 0.0) && (fabs(interior->Fade_Distance) > EPSILON))
		return true;
	for(vector<Media>::const_iterator media(interior->media.begin()); media != interior->media.end(); media++)
		if(media->use_extinction)
			return true;
	return false;
}

/// What each of the scene's objects is: to look at one is to wait for memory.
struct ShadowCasters::Look
{
	enum Kind { kNone, kMapped, kUnmapped };

	const vector<ObjectPtr>& scene;
	vector<dsm_box> boxes;
	vector<unsigned char> kinds, volumes; ///< volumes: whether it has one

	explicit Look(const vector<ObjectPtr>& s) : scene(s), boxes(s.size()), kinds(s.size()), volumes(s.size()) { }

	void At(size_t stretch)
	{
		for(size_t i = stretch * kStretch; i < min((stretch + 1) * kStretch, scene.size()); i++)
		{
			// a light stands for its looks_like object, which never casts a shadow
			if(Test_Flag(scene[i], NO_SHADOW_FLAG) || (scene[i]->Type & LIGHT_SOURCE_OBJECT))
				continue;
			kinds[i] = BoxOf(scene[i], boxes[i]) ? kMapped : kUnmapped;
			volumes[i] = HasVolume(scene[i]);
		}
	}
};

ShadowCasters::ShadowCasters(const vector<ObjectPtr>& scene, unsigned int t) : threads(t), hasVolumes(false), hasUnmappedVolumes(false)
{
	Look look(scene);

	ShareWork(threads, (scene.size() + kStretch - 1) / kStretch, boost::bind(&Look::At, &look, _1));
	objects.reserve(scene.size());
	for(size_t i = 0; i < scene.size(); i++)
		if(look.kinds[i] == Look::kMapped)
		{
			look.boxes[objects.size()] = look.boxes[i];
			objects.push_back(scene[i]);
		}
		else if(look.kinds[i] == Look::kUnmapped)
			unmapped.push_back(scene[i]);
	boxes.swap(look.boxes);
	boxes.resize(objects.size());

	SplitOffOutsized();

	if(std::find(look.volumes.begin(), look.volumes.end(), 1) == look.volumes.end())
		return;
	for(vector<ObjectPtr>::const_iterator i(objects.begin()); i != objects.end(); i++)
		if(HasVolume(*i))
		{
			hasVolumes = true;
			volumes.Add(*i);
		}
	for(vector<ObjectPtr>::const_iterator i(unmapped.begin()); i != unmapped.end(); i++)
		hasUnmappedVolumes = hasUnmappedVolumes || HasVolume(*i);
}

void ShadowCasters::Prepare(unsigned int threads) const
{
	boost::lock_guard<boost::mutex> lock(mutex);

	if(tree)
		return;
	boost::scoped_ptr<ShadowTree> made(new ShadowTree(boxes, threads));

	vector<unsigned int> places(objects.size());
	for(unsigned int place = 0; place < places.size(); place++)
		places[made->Box(place)] = place;
	shapes.resize(objects.size());
	placed.reset(new ObjectPtr[objects.size()]);
	rods.reset(new ShadowRod[objects.size()]);
	ShareWork(threads, (objects.size() + kStretch - 1) / kStretch, boost::bind(&ShadowCasters::Sketch, this, boost::cref(places), _1));
	tree.swap(made);
}

/// What is looked at together lies together, in the order of the tree. But the objects lie in memory in their own order.
void ShadowCasters::Sketch(const vector<unsigned int>& places, size_t stretch) const
{
	ShadowRod rod;

	for(size_t i = stretch * kStretch; i < min((stretch + 1) * kStretch, objects.size()); i++)
	{
		const ShadowShape shape = ShadowShapeOf(objects[i], rod);
		shapes[places[i]] = shape;
		placed[places[i]] = objects[i];
		if(shape == kRodShape)
			rods[places[i]] = rod;
	}
}

void ShadowCasters::FetchObject(unsigned int place) const
{
	const ObjectBase *object = placed[place];
	const char *transform = reinterpret_cast<const char *>((object->Trans != NULL) ? &object->Trans->inverse : NULL);

	if(transform != NULL)
		for(size_t i = 0; i < sizeof(MATRIX); i += kCacheLine)
			__builtin_prefetch(transform + i);
	for(size_t i = kCacheLine; i < sizeof(ObjectBase); i += kCacheLine)
		__builtin_prefetch(reinterpret_cast<const char *>(object) + i);
}

/// A floor of 10,000 units with a few objects on it, or a sky around everything, would make the rest of the scene one
/// pixel of the map. Such objects are few and simple: the look-up tests them instead.
void ShadowCasters::SplitOffOutsized()
{
	vector<unsigned int> bySize(boxes.size());
	vector<double> size(boxes.size());

	for(unsigned int i = 0; i < boxes.size(); i++)
	{
		bySize[i] = i;
		size[i] = HalfDiagonal(boxes[i]);
	}
	// the order of the others, and which of them are how large, does not matter
	const unsigned int large = min(boxes.size(), size_t(kMostOutsized + 1));
	std::partial_sort(bySize.begin(), bySize.begin() + large, bySize.end(), LargerFirst(size));

	// from the small end: the union of all casters smaller than the one looked at
	unsigned int outsized = 0;
	dsm_box rest;
	for(unsigned int i = bySize.size(); i-- > 1; )
	{
		if(i + 1 == bySize.size())
			rest = boxes[bySize[i]];
		else
			Include(rest, boxes[bySize[i]]);

		if((i <= kMostOutsized) && (size[bySize[i - 1]] > kOutsizedFactor * HalfDiagonal(rest)) && !HasVolume(objects[bySize[i - 1]]))
			outsized = max(outsized, i);
	}
	if(outsized == 0)
		return;

	for(unsigned int i = 0; i < outsized; i++)
		if(HasVolume(objects[bySize[i]]))
			return; // it has to be in the map, and then the others may as well

	vector<bool> out(boxes.size(), false);
	for(unsigned int i = 0; i < outsized; i++)
		out[bySize[i]] = true;

	vector<ObjectPtr> keptObjects;
	vector<dsm_box> keptBoxes;
	for(unsigned int i = 0; i < boxes.size(); i++)
	{
		if(out[i])
			unmapped.push_back(objects[i]);
		else
		{
			keptObjects.push_back(objects[i]);
			keptBoxes.push_back(boxes[i]);
		}
	}
	objects.swap(keptObjects);
	boxes.swap(keptBoxes);
}

bool ShadowCasters::MayMeetUnmapped(const Ray& ray, double depth) const
{
	for(vector<ObjectPtr>::const_iterator caster(unmapped.begin()); caster != unmapped.end(); caster++)
		if(MayMeet(**caster, ray, depth))
			return true;
	return false;
}

bool ShadowCasters::IsUnmapped(const ObjectBase *object) const
{
	for(vector<ObjectPtr>::const_iterator i(unmapped.begin()); i != unmapped.end(); i++)
		if(*i == object)
			return true;
	return false;
}

void ShadowCasters::Containing(const Vector3d& point, TraceThreadData *thread, vector<ObjectPtr>& out) const
{
	for(unsigned int i = 0; i < objects.size(); i++)
	{
		const dsm_box& box = boxes[i];
		if((point[X] >= box.low[X]) && (point[X] <= box.high[X]) && (point[Y] >= box.low[Y]) && (point[Y] <= box.high[Y]) &&
		   (point[Z] >= box.low[Z]) && (point[Z] <= box.high[Z]) && (objects[i]->interior != NULL) && objects[i]->Inside(*point, thread))
			out.push_back(objects[i]);
	}
}

}
