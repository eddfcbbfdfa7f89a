// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/pattern/pattern.h"
#include "backend/shadow/shadowtransfer.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// Values closer than this are one: the difference of two integrals would have no digits left.
const double kSameValue = 1.0e-7;

}

bool ShadowTransfer::Read(const BLEND_MAP *map)
{
	entries.clear();
	grey = true;
	if((map == NULL) || (map->Number_Of_Entries < 1))
		return false;

	for(int i = 0; i < map->Number_Of_Entries; i++)
	{
		const BLEND_MAP_ENTRY& from = map->Blend_Map_Entries[i];
		Entry entry;

		entry.value = from.value;
		if(map->Type == COLOUR_TYPE)
			entry.colour = DblRGBColour(from.Vals.colour[0], from.Vals.colour[1], from.Vals.colour[2]);
		else if((map->Type == DENSITY_TYPE) || (map->Type == PIGMENT_TYPE))
		{
			const PIGMENT *plain = from.Vals.Pigment;
			if((plain->Type != PLAIN_PATTERN) || (plain->Quick_Colour[0] != -1.0))
				return false;
			entry.colour = DblRGBColour(plain->colour[0], plain->colour[1], plain->colour[2]);
		}
		else
			return false;
		if(!(fabs(entry.colour.red()) + fabs(entry.colour.green()) + fabs(entry.colour.blue()) < HUGE_VAL))
			return false; // not to be integrated

		grey = grey && (entry.colour.red() == entry.colour.green()) && (entry.colour.red() == entry.colour.blue());
		if(!entries.empty())
		{
			Entry& last = entries.back();
			if(!(entry.value >= last.value))
				return false;
			entry.integral = last.integral + (last.colour + entry.colour) * (0.5 * (entry.value - last.value));
			if(entry.value > last.value)
				last.slope = (entry.colour - last.colour) * (1.0 / (entry.value - last.value));
		}
		entries.push_back(entry);
	}
	return true;
}

/// Of entries with the same value the first counts, but the last one of all from its value on: as in Search_Blend_Map.
DblRGBColour ShadowTransfer::At(double value) const
{
	if(value >= entries.back().value)
		return entries.back().colour;

	const vector<Entry>::const_iterator next = std::lower_bound(entries.begin(), entries.end(), value);
	if((next == entries.begin()) || (next->value == value))
		return next->colour;

	const Entry& last = *(next - 1);
	return last.colour + (next->colour - last.colour) * ((value - last.value) / (next->value - last.value));
}

inline double ShadowTransfer::Integral(int entry, double value, int channel) const
{
	if(entry < 0)
		return entries[0].colour[channel] * (value - entries[0].value);

	const Entry& from = entries[entry];
	const double beyond = value - from.value;
	return from.integral[channel] + beyond * (from.colour[channel] + 0.5 * beyond * from.slope[channel]);
}

template<int kChannels> void ShadowTransfer::Means(const double *values, int count, double (*means)[3]) const
{
	int last = Find(values[0], 0);

	for(int i = 0; i < count; i++)
	{
		const double difference = values[i + 1] - values[i], middle = 0.5 * (values[i] + values[i + 1]);
		const int next = Find(values[i + 1], last);

		if((next == last) || (fabs(difference) < kSameValue)) // on a straight line, or as good as
		{
			const int at = Find(middle, next);
			const Entry& entry = entries[max(at, 0)];
			const double beyond = (at < 0) ? 0.0 : middle - entry.value;
			for(int k = 0; k < kChannels; k++)
				means[i][k] = entry.colour[k] + beyond * entry.slope[k];
		}
		else
		{
			const double scale = 1.0 / difference;
			for(int k = 0; k < kChannels; k++)
				means[i][k] = (Integral(next, values[i + 1], k) - Integral(last, values[i], k)) * scale;
		}
		last = next;
	}
}

template void ShadowTransfer::Means<1>(const double *values, int count, double (*means)[3]) const;
template void ShadowTransfer::Means<3>(const double *values, int count, double (*means)[3]) const;

void ShadowTransfer::Range(double low, double high, DblRGBColour& least, DblRGBColour& most) const
{
	const DblRGBColour ends[2] = { At(low), At(high) };
	if(low == high)
	{
		least = most = ends[0];
		return;
	}

	vector<Entry>::const_iterator next = std::lower_bound(entries.begin(), entries.end(), low);

	for(int k = 0; k < 3; k++)
	{
		least[k] = min(ends[0][k], ends[1][k]);
		most[k] = max(ends[0][k], ends[1][k]);
	}
	for(; (next != entries.end()) && (next->value <= high); next++)
		for(int k = 0; k < 3; k++)
		{
			least[k] = min(least[k], next->colour[k]);
			most[k] = max(most[k], next->colour[k]);
		}
}

}
