// SPDX-License-Identifier: AGPL-3.0-or-later
// What can be known of one density statement before any ray asks: its map, and where along a line its value stays.

#ifndef POVRAY_BACKEND_SHADOWDENSITY_H
#define POVRAY_BACKEND_SHADOWDENSITY_H

#include <boost/shared_ptr.hpp>

#include "backend/shadow/shadowbricks.h"
#include "backend/shadow/shadowplugin.h"
#include "backend/shadow/shadowtransfer.h"

namespace pov
{

/// Read-only once made, and shared by all threads.
class ShadowDensity
{
	public:
		enum Kind
		{
			kConstant, ///< the same everywhere
			kMapped,   ///< a transfer function of a pattern's value
			kUnknown   ///< only an evaluation tells
		};

		explicit ShadowDensity(const PIGMENT *pigment);

		Kind GetKind() const { return kind; }
		/// Of a constant density.
		const DblRGBColour& Colour() const { return colour; }
		/// Of a mapped density.
		const ShadowTransfer& Transfer() const { return transfer; }
		const DblRGBColour& Least() const { return least; }
		const DblRGBColour& Most() const { return most; }

		/// The pattern's value at a point: what the map is then asked for. For mapped densities.
		double Value(const VECTOR point, TraceThreadData *thread) const;

		/// A ray, in the space in which the density's structure is simple.
		struct Line
		{
			ShadowBricks::Line grid;
			double square[3]; ///< distance from the pattern's centre: sqrt(s[0] + s[1] d + s[2] d^2) at depth d
		};
		void Place(const dsm_ray& ray, Line& line) const;

		/// A stretch of a line, from a given depth on, and bounds of the density there.
		struct Piece
		{
			double end;              ///< depth, beyond the given one; huge: there is no end
			bool bounded;            ///< `least` and `most` hold
			DblRGBColour least, most;
			double step;             ///< a first step that misses nothing, in depth; huge: nothing is known of that
			bool grid;               ///< that step is a cell of a density file
		};
		/// @param[in]      fine        take the smaller pieces, where there are two sizes
		void Next(const Line& line, double depth, bool fine, Piece& piece) const;
	private:
		enum Structure { kNone, kGrid, kDistance };

		const PIGMENT *pigment;
		Kind kind;
		Structure structure;
		DblRGBColour colour;
		ShadowTransfer transfer;
		boost::shared_ptr<ShadowBricks> bricks;
		bool axes[3]; ///< that the distance from the pattern's centre is measured along
		DblRGBColour least, most; ///< of the whole map

		Structure FindStructure();
		void NextShell(const Line& line, double depth, Piece& piece, double& low, double& high) const;
};

}

#endif
