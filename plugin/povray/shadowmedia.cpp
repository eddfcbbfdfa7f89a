// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <limits>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/math/vector.h"
#include "backend/shadow/shadowmedia.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// A stretch of which nothing is known begins with this many steps at least, and at most.
const int kLeastSteps = 4, kMostSteps = 64;

/// A step is halved until it is this much shorter than the first steps: a jump is found to that precision.
const double kShortest = 1.0 / 128.0;

/// Share of the tolerance that one step may be wrong by, before slackness. Steps err to both sides.
const double kStepShare = 0.3;

/// Share of the tolerance by which light within a span may differ from the exponential.
const double kSpanShare = 0.5;

/// Where a density file is interpolated, the pattern's value bends at every voxel, and neighbouring steps err to the same
/// side. So each may err by this share of that only.
const double kGridShare = 0.25;

/// A run's ends keep this share of the depth clear of what comes before and behind: there the density may jump.
const double kClear = 1.0e-10;

/// A stretch counts as even if the bounds of its extinction leave open no more than this share of a first step's error.
const double kEvenShare = 0.25;

/// Light that is left below this share of the tolerance is not worth a step.
const double kDarkShare = 0.5;

/// A jump may lie half a step, so two quarters, from where it is taken to be; and for all of a pixel's rays: it has no slackness.
const double kJump = 2.0;

/// The integral is never asked to be better than this.
const double kLeastTolerance = 1.0e-4;

/// Light that a span takes below this is nothing.
const double kNothing = 1.0e-9;

/// A run is passed when it has come to this many samples.
const size_t kMostPlanned = 64;

const double kHuge = std::numeric_limits<double>::max();

double Least(const DblRGBColour& c) { return min(c.red(), min(c.green(), c.blue())); }
double Largest(const DblRGBColour& c) { return max(c.red(), max(c.green(), c.blue())); }

/// Slope at a sample: that of the parabola through it and its neighbours, in units of `length`.
double Slope(double before, double at, double after, double lengthBefore, double lengthAfter, double length)
{
	return length * ((at - before) / lengthBefore * lengthAfter + (after - at) / lengthAfter * lengthBefore) / (lengthBefore + lengthAfter);
}

/// The cubic with these ends and slopes at quarters of the way.
void Quarters(double a, double b, double slopeA, double slopeB, double out[5])
{
	out[0] = a;
	out[1] = (54.0 * a + 10.0 * b + 9.0 * slopeA - 3.0 * slopeB) / 64.0;
	out[2] = 0.5 * (a + b) + 0.125 * (slopeA - slopeB);
	out[3] = (10.0 * a + 54.0 * b + 3.0 * slopeA - 9.0 * slopeB) / 64.0;
	out[4] = b;
}

/// Share of the change between two samples that may be a jump anywhere between them: what is more than twice the changes on both sides,
/// or four times the one that is known.
double Jump(double before, double a, double b, double after, bool bothSides)
{
	const double around = (fabs(a - before) + fabs(after - b)) * (bothSides ? 2.0 : 4.0);
	return (fabs(b - a) > around) ? 1.0 - around / fabs(b - a) : 0.0;
}

}

ShadowMedia::ShadowMedia(TraceThreadData *td) : evaluations(0), thread(td), grey(true), grows(false), ray(NULL), visibleAtFront(1.0), allowed(0.0), allowedSmooth(0.0), allowedInRun(0.0), firstStep(0.0), shortest(0.0)
{
}

void ShadowMedia::Clear()
{
	media.clear();
	mapped.clear();
	others.clear();
	grey = true;
}

void ShadowMedia::Add(const ShadowMedium& medium)
{
	media.push_back(&medium);
	if((medium.Mapped() != NULL) && (mapped.size() < kMostMapped))
		mapped.push_back(&medium);
	else
		others.push_back(&medium);
	grey = grey && others.empty() && medium.Mapped()->Transfer().Grey() && (Least(medium.Scale()) == Largest(medium.Scale()));
}

double ShadowMedia::Integrate(const dsm_ray& r, double front, double back, double visible, double wanted, double slackness, Sink& sink)
{
	const double tolerance = max(wanted, kLeastTolerance), dark = kDarkShare * tolerance;
	Stretch stretch;

	if(media.empty() || !(back > front) || (visible <= dark))
		return visible;

	ray = &r;
	grows = false;
	visibleAtFront = visible;
	allowed = kStepShare * tolerance;
	allowedSmooth = slackness * allowed;
	Begin(front, back);

	for(double depth = front; (depth < back) && (points.back().visible > dark); depth = stretch.end)
	{
		Look(depth, back, stretch);
		if(stretch.even)
		{
			if(!planned.empty())
			{
				Plan(depth, firstStep, true);
				Run(dark);
			}
			grows = grows || (Least(stretch.extinction) < 0.0);
			Advance(stretch.end, stretch.extinction * (stretch.end - depth));
			continue;
		}

		const bool full = (planned.size() >= kMostPlanned) || (stretch.end >= back);
		if(planned.empty())
			Plan(depth, stretch.step, true);
		Plan(stretch.end, stretch.step, full);
		if(stretch.grid)
			allowedInRun = kGridShare * allowed;
		if(full)
			Run(dark);
	}

	if(grows)
		sink.Mark();
	if(grey)
		Emit<1>(tolerance, sink);
	else
		Emit<3>(tolerance, sink);
	return points.back().visible;
}

void ShadowMedia::Begin(double front, double back)
{
	const Point start = { front, DblRGBColour(0.0), visibleAtFront };
	const double length = back - front;

	points.clear();
	points.push_back(start);
	planned.clear();
	parts.clear();

	firstStep = length / kLeastSteps;
	for(vector<const ShadowMedium *>::const_iterator m(media.begin()); m != media.end(); m++)
	{
		const vector<ShadowDensity>& densities = (*m)->Densities();

		firstStep = min(firstStep, (*m)->Step());
		for(vector<ShadowDensity>::const_iterator density(densities.begin()); density != densities.end(); density++)
		{
			parts.push_back(Part());
			parts.back().medium = *m;
			parts.back().density = &*density;
			parts.back().piece.end = -kHuge;
			density->Place(*ray, parts.back().line);
		}
	}
	firstStep = max(firstStep, length / kMostSteps);
	allowedInRun = allowedSmooth;
	shortest = kHuge;
}

bool ShadowMedia::IsEven(const DblRGBColour& least, const DblRGBColour& most) const
{
	return 0.5 * Largest(most - least) * firstStep * points.back().visible <= kEvenShare * allowed;
}

/// What is known of the way from `depth` on.
void ShadowMedia::Look(double depth, double back, Stretch& stretch)
{
	vector<Part>::iterator part(parts.begin());

	stretch.end = back;
	stretch.even = true;
	stretch.step = kHuge;
	stretch.grid = false;
	stretch.extinction = DblRGBColour(0.0);

	for(vector<const ShadowMedium *>::const_iterator m(media.begin()); m != media.end(); m++)
	{
		DblRGBColour least((*m)->Scale()), most(least);
		double step = kHuge;
		bool bounded = true, grid = false;

		for(; (part != parts.end()) && (part->medium == *m); part++)
		{
			ShadowDensity::Piece& piece = part->piece;
			if(!(piece.end > depth))
			{
				part->density->Next(part->line, depth, false, piece);
				part->even = piece.bounded && IsEven(piece.least * (*m)->Scale(), piece.most * (*m)->Scale());
				if(!part->even)
					part->density->Next(part->line, depth, true, piece);
			}

			stretch.end = min(stretch.end, piece.end);
			if(!part->even)
			{
				step = min(step, min(piece.step, firstStep));
				grid = grid || piece.grid;
			}
			// what may be below 0 has no bounds when it is multiplied
			bounded = bounded && piece.bounded && ((Least(piece.least) >= 0.0) || ((*m)->Densities().size() == 1));
			least *= piece.least;
			most *= piece.most;
		}

		if(bounded && IsEven(least, most))
			stretch.extinction += (least + most) * 0.5;
		else
		{
			stretch.even = false;
			stretch.step = min(stretch.step, (step < kHuge) ? step : firstStep);
			stretch.grid = stretch.grid || grid;
		}
	}
}

/// Plans samples up to `depth`. One that is not `forced` is left to the next call if it comes too soon.
void ShadowMedia::Plan(double depth, double step, bool forced)
{
	Sample sample;

	sample.known = false;
	sample.depth = depth;
	shortest = min(shortest, kShortest * step);
	if(planned.empty())
	{
		planned.push_back(sample);
		return;
	}

	const double from = planned.back().depth;
	if(depth - from < 0.5 * step)
	{
		if(forced && (planned.size() > 1))
			planned.back().depth = depth;
		else if(forced && (depth > from))
			planned.push_back(sample);
		return;
	}

	const int count = max(1, (int)ceil((depth - from) / step - 1.0e-6));
	for(int i = 1; i <= count; i++)
	{
		sample.depth = (i < count) ? from + (depth - from) * i / count : depth;
		planned.push_back(sample);
	}
}

void ShadowMedia::Know(Sample& sample) const
{
	if(sample.known)
		return;

	evaluations++;
	const Vector3d point(ray->origin[X] + sample.depth * ray->direction[X], ray->origin[Y] + sample.depth * ray->direction[Y],
	                     ray->origin[Z] + sample.depth * ray->direction[Z]);
	for(size_t i = 0; i < mapped.size(); i++)
	{
		sample.value[i] = mapped[i]->Mapped()->Value(*point, thread);
		grows = grows || (mapped[i]->MayGrow() && (Least(mapped[i]->Mapped()->Transfer().At(sample.value[i]) * mapped[i]->Scale()) < 0.0));
	}

	sample.other = DblRGBColour(0.0);
	for(vector<const ShadowMedium *>::const_iterator i(others.begin()); i != others.end(); i++)
	{
		const DblRGBColour extinction((*i)->Extinction(point, thread));
		grows = grows || (Least(extinction) < 0.0);
		sample.other += extinction;
	}
	sample.known = true;
}

/// Passes the planned samples, and halves the steps that bend too much. A new sample also tells more of the step before
/// it, which is therefore looked at again.
void ShadowMedia::Run(double dark)
{
	const double clear = kClear * (1.0 + fabs(planned.front().depth));

	planned.front().depth += clear;
	planned.back().depth -= clear;
	if(planned.size() == 2)
	{
		// a straight line through two samples would agree with anything
		planned.insert(planned.begin() + 1, planned.front());
		planned[1].depth = 0.5 * (planned[0].depth + planned[2].depth);
	}

	passed.clear();
	passed.push_back(planned.front());
	ahead.assign(planned.rbegin(), planned.rend() - 1);
	planned.clear();
	Know(passed.back());

	while(!ahead.empty() && (points.back().visible > dark))
	{
		const size_t next = ahead.size() - 1, last = passed.size() - 1;
		DblRGBColour halves[2];

		Know(ahead[next]);
		if(next > 0)
			Know(ahead[next - 1]);

		const double from = passed[last].depth, to = ahead[next].depth, middle = 0.5 * (from + to);
		const Sample *before = (last > 0) ? &passed[last - 1] : NULL, *after = (next > 0) ? &ahead[next - 1] : NULL;
		const double bend = grey ? Bend<1>(before, passed[last], ahead[next], after, halves) : Bend<3>(before, passed[last], ahead[next], after, halves);
		if((bend * points.back().visible <= allowedInRun) || (to - from <= shortest))
		{
			Advance(middle, halves[0]);
			Advance(to, halves[1]);
			passed.push_back(ahead.back());
			ahead.pop_back();
			continue;
		}

		Sample sample;
		sample.known = false;
		sample.depth = middle;
		ahead.push_back(sample);
		if(last > 0)
		{
			Know(ahead.back());
			ahead.push_back(passed.back());
			passed.pop_back();
			points.resize(points.size() - 2, points.front());
		}
	}
	allowedInRun = allowedSmooth;
	shortest = kHuge;
}

/// How much a cubic through four samples differs from a straight line between the inner two, in optical depth, or how far off a
/// jump between them may be. Quarters of the way count one by one: where the map of a density jumps, only they tell.
/// @param[in]      before,after    the outer samples, or NULL
/// @param[out]     halves          optical depth of both halves of the way, along the cubic
template<int kChannels>
double ShadowMedia::Bend(const Sample *before, const Sample& from, const Sample& to, const Sample *after, DblRGBColour halves[2]) const
{
	const double length = to.depth - from.depth;
	const double lengthBefore = (before != NULL) ? from.depth - before->depth : 0.0;
	const double lengthAfter = (after != NULL) ? after->depth - to.depth : 0.0;
	const bool bothSides = (before != NULL) && (after != NULL);
	double curved[4][3] = { { 0.0 } }, straight[4][3] = { { 0.0 } }, jumps[3] = { 0.0 };
	for(size_t i = 0; i < mapped.size(); i++)
	{
		const double a = from.value[i], b = to.value[i];
		const double slopeA = (before != NULL) ? Slope(before->value[i], a, b, lengthBefore, length, length) : b - a;
		const double slopeB = (after != NULL) ? Slope(a, b, after->value[i], length, lengthAfter, length) : b - a;
		const double line[5] = { a, 0.75 * a + 0.25 * b, 0.5 * (a + b), 0.25 * a + 0.75 * b, b };
		const DblRGBColour& scale = mapped[i]->Scale();
		double cubic[5], means[4][3];

		Quarters(a, b, slopeA, slopeB, cubic);
		const ShadowTransfer& transfer = mapped[i]->Mapped()->Transfer();
		const double jump = Jump((before != NULL) ? before->value[i] : a, a, b, (after != NULL) ? after->value[i] : b, bothSides);
		const DblRGBColour change((jump > 0.0) ? (transfer.At(b) - transfer.At(a)) * scale * jump : DblRGBColour(0.0));
		for(int k = 0; k < kChannels; k++)
			jumps[k] += fabs(change[k]);
		const int entry = transfer.Straight(*std::min_element(cubic, cubic + 5), *std::max_element(cubic, cubic + 5), 0);
		if(entry != ShadowTransfer::kBent) // the means are in the middle
		{
			for(int q = 0; q < 4; q++)
				for(int k = 0; k < kChannels; k++)
				{
					curved[q][k] += transfer.On(entry, 0.5 * (cubic[q] + cubic[q + 1]), k) * scale[k];
					straight[q][k] += transfer.On(entry, a + (b - a) * (q + 0.5) / 4.0, k) * scale[k];
				}
			continue;
		}
		transfer.Means<kChannels>(cubic, 4, means);
		for(int q = 0; q < 4; q++)
			for(int k = 0; k < kChannels; k++)
				curved[q][k] += means[q][k] * scale[k];
		transfer.Means<kChannels>(line, 4, means);
		for(int q = 0; q < 4; q++)
			for(int k = 0; k < kChannels; k++)
				straight[q][k] += means[q][k] * scale[k];
	}

	for(int k = 0; (k < kChannels) && !others.empty(); k++)
	{
		const double a = from.other[k], b = to.other[k];
		const double slopeA = (before != NULL) ? Slope(before->other[k], a, b, lengthBefore, length, length) : b - a;
		const double slopeB = (after != NULL) ? Slope(a, b, after->other[k], length, lengthAfter, length) : b - a;
		double cubic[5];

		jumps[k] += fabs(b - a) * Jump((before != NULL) ? before->other[k] : a, a, b, (after != NULL) ? after->other[k] : b, bothSides);
		Quarters(a, b, slopeA, slopeB, cubic);
		for(int q = 0; q < 4; q++)
		{
			curved[q][k] += 0.5 * (cubic[q] + cubic[q + 1]);
			straight[q][k] += a + (b - a) * (q + 0.5) / 4.0;
		}
	}

	double bend = 0.0;
	for(int k = 0; k < kChannels; k++)
	{
		double sum = 0.0;
		for(int q = 0; q < 4; q++)
			sum += fabs(curved[q][k] - straight[q][k]);
		bend = max(bend, max(sum, kJump * jumps[k] * allowedInRun / allowed));
	}
	for(int k = 0; k < 3; k++)
	{
		const int channel = (kChannels == 1) ? 0 : k;
		halves[0][k] = (curved[0][channel] + curved[1][channel]) * (0.25 * length);
		halves[1][k] = (curved[2][channel] + curved[3][channel]) * (0.25 * length);
	}
	return bend * 0.25 * length;
}

void ShadowMedia::Advance(double depth, const DblRGBColour& thickness)
{
	Point point = points.back();

	// densities below 0, whose rays are marked, and a cubic that overshoots must not make light
	for(int k = 0; k < 3; k++)
		point.thickness[k] += (thickness[k] > 0.0) ? thickness[k] : 0.0;
	point.depth = depth;
	point.visible = visibleAtFront * exp(-Least(point.thickness));
	points.push_back(point);
}

/// Hands on the fewest spans, each as long as light within it keeps to the exponential. Spans end on points, where light
/// is known, so that their errors do not add up.
template<int kChannels>
void ShadowMedia::Emit(double tolerance, Sink& sink) const
{
	size_t first = 0;

	while(first + 1 < points.size())
	{
		const Point& from = points[first];
		double low[3] = { -kHuge, -kHuge, -kHuge }, high[3] = { kHuge, kHuge, kHuge };
		bool open = true;
		size_t last = first + 1;

		for(size_t i = first + 1; open && (i < points.size()); i++)
		{
			const double length = points[i].depth - from.depth;
			const double slack = kSpanShare * tolerance / points[i].visible;
			bool fits = true;

			if(!(length > 0.0))
			{
				last = i;
				continue;
			}
			const double perLength = 1.0 / length;
			for(int k = 0; k < kChannels; k++)
			{
				const double thickness = points[i].thickness[k] - from.thickness[k];
				fits = fits && (thickness >= low[k] * length) && (thickness <= high[k] * length);
				low[k] = max(low[k], (thickness - slack) * perLength);
				high[k] = min(high[k], (thickness + slack) * perLength);
				open = open && (low[k] <= high[k]);
			}
			if(fits)
				last = i;
		}

		const DblRGBColour thickness(points[last].thickness - from.thickness);
		if(Largest(thickness) * from.visible > kNothing)
		{
			DblRGBColour transmittance(exp(-thickness.red()));
			for(int k = 1; k < kChannels; k++)
				transmittance[k] = exp(-thickness[k]);
			sink.Span(from.depth, points[last].depth, transmittance);
		}
		first = last;
	}
}

}
