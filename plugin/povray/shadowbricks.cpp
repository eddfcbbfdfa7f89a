// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <limits>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/pattern/pattern.h"
#include "backend/shadow/shadowbricks.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

const size_t kBrick = 8;

/// Tricubic interpolation has negative weights. In one dimension they add up to -1/8 at most, in three to
/// -((1 + 2/8)^3 - 1) / 2 = -0.477: values may leave the voxels' range by that share of it.
const double kOvershoot = 0.48;

/// A pattern's value above this begins anew at 0 (see Evaluate_TPat).
const double kWrap = 1.00001;

/// Depths are good to this share of themselves.
const double kNudge = 1.0e-12;

}

ShadowBricks::ShadowBricks(const DENSITY_FILE& file) : data(file.Data)
{
	const int interpolation = file.Interpolation % 10;

	cubic = (interpolation != NO_INTERPOLATION) && (interpolation != TRILINEAR_INTERPOLATION);
	before = cubic ? 1 : 0;
	after = cubic ? 2 : (interpolation == TRILINEAR_INTERPOLATION) ? 1 : 0;

	size[X] = data->Sx;
	size[Y] = data->Sy;
	size[Z] = data->Sz;
	for(int i = 0; i < 3; i++)
		count[i] = (size[i] + kBrick - 1) / kBrick;

	bricks.reserve(count[X] * count[Y] * count[Z]);
	for(size_t z = 0; z < size[Z]; z += kBrick)
		for(size_t y = 0; y < size[Y]; y += kBrick)
			for(size_t x = 0; x < size[X]; x += kBrick)
			{
				const size_t begin[3] = { x, y, z };
				const size_t end[3] = { min(x + kBrick, size[X]), min(y + kBrick, size[Y]), min(z + kBrick, size[Z]) };
				bricks.push_back(Scan(begin, end));
			}
}

double ShadowBricks::Voxel(size_t x, size_t y, size_t z) const
{
	const size_t at = (z * size[Y] + y) * size[X] + x;

	switch(data->Type)
	{
		case 4:  return data->Density32[at] / (double)UINT_MAX;
		case 2:  return data->Density16[at] / (double)USHRT_MAX;
		default: return data->Density8[at] / (double)UCHAR_MAX;
	}
}

/// Bounds of what density_pattern makes of the cells from `begin` up to, not including, `end`. Neighbours beyond the grid
/// are those that it takes: the index wraps, as an unsigned number does below 0.
ShadowBricks::Range ShadowBricks::Scan(const size_t begin[3], const size_t end[3]) const
{
	double low = std::numeric_limits<double>::max(), high = 0.0;

	for(size_t z = begin[Z] - before; z != end[Z] + after; z++)
		for(size_t y = begin[Y] - before; y != end[Y] + after; y++)
			for(size_t x = begin[X] - before; x != end[X] + after; x++)
			{
				const double voxel = Voxel(x % size[X], y % size[Y], z % size[Z]);
				low = min(low, voxel);
				high = max(high, voxel);
			}

	if(cubic && (high > low))
	{
		const double overshoot = kOvershoot * (high - low);
		low = max(low - overshoot, 0.0);
		high += overshoot;
		if(high > kWrap)
			low = 0.0;
	}

	// rounding of the interpolation, and of the floats here, must not leave the range
	const Range range = { (float)low - 1.0e-6f * (high > low), (float)high + 1.0e-6f * (high > low) };
	return range;
}

ShadowBricks::Line ShadowBricks::Enter(const VECTOR origin, const VECTOR direction) const
{
	Line line;

	line.enter = -std::numeric_limits<double>::max();
	line.leave = std::numeric_limits<double>::max();
	for(int i = 0; i < 3; i++)
	{
		line.origin[i] = origin[i] * size[i];
		line.direction[i] = direction[i] * size[i];
		if(line.direction[i] != 0.0)
		{
			const double a = -line.origin[i] / line.direction[i];
			const double b = (size[i] - line.origin[i]) / line.direction[i];
			line.enter = max(line.enter, min(a, b));
			line.leave = min(line.leave, max(a, b));
		}
		else if((line.origin[i] < 0.0) || (line.origin[i] >= size[i]))
			line.leave = -std::numeric_limits<double>::max();
	}
	return line;
}

void ShadowBricks::Next(const Line& line, double depth, bool cell, double& end, double& low, double& high) const
{
	const double nudge = kNudge * (1.0 + fabs(depth));

	low = high = 0.0;
	end = std::numeric_limits<double>::max();
	if(!(line.enter < line.leave) || (depth + nudge >= line.leave))
		return;
	if(depth + nudge < line.enter)
	{
		end = line.enter;
		return;
	}

	size_t begin[3], stop[3], brick[3];
	const double length = cell ? 1.0 : (double)kBrick;

	for(int i = 0; i < 3; i++)
	{
		// just ahead, so that a line on a border is taken to be where it goes
		const double at = line.origin[i] + (depth + nudge) * line.direction[i];
		const double within = min(max(at, 0.0), size[i] - 1.0);
		const double first = floor(within / length) * length;

		begin[i] = (size_t)first;
		stop[i] = begin[i] + 1;
		brick[i] = begin[i] / kBrick;
		if(line.direction[i] != 0.0)
			end = min(end, ((line.direction[i] > 0.0 ? first + length : first) - line.origin[i]) / line.direction[i]);
	}
	end = max(min(end, line.leave), depth + 2.0 * nudge);

	const Range range = cell ? Scan(begin, stop) : bricks[(brick[Z] * count[Y] + brick[Y]) * count[X] + brick[X]];
	low = range.low;
	high = range.high;
}

double ShadowBricks::CellLength(const Line& line)
{
	return 1.0 / max(fabs(line.direction[X]), max(fabs(line.direction[Y]), max(fabs(line.direction[Z]), 1.0e-30)));
}

}
