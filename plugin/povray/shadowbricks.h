// SPDX-License-Identifier: AGPL-3.0-or-later
// What a density file holds, brick by brick: the least and the most of its values.

#ifndef POVRAY_BACKEND_SHADOWBRICKS_H
#define POVRAY_BACKEND_SHADOWBRICKS_H

#include "backend/frame.h"

namespace pov
{

/// Bricks of 8 x 8 x 8 cells. A cell is what the interpolation does not look beyond: a voxel, or the space between eight
/// of them. Read-only once made.
class ShadowBricks
{
	public:
		explicit ShadowBricks(const DENSITY_FILE& file);

		/// A straight line through the grid, in cells: depth d is at origin + d * direction.
		struct Line
		{
			double origin[3], direction[3];
			double enter, leave; ///< depths; enter > leave: the line misses the grid
		};

		/// From a line in the pattern's own space, where the grid fills the unit cube.
		Line Enter(const VECTOR origin, const VECTOR direction) const;

		/// The piece of the line that begins at `depth` and keeps to one brick, or one cell, or stays outside the grid.
		/// @param[out]     end         its end, beyond `depth`
		/// @param[out]     low,high    bounds of the pattern's value there
		void Next(const Line& line, double depth, bool cell, double& end, double& low, double& high) const;

		/// A cell's length along the line, in depth.
		static double CellLength(const Line& line);
	private:
		struct Range { float low, high; };

		const DENSITY_FILE_DATA *data;
		size_t size[3];   ///< cells
		size_t count[3];  ///< bricks
		int before, after; ///< voxels that the interpolation needs on either side of a cell's own
		bool cubic;
		vector<Range> bricks;

		double Voxel(size_t x, size_t y, size_t z) const;
		Range Scan(const size_t begin[3], const size_t end[3]) const;
};

}

#endif
