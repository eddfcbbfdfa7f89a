// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/interior/interior.h"
#include "backend/interior/media.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/scene/threaddata.h"
#include "backend/support/task.h"
#include "backend/shadow/shadowevents.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// A fading span is halved at most this often.
const int kMostHalvings = 16;

/// The mean of a few of a pixel's rays is certain if its standard error is not above this many times the tolerance, which is
/// never taken to be finer than this.
const double kCertain = 2.0, kLeastTolerance = 1.0e-4;

/// Rays of one pixel integrate with errors to both sides, and each is far nearer than its bound (measured on clouds). So the
/// bound of one step may be this many times as wide, for so many rays.
double Slackness(unsigned int rays)
{
	const double kMost = 8.0;

	return min(max(0.5 * rays, 1.0), kMost);
}

/// Whether a few rays can stand for so many, and it pays.
bool CanSpare(unsigned int rays)
{
	return (rays >= 16) && (rays % 16 == 0);
}

double FadeFactor(double colour, double distance, double power, double length)
{
	return colour + (1.0 - colour) / (1.0 + pow(length / distance, power));
}

}

ShadowEvents::ShadowEvents(shared_ptr<SceneData> scene, TraceThreadData *thread, unsigned int quality, const ShadowCasters& c) :
	// no volumes in the base class: media and atmosphere are not the texture's business here
	Trace(scene, thread, quality & ~Q_VOLUME, noCooperate, noMedia, noRadiosity),
	casters(c),
	volumes((quality & Q_VOLUME) != 0),
	slackness(1.0),
	shaded(0),
	containersOf(NULL),
	hits(c, thread),
	shade(Ray::OtherRay, true),
	media(thread)
{
	// maps hold plain filtered shadows; receivers of photons are ray-traced
	thread->litObjectIgnoresPhotons = true;
}

dsm_result ShadowEvents::TraceRays(const LightSource& light, const dsm_ray *rays, unsigned int count, double tolerance, dsm_sink *sink)
{
	if(casters.HasVolumes())
		FindContainers(light);

	const unsigned int ofPixel = ShadowPlugin::Api().sink_pixel_rays(sink);

	slackness = Slackness(ofPixel);

	for(unsigned int done = 0, ready; done < count; done += ready)
	{
		ready = hits.Find(rays + done, count - done);
		for(unsigned int i = 0, next; i < ready; i = next)
		{
			const bool whole = volumes && casters.HasVolumes() && CanSpare(ofPixel) && ((done + i) % ofPixel == 0) && (i + ofPixel <= ready);

			next = i + (whole ? ofPixel : 1);
			const dsm_result result = whole ? ReportPixel(light, rays + done, i, ofPixel, tolerance, sink, done)
			                                : ReportRay(light, rays + done, i, tolerance, sink, done);
			if(result != DSM_OK)
				return result;
		}
	}
	return DSM_OK;
}

dsm_result ShadowEvents::ReportRay(const LightSource& light, const dsm_ray *rays, unsigned int ray, double tolerance, dsm_sink *sink, unsigned int offset)
{
	if((ray & 0x0f) == 0)
		Task::CurrentTaskCooperate();
	Follow(light, rays[ray], hits.Of(ray), tolerance, story);
	return story.Tell(offset + ray, sink);
}

/// Whether rays of one pixel meet the same surfaces, of which the first lets light through.
bool ShadowEvents::AllMeetTheSame(unsigned int begin, unsigned int count)
{
	first = hits.Of(begin);
	if(first.empty() || (first[0].surface == ShadowHits::kOpaque))
		return false;
	for(unsigned int i = 1; i < count; i++)
	{
		const vector<ShadowHits::Hit>& found = hits.Of(begin + i);

		if(found.size() != first.size())
			return false;
		for(size_t k = 0; k < found.size(); k++)
			if((found[k].caster != first[k].caster) || (found[k].number != first[k].number) || ((found[k].surface == ShadowHits::kOpaque) != (first[k].surface == ShadowHits::kOpaque)))
				return false;
	}
	return true;
}

/// Reports the rays of one map pixel. What they pass through changes little from one to the next, unless they meet different surfaces;
/// and each integral of a density is dear. So where a few of them agree, the others are spared.
dsm_result ShadowEvents::ReportPixel(const LightSource& light, const dsm_ray *rays, unsigned int begin, unsigned int count, double tolerance, dsm_sink *sink, unsigned int offset)
{
	// of each quarter another quarter: of the pixel's rows and columns, each has one (see sink_pixel_rays)
	static const unsigned int kQuarter[ShadowStory::kFew] = { 0, 2, 1, 3 };
	const unsigned int step = count / ShadowStory::kFew;
	const dsm_ray *few[ShadowStory::kFew];
	unsigned int chosen[ShadowStory::kFew], followed = 0;
	dsm_result result = DSM_OK;

	Task::CurrentTaskCooperate();
	const bool same = AllMeetTheSame(begin, count);
	bool hasMedia = false;
	for(; (followed < ShadowStory::kFew) && same; followed++)
	{
		chosen[followed] = begin + followed * step + kQuarter[followed] * step / ShadowStory::kFew;
		few[followed] = rays + chosen[followed];
		Follow(light, *few[followed], hits.Of(chosen[followed]), tolerance, stories[followed]);
		hasMedia = hasMedia || stories[followed].HasMedia();
	}
	const bool enough = hasMedia && ShadowStory::Agree(stories, ShadowStory::Contrast(few), kCertain * max(tolerance, kLeastTolerance));

	for(unsigned int i = 0; (i < count) && (result == DSM_OK); i++)
	{
		const unsigned int quarter = i / step;

		if((quarter < followed) && (begin + i == chosen[quarter]))
			result = stories[quarter].Tell(offset + begin + i, sink);
		else if(enough)
			result = ShadowPlugin::Api().sink_spare(sink, offset + begin + i);
		else
			result = ReportRay(light, rays, begin + i, tolerance, sink, offset);
	}
	return result;
}

/// Stock puts no media on the way from the light to the first surface, even if the light stands in them. The containers
/// are needed all the same, so that leaving one is not taken for entering it.
void ShadowEvents::FindContainers(const LightSource& light)
{
	if(containersOf == &light)
		return;
	containersOf = &light;
	containers.clear();
	if(!light.Parallel)
		casters.Containing(Vector3d(light.Center), threadData, containers);
}

void ShadowEvents::EnterContainers(const LightSource& light, const dsm_ray& ray)
{
	inside.clear();
	if(light.Parallel)
	{
		containers.clear();
		casters.Containing(Vector3d(ray.origin[X], ray.origin[Y], ray.origin[Z]), threadData, containers);
	}
	for(vector<ObjectPtr>::const_iterator i(containers.begin()); i != containers.end(); i++)
		inside.push_back((*i)->interior);
}

void ShadowEvents::Toggle(Interior *interior)
{
	vector<Interior *>::iterator i = std::find(inside.begin(), inside.end(), interior);
	if(i == inside.end())
		inside.push_back(interior);
	else
		inside.erase(i);
}

/// What the surface's textures let through, seen from the receiver: stock shades a caster along the ray that comes from
/// the receiver, and normals, interior textures and several patterns depend on that.
RGBColour ShadowEvents::ShadeSurface(const LightSource& light, const dsm_ray& ray, Intersection& isect)
{
	TraceTicket ticket(sceneData->parsedMaxTraceLevel, sceneData->parsedAdcBailout);
	RGBColour colour(1.0);

	for(int i = 0; i < 3; i++)
	{
		shade.Origin[i] = isect.IPoint[i] + ray.direction[i];
		shade.Direction[i] = -ray.direction[i];
	}
	shaded++;
	shade.ClearInteriors(); // so neither fading nor media come in
	isect.Depth = 1.0;
	ComputeShadowColour(light, isect, shade, colour, ticket);
	return colour;
}

/// Finds what dims a ray: hits, and what lies between them. Light that is gone stays gone: nothing behind matters.
void ShadowEvents::Follow(const LightSource& light, const dsm_ray& ray, const vector<ShadowHits::Hit>& found, double tolerance, ShadowStory& story)
{
	double visible = 1.0;
	size_t i = 0;

	story.Clear();
	if(found.empty())
		return;
	if(casters.HasVolumes())
		EnterContainers(light, ray);

	for(; i < found.size(); i++)
	{
		const ShadowHits::Hit& hit = found[i];
		double colour[3] = { 0.0, 0.0, 0.0 };

		if(hit.surface != ShadowHits::kOpaque)
		{
			const RGBColour c(ShadeSurface(light, ray, hits.Surface(hit)));
			for(int k = 0; k < 3; k++)
				colour[k] = c[k];
		}
		story.Surface(hit.depth, colour);

		// light that grows is traced, and the library drops colours that are no numbers
		const double most = max(colour[0], max(colour[1], colour[2]));
		visible *= (most < 1.0) ? most : 1.0;
		if(visible <= 0.0)
			break;
		if(!casters.HasVolumes())
			continue;

		const double next = (i + 1 < found.size()) ? found[i + 1].depth : ray.far_depth;
		Interior *interior = hits.Surface(hit).Object->interior;

		Toggle(interior);
		if((interior->Fade_Power > 0.0) && (fabs(interior->Fade_Distance) > EPSILON) && (std::find(inside.begin(), inside.end(), interior) != inside.end()))
			Fade(*interior, hit.depth, next, tolerance, story);
		if(volumes)
			visible = PassMedia(ray, hit.depth, next, visible, tolerance, story);
	}
	if(IsOpen(ray, (i < found.size()) ? &found[i] : NULL))
		story.Mark();
}

/// Sheets, height fields and other open things begin what they do not end. Stock then goes by what the ray of the camera has
/// passed on its way to the receiver, and that no map knows.
/// @param      last    where light was gone; NULL: nowhere
bool ShadowEvents::IsOpen(const dsm_ray& ray, const ShadowHits::Hit *last)
{
	vector<ObjectPtr> around;

	if(!casters.HasVolumes())
		return false;
	if((last != NULL) && (last->surface != ShadowHits::kOpaque))
	{
		const Interior *own = hits.Surface(*last).Object->interior;
		inside.erase(std::remove(inside.begin(), inside.end(), own), inside.end());
	}
	for(vector<Interior *>::const_iterator i(inside.begin()); i != inside.end(); i++)
	{
		if(!ShadowCasters::Dims(*i))
			continue;
		if(last == NULL)
			return true;
		if(around.empty())
			casters.Containing(Vector3d(ray.origin[X], ray.origin[Y], ray.origin[Z]) + last->depth * Vector3d(ray.direction[X], ray.direction[Y], ray.direction[Z]), threadData, around);

		bool holds = false;
		for(vector<ObjectPtr>::const_iterator object(around.begin()); object != around.end(); object++)
			holds = holds || ((*object)->interior == *i);
		if(!holds)
			return true;
	}
	return false;
}

/// Fading takes one factor, 1 / (1 + (d/D)^p), from an object's surface on the light's side to the next surface only.
/// It is no exponential, so the span is halved until a chord in the logarithm follows it.
void ShadowEvents::Fade(const Interior& interior, double front, double back, double tolerance, ShadowStory& story)
{
	const double distance = interior.Fade_Distance, power = interior.Fade_Power;
	const bool exponential = (power >= 1000);
	double begin = front;

	while(begin < back)
	{
		double end = back, t[3];

		for(int halvings = 0; ; halvings++)
		{
			double error = 0.0;
			for(int k = 0; k < 3; k++)
			{
				const double colour = interior.Fade_Colour[k];
				if(exponential)
				{
					t[k] = exp(-(1.0 - colour) * (end - begin) / distance);
					continue;
				}
				const double atBegin = FadeFactor(colour, distance, power, begin - front);
				const double atMiddle = FadeFactor(colour, distance, power, 0.5 * (begin + end) - front);
				const double atEnd = FadeFactor(colour, distance, power, end - front);
				t[k] = (atBegin > 0.0) ? atEnd / atBegin : 0.0;
				error = max(error, fabs(atMiddle - sqrt(max(atBegin * atEnd, 0.0))));
			}
			if((error <= 0.25 * tolerance) || (halvings == kMostHalvings))
				break;
			end = 0.5 * (begin + end);
		}

		story.Span(begin, end, t);
		begin = end;
	}
}

/// Media count only while every container around is hollow.
double ShadowEvents::PassMedia(const dsm_ray& ray, double front, double back, double visible, double tolerance, ShadowStory& story)
{
	media.Clear();
	for(vector<Interior *>::const_iterator i(inside.begin()); i != inside.end(); i++)
	{
		if(!(*i)->hollow)
			return visible;
		for(vector<Media>::const_iterator m((*i)->media.begin()); m != (*i)->media.end(); m++)
		{
			const ShadowMedium *medium = casters.Volumes().Find(&*m);
			if(medium != NULL)
				media.Add(*medium);
		}
	}
	if(media.Empty())
		return visible;
	story.Media();
	return media.Integrate(ray, front, back, visible, tolerance, slackness, story);
}

}
