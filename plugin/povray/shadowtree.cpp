// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/shadow/shadowtree.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

const unsigned int kLeafBoxes = 4;
const int kBins = 16;

double Centre(const dsm_box& box, int axis)
{
	return 0.5 * (box.low[axis] + box.high[axis]);
}

dsm_box Nothing()
{
	dsm_box box;
	for(int i = 0; i < 3; i++)
	{
		box.low[i] = HUGE_VAL;
		box.high[i] = -HUGE_VAL;
	}
	return box;
}

/// Half the surface: the chance that a ray hits the box.
double Area(const dsm_box& box)
{
	const double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1], z = box.high[2] - box.low[2];
	return (x < 0.0) ? 0.0 : x * y + y * z + z * x;
}

int BinOf(const dsm_box& box, const dsm_box& centres, int axis)
{
	const double width = centres.high[axis] - centres.low[axis];
	return min(kBins - 1, int(kBins * (Centre(box, axis) - centres.low[axis]) / width));
}

struct BelowBin
{
	const vector<dsm_box>& boxes;
	const dsm_box& centres;
	const int axis, bin;
	BelowBin(const vector<dsm_box>& b, const dsm_box& c, int a, int n) : boxes(b), centres(c), axis(a), bin(n) { }
	bool operator()(unsigned int i) const { return BinOf(boxes[i], centres, axis) < bin; }
};

}

void Include(dsm_box& box, const dsm_box& other)
{
	for(int i = 0; i < 3; i++)
	{
		box.low[i] = min(box.low[i], other.low[i]);
		box.high[i] = max(box.high[i], other.high[i]);
	}
}

ShadowTree::ShadowTree(const vector<dsm_box>& b) : boxes(b)
{
	for(unsigned int i = 0; i < boxes.size(); i++)
		order.push_back(i);
	if(boxes.empty())
		return;
	nodes.reserve(boxes.size());
	nodes.resize(1);
	Build(0, 0, boxes.size());
	for(unsigned int i = 0; i < order.size(); i++)
		leaves.push_back(Round(boxes[order[i]]));
}

ShadowTree::Slabs ShadowTree::Round(const dsm_box& box)
{
	Slabs slabs;
	for(int axis = 0; axis < 3; axis++)
	{
		slabs.side[0][axis] = nextafterf(float(box.low[axis]), -HUGE_VALF);
		slabs.side[1][axis] = nextafterf(float(box.high[axis]), HUGE_VALF);
	}
	return slabs;
}

void ShadowTree::Build(unsigned int node, unsigned int first, unsigned int count)
{
	dsm_box all(Nothing()), centres(Nothing());

	for(unsigned int i = first; i < first + count; i++)
	{
		const dsm_box& box = boxes[order[i]];
		Include(all, box);
		for(int axis = 0; axis < 3; axis++)
		{
			centres.low[axis] = min(centres.low[axis], Centre(box, axis));
			centres.high[axis] = max(centres.high[axis], Centre(box, axis));
		}
	}

	nodes[node].slabs = Round(all);
	nodes[node].first = first;
	nodes[node].count = count;
	if(count <= kLeafBoxes)
		return;

	const unsigned int half = Split(centres, first, count);
	const unsigned int left = nodes.size();
	nodes[node].first = left;
	nodes[node].count = 0;
	nodes.resize(left + 2);
	Build(left, first, half);
	Build(left + 1, first + half, count - half);
}

/// Reorders the boxes so that the two parts of the cheapest split lie one behind the other.
/// @return     size of the first part, neither 0 nor all
unsigned int ShadowTree::Split(const dsm_box& centres, unsigned int first, unsigned int count)
{
	double best = HUGE_VAL;
	int bestAxis = 0, bestBin = 0;

	for(int axis = 0; axis < 3; axis++)
	{
		unsigned int counts[kBins] = { 0 };
		dsm_box bins[kBins];
		double rightCost[kBins];

		if(!(centres.high[axis] > centres.low[axis]))
			continue;
		std::fill(bins, bins + kBins, Nothing());
		for(unsigned int i = first; i < first + count; i++)
		{
			const int bin = BinOf(boxes[order[i]], centres, axis);
			counts[bin]++;
			Include(bins[bin], boxes[order[i]]);
		}

		dsm_box part(Nothing());
		unsigned int number = 0;
		for(int bin = kBins - 1; bin > 0; bin--)
		{
			Include(part, bins[bin]);
			number += counts[bin];
			rightCost[bin] = Area(part) * number;
		}
		part = Nothing();
		number = 0;
		for(int bin = 1; bin < kBins; bin++)
		{
			Include(part, bins[bin - 1]);
			number += counts[bin - 1];
			const double cost = Area(part) * number + rightCost[bin];
			if((number > 0) && (number < count) && (cost < best))
			{
				best = cost;
				bestAxis = axis;
				bestBin = bin;
			}
		}
	}

	if(bestBin == 0) // all centres coincide
		return count / 2;
	vector<unsigned int>::iterator begin(order.begin() + first);
	return std::partition(begin, begin + count, BelowBin(boxes, centres, bestAxis, bestBin)) - begin;
}

ShadowTree::Walk::Walk(const ShadowTree& t, const dsm_ray& r, Stack& s) : tree(t), line(r), stack(s), leafItem(0), leafEnd(0)
{
	double leave;
	Entry root = { 0, 0.0 };

	stack.clear();
	if(!tree.nodes.empty() && line.Cross(tree.nodes[0].slabs, root.enter, leave))
		stack.push_back(root);
}

bool ShadowTree::Walk::Next(double end, unsigned int& box, double& enter, double& leave)
{
	while(true)
	{
		while(leafItem < leafEnd)
		{
			const unsigned int item = leafItem++;
			if(line.Cross(tree.leaves[item], enter, leave) && (enter <= end))
			{
				box = tree.order[item];
				return true;
			}
		}

		if(stack.empty())
			return false;

		const Entry entry = stack.back();
		stack.pop_back();
		if(entry.enter > end)
			continue;

		const Node& node = tree.nodes[entry.node];
		if(node.count > 0)
		{
			leafItem = node.first;
			leafEnd = node.first + node.count;
			continue;
		}

		// the nearer child is looked at first, so it goes on top
		Entry left = { node.first, 0.0 }, right = { node.first + 1, 0.0 };
		double unused;
		const bool crossLeft = line.Cross(tree.nodes[left.node].slabs, left.enter, unused) && (left.enter <= end);
		const bool crossRight = line.Cross(tree.nodes[right.node].slabs, right.enter, unused) && (right.enter <= end);
		if(crossLeft && crossRight)
		{
			stack.push_back((left.enter < right.enter) ? right : left);
			stack.push_back((left.enter < right.enter) ? left : right);
		}
		else if(crossLeft || crossRight)
			stack.push_back(crossLeft ? left : right);
	}
}

ShadowTree::Sweep::Sweep(const ShadowTree& t, const ShadowBeam& b, Heap& h, size_t most) : tree(t), beam(b), heap(h), budget(most)
{
	heap.clear();
	if(!tree.nodes.empty())
		Push(tree.nodes[0].slabs, 0, false);
}

inline void ShadowTree::Sweep::Push(const Slabs& slabs, unsigned int place, bool isBox)
{
	ShadowRect rect;

	if(!beam.Meets(slabs.side[0], slabs.side[1], rect))
		return;
	const Ahead ahead = { rect.nearness, place, isBox };
	heap.push_back(ahead);
	std::push_heap(heap.begin(), heap.end());
}

bool ShadowTree::Sweep::Next(unsigned int& place)
{
	while(!heap.empty() && (heap.front().nearness >= beam.End()) && (budget > 0))
	{
		const Ahead ahead = heap.front();

		std::pop_heap(heap.begin(), heap.end());
		heap.pop_back();
		budget--;
		if(ahead.isBox)
		{
			place = ahead.place;
			return true;
		}

		const Node& node = tree.nodes[ahead.place];
		ShadowRect rect;
		if(!beam.Meets(node.slabs.side[0], node.slabs.side[1], rect) || beam.Hides(rect))
			continue;
		if(node.count > 0)
			for(unsigned int i = node.first; i < node.first + node.count; i++)
				Push(tree.leaves[i], i, true);
		else
			for(unsigned int i = node.first; i < node.first + 2; i++)
				Push(tree.nodes[i].slabs, i, false);
	}
	return false;
}

}
