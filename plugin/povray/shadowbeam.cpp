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
const float kFloatRounding = 1.0e-6f;

/// What a place in cells is off by in floats, and some more; and one where no cell is.
const float kFloatEdge = 1.0e-4f, kFar = 1.0e9f;

/// What can be divided by.
const float kLeastFloat = 1.0e-30f;

/// What one instruction works on: of any processor, and of those with AVX2. Both find the same.
struct NarrowLanes
{
	enum { kCount = 4 };
	typedef float Floats __attribute__((vector_size(16)));
	typedef int Ints __attribute__((vector_size(16)));
};
struct WideLanes
{
	enum { kCount = 8 };
	typedef float Floats __attribute__((vector_size(32)));
	typedef int Ints __attribute__((vector_size(32)));
};
const float kNumbers[WideLanes::kCount] = { 0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f };

#ifdef __x86_64__
#define FOR_WIDE_LANES __attribute__((target("avx2")))
const bool kHasWideLanes = (__builtin_cpu_init(), __builtin_cpu_supports("avx2"));
#else
#define FOR_WIDE_LANES
const bool kHasWideLanes = false;
#endif

/// For functions that are to be made of the instructions of those that call them.
#define PART_OF_CALLER inline __attribute__((always_inline))

/// Most outlines have no more sides.
const int kUsualSides = 4;

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

	// some more, so that all lanes can be read anywhere
	across.assign(slots.size() + WideLanes::kCount - 1, 0.0f);
	upward.assign(slots.size() + WideLanes::kCount - 1, 0.0f);
	ends.assign(slots.size() + WideLanes::kCount - 1, HUGE_VALF);
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

/// An outline over the beam's cells, in floats: side by side, so that one instruction works on many rows or rays. All of it
/// lets through a little more than the outline does, so that rounding costs nothing.
template<int kSides> struct ShadowBeam::Mould
{
	float a[kSides], b[kSides], c[kSides]; ///< a x + b y <= c
	float left[kSides], leftStep[kSides];  ///< no cell of row y is inside that ends before left + leftStep y,
	float right[kSides], rightStep[kSides]; ///< nor one that begins behind right + rightStep y
	float least, most;                     ///< likewise, of all rows
	float nearness;

	PART_OF_CALLER Mould(const ShadowBeam& beam, const ShadowOutline& outline)
	{
		const ShadowRect& rect = outline.rect;

		nearness = ShadowFloatAbove(rect.nearness);
		least = float((rect.low[0] - beam.low[0]) * beam.perCell[0]);
		least -= kFloatEdge + kFloatRounding * fabsf(least);
		most = float((rect.high[0] - beam.low[0]) * beam.perCell[0]);
		most += kFloatEdge + kFloatRounding * fabsf(most);
		for(int i = 0; i < kSides; i++)
		{
			const ShadowOutline::Side& side = outline.sides[i];
			const bool unused = (i >= outline.sideCount);
			const double x = unused ? 0.0 : side.a * beam.cellSize[0], y = unused ? 0.0 : side.b * beam.cellSize[1];
			const double end = unused ? 1.0 : side.c - side.a * beam.low[0] - side.b * beam.low[1];
			a[i] = float(x);
			b[i] = float(y);
			c[i] = float(end + kFloatRounding * (kMostCells * (fabs(x) + fabs(y)) + fabs(end)));

			// of a row's two edges, the one at which the side leaves more cells; a side that runs along the rows cuts none
			const bool along = !(fabsf(a[i]) > kLeastFloat) || (fabs(side.a) < kLeastCut), onLeft = (a[i] < 0.0f);
			const float per = 1.0f / (along ? 1.0f : a[i]), step = -b[i] * per;
			const float edge = ((step > 0.0f) == !onLeft) ? 1.0f + kFloatEdge : -kFloatEdge;
			const float at = c[i] * per + step * edge, room = kFloatEdge + kFloatRounding * (fabsf(at) + kMostCells * fabsf(step));
			left[i] = (along || !onLeft) ? -kFar : at - room;
			leftStep[i] = (along || !onLeft) ? 0.0f : step;
			right[i] = (along || onLeft) ? kFar : at + room;
			rightStep[i] = (along || onLeft) ? 0.0f : step;
		}
	}

	/// The cells of some rows, from `row` on, that may be inside: from first to last, none if the last comes before the first.
	template<class Lanes> PART_OF_CALLER void Rows(int row, int cells, int from[Lanes::kCount], int to[Lanes::kCount]) const
	{
		typedef typename Lanes::Floats Floats;
		typedef typename Lanes::Ints Ints;
		const Floats zero = { 0.0f }, end = zero + float(cells - 1);
		const Ints nowhere = Ints { 0 } - 1;
		Floats y, low = zero + least, high = zero + most;

		memcpy(&y, kNumbers, sizeof(y));
		y += float(row);
		for(int i = 0; i < kSides; i++)
		{
			const Floats l = y * leftStep[i] + left[i], r = y * rightStep[i] + right[i];
			low = (l > low) ? l : low;
			high = (r < high) ? r : high;
		}
		// nothing lies left of the first cell or right of the last, but what is on its edge does so by rounding
		const Ints none = (low > high) | (high < zero - 2.0f * kFloatEdge) | (low > end + (1.0f + 2.0f * kFloatEdge));
		const Floats first = (low > zero) ? low : zero, last = (high > zero) ? high : zero;
		const Ints firstCell = __builtin_convertvector((first < end) ? first : end, Ints);
		const Ints lastCell = none ? nowhere : __builtin_convertvector((last < end) ? last : end, Ints);
		memcpy(from, &firstCell, sizeof(firstCell));
		memcpy(to, &lastCell, sizeof(lastCell));
	}

	/// Of some slots, all bits of those that are inside and do not end before the outline.
	/// @return     false if there are none
	template<class Lanes> PART_OF_CALLER bool Hold(const ShadowBeam& beam, unsigned int slot, int held[Lanes::kCount]) const
	{
		typename Lanes::Floats x, y, end;
		memcpy(&x, &beam.across[slot], sizeof(x));
		memcpy(&y, &beam.upward[slot], sizeof(y));
		memcpy(&end, &beam.ends[slot], sizeof(end));
		typename Lanes::Ints inside = (nearness >= end);
		for(int i = 0; i < kSides; i++)
			inside &= (x * a[i] + y * b[i] <= c[i]);

		long long any[sizeof(inside) / sizeof(long long)], all = 0;
		memcpy(any, &inside, sizeof(any));
		for(size_t i = 0; i < sizeof(any) / sizeof(*any); i++)
			all |= any[i];
		if(all == 0)
			return false;
		memcpy(held, &inside, sizeof(inside));
		return true;
	}
};

template<class Lanes, int kSides> PART_OF_CALLER void ShadowBeam::SelectInside(const ShadowOutline& outline, std::vector<unsigned int>& selected) const
{
	const ShadowRect& rect = outline.rect;
	const Mould<kSides> mould(*this, outline);
	const int begin = CellOf(1, rect.low[1] - kEdge * cellSize[1]), end = CellOf(1, rect.high[1] + kEdge * cellSize[1]) + 1;

	for(int row = begin; row < end; row += Lanes::kCount)
	{
		int from[Lanes::kCount], to[Lanes::kCount], held[Lanes::kCount];
		mould.template Rows<Lanes>(row, cells[0], from, to);
		for(int y = 0; y < min(int(Lanes::kCount), end - row); y++)
		{
			// cells of a row lie one behind the other
			const unsigned int *const starts = &first[(row + y) * cells[0]];
			const unsigned int last = starts[max(from[y], to[y] + 1)];
			for(unsigned int i = starts[from[y]]; i < last; i += Lanes::kCount)
			{
				if(!mould.template Hold<Lanes>(*this, i, held))
					continue;
				for(unsigned int k = 0; (k < Lanes::kCount) && (i + k < last); k++)
					if(held[k] && (!outline.round || outline.Holds(slots[i + k].u, slots[i + k].v)))
						selected.push_back(i + k);
			}
		}
	}
}

template<class Lanes> PART_OF_CALLER void ShadowBeam::SelectBy(const ShadowOutline& outline, std::vector<unsigned int>& selected) const
{
	if(outline.sideCount <= kUsualSides)
		SelectInside<Lanes, kUsualSides>(outline, selected);
	else
		SelectInside<Lanes, ShadowOutline::kMostSides>(outline, selected);
}

FOR_WIDE_LANES void ShadowBeam::SelectWide(const ShadowOutline& outline, std::vector<unsigned int>& selected) const
{
	SelectBy<WideLanes>(outline, selected);
}

void ShadowBeam::Select(const ShadowOutline& outline, std::vector<unsigned int>& selected) const
{
	const ShadowRect& rect = outline.rect;

	if((rect.low[0] > high[0]) || (rect.high[0] < low[0]) || (rect.low[1] > high[1]) || (rect.high[1] < low[1]) || (rect.nearness < end))
		return;
	if(kHasWideLanes)
		SelectWide(outline, selected);
	else
		SelectBy<NarrowLanes>(outline, selected);
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
