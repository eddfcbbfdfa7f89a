// SPDX-License-Identifier: AGPL-3.0-or-later
// What can cast a shadow in a scene: the finite objects that maps hold, in a tree of boxes, and the others, which
// every look-up tests by itself.

#ifndef POVRAY_BACKEND_SHADOWCASTERS_H
#define POVRAY_BACKEND_SHADOWCASTERS_H

#include "backend/shadow/shadowplugin.h"

namespace pov
{

class SceneData;

class ShadowCasters
{
	public:
		explicit ShadowCasters(const SceneData& scene);

		/// One box for each object that maps hold.
		const vector<dsm_box>& Boxes() const { return boxes; }

		/// Objects without end, and objects so much larger than all others that a map framed to them would lose the rest.
		const vector<ObjectPtr>& Unmapped() const { return unmapped; }
		bool IsUnmapped(const ObjectBase *object) const;

		/// Whether a map holds, or would have to hold, light that media or fading take.
		bool HasVolumes() const { return hasVolumes; }
		/// Whether an unmapped object has media or fading: no map can hold that, nor a single shadow test add it.
		bool HasUnmappedVolumes() const { return hasUnmappedVolumes; }

		/// Objects whose inside holds the point.
		void Containing(const Vector3d& point, TraceThreadData *thread, vector<ObjectPtr>& out) const;

		/// Walks the mapped objects whose boxes a light ray crosses, those with the nearer boxes first.
		class Walk
		{
			public:
				Walk(const ShadowCasters& casters, const dsm_ray& ray);

				/// The next object whose box begins in front of `end`, and where the ray enters and leaves that box.
				ObjectPtr Next(double end, double& enter, double& leave);
			private:
				struct Entry
				{
					unsigned int node;
					double enter, leave;
				};

				bool Cross(const dsm_box& box, double& enter, double& leave) const;
				void Push(unsigned int node);

				const ShadowCasters& casters;
				const dsm_ray& ray;
				double inverse[3];
				vector<Entry> stack;
				unsigned int leafItem, leafEnd; ///< objects of the current leaf that are still to be seen
		};
	private:
		struct Node
		{
			dsm_box box;
			unsigned int first, count; ///< a leaf's objects, in `order`; count 0: an inner node
			unsigned int left, right;
		};

		vector<ObjectPtr> objects;    ///< parallel to boxes
		vector<dsm_box> boxes;
		vector<ObjectPtr> unmapped;
		vector<Node> nodes;
		vector<unsigned int> order;
		bool hasVolumes, hasUnmappedVolumes;

		void SplitOffOutsized();
		unsigned int Build(unsigned int first, unsigned int count);
};

}

#endif
