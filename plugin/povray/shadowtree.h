// SPDX-License-Identifier: AGPL-3.0-or-later
// A tree of boxes, and the boxes that a light ray crosses, nearest first.

#ifndef POVRAY_BACKEND_SHADOWTREE_H
#define POVRAY_BACKEND_SHADOWTREE_H

#include <vector>

#include "backend/shadow/shadowplugin.h"

namespace pov
{

/// Split by the surface area heuristic over a few bins of the boxes' centres (Wald 2007). POV-Ray's own trees are not
/// used: they are there for some bounding methods only, hold lights and infinite objects, and keep their boxes in floats.
class ShadowTree
{
	public:
		explicit ShadowTree(const std::vector<dsm_box>& boxes);

		/// Scratch of a walk, kept by the caller from ray to ray.
		struct Entry
		{
			unsigned int node;
			double enter;
		};
		typedef std::vector<Entry> Stack;

		class Walk
		{
			public:
				Walk(const ShadowTree& tree, const dsm_ray& ray, Stack& stack);

				/// The next box that begins in front of `end`, and where the ray enters and leaves it.
				/// @return     false when there is none left
				bool Next(double end, unsigned int& box, double& enter, double& leave);
			private:
				bool Cross(const dsm_box& box, double& enter, double& leave) const;

				const ShadowTree& tree;
				const dsm_ray& ray;
				Stack& stack;
				double inverse[3];
				unsigned int leafItem, leafEnd; ///< boxes of the current leaf that are still to be seen
		};
	private:
		struct Node
		{
			dsm_box box;
			unsigned int first; ///< a leaf's boxes, in `order`; of an inner node the left child, the right one follows
			unsigned int count; ///< 0: an inner node
		};

		const std::vector<dsm_box>& boxes;
		std::vector<Node> nodes;
		std::vector<unsigned int> order;

		void Build(unsigned int node, unsigned int first, unsigned int count);
		unsigned int Split(const dsm_box& centres, unsigned int first, unsigned int count);
};

}

#endif
