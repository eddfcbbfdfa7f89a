// SPDX-License-Identifier: AGPL-3.0-or-later
// A transfer function: what a density map makes of its pattern's value, integrated beforehand.

#ifndef POVRAY_BACKEND_SHADOWTRANSFER_H
#define POVRAY_BACKEND_SHADOWTRANSFER_H

#include "backend/frame.h"

namespace pov
{

/// Colour as a piecewise linear function of a pattern's value, as Compute_Pigment has it. Because its integral is known,
/// its mean between two values is exact: no step of the map, however thin, falls between two samples of a ray as long as
/// the pattern's value is about linear there (Hadwiger et al. 2006, 3.2, without a table in two dimensions).
class ShadowTransfer
{
	public:
		/// @return     false if the map's colours depend on more than the pattern's value; nothing else may be called then
		bool Read(const BLEND_MAP *map);

		DblRGBColour At(double value) const;
		/// Whether all channels are the same.
		bool Grey() const { return grey; }

		/// The mean over all values between two neighbours, for `count` pairs: means[i] is of values[i] and values[i + 1].
		/// Of the first `kChannels` channels: one is enough for grey.
		template<int kChannels> void Means(const double *values, int count, double (*means)[3]) const;
		/// @return     the entry from which on, or -1 in front of which, the map is one straight line over all values from `low` to
		///             `high`; kBent if it is not
		int Straight(double low, double high, int from) const
		{
			const int entry = Find(low, from);
			return ((entry + 1 == (int)entries.size()) || (high <= entries[entry + 1].value)) ? entry : int(kBent);
		}
		enum { kBent = -2 };
		/// On the straight line of such an entry.
		double On(int entry, double value, int channel) const
		{
			const Entry& on = entries[max(entry, 0)];
			return on.colour[channel] + ((entry < 0) ? 0.0 : (value - on.value) * on.slope[channel]);
		}

		/// The least and the most of each channel over all values from `low` to `high`.
		void Range(double low, double high, DblRGBColour& least, DblRGBColour& most) const;

		/// Where the map bends or steps, in rising order.
		size_t Count() const { return entries.size(); }
		double Value(size_t entry) const { return entries[entry].value; }
	private:
		struct Entry
		{
			double value;
			DblRGBColour colour;
			DblRGBColour integral; ///< from the first entry's value to this one's
			DblRGBColour slope;    ///< from here to the next entry; of the last one 0
			bool operator<(double v) const { return value < v; }
		};
		vector<Entry> entries;
		bool grey;

		/// The last entry that is not above a value, or -1. Looks near `from` first: the next value is seldom far.
		int Find(double value, int from) const
		{
			const int count = entries.size();

			while((from >= 0) && (value < entries[from].value))
				from--;
			while((from + 1 < count) && (value >= entries[from + 1].value))
				from++;
			return from;
		}
		double Integral(int entry, double value, int channel) const;
};

}

#endif
