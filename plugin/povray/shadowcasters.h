// SPDX-License-Identifier: AGPL-3.0-or-later
// What can cast a shadow in a scene: the finite objects that maps hold, in a tree of boxes, and the others, which
// every look-up tests by itself.

#ifndef POVRAY_BACKEND_SHADOWCASTERS_H
#define POVRAY_BACKEND_SHADOWCASTERS_H

#include <boost/scoped_array.hpp>
#include <boost/scoped_ptr.hpp>
#include <boost/thread/mutex.hpp>

#include "backend/shadow/shadowtree.h"
#include "backend/shadow/shadowvolumes.h"

namespace pov
{

class ShadowCasters
{
	public:
		/// @param[in]      threads     that may be used to prepare
		ShadowCasters(const vector<ObjectPtr>& scene, unsigned int threads);

		/// One box for each object that maps hold.
		const vector<dsm_box>& Boxes() const { return boxes; }

		/// Objects without end, and objects so much larger than all others that a map framed to them would lose the rest.
		const vector<ObjectPtr>& Unmapped() const { return unmapped; }
		bool IsUnmapped(const ObjectBase *object) const;
		/// Whether any of them can lie on a shadow ray. What is cheaper to tell than to trace.
		bool MayMeetUnmapped(const Ray& ray, double depth) const;

		/// Whether an inside takes light.
		static bool Dims(const Interior *interior);
		/// Whether a map holds, or would have to hold, light that media or fading take.
		bool HasVolumes() const { return hasVolumes; }
		/// Whether an unmapped object has media or fading: no map can hold that, nor a single shadow test add it.
		bool HasUnmappedVolumes() const { return hasUnmappedVolumes; }

		/// The media of all objects that maps hold.
		const ShadowVolumes& Volumes() const { return volumes; }

		/// Objects whose inside holds the point.
		void Containing(const Vector3d& point, TraceThreadData *thread, vector<ObjectPtr>& out) const;

		/// To be called before any ray is traced: what light rays are found with is made when the first one comes.
		void Prepare() const { Prepare(threads); }
		void Prepare(unsigned int threads) const;

		/// The boxes as a tree, and the object that a box of the tree belongs to.
		const ShadowTree& Tree() const { return *tree; }
		ObjectPtr Object(unsigned int box) const { return objects[box]; }
		/// The object of the box at a place of the tree.
		ObjectPtr ObjectAt(unsigned int place) const { return placed[place]; }

		/// How the object at a place of the tree is outlined.
		/// @return     false if it lies around the light, and can be anywhere
		bool Draw(unsigned int place, const ShadowFrame& frame, ShadowOutline& outline) const
		{
			return (shapes[place] == kRodShape) ? outline.Draw(frame, rods[place]) : outline.Draw(frame, ShadowShape(shapes[place]), placed[place]);
		}

		/// Sets the outline's plane, if drawing has left that.
		void Face(unsigned int place, const ShadowFrame& frame, ShadowOutline& outline) const
		{
			if(shapes[place] == kRodShape)
				outline.Face(frame, rods[place]);
		}

		/// Has memory send what drawing, or an intersection test, will need.
		void FetchDrawing(unsigned int place) const
		{
			__builtin_prefetch(&rods[place]);
			__builtin_prefetch(&placed[place]);
		}
		void FetchObject(unsigned int place) const;
	private:
		const unsigned int threads;
		vector<ObjectPtr> objects;    ///< parallel to boxes
		vector<dsm_box> boxes;
		vector<ObjectPtr> unmapped;

		mutable boost::mutex mutex;   ///< guards the making of the next four
		mutable boost::scoped_ptr<ShadowTree> tree;
		mutable vector<unsigned char> shapes;  ///< ShadowShape, by place in the tree
		mutable boost::scoped_array<ObjectPtr> placed; ///< likewise
		mutable boost::scoped_array<ShadowRod> rods; ///< parallel to shapes; only rods are set, the rest costs no memory

		bool hasVolumes, hasUnmappedVolumes;
		ShadowVolumes volumes;

		struct Look;

		void SplitOffOutsized();
		void Sketch(const vector<unsigned int>& places, size_t stretch) const;
};

}

#endif
