// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <cmath>
#include <cstring>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/shadow/shadowbeam.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// Rays this far from the beam's axis are too oblique for tangents: cosine of 72 degrees.
const double kLeastCosine = 0.3;

/// Rays a cell, on average: a cell costs about as much as a ray.
const double kRaysPerCell = 3.0;

/// What is known of a point's place, relative to its coordinates.
const double kRounding = 1.0e-14;

/// A ray this near to a cell's edge, in cells, may have been sorted into either cell.
const double kEdge = 1.0e-6;

/// A side that is cut by this little by a row of cells leaves all of them.
const double kLeastCut = 0.01;

/// What floats are off by, and some more.
const double kFloatRounding = 1.0e-6;

/// What one instruction works on.
typedef float Lanes __attribute__((vector_size(16)));
typedef int IntLanes __attribute__((vector_size(16)));

/// Hidden or not is asked of at most so many blocks.
const int kMostBlocksAsked = 16;

bool Same(const double a[3], const double b[3])
{
	return (a[0] == b[0]) && (a[1] == b[1]) && (a[2] == b[2]);
}

}

/// Sets the frame.
bool ShadowBeam::Orient(unsigned int count)
{
	bool point = true, parallel = true;
	double sum[3] = { 0.0, 0.0, 0.0 }, deepest = 0.0;

	for(unsigned int i = 0; i < count; i++)
	{
		point = point && Same(rays[i].origin, rays[0].origin);
		parallel = parallel && Same(rays[i].direction, rays[0].direction);
		if(!point && !parallel)
			return false;
		for(int k = 0; k < 3; k++)
			sum[k] += rays[i].direction[k];
		deepest = max(deepest, fabs(rays[i].far_depth));
	}
	frame.perspective = !parallel;

	const double length = sqrt(ShadowDot(sum, sum));
	if(!(length > kLeastCosine * count))
		return false;
	int thin = 0; // the direction's smallest component
	for(int k = 0; k < 3; k++)
	{
		frame.origin[k] = rays[0].origin[k];
		frame.forward[k] = sum[k] / length;
		if(fabs(frame.forward[k]) < fabs(frame.forward[thin]))
			thin = k;
	}
	const int next = (thin + 1) % 3, last = (thin + 2) % 3;
	const double across = 1.0 / sqrt(Sqr(frame.forward[next]) + Sqr(frame.forward[last]));
	frame.right[thin] = 0.0;
	frame.right[next] = -frame.forward[last] * across;
	frame.right[last] = frame.forward[next] * across;
	for(int k = 0; k < 3; k++)
		frame.up[k] = frame.forward[(k + 1) % 3] * frame.right[(k + 2) % 3] - frame.forward[(k + 2) % 3] * frame.right[(k + 1) % 3];
	frame.slack = kRounding * (fabs(frame.origin[0]) + fabs(frame.origin[1]) + fabs(frame.origin[2]) + deepest);
	return true;
}

double ShadowBeam::EndAt(const dsm_ray& ray, double depth) const
{
	double w = (depth + ahead) * ShadowDot(ray.direction, frame.forward) + frame.slack;

	if(!frame.perspective)
	{
		double from[3];
		frame.Point(ray.origin, from);
		w += from[2];
	}
	return frame.Nearness(w);
}

bool ShadowBeam::Aim(const dsm_ray *r, unsigned int count, double a)
{
	rays = r;
	ahead = a;
	if(!Orient(count))
		return false;

	unsorted.resize(count);
	for(int k = 0; k < 2; k++)
	{
		low[k] = HUGE_VAL;
		high[k] = -HUGE_VAL;
	}
	for(unsigned int i = 0; i < count; i++)
	{
		double at[3];
		if(frame.perspective)
		{
			frame.Vector(rays[i].direction, at);
			if(!(at[2] > kLeastCosine))
				return false;
			at[0] /= at[2];
			at[1] /= at[2];
		}
		else
			frame.Point(rays[i].origin, at);
		Slot& slot = unsorted[i];
		slot.u = at[0];
		slot.v = at[1];
		slot.ray = i;
		slot.end = EndAt(rays[i], rays[i].far_depth);
		for(int k = 0; k < 2; k++)
		{
			low[k] = min(low[k], at[k]);
			high[k] = max(high[k], at[k]);
		}
	}
	Sort();
	return true;
}

inline int ShadowBeam::CellOf(int axis, double x) const
{
	const double cell = (x - low[axis]) * perCell[axis];
	return (cell > 0.0) ? ((cell < cells[axis]) ? int(cell) : cells[axis] - 1) : 0;
}

/// Square cells, as far as their number allows.
void ShadowBeam::Sort()
{
	const double width = high[0] - low[0], height = high[1] - low[1], wanted = unsorted.size() / kRaysPerCell;

	for(int k = 0; k < 2; k++)
	{
		const double own = (k == 0) ? width : height, other = (k == 0) ? height : width;
		const double number = (own > 0.0) ? ((other > 0.0) ? sqrt(wanted * own / other) : wanted) : 1.0;
		cells[k] = int(max(1.0, min(double(kMostCells), number)));
		perCell[k] = (own > 0.0) ? cells[k] / own : 0.0;
		cellSize[k] = own / cells[k];
		blocks[k] = (cells[k] + kBlock - 1) / kBlock;
	}

	first.assign(cells[0] * cells[1] + 1, 0);
	for(vector<Slot>::iterator i(unsorted.begin()); i != unsorted.end(); i++)
	{
		i->cell = CellOf(1, i->v) * cells[0] + CellOf(0, i->u);
		first[i->cell + 1]++;
	}
	for(size_t i = 1; i < first.size(); i++)
		first[i] += first[i - 1];
	slots.resize(unsorted.size());
	cellEnds.assign(cells[0] * cells[1], HUGE_VAL);
	for(vector<Slot>::const_iterator i(unsorted.begin()); i != unsorted.end(); i++)
	{
		slots[first[i->cell]++] = *i;
		cellEnds[i->cell] = min(cellEnds[i->cell], i->end);
	}
	// filling has moved each start to its end, which is the next cell's start
	std::copy_backward(first.begin(), first.end() - 1, first.end());
	first[0] = 0;

	// three more, so that four can be read anywhere
	across.assign(slots.size() + 3, 0.0f);
	upward.assign(slots.size() + 3, 0.0f);
	ends.assign(slots.size() + 3, HUGE_VALF);
	for(size_t i = 0; i < slots.size(); i++)
	{
		across[i] = float((slots[i].u - low[0]) * perCell[0]);
		upward[i] = float((slots[i].v - low[1]) * perCell[1]);
		ends[i] = ShadowFloatBelow(slots[i].end);
	}

	blockEnds.resize(blocks[0] * blocks[1]);
	for(size_t i = 0; i < blockEnds.size(); i++)
		FindBlockEnd(i);
	FindEnd();
}

void ShadowBeam::FindBlockEnd(int block)
{
	const int x = block % blocks[0] * kBlock, y = block / blocks[0] * kBlock;
	double farthest = HUGE_VAL;

	for(int j = y; j < min(y + int(kBlock), cells[1]); j++)
		for(int i = x; i < min(x + int(kBlock), cells[0]); i++)
			farthest = min(farthest, cellEnds[j * cells[0] + i]);
	blockEnds[block] = farthest;
}

void ShadowBeam::FindEnd()
{
	end = *std::min_element(blockEnds.begin(), blockEnds.end());
}

void ShadowBeam::Shorten(unsigned int slot, double depth)
{
	Slot& s = slots[slot];
	const double before = s.end;

	s.end = EndAt(rays[s.ray], depth);
	ends[slot] = ShadowFloatBelow(s.end);
	if(before > cellEnds[s.cell])
		return;

	double farthest = HUGE_VAL;
	for(unsigned int i = first[s.cell]; i < first[s.cell + 1]; i++)
		farthest = min(farthest, slots[i].end);
	const double cellBefore = cellEnds[s.cell];
	cellEnds[s.cell] = farthest;

	const int block = s.cell / cells[0] / kBlock * blocks[0] + s.cell % cells[0] / kBlock;
	if(cellBefore > blockEnds[block])
		return;
	const double blockBefore = blockEnds[block];
	FindBlockEnd(block);
	if(blockBefore <= end)
		FindEnd();
}

bool ShadowBeam::Meets(const float boxLow[3], const float boxHigh[3], ShadowRect& rect) const
{
	double middle[3], half[3], at[3], reach[3];

	for(int k = 0; k < 3; k++)
	{
		middle[k] = 0.5 * (double(boxLow[k]) + double(boxHigh[k]));
		half[k] = 0.5 * (double(boxHigh[k]) - double(boxLow[k]));
	}
	frame.Point(middle, at);
	reach[0] = half[0] * fabs(frame.right[0]) + half[1] * fabs(frame.right[1]) + half[2] * fabs(frame.right[2]) + frame.slack;
	reach[1] = half[0] * fabs(frame.up[0]) + half[1] * fabs(frame.up[1]) + half[2] * fabs(frame.up[2]) + frame.slack;
	reach[2] = half[0] * fabs(frame.forward[0]) + half[1] * fabs(frame.forward[1]) + half[2] * fabs(frame.forward[2]) + frame.slack;

	const double nearest = at[2] - reach[2], farthest = at[2] + reach[2];
	if(!frame.perspective)
	{
		rect.nearness = -nearest;
		for(int k = 0; k < 2; k++)
		{
			rect.low[k] = at[k] - reach[k];
			rect.high[k] = at[k] + reach[k];
		}
	}
	else if(nearest > 1.0e-3 * reach[2])
	{
		const double nearScale = 1.0 / nearest, farScale = 1.0 / farthest;
		rect.nearness = nearScale;
		for(int k = 0; k < 2; k++)
		{
			const double from = at[k] - reach[k], to = at[k] + reach[k];
			rect.low[k] = from * ((from < 0.0) ? nearScale : farScale);
			rect.high[k] = to * ((to > 0.0) ? nearScale : farScale);
		}
	}
	else
	{
		if(farthest < 0.0)
			return false;
		rect.nearness = HUGE_VAL;
		for(int k = 0; k < 2; k++)
		{
			rect.low[k] = -HUGE_VAL;
			rect.high[k] = HUGE_VAL;
		}
	}
	// the rays' own places are rounded as well: by parts in 1e15 of the beam's width, which `slack` has room for
	return (rect.nearness >= end) && (rect.low[0] <= high[0]) && (rect.high[0] >= low[0]) && (rect.low[1] <= high[1]) && (rect.high[1] >= low[1]);
}

bool ShadowBeam::Hides(const ShadowRect& rect) const
{
	if(rect.nearness < end)
		return true;
	const int x0 = CellOf(0, rect.low[0]) / kBlock, x1 = CellOf(0, rect.high[0]) / kBlock;
	const int y0 = CellOf(1, rect.low[1]) / kBlock, y1 = CellOf(1, rect.high[1]) / kBlock;

	if((x1 - x0 + 1) * (y1 - y0 + 1) > kMostBlocksAsked)
		return false;
	for(int y = y0; y <= y1; y++)
		for(int x = x0; x <= x1; x++)
			if(rect.nearness >= blockEnds[y * blocks[0] + x])
				return false;
	return true;
}

/// Where the outline's sides cut the rows of cells, in cells from the left: linear in the row.
struct ShadowBeam::Clip
{
	struct Cut
	{
		double at, step; ///< in row 0, and from row to row
	};
	Cut lefts[ShadowOutline::kMostSides + 1], rights[ShadowOutline::kMostSides + 1];
	int leftCount, rightCount;

	Clip(const ShadowBeam& beam, const ShadowOutline& outline) : leftCount(1), rightCount(1)
	{
		const Cut left = { (outline.rect.low[0] - beam.low[0]) * beam.perCell[0], 0.0 };
		const Cut right = { (outline.rect.high[0] - beam.low[0]) * beam.perCell[0], 0.0 };
		lefts[0] = left;
		rights[0] = right;
		for(int i = 0; i < outline.sideCount; i++)
		{
			const ShadowOutline::Side& side = outline.sides[i];
			if(fabs(side.a) < kLeastCut)
				continue;
			// of a row's two edges, the one at which the side leaves more cells
			const double across = 1.0 / side.a, slope = -side.b * across;
			const bool top = (slope > 0.0) == (side.a > 0.0);
			const double edge = beam.low[1] + (top ? 1.0 + kEdge : -kEdge) * beam.cellSize[1];
			const Cut cut = { (side.c * across + slope * edge - beam.low[0]) * beam.perCell[0], slope * beam.cellSize[1] * beam.perCell[0] };
			if(side.a > 0.0)
				rights[rightCount++] = cut;
			else
				lefts[leftCount++] = cut;
		}
	}

	/// The row's cells that the sides leave, from first to last.
	void Row(int row, int cells, int& from, int& to) const
	{
		double left = lefts[0].at, right = rights[0].at;

		for(int i = 1; i < leftCount; i++)
			left = max(left, lefts[i].at + row * lefts[i].step);
		for(int i = 1; i < rightCount; i++)
			right = min(right, rights[i].at + row * rights[i].step);
		from = Within(left - kEdge, cells);
		to = (left <= right) ? Within(right + kEdge, cells) : from - 1;
	}
	static int Within(double cell, int cells) { return (cell > 0.0) ? ((cell < cells) ? int(cell) : cells - 1) : 0; }
};

/// The outline's sides in float cells, for four rays at a time. They let through a little more, so that rounding costs none.
struct ShadowBeam::Sides
{
	Lanes a[ShadowOutline::kMostSides], b[ShadowOutline::kMostSides], c[ShadowOutline::kMostSides], nearness;
	const int count;

	Sides(const ShadowBeam& beam, const ShadowOutline& outline) : count(outline.sideCount)
	{
		const Lanes zero = { 0.0f, 0.0f, 0.0f, 0.0f };
		for(int i = 0; i < count; i++)
		{
			const ShadowOutline::Side& side = outline.sides[i];
			const double x = side.a * beam.cellSize[0], y = side.b * beam.cellSize[1];
			const double most = side.c - side.a * beam.low[0] - side.b * beam.low[1];
			a[i] = zero + float(x);
			b[i] = zero + float(y);
			c[i] = zero + float(most + kFloatRounding * (kMostCells * (fabs(x) + fabs(y)) + fabs(most)));
		}
		nearness = zero + ShadowFloatAbove(outline.rect.nearness);
	}

	/// Of four slots, all bits of those that are inside and do not end before the outline.
	IntLanes Hold(const ShadowBeam& beam, unsigned int slot) const
	{
		Lanes x, y, end;
		memcpy(&x, &beam.across[slot], sizeof(x));
		memcpy(&y, &beam.upward[slot], sizeof(y));
		memcpy(&end, &beam.ends[slot], sizeof(end));
		IntLanes held = (nearness >= end);
		for(int i = 0; i < count; i++)
			held &= (a[i] * x + b[i] * y <= c[i]);
		return held;
	}
};

void ShadowBeam::Select(const ShadowOutline& outline, std::vector<unsigned int>& selected) const
{
	const ShadowRect& rect = outline.rect;

	if((rect.low[0] > high[0]) || (rect.high[0] < low[0]) || (rect.low[1] > high[1]) || (rect.high[1] < low[1]) || (rect.nearness < end))
		return;
	const Clip clip(*this, outline);
	const Sides sides(*this, outline);
	const int y1 = CellOf(1, rect.high[1] + kEdge * cellSize[1]);
	for(int y = CellOf(1, rect.low[1] - kEdge * cellSize[1]); y <= y1; y++)
	{
		int from, to;
		clip.Row(y, cells[0], from, to);
		const unsigned int last = (from <= to) ? first[y * cells[0] + to + 1] : 0; // cells of a row lie one behind the other
		for(unsigned int i = (from <= to) ? first[y * cells[0] + from] : 0; i < last; i += 4)
		{
			const IntLanes held(sides.Hold(*this, i));
			long long any[2];
			memcpy(any, &held, sizeof(any));
			if((any[0] | any[1]) == 0)
				continue;
			for(unsigned int k = 0; (k < 4) && (i + k < last); k++)
				if(held[k] && (!outline.round || outline.Holds(slots[i + k].u, slots[i + k].v)))
					selected.push_back(i + k);
		}
	}
}

void ShadowBeam::Drop(const double plane[3], size_t from, std::vector<unsigned int>& selected) const
{
	size_t kept = from;

	for(size_t i = from; i < selected.size(); i++)
	{
		const Slot& slot = slots[selected[i]];
		if(plane[0] * slot.u + plane[1] * slot.v + plane[2] >= slot.end)
			selected[kept++] = selected[i];
	}
	selected.resize(kept);
}

void ShadowBeam::SelectAll(std::vector<unsigned int>& selected) const
{
	for(size_t i = 0; i < slots.size(); i++)
		selected.push_back(i);
}

}
