// SPDX-License-Identifier: AGPL-3.0-or-later
// A tree of boxes, and the boxes that a light ray or a beam of them crosses, nearest first.

#ifndef POVRAY_BACKEND_SHADOWTREE_H
#define POVRAY_BACKEND_SHADOWTREE_H

#include <vector>

#include <boost/scoped_array.hpp>

#include "backend/shadow/shadowbeam.h"

namespace pov
{

/// Enlarges `box` so that it holds `other`.
void Include(dsm_box& box, const dsm_box& other);

/// Split by the surface area heuristic over a few bins of the boxes' centres (Wald 2007). POV-Ray's own trees are not
/// used: they are there for some bounding methods only, and hold lights and infinite objects.
class ShadowTree
{
	private:
		class Builder;
		struct Slabs;
	public:
		/// @param[in]      threads     that may be used
		ShadowTree(const std::vector<dsm_box>& boxes, unsigned int threads);

		/// A ray, ready to be compared with many boxes.
		class Line
		{
			public:
				explicit Line(const dsm_ray& ray);

				/// Where the ray enters and leaves a box, between its near and far depth.
				bool Cross(const Slabs& slabs, double& enter, double& leave) const;
			private:
				const dsm_ray& ray;
				double inverse[3];
				int nearSide[3]; ///< which side of a slab the ray meets first
		};

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

				/// The next box that begins no later than `end`, and where the ray enters and leaves it.
				/// @return     false when there is none left
				bool Next(double end, unsigned int& box, double& enter, double& leave);
			private:
				const ShadowTree& tree;
				const Line line;
				Stack& stack;
				unsigned int leafItem, leafEnd; ///< boxes of the current leaf that are still to be seen
		};

		/// Scratch of a sweep, kept by the caller from beam to beam.
		struct Ahead
		{
			unsigned int node;
			ShadowRect rect; ///< that the beam sees of it
		};
		typedef std::vector<Ahead> Path;

		/// The boxes in a beam, nodes nearest first. The beam's rays may be shortened on the way.
		class Sweep
		{
			public:
				/// @param[in]      budget      the sweep gives up after so many nodes and boxes
				Sweep(const ShadowTree& tree, const ShadowBeam& beam, Path& path, size_t budget);

				/// The next boxes that may be seen.
				/// @param[out]     first, end  places of the boxes in the tree, without the last
				/// @return                     false when there is none left, or the budget is spent
				bool Next(unsigned int& first, unsigned int& end);

				bool GaveUp() const { return budget == 0; }
			private:
				const ShadowTree& tree;
				const ShadowBeam& beam;
				Path& path;
				size_t budget;

				void Push(const Ahead& ahead);
		};

		/// The box at a place of the tree. Places that are neighbours lie close together.
		unsigned int Box(unsigned int place) const { return order[place]; }
		unsigned int Places() const { return order.size(); }

		/// Where a ray enters and leaves the box at that place.
		bool Cross(const dsm_ray& ray, unsigned int place, double& enter, double& leave) const { return Line(ray).Cross(leaves[place], enter, leave); }
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

		boost::scoped_array<Node> nodes; ///< the first is the root; none if there are no boxes. Not all places are used
		std::vector<unsigned int> order; ///< boxes in the order of the leaves
		boost::scoped_array<Slabs> leaves; ///< in that order
};

inline ShadowTree::Line::Line(const dsm_ray& r) : ray(r)
{
	for(int i = 0; i < 3; i++)
	{
		inverse[i] = 1.0 / ray.direction[i];
		nearSide[i] = (inverse[i] < 0.0) ? 1 : 0;
	}
}

/// Slabs in double, however far away the light is. A direction along a face gives infinities of the right sign; a
/// NaN (an origin on the face as well) leaves that slab out of account.
inline bool ShadowTree::Line::Cross(const Slabs& slabs, double& enter, double& leave) const
{
	double from = ray.near_depth, to = ray.far_depth;
	for(int i = 0; i < 3; i++)
	{
		const double low = (slabs.side[nearSide[i]][i] - ray.origin[i]) * inverse[i];
		const double high = (slabs.side[1 - nearSide[i]][i] - ray.origin[i]) * inverse[i];
		from = (low > from) ? low : from;
		to = (high < to) ? high : to;
	}
	enter = from;
	leave = to;
	return from <= to;
}

}

#endif
