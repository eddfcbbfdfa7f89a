// SPDX-License-Identifier: AGPL-3.0-or-later
// Many light rays side by side, as a small picture that objects are drawn into.

#ifndef POVRAY_BACKEND_SHADOWBEAM_H
#define POVRAY_BACKEND_SHADOWBEAM_H

#include <vector>

#include "backend/shadow/shadowoutline.h"

namespace pov
{

/// Rays that share their origin or their direction, sorted into cells over u and v; see ShadowFrame. Each has an end,
/// and each cell and each block of cells knows the farthest end in it: what lies behind that is hidden. Ends are kept
/// as nearness, so the farthest is the smallest.
///
/// A ray's place in the order of the cells is its slot.
class ShadowBeam
{
	public:
		/// Sorts the rays. All end at their far depths, plus `ahead`.
		/// @return     false if they are no beam: of several origins and directions, or too wide
		bool Aim(const dsm_ray *rays, unsigned int count, double ahead);

		const ShadowFrame& Frame() const { return frame; }

		/// The index that the ray had when it came.
		unsigned int Ray(unsigned int slot) const { return slots[slot].ray; }

		/// The ray ends at this depth now, plus `ahead`. Never later than before.
		void Shorten(unsigned int slot, double depth);

		/// A box's place in the beam.
		/// @return     false if no ray meets it, or all end before; `rect` says nothing then
		bool Meets(const float low[3], const float high[3], ShadowRect& rect) const;

		/// Whether all rays in the rectangle end before its nearness. May say no where they do.
		bool Hides(const ShadowRect& rect) const;

		/// Adds all rays inside the outline that do not end before the nearest of it, and maybe a few beside it.
		void Select(const ShadowOutline& outline, std::vector<unsigned int>& selected) const;
		void SelectAll(std::vector<unsigned int>& selected) const;

		/// Takes out the rays that end before a plane; see ShadowOutline. The first `from` stay.
		void Drop(const double plane[3], size_t from, std::vector<unsigned int>& selected) const;

		/// The farthest end of all.
		double End() const { return end; }
	private:
		enum { kBlock = 4 }; ///< cells along a block's side
		enum { kMostCells = 64 }; ///< along a side

		template<int kSides> struct Mould;
		struct Slot
		{
			double u, v, end;
			unsigned int ray, cell;
		};

		ShadowFrame frame;
		double ahead;
		const dsm_ray *rays;
		double low[2], high[2], perCell[2], cellSize[2];
		int cells[2], blocks[2];
		std::vector<Slot> slots, unsorted;
		std::vector<float> across, upward, ends; ///< of the slots: u and v in cells, and their ends
		std::vector<unsigned int> first; ///< of each cell's slots; one more than cells
		std::vector<double> cellEnds, blockEnds;
		double end;

		bool Orient(unsigned int count);
		void Sort();
		double EndAt(const dsm_ray& ray, double depth) const;
		int CellOf(int axis, double x) const;
		void FindBlockEnd(int block);
		void FindEnd();
		template<class Lanes, int kSides> void SelectInside(const ShadowOutline& outline, std::vector<unsigned int>& selected) const;
		template<class Lanes> void SelectBy(const ShadowOutline& outline, std::vector<unsigned int>& selected) const;
		void SelectWide(const ShadowOutline& outline, std::vector<unsigned int>& selected) const;
};

}

#endif
