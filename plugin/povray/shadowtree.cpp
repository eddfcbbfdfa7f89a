// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <cmath>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/shadow/shadowthreads.h"
#include "backend/shadow/shadowtree.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

const unsigned int kLeafBoxes = 4;

/// Of parts of few boxes there are very many, and each costs its bins.
enum { kMostBins = 16, kFewBins = 8, kFewestBins = 4 };
const unsigned int kFewItems = 64, kFewestItems = 16;

/// A part of so many boxes is one thread's work.
const unsigned int kBranchItems = 4096;

/// What one instruction works on. The fourth lane says nothing.
typedef float Lanes __attribute__((vector_size(16)));
typedef int IntLanes __attribute__((vector_size(16)));

inline Lanes Least(Lanes a, Lanes b) { return (a < b) ? a : b; }
inline Lanes Most(Lanes a, Lanes b) { return (a > b) ? a : b; }

/// A box.
struct Item
{
	Lanes low, high;

	void Clear()
	{
		const Lanes zero = { 0.0f, 0.0f, 0.0f, 0.0f };
		low = zero + HUGE_VALF;
		high = zero - HUGE_VALF;
	}
	void Include(Lanes otherLow, Lanes otherHigh)
	{
		low = Least(otherLow, low);
		high = Most(otherHigh, high);
	}
	void Include(const Item& other) { Include(other.low, other.high); }
	Lanes TwiceCentre() const { return low + high; }

	/// Half the surface: the chance that a ray hits the box.
	float Area() const
	{
		const Lanes size = high - low;
		return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
	}
};

/// Where centres are sorted into bins of equal width.
class Bins
{
	public:
		const int count;

		/// @param[in]      centres     twice the centres of so many items
		Bins(const Item& centres, unsigned int items) :
			count((items < kFewestItems) ? kFewestBins : (items < kFewItems) ? kFewBins : kMostBins), from(centres.low)
		{
			for(int i = 0; i < 4; i++)
			{
				const float perWidth = count / (centres.high[i] - centres.low[i]);
				scale[i] = (perWidth < HUGE_VALF) ? perWidth : 0.0f;
				last[i] = count - 1;
			}
		}

		/// Along each axis.
		IntLanes Of(const Item& item) const
		{
			const IntLanes bin = __builtin_convertvector((item.TwiceCentre() - from) * scale, IntLanes);
			return (bin < last) ? bin : last;
		}
	private:
		Lanes from, scale;
		IntLanes last;
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

/// Moves the boxes themselves, so that each level of the tree reads memory from front to back.
class ShadowTree::Builder
{
	public:
		Builder(ShadowTree& t, const vector<dsm_box>& boxes, unsigned int threads);
	private:
		ShadowTree& tree;
		const vector<dsm_box>& boxes;
		const unsigned int count;
		boost::scoped_array<Item> items; ///< in the order of the leaves

		/// A stretch of `items`, and the node that holds it.
		struct Part
		{
			unsigned int node, first, count;
			Item all, centres;
		};

		/// A part that is too large for one thread, and what becomes of it.
		struct Fork
		{
			Part part, sides[2];
		};

		vector<Fork> forks;
		vector<Part> branches; ///< each is work for one thread
		vector<Node> top;      ///< nodes of forks, and those with which branches begin

		void ReadBoxes(size_t stretch);
		void SplitFork(size_t fork) { Split(forks[fork].part, forks[fork].sides[0], forks[fork].sides[1]); }
		void GrowBranch(size_t branch);
		void Plan(const Part& part, vector<Fork>& wide);
		static void SetLeaf(Node& node, const Part& part);
		static void SetChildren(Node& node, unsigned int children);
		void Build(const Part& part, unsigned int& next);
		void Split(const Part& part, Part& left, Part& right);
		bool Cheapest(const Part& part, const Bins& bins, int& axis, int& bin) const;
		void Divide(const Part& part, const Bins& bins, int axis, int bin, Part& left, Part& right);
		void Halve(const Part& part, Part& left, Part& right) const;
		void Measure(Part& part) const;

		static Slabs Sides(const Item& item)
		{
			Slabs slabs;
			for(int i = 0; i < 3; i++)
			{
				slabs.side[0][i] = item.low[i];
				slabs.side[1][i] = item.high[i];
			}
			return slabs;
		}
};

/// The tree is the same for any number of threads.
ShadowTree::Builder::Builder(ShadowTree& t, const vector<dsm_box>& b, unsigned int threads) :
	tree(t), boxes(b), count(boxes.size()), items(new Item[count])
{
	Part whole;
	vector<Fork> wide;

	tree.order.resize(count);
	tree.leaves.reset(new Slabs[count]);
	top.resize(1);
	ShareWork(threads, (count + kBranchItems - 1) / kBranchItems, boost::bind(&Builder::ReadBoxes, this, _1));

	whole.node = whole.first = 0;
	whole.count = count;
	Measure(whole);
	for(Plan(whole, wide); !wide.empty(); )
	{
		forks.swap(wide);
		wide.clear();
		ShareWork(threads, forks.size(), boost::bind(&Builder::SplitFork, this, _1));
		for(size_t i = 0; i < forks.size(); i++)
		{
			const unsigned int children = top.size();
			SetChildren(top[forks[i].part.node], children);
			top.resize(children + 2);
			for(unsigned int side = 0; side < 2; side++)
			{
				forks[i].sides[side].node = children + side;
				Plan(forks[i].sides[side], wide);
			}
		}
	}

	// a branch with n boxes has fewer than 2 n nodes, so each has its own stretch; what is left over is memory that is never touched
	tree.nodes.reset(new Node[top.size() + 2 * size_t(count)]);
	std::copy(top.begin(), top.end(), tree.nodes.get());
	ShareWork(threads, branches.size(), boost::bind(&Builder::GrowBranch, this, _1));
}

void ShadowTree::Builder::ReadBoxes(size_t stretch)
{
	const unsigned int first = stretch * kBranchItems;

	for(unsigned int i = first; i < min(first + kBranchItems, count); i++)
	{
		Item& item = items[i];
		for(int axis = 0; axis < 3; axis++)
		{
			item.low[axis] = ShadowFloatBelow(boxes[i].low[axis]);
			item.high[axis] = ShadowFloatAbove(boxes[i].high[axis]);
		}
		item.low[3] = item.high[3] = 0.0f;
		tree.order[i] = i;
	}
}

/// Decides whether a part is one thread's work.
void ShadowTree::Builder::Plan(const Part& part, vector<Fork>& wide)
{
	SetLeaf(top[part.node], part);
	if(part.count > kBranchItems)
	{
		wide.push_back(Fork());
		wide.back().part = part;
	}
	else
		branches.push_back(part);
}

void ShadowTree::Builder::GrowBranch(size_t branch)
{
	const Part& part = branches[branch];
	unsigned int next = top.size() + 2 * part.first;

	Build(part, next);
	for(unsigned int i = part.first; i < part.first + part.count; i++)
		tree.leaves[i] = Sides(items[i]);
}

void ShadowTree::Builder::SetLeaf(Node& node, const Part& part)
{
	node.slabs = Sides(part.all);
	node.first = part.first;
	node.count = part.count;
}

void ShadowTree::Builder::SetChildren(Node& node, unsigned int children)
{
	node.first = children;
	node.count = 0;
}

/// @param[in,out]  next    the first node that is free
void ShadowTree::Builder::Build(const Part& part, unsigned int& next)
{
	SetLeaf(tree.nodes[part.node], part);
	if(part.count <= kLeafBoxes)
		return;

	Part left, right;
	left.node = next++;
	right.node = next++;
	SetChildren(tree.nodes[part.node], left.node);
	Split(part, left, right);
	Build(left, next);
	Build(right, next);
}

void ShadowTree::Builder::Split(const Part& part, Part& left, Part& right)
{
	const Bins bins(part.centres, part.count);
	int axis, bin;

	if(Cheapest(part, bins, axis, bin))
		Divide(part, bins, axis, bin, left, right);
	else
		Halve(part, left, right);
}

/// The split after which a ray meets the fewest boxes. Larger parts are split along their widest side: the other two would
/// better the tree by a few parts in a hundred, and cost a third of the time.
/// @return     false if all centres are in one bin
bool ShadowTree::Builder::Cheapest(const Part& part, const Bins& bins, int& bestAxis, int& bestBin) const
{
	const Lanes width = part.centres.high - part.centres.low;
	const int widest = (width[0] > width[1]) ? ((width[0] > width[2]) ? 0 : 2) : ((width[1] > width[2]) ? 1 : 2);
	const bool few = (part.count < kFewItems);
	const int firstAxis = few ? 0 : widest, lastAxis = few ? 2 : widest;
	unsigned int counts[3][kMostBins] = { { 0 } };
	Item boxes[3][kMostBins];
	float best = HUGE_VALF;

	for(int axis = firstAxis; axis <= lastAxis; axis++)
		for(int bin = 0; bin < bins.count; bin++)
			boxes[axis][bin].Clear();
	for(unsigned int i = part.first; i < part.first + part.count; i++)
	{
		const Item item(items[i]);
		const IntLanes bin(bins.Of(item));
		for(int axis = firstAxis; axis <= lastAxis; axis++)
		{
			boxes[axis][bin[axis]].Include(item);
			counts[axis][bin[axis]]++;
		}
	}

	for(int axis = firstAxis; axis <= lastAxis; axis++)
	{
		float rightCost[kMostBins];
		unsigned int number = 0;
		Item side;

		side.Clear();
		for(int bin = bins.count - 1; bin > 0; bin--)
		{
			side.Include(boxes[axis][bin]);
			number += counts[axis][bin];
			rightCost[bin] = side.Area() * number;
		}
		side.Clear();
		number = 0;
		for(int bin = 1; bin < bins.count; bin++)
		{
			side.Include(boxes[axis][bin - 1]);
			number += counts[axis][bin - 1];
			const float cost = side.Area() * number + rightCost[bin];
			if((number > 0) && (number < part.count) && (cost < best))
			{
				best = cost;
				bestAxis = axis;
				bestBin = bin;
			}
		}
	}
	return best < HUGE_VALF;
}

void ShadowTree::Builder::Divide(const Part& part, const Bins& bins, int axis, int bin, Part& left, Part& right)
{
	unsigned int begin = part.first, end = part.first + part.count;
	Item all[2], centres[2]; // of the left part and the right

	for(int side = 0; side < 2; side++)
	{
		all[side].Clear();
		centres[side].Clear();
	}
	while(begin < end)
	{
		const unsigned int last = end - 1;
		const Item item(items[begin]), other(items[last]);
		const unsigned int box = tree.order[begin], otherBox = tree.order[last];
		const int side = (bins.Of(item)[axis] < bin) ? 0 : 1;

		all[side].Include(item);
		centres[side].Include(item.TwiceCentre(), item.TwiceCentre());
		// both are written, so that there is no jump to guess
		const unsigned int here = side ? last : begin, there = side ? begin : last;
		items[there] = other;
		items[here] = item;
		tree.order[there] = otherBox;
		tree.order[here] = box;
		begin += 1 - side;
		end -= side;
	}
	left.first = part.first;
	left.count = end - part.first;
	left.all = all[0];
	left.centres = centres[0];
	right.first = end;
	right.count = part.count - left.count;
	right.all = all[1];
	right.centres = centres[1];
}

void ShadowTree::Builder::Halve(const Part& part, Part& left, Part& right) const
{
	left.first = part.first;
	left.count = part.count / 2;
	right.first = part.first + left.count;
	right.count = part.count - left.count;
	Measure(left);
	Measure(right);
}

void ShadowTree::Builder::Measure(Part& part) const
{
	part.all.Clear();
	part.centres.Clear();
	for(unsigned int i = part.first; i < part.first + part.count; i++)
	{
		part.all.Include(items[i]);
		part.centres.Include(items[i].TwiceCentre(), items[i].TwiceCentre());
	}
}

ShadowTree::ShadowTree(const vector<dsm_box>& boxes, unsigned int threads)
{
	if(!boxes.empty())
		Builder(*this, boxes, threads);
}

ShadowTree::Walk::Walk(const ShadowTree& t, const dsm_ray& r, Stack& s) : tree(t), line(r), stack(s), leafItem(0), leafEnd(0)
{
	double leave;
	Entry root = { 0, 0.0 };

	stack.clear();
	if(tree.nodes && line.Cross(tree.nodes[0].slabs, root.enter, leave))
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

ShadowTree::Sweep::Sweep(const ShadowTree& t, const ShadowBeam& b, Path& p, size_t most) : tree(t), beam(b), path(p), budget(most)
{
	Ahead root;

	path.clear();
	root.node = 0;
	if(tree.nodes && beam.Meets(tree.nodes[0].slabs.side[0], tree.nodes[0].slabs.side[1], root.rect))
		path.push_back(root);
}

bool ShadowTree::Sweep::Next(unsigned int& first, unsigned int& end)
{
	while((budget > 0) && !path.empty())
	{
		const Ahead ahead(path.back());

		path.pop_back();
		budget--;
		if(beam.Hides(ahead.rect))
			continue;

		const Node& node = tree.nodes[ahead.node];
		if(node.count > 0)
		{
			first = node.first;
			end = node.first + node.count;
			budget -= min(budget, size_t(node.count));
			return true;
		}

		// the nearer child is looked at first, so it goes on top
		Ahead left, right;
		left.node = node.first;
		right.node = node.first + 1;
		const Node *children = &tree.nodes[node.first];
		const bool meetsLeft = beam.Meets(children[0].slabs.side[0], children[0].slabs.side[1], left.rect);
		const bool meetsRight = beam.Meets(children[1].slabs.side[0], children[1].slabs.side[1], right.rect);
		const bool leftFirst = meetsLeft && meetsRight && (left.rect.nearness > right.rect.nearness);
		if(meetsLeft && !leftFirst)
			Push(left);
		if(meetsRight)
			Push(right);
		if(leftFirst)
			Push(left);
	}
	return false;
}

/// Memory is slow: what the node leads to is on its way when its turn comes.
inline void ShadowTree::Sweep::Push(const Ahead& ahead)
{
	const Node& node = tree.nodes[ahead.node];

	path.push_back(ahead);
	if(node.count > 0)
		return;
	__builtin_prefetch(&tree.nodes[node.first]);
	__builtin_prefetch(&tree.nodes[node.first + 1]);
}

}
