// SPDX-License-Identifier: AGPL-3.0-or-later

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/interior/interior.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/scene/threaddata.h"
#include "backend/scene/view.h"
#include "backend/shadow/shadowcontext.h"
#include "backend/shadow/shadowmaps.h"
#include "backend/shadow/shadowsurvey.h"
#include "backend/shadow/shadowwork.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// Image pixels for each sample, and how many samples are enough for any image.
const double kPixelsPerSample = 512.0;
const unsigned int kFewestSamples = 100, kMostSamples = 1000;

/// Where maps want to see the picture: edges take little of it, and too few samples would miss them.
const double kPixelsPerPlace = 16.0;

/// The first judgement comes after so many samples, and the next ones after twice as many as the last.
const unsigned int kFirstJudgement = 16;

/// So much more must one side cost to be given up at the first judgement. It takes four times as many samples to be twice as sure.
const double kFirstConfidence = 4.0;

/// Tiles that are baked to learn what they cost.
const unsigned int kMostBaked = 8;

/// Fewer requests tell too little of a light to bake anything.
const unsigned int kFewestRequests = 16;

/// Of the rays' work, what baking tiles may cost: it is lost where rays are chosen.
const double kBakeShare = 0.02;

/// Pixels at edges, of those that antialiasing looks at.
const double kEdges = 0.15;

double Fraction(double x)
{
	return x - floor(x);
}

}

double ShadowSampling::RaysPerPixel() const
{
	const double side = (method == 2) ? double(1u << depth) : double(depth);

	return (method == 0) ? 1.0 : 1.0 + Sqr(side) * ((threshold > 0.0) ? kEdges : 1.0);
}

double ShadowSampling::Spacing() const
{
	return ((method == 0) || (threshold > 0.0)) ? 1.0 : 1.0 / ((method == 2) ? double(1u << depth) : double(depth));
}

ShadowSurvey::ShadowSurvey(ViewData *vd, TraceThreadData *td, CooperateFunctor& cf, MediaFunctor& mf, RadiosityFunctor& rf, double spacing) :
	TracePixel(vd, td, vd->GetSceneData()->parsedMaxTraceLevel, vd->GetSceneData()->parsedAdcBailout, vd->GetQualityFeatureFlags(), cf, mf, rf),
	viewData(vd),
	thread(td),
	tallies(vd->GetSceneData()->shadowMaps->Count()),
	tracing(false),
	counting(false)
{
	shadowReceiver.survey = this;
	SetSampleSpacing(spacing);
}

void ShadowSurvey::TracePixelAt(int x, int y, bool counted)
{
	Colour colour;

	counting = counted;
	(*this)(x, y, viewData->GetWidth(), viewData->GetHeight(), colour);
}

void ShadowSurvey::BeginSample()
{
	for(vector<ShadowTally>::iterator i(tallies.begin()); i != tallies.end(); i++)
		i->BeginSample();
}

void ShadowSurvey::Want(void *tally, const dsm_tiles *tiles)
{
	static_cast<ShadowTally *>(tally)->Want(*tiles);
}

void ShadowSurvey::Request(size_t map, const dsm_receiver& receiver, const LightSource& light, double depth, const Ray& ray, const Vector3d& point, RGBColour& colour, TraceTicket& ticket)
{
	const ShadowMaps& maps = *viewData->GetSceneData()->shadowMaps;
	const ShadowCasters& casters = maps.Casters();
	const RenderStatistics& stats = thread->Stats();
	RGBColour left(1.0);

	shadowReceiver.context->TilesWanted(map, receiver, &ShadowSurvey::Want, &tallies[map]);

	const double before = ShadowWorkOf(stats);
	if(counting && casters.MayMeetUnmapped(ray, depth))
		TraceUnmappedCasters(casters.Unmapped(), light, depth, ray, left, ticket);
	if(counting && maps[map].atmosphere)
	{
		ShadowAir air(ray, depth);
		ComputeShadowMedia(air.ray, air.end, left, true, ticket);
	}

	const double middle = ShadowWorkOf(stats);
	tracing = true;
	ticket.traceLevel--; // it is the same ray still
	TraceShadowRay(light, depth, ray, point, colour, ticket);
	ticket.traceLevel++;
	tracing = false;
	if(counting)
		tallies[map].AddRequest(ShadowWorkOf(stats) - middle, middle - before);
}

void ShadowSurvey::Explore(size_t map, const dsm_receiver& receiver)
{
	if(counting)
		shadowReceiver.context->Explore(map, receiver);
}

void ShadowSurveyMedia::ComputeMedia(vector<Media>& source, const Ray& ray, Intersection& isect, Colour& colour, Trace::TraceTicket& ticket)
{
	if(!source.empty())
		Made().ComputeMedia(source, ray, isect, colour, ticket);
}

void ShadowSurveyMedia::ComputeMedia(const RayInteriorVector& source, const Ray& ray, Intersection& isect, Colour& colour, Trace::TraceTicket& ticket)
{
	for(RayInteriorVector::const_iterator i(source.begin()); i != source.end(); i++)
		if(!(*i)->media.empty())
		{
			Made().ComputeMedia(source, ray, isect, colour, ticket);
			return;
		}
}

void ShadowSurveyMedia::ComputeMedia(MediaVector& source, const Ray& ray, Intersection& isect, Colour& colour, Trace::TraceTicket& ticket)
{
	if(!source.empty())
		Made().ComputeMedia(source, ray, isect, colour, ticket);
}

MediaFunction& ShadowSurveyMedia::Made()
{
	if(!made)
		made.reset(new MediaFunction(thread, survey, gatherer));
	return *made;
}

ShadowSurveyTask::ShadowSurveyTask(ViewData *vd, const ShadowSampling& s) :
	RenderTask(vd),
	sampling(s),
	survey(vd, GetViewDataPtr(), cooperate, media, radiosity, s.Spacing()),
	cooperate(*this),
	media(GetViewDataPtr(), &survey, &photonGatherer),
	photonGatherer(&vd->GetSceneData()->mediaPhotonMap, vd->GetSceneData()->photonSettings)
{
	GetViewDataPtr()->qualityFlags = vd->GetQualityFeatureFlags();
}

/// Places follow each other so that those of any length of time are spread evenly (Roberts' R2 sequence). At each place,
/// one pixel fills the caches, and its neighbour is counted.
void ShadowSurveyTask::Run()
{
	ShadowMaps& maps = *GetSceneData()->shadowMaps;
	const POVRect area(GetViewData()->GetRenderArea());
	const double pixels = double(area.GetWidth()) * area.GetHeight();
	const bool explores = maps.Explores();
	const unsigned int samples = max(1.0, min(pixels / 8.0, max(double(kFewestSamples), min(double(kMostSamples), pixels / (explores ? kPixelsPerPlace : kPixelsPerSample)))));
	unsigned int judgement = kFirstJudgement;

	for(unsigned int i = 0; (i < samples) && (explores || maps.HasUndecided()); i++)
	{
		const int x = area.left + int(Fraction(0.5 + i * 0.7548776662466927) * area.GetWidth());
		const int y = area.top + int(Fraction(0.5 + i * 0.5698402909980532) * area.GetHeight());
		const int beside = (x < int(area.right)) ? x + 1 : max(x - 1, int(area.left));

		survey.BeginSample();
		if(maps.HasUndecided())
			survey.TracePixelAt(beside, y, false);
		survey.TracePixelAt(x, y, true);
		Cooperate();

		const bool last = (i + 1 == samples);
		if((i + 1 < judgement) && !last)
			continue;
		for(size_t map = 0; map < maps.Count(); map++)
			if(maps.IsUndecided(map))
				Judge(map, i + 1, last ? 1.0 : max(1.0, kFirstConfidence / sqrt(double(judgement) / kFirstJudgement)));
		judgement *= 2;
	}

	maps.Explored(samples, 1.0 / sampling.Spacing());

	// the statistics are of the image
	GetViewDataPtr()->Stats() = RenderStatistics();
}

/// Bakes wanted tiles, until so many have been.
void ShadowSurveyTask::Bake(size_t map, unsigned int most)
{
	ShadowContext& context = *GetSceneData()->shadowMaps->Current();
	ShadowTally& tally = survey.Tally(map);
	dsm_tiles tile;

	while((tally.Baked() < most) && tally.Pick(tile))
	{
		const double before = context.BakeWork(map);
		context.BakeTile(map, tile);
		tally.AddBaked(context.BakeWork(map) - before);
		Cooperate();
	}
}

/// Decides if one side costs more than the other by a factor.
/// @param[in]      confidence  that factor; 1: now or never
void ShadowSurveyTask::Judge(size_t map, unsigned int taken, double confidence)
{
	ShadowMaps& maps = *GetSceneData()->shadowMaps;
	const POVRect area(GetViewData()->GetRenderArea());
	const double scale = sampling.RaysPerPixel() * area.GetWidth() * area.GetHeight() / taken;
	const double tiles = maps.FinestTiles(map);
	ShadowTally& tally = survey.Tally(map);
	const bool last = (confidence <= 1.0);

	if(tally.Requests() == 0)
	{
		if(last)
			maps.Decide(map, false, 0.0);
		return;
	}

	// a guess is low: first one tile has to be baked to believe that the map costs less, then a few, where that is cheap
	const double rays = tally.RaysWork(scale), affordable = kBakeShare * rays;
	if((tally.Baked() == 0) && (tally.Requests() >= kFewestRequests) && (tally.MapWork(scale, tiles) <= rays) && (tally.LikelyTileWork() <= affordable))
		Bake(map, 1);
	if((tally.Baked() > 0) && (tally.MapWork(scale, tiles) <= 2.0 * rays) && (tally.TileWork() * kMostBaked <= affordable))
		Bake(map, kMostBaked);

	const double cost = tally.MapWork(scale, tiles);
	const bool known = (tally.Baked() > 0);
	if((cost > confidence * rays) || (last && !(known && (cost <= rays))))
		maps.Decide(map, false, (cost > rays) ? cost / rays : 0.0);
	else if(known && (cost * confidence <= rays))
		maps.Decide(map, true, cost / rays);
}

}
