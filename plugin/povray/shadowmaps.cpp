// SPDX-License-Identifier: AGPL-3.0-or-later

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <iomanip>
#include <sstream>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "base/povmsgid.h"
#include "backend/control/renderbackend.h"
#include "backend/lighting/point.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/scene/threaddata.h"
#include "backend/scene/view.h"
#include "backend/shadow/shadowbaketask.h"
#include "backend/shadow/shadowcontext.h"
#include "backend/shadow/shadowmaps.h"
#include "backend/shadow/shadowsurvey.h"
#include "backend/support/taskqueue.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

namespace
{

bool IsRefractingTarget(const ObjectBase *object, const LightSource& light)
{
	if(Test_Flag(object, PH_TARGET_FLAG) && !Test_Flag(object, PH_RFR_OFF_FLAG) && !Test_Flag(&light, PH_RFR_OFF_FLAG) &&
	   (Test_Flag(object, PH_RFR_ON_FLAG) || Test_Flag(&light, PH_RFR_ON_FLAG)))
		return true;

	if(object->Type & IS_COMPOUND_OBJECT)
	{
		const CompoundObject *compound = static_cast<const CompoundObject *>(object);
		for(vector<ObjectPtr>::const_iterator child(compound->children.begin()); child != compound->children.end(); child++)
			if(IsRefractingTarget(*child, light))
				return true;
	}
	return false;
}

const POV_LONG kProgressInterval = 500; // ms
const int kProgressWidth = 48; // on the console, a line overwrites the last one

/// Without shadows nobody asks for casters, and the base line of every timing must not pay for them.
const vector<ObjectPtr> kNoObjects;

/// The block whose kind of map every light shall have; empty if each light says so itself.
string BlockForAll(int method)
{
	return (method == kPOVList_ShadowMethod_Deep) ? "deep_shadow" : (method == kPOVList_ShadowMethod_Map) ? "shadow_map" : "";
}

/// The environment's DEEP_SHADOW_CHOICE says "map": maps are not to be given up because they cost more than rays.
bool AlwaysMaps()
{
	const char *wish = getenv("DEEP_SHADOW_CHOICE");

	return (wish != NULL) && (strcmp(wish, "map") == 0);
}

/// Whether fog dims light by one factor a length, so that it can be multiplied in at the look-up.
bool FogMultiplies(const FOG *fog)
{
	for(; fog != NULL; fog = fog->Next)
		if((fog->Turb != NULL) || (fog->colour.transm() > 0.0))
			return false;
	return true;
}

/// The light as the library wants it.
void Describe(const LightSource& light, const vector<dsm_box>& casters, dsm_light& out)
{
	out.size = sizeof(out);
	out.kind = light.Parallel ? DSM_LIGHT_PARALLEL : (light.Light_Type == SPOT_SOURCE) ? DSM_LIGHT_SPOT : DSM_LIGHT_POINT;
	for(int i = 0; i < 3; i++)
	{
		out.origin[i] = light.Center[i];
		out.direction[i] = light.Direction[i];
	}
	out.cos_angle = (light.Light_Type == SPOT_SOURCE) ? max(light.Falloff, 0.0) : 0.0; // POV-Ray's spots end at 90 degrees
	out.radius = (light.Light_Type == CYLINDER_SOURCE) ? light.Falloff : 0.0;
	out.casters = casters.empty() ? NULL : &casters[0];
	out.caster_count = casters.size();
}

}

shared_ptr<ShadowMaps> ShadowMaps::New(ViewData *viewData, int method, int threadCount, vector<ViewThreadData *>& threads)
{
	const SceneData& scene = *viewData->GetSceneData();
	const bool wanted = (method == kPOVList_ShadowMethod_None) || !BlockForAll(method).empty() ||
	                    ((method == kPOVList_ShadowMethod_Scene) && !scene.shadowSettings.empty());

	return shared_ptr<ShadowMaps>(wanted ? new ShadowMaps(viewData, method, threadCount, threads) : NULL);
}

ShadowMaps::ShadowMaps(ViewData *vd, int method, int threadCount, vector<ViewThreadData *>& threads) :
	viewData(vd),
	casters((method == kPOVList_ShadowMethod_None) ? kNoObjects : vd->GetSceneData()->objects, threadCount),
	unshadowed(method == kPOVList_ShadowMethod_None),
	rayTracedLights(0),
	current(&ShadowMaps::Release),
	nextFile(0)
{
	const SceneData& scene = *viewData->GetSceneData();

	for(vector<LightSource *>::const_iterator i(scene.lightSources.begin()); i != scene.lightSources.end(); i++)
		globalLights.push_back(Add(**i, method));
	for(vector<LightSource *>::const_iterator i(scene.lightGroupLightSources.begin()); i != scene.lightGroupLightSources.end(); i++)
		groupLights.push_back(Add(**i, method));

	for(int i = 0; (i < threadCount) && !maps.empty(); i++)
	{
		threads.push_back(new ViewThreadData(viewData));
		contexts.push_back(shared_ptr<ShadowContext>(new ShadowContext(*this, viewData, threads.back())));
		idle.push_back(contexts.back().get());
	}
}

ShadowMaps::~ShadowMaps()
{
	current.release(); // the contexts go now, and must not be put back among the idle ones later
}

/// @return     the light's place in the list of maps, or kNone
size_t ShadowMaps::Add(const LightSource& light, int method)
{
	const SceneData& scene = *viewData->GetSceneData();
	const string all(BlockForAll(method));
	const bool wanted = !all.empty() || ((method == kPOVList_ShadowMethod_Scene) && (light.shadowSettings != 0));

	if(!wanted || (light.Light_Type == FILL_LIGHT_SOURCE))
		return kNone;
	if(!CanHaveMap(light))
	{
		rayTracedLights++;
		return kNone;
	}

	// a block of the other kind has nothing to say
	const ShadowSettings *own = (light.shadowSettings != 0) ? scene.shadowSettings[light.shadowSettings - 1].get() : NULL;
	const bool created = ((own != NULL) && (all.empty() || (all == own->Block().name))) ?
		Create(light, *own) : Create(light, ShadowSettings(all));
	if(!created)
		rayTracedLights++;
	return created ? maps.size() - 1 : kNone;
}

bool ShadowMaps::CanHaveMap(const LightSource& light) const
{
	const SceneData& scene = *viewData->GetSceneData();
	const bool attenuated = light.Media_Interaction && light.Media_Attenuation;

	// the parser has warned of these
	if(light.Area_Light || (light.Projected_Through_Object != NULL))
		return false;

	const char *why = NULL;
	if((light.Parallel || (light.Light_Type == SPOT_SOURCE)) && !(fabs(Vector3d(light.Direction).lengthSqr() - 1.0) < 1.0e-6))
		why = "points nowhere (point_at is its own location)";
	else if(casters.HasUnmappedVolumes())
		why = "shines on an object without end that has media or fading";
	else if(attenuated && !FogMultiplies(scene.fog))
		why = "shines through fog with turbulence or a minimum transmittance";
	if(why != NULL)
		Tell(1, string("A light_source ") + why + "; its shadows are ray-traced.");
	return why == NULL;
}

bool ShadowMaps::Create(const LightSource& light, const ShadowSettings& settings)
{
	const SceneData& scene = *viewData->GetSceneData();
	dsm_host host;
	dsm_light description;
	ShadowMap entry;
	dsm_map *map = NULL;

	host.size = sizeof(host);
	host.data = this;
	host.trace = &ShadowContext::Trace;
	host.pause = &ShadowContext::Pause;
	host.report = &ShadowMaps::Report;

	Describe(light, casters.Boxes(), description);
	const dsm_result result = ShadowPlugin::Api().map_create(&host, &description, settings.Get(), &map);
	if(result == DSM_NO_MEMORY)
		throw POV_EXCEPTION_CODE(kOutOfMemoryErr);
	if(result != DSM_OK)
		return false;

	entry.light = &light;
	entry.map.reset(map, ShadowPlugin::Api().map_destroy);
	entry.photons = false;
	for(vector<ObjectPtr>::const_iterator i(scene.objects.begin()); i != scene.objects.end() && scene.photonSettings.photonsEnabled && !entry.photons; i++)
		entry.photons = IsRefractingTarget(*i, light);
	entry.atmosphere = light.Media_Interaction && light.Media_Attenuation && ((scene.fog != NULL) || !scene.atmosphere.empty());
	entry.deep = (string(settings.Block().name) == "deep_shadow");
	entry.loadPath = settings.loadPath;
	entry.savePath = settings.savePath;
	entry.choice = (entry.deep && !settings.IsBlurred() && !settings.IsRefined() && entry.loadPath.empty() && entry.savePath.empty() && !AlwaysMaps()) ? ShadowMap::kOpen : ShadowMap::kNone;
	entry.cost = 0.0;
	entry.explores = entry.deep && settings.IsRefined();
	maps.push_back(entry);
	return true;
}

void ShadowMaps::AppendTasks(TaskQueue& queue, vector<ViewThreadData *>& threads, unsigned int method, double threshold, unsigned int depth)
{
	size_t files = 0;
	bool saves = false;

	for(vector<ShadowMap>::const_iterator i(maps.begin()); i != maps.end(); i++)
	{
		saves = saves || !i->savePath.empty();
		files += i->HasFile() ? 1 : 0;
	}
	for(size_t i = 0; i < min(files, contexts.size()); i++)
		threads.push_back(static_cast<ViewThreadData *>(queue.AppendTask(new ShadowFilesTask(viewData))));
	if(files > 0)
		queue.AppendSync();
	if(saves)
	{
		bakers.assign(maps.size(), contexts.size());
		for(size_t i = 0; i < contexts.size(); i++)
			threads.push_back(static_cast<ViewThreadData *>(queue.AppendTask(new ShadowBakeTask(viewData))));
		queue.AppendSync();
	}
	if(HasUndecided() || Explores())
	{
		const ShadowSampling sampling = { method, threshold, depth };
		threads.push_back(static_cast<ViewThreadData *>(queue.AppendTask(new ShadowSurveyTask(viewData, sampling))));
		queue.AppendSync();
	}
}

bool ShadowMaps::Answers(TraceThreadData& thread, const LightSource& light)
{
	const ShadowMaps *maps = thread.GetSceneData()->shadowMaps.get();
	const size_t index = (maps != NULL) ? maps->Find(light) : kNone;

	return (index != kNone) && !maps->IsUndecided(index);
}

bool ShadowMaps::HasUndecided() const
{
	for(size_t i = 0; i < maps.size(); i++)
		if(IsUndecided(i))
			return true;
	return false;
}

bool ShadowMaps::Explores() const
{
	for(size_t i = 0; i < maps.size(); i++)
		if(maps[i].explores)
			return true;
	return false;
}

void ShadowMaps::Explored(POV_ULONG cameraRays, double raysAcross)
{
	for(size_t i = 0; i < maps.size(); i++)
		if(maps[i].explores)
			ShadowPlugin::Api().explored(maps[i].map.get(), cameraRays, raysAcross);
}

string ShadowMaps::Times(double cost)
{
	const double kMost = 100.0;
	std::ostringstream text;

	if(cost >= kMost)
		text << "more than " << kMost;
	else
		text << "about " << std::setprecision(2) << cost;
	return text.str();
}

/// Lights are told apart by their order in the scene: they have no names.
string ShadowMaps::Name(const LightSource& light) const
{
	std::ostringstream name;

	name << "light source " << light.index + 1 << (light.lightGroupLight ? " of those in light groups" : "");
	return name.str();
}

void ShadowMaps::Decide(size_t map, bool useMap, double cost)
{
	ShadowMap& entry = maps[map];
	std::ostringstream sentence;

	entry.choice = useMap ? ShadowMap::kMap : ShadowMap::kRays;
	entry.cost = cost;
	if(useMap)
		return;

	std::replace(globalLights.begin(), globalLights.end(), map, size_t(kNone));
	std::replace(groupLights.begin(), groupLights.end(), map, size_t(kNone));
	rayTracedLights++;
	sentence << "The shadows of " << Name(*entry.light) << " are ray-traced: ";
	if(cost > 0.0)
		sentence << "a map would cost " << Times(cost) << " times as much.";
	else
		sentence << "they are too few for a map.";
	Tell(1, sentence.str());
}

double ShadowMaps::FinestTiles(size_t map) const
{
	const double kTilePixels = 256.0;
	dsm_statistics s = { 0 };

	s.size = sizeof(s);
	ShadowPlugin::Api().statistics(maps[map].map.get(), &s);
	return min(double(s.tiles), 2.0 * s.faces + 1.1 * s.pixels / kTilePixels); // those at edges are cut
}

size_t ShadowMaps::TakeFile()
{
	boost::lock_guard<boost::mutex> lock(bakeMutex);

	while((nextFile < maps.size()) && !maps[nextFile].HasFile())
		nextFile++;
	return (nextFile < maps.size()) ? nextFile++ : kNone;
}

bool ShadowMaps::LeaveBake(size_t map)
{
	boost::lock_guard<boost::mutex> lock(bakeMutex);

	return --bakers[map] == 0;
}

/// Threads finish tiles many times a second: one message a stage, and then two a second, are enough.
void ShadowMaps::Progress(size_t map, double share, bool saving)
{
	size_t number = 0, count = 0;
	std::ostringstream stage, text;

	for(size_t i = 0; i < maps.size(); i++)
		if(!maps[i].savePath.empty())
		{
			count++;
			number += (i <= map) ? 1 : 0;
		}
	const char *kind = maps[map].deep ? (saving ? "deep shadow map" : "Deep shadow map") : (saving ? "shadow map" : "Shadow map");
	stage << (saving ? "Saving " : "") << kind << " " << number << " of " << count;

	{
		boost::lock_guard<boost::mutex> lock(bakeMutex);

		if(!stages.insert(stage.str()).second && (sinceProgress.ElapsedRealTime() < kProgressInterval))
			return;
		sinceProgress.Reset();
	}

	stage << " (" << int(100.0 * share) << "%)";
	text << std::left << std::setw(kProgressWidth) << stage.str();
	POVMS_Object message(kPOVObjectClass_ShadowProgress);
	message.SetString(kPOVAttrib_EnglishText, text.str().c_str());
	RenderBackend::SendViewOutput(viewData->GetViewId(), viewData->GetSceneData()->frontendAddress, kPOVMsgIdent_Progress, message);
}

/// Tasks follow each other in threads of their own, never more at a time than there are contexts; the next one may start
/// while the last one's thread is still ending.
ShadowContext *ShadowMaps::Current()
{
	ShadowContext *context = current.get();
	if(context != NULL)
		return context;

	boost::unique_lock<boost::mutex> lock(idleMutex);
	while(idle.empty())
		idleChanged.wait(lock);
	context = idle.back();
	idle.pop_back();
	current.reset(context);
	return context;
}

void ShadowMaps::Release(ShadowContext *context)
{
	ShadowMaps& maps = context->Maps();

	boost::lock_guard<boost::mutex> lock(maps.idleMutex);
	maps.idle.push_back(context);
	maps.idleChanged.notify_one();
}

void ShadowMaps::Report(void *data, int32_t severity, const char *sentence)
{
	ShadowMaps& self = *static_cast<ShadowMaps *>(data);
	ShadowContext *context = self.current.get();

	if((severity < 2) || (context == NULL) || !context->Complain(sentence))
		self.Tell(severity, sentence);
}

void ShadowMaps::Tell(int severity, const string& sentence) const
{
	if(severity < 1)
		return;

	POVMS_Object message(kPOVObjectClass_ControlData);
	message.SetString(kPOVAttrib_EnglishText, ("Deep shadows: " + sentence).c_str());
	message.SetInt(kPOVAttrib_Warning, 0);
	RenderBackend::SendViewOutput(viewData->GetViewId(), viewData->GetSceneData()->frontendAddress, kPOVMsgIdent_Warning, message);
}

}
