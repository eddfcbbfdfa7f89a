// SPDX-License-Identifier: AGPL-3.0-or-later

#include <limits>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/matrices.h"
#include "backend/math/vector.h"
#include "backend/pattern/pattern.h"
#include "backend/pattern/warps.h"
#include "backend/shadow/shadowdensity.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

const double kHuge = std::numeric_limits<double>::max();

/// Shells closer than this, in depth, are one.
const double kNudge = 1.0e-9;

/// Whether points come to the pattern through transformations alone: straight lines stay straight.
bool KeepsLines(const WARP *warp)
{
	for(; warp != NULL; warp = warp->Next_Warp)
		if((warp->Warp_Type != TRANSFORM_WARP) && (warp->Warp_Type != NO_WARP))
			return false;
	return true;
}

}

ShadowDensity::ShadowDensity(const PIGMENT *p) : pigment(p), kind(kUnknown), structure(kNone)
{
	// a picture of low quality takes this colour instead
	if(pigment->Quick_Colour[0] != -1.0)
		return;

	if(pigment->Type == PLAIN_PATTERN)
	{
		kind = kConstant;
		colour = DblRGBColour(pigment->colour[0], pigment->colour[1], pigment->colour[2]);
	}
	else if((pigment->Type > LAST_SPECIAL_PATTERN) && transfer.Read(pigment->Blend_Map))
	{
		kind = kMapped;
		transfer.Range(-kHuge, kHuge, least, most);
		structure = FindStructure();
	}
}

ShadowDensity::Structure ShadowDensity::FindStructure()
{
	if((pigment->Frequency != 1.0) || (pigment->Phase != 0.0) || (pigment->Wave_Type != RAMP_WAVE) || !KeepsLines(pigment->Warps))
		return kNone;

	axes[X] = axes[Y] = axes[Z] = false;
	switch(pigment->Type)
	{
		case DENSITY_FILE_PATTERN:
		{
			const DENSITY_FILE *file = pigment->Vals.Density_File;
			if((file == NULL) || (file->Data == NULL) || (file->Data->Sx == 0) || (file->Data->Sy == 0) || (file->Data->Sz == 0) ||
			   (file->Data->Density8 == NULL))
				return kNone;
			bricks.reset(new ShadowBricks(*file));
			return kGrid;
		}
		case SPHERICAL_PATTERN:
			axes[X] = axes[Y] = axes[Z] = true;
			return kDistance;
		case CYLINDRICAL_PATTERN:
			axes[X] = axes[Z] = true;
			return kDistance;
		case PLANAR_PATTERN:
			axes[Y] = true;
			return kDistance;
		default:
			return kNone;
	}
}

double ShadowDensity::Value(const VECTOR point, TraceThreadData *thread) const
{
	VECTOR at;

	Warp_EPoint(at, point, pigment);
	const double value = Evaluate_TPat(pigment, at, NULL, NULL, thread);
	return (value == value) ? value : 0.0; // of what is no number, POV-Ray takes the first colour
}

void ShadowDensity::Place(const dsm_ray& ray, Line& line) const
{
	VECTOR origin, direction;

	if(structure == kNone)
		return;

	Assign_Vector(origin, ray.origin);
	Assign_Vector(direction, ray.direction);
	for(const WARP *warp = pigment->Warps; warp != NULL; warp = warp->Next_Warp)
		if(warp->Warp_Type == TRANSFORM_WARP)
		{
			const TRANSFORM& transform = static_cast<const Trans_Warp *>(warp)->Trans;
			MInvTransPoint(origin, origin, &transform);
			MInvTransDirection(direction, direction, &transform);
		}

	if(structure == kGrid)
	{
		line.grid = bricks->Enter(origin, direction);
		return;
	}
	line.square[0] = line.square[1] = line.square[2] = 0.0;
	for(int i = 0; i < 3; i++)
		if(axes[i])
		{
			line.square[0] += origin[i] * origin[i];
			line.square[1] += 2.0 * origin[i] * direction[i];
			line.square[2] += direction[i] * direction[i];
		}
}

void ShadowDensity::Next(const Line& line, double depth, bool fine, Piece& piece) const
{
	double low, high;

	piece.end = piece.step = kHuge;
	piece.bounded = (kind != kUnknown);
	piece.grid = (structure == kGrid);
	if(kind == kConstant)
	{
		piece.least = piece.most = colour;
		return;
	}

	switch(structure)
	{
		case kGrid:
			bricks->Next(line.grid, depth, fine, piece.end, low, high);
			piece.step = ShadowBricks::CellLength(line.grid);
			break;
		case kDistance:
			NextShell(line, depth, piece, low, high);
			break;
		default:
			piece.least = least;
			piece.most = most;
			return;
	}
	transfer.Range(low, high, piece.least, piece.most);
}

/// The pattern's value is 1 - distance, and 0 from distance 1 on. A piece ends where the value comes to an entry of the
/// map, or where the line is nearest to the centre: there the value bends.
void ShadowDensity::NextShell(const Line& line, double depth, Piece& piece, double& low, double& high) const
{
	const double *s = line.square;
	const double nudge = kNudge * (1.0 + fabs(depth));
	const double nearest = (s[2] > 0.0) ? -s[1] / (2.0 * s[2]) : 0.0;

	if(s[2] > 0.0)
	{
		if(nearest > depth + nudge)
			piece.end = nearest;
		for(size_t i = 0; i <= transfer.Count(); i++)
		{
			const double distance = (i < transfer.Count()) ? 1.0 - transfer.Value(i) : 1.0;
			const double square = s[1] * s[1] - 4.0 * s[2] * (s[0] - distance * distance);
			if((distance < 0.0) || (square < 0.0))
				continue;
			const double root = sqrt(square);
			for(int sign = -1; sign <= 1; sign += 2)
			{
				const double at = (-s[1] + sign * root) / (2.0 * s[2]);
				if(at > depth + nudge)
					piece.end = min(piece.end, at);
			}
		}
		if(piece.end < kHuge)
			piece.step = piece.end - depth;
	}

	// between two ends the distance only grows or only falls
	const double at[2] = { depth, (piece.end < kHuge) ? piece.end : depth };
	double value[2];
	for(int i = 0; i < 2; i++)
		value[i] = max(0.0, 1.0 - sqrt(max(0.0, s[0] + at[i] * (s[1] + at[i] * s[2]))));
	if((piece.end == kHuge) && (s[2] > 0.0))
		value[1] = 0.0;

	// the ends lie on an entry's value to a few digits only: a step of the map there belongs to one side of it
	low = min(value[0], value[1]);
	high = max(value[0], value[1]);
	const double inward = min(0.25 * (high - low), 1.0e-7);
	low += inward;
	high -= inward;
}

}
