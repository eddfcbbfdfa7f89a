// SPDX-License-Identifier: AGPL-3.0-or-later
// A tree of boxes, and the boxes that a light ray crosses, nearest first.

#ifndef POVRAY_BACKEND_SHADOWTREE_H
#define POVRAY_BACKEND_SHADOWTREE_H

#include <vector>

#include "backend/shadow/shadowplugin.h"

namespace pov
{

/// Enlarges `box` so that it holds `other`.
void Include(dsm_box& box, const dsm_box& other);

/// Split by the surface area heuristic over a few bins of the boxes' centres (Wald 2007). POV-Ray's own trees are not
/// used: they are there for some bounding methods only, and hold lights and infinite objects.
class ShadowTree
{
	private:
		struct Slabs;
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
				bool Cross(const Slabs& slabs, double& enter, double& leave) const;

				const ShadowTree& tree;
				const dsm_ray& ray;
				Stack& stack;
				double inverse[3];
				int nearSide[3]; ///< which side of a slab the ray meets first
				unsigned int leafItem, leafEnd; ///< boxes of the current leaf that are still to be seen
		};
	private:
		/// A box in floats, rounded outwards: a walk is bound by the memory that it touches. side[0] is low, side[1] high.
		struct Slabs
		{
			float side[2][3];
		};

		struct Node
		{
			Slabs slabs;
			unsigned int first; ///< a leaf's boxes, in `leaves`; of an inner node the left child, the right one follows
			unsigned int count; ///< 0: an inner node
		};

		const std::vector<dsm_box>& boxes;
		std::vector<Node> nodes;
		std::vector<unsigned int> order; ///< boxes in the order of the leaves
		std::vector<Slabs> leaves;       ///< in that order

		static Slabs Round(const dsm_box& box);

		void Build(unsigned int node, unsigned int first, unsigned int count);
		unsigned int Split(const dsm_box& centres, unsigned int first, unsigned int count);
};

}

#endif
