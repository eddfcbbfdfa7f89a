// SPDX-License-Identifier: AGPL-3.0-or-later

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/scene/threaddata.h"
#include "backend/scene/view.h"
#include "backend/support/task.h"
#include "backend/shadow/shadowcontext.h"
#include "backend/shadow/shadowmaps.h"
#include "backend/shadow/shadowwork.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

ShadowContext::ShadowContext(ShadowMaps& m, ViewData *vd, ViewThreadData *threadData) :
	maps(m),
	viewData(vd),
	thread(threadData),
	workers(m.Count()),
	inFile(false)
{
	for(size_t i = 0; i < workers.size(); i++)
	{
		workers[i].context = this;
		workers[i].map = i;
		workers[i].worker = NULL;
		workers[i].lookUps = workers[i].rayTraced = 0;
		if(ShadowPlugin::Api().worker_create(maps[i].map.get(), &workers[i], &workers[i].worker) != DSM_OK)
			throw POV_EXCEPTION_CODE(kOutOfMemoryErr);
	}
}

ShadowContext::~ShadowContext()
{
	for(vector<Worker>::iterator i(workers.begin()); i != workers.end(); i++)
		ShadowPlugin::Api().worker_destroy(i->worker);
}

dsm_result ShadowContext::LookUp(size_t map, const dsm_receiver& receiver, double rgb[3])
{
	const dsm_result result = ShadowPlugin::Api().lookup(workers[map].worker, &receiver, rgb);

	workers[map].lookUps++;
	if((result == DSM_OK) || (result == DSM_OUTSIDE))
		return result;
	workers[map].rayTraced++;

	PassOnFailure();
	if(result == DSM_NO_MEMORY)
		throw POV_EXCEPTION_CODE(kOutOfMemoryErr);
	return DSM_TRACE;
}

void ShadowContext::TilesWanted(size_t map, const dsm_receiver& receiver, void (*wanted)(void *data, const dsm_tiles *tiles), void *data)
{
	if(ShadowPlugin::Api().tiles_wanted(workers[map].worker, &receiver, wanted, data) == DSM_NO_MEMORY)
		throw POV_EXCEPTION_CODE(kOutOfMemoryErr);
}

void ShadowContext::BakeTile(size_t map, const dsm_tiles& tile)
{
	const dsm_result result = ShadowPlugin::Api().bake_tile(workers[map].worker, tile.face, tile.x, tile.y);

	PassOnFailure();
	if(result == DSM_NO_MEMORY)
		throw POV_EXCEPTION_CODE(kOutOfMemoryErr);
}

void ShadowContext::Explore(size_t map, const dsm_receiver& receiver)
{
	const dsm_result result = ShadowPlugin::Api().explore(workers[map].worker, &receiver);

	PassOnFailure();
	if(result == DSM_NO_MEMORY)
		throw POV_EXCEPTION_CODE(kOutOfMemoryErr);
}

double ShadowContext::BakeWork(size_t map) const
{
	dsm_statistics s = { 0 };

	s.size = sizeof(s);
	ShadowPlugin::Api().statistics(maps[map].map.get(), &s);
	return ShadowWorkOf(thread->Stats()) + (events ? ShadowWorkOf(*events) : 0.0) + ShadowWorkOf(s);
}

void ShadowContext::Load(size_t map, const string& path)
{
	inFile = true;
	Check(ShadowPlugin::Api().load(workers[map].worker, path.c_str()));
}

void ShadowContext::BeginSave(size_t map, const string& path)
{
	inFile = true;
	Check(ShadowPlugin::Api().save_begin(workers[map].worker, path.c_str()));
}

void ShadowContext::EndSave(size_t map)
{
	inFile = true;
	Check(ShadowPlugin::Api().save_end(workers[map].worker, &ShadowContext::SaveProgress));
}

bool ShadowContext::BakeNext(size_t map, double& share)
{
	inFile = true;
	const dsm_result result = ShadowPlugin::Api().bake_next(workers[map].worker, &share);
	Check(result);
	return result != DSM_DONE;
}

bool ShadowContext::Complain(const char *sentence)
{
	if(inFile)
		complaint = sentence;
	return inFile;
}

ShadowEvents& ShadowContext::Events()
{
	if(!events)
		events.reset(new ShadowEvents(viewData->GetSceneData(), thread, viewData->GetQualityFeatureFlags(), maps.Casters()));
	return *events;
}

void ShadowContext::PassOnFailure()
{
	if(failure)
	{
		std::exception_ptr thrown;
		std::swap(thrown, failure);
		std::rethrow_exception(thrown);
	}
}

/// After a file's call: a render that was to have this map must not go on without it.
void ShadowContext::Check(dsm_result result)
{
	inFile = false;
	PassOnFailure();
	if((result == DSM_OK) || (result == DSM_DONE))
		return;
	if(result == DSM_NO_MEMORY)
		throw POV_EXCEPTION_CODE(kOutOfMemoryErr);
	throw POV_EXCEPTION(kFileDataErr, "Deep shadows: " + (complaint.empty() ? string("a map cannot be baked or its file cannot be used.") : complaint));
}

dsm_result ShadowContext::Trace(void *data, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink)
{
	Worker& worker = *static_cast<Worker *>(data);
	ShadowContext& self = *worker.context;

	try
	{
		return self.Events().TraceRays(*self.maps[worker.map].light, rays, count, tolerance, sink);
	}
	catch(...)
	{
		// a stopped task, or an error of POV-Ray's: LookUp passes it on
		self.failure = std::current_exception();
		return DSM_CANCELLED;
	}
}

int32_t ShadowContext::Pause(void *data)
{
	ShadowContext& self = *static_cast<Worker *>(data)->context;

	try
	{
		Task::CurrentTaskCooperate();
		return 0;
	}
	catch(...)
	{
		self.failure = std::current_exception();
		return 1;
	}
}

void ShadowContext::SaveProgress(void *data, double share)
{
	const Worker& worker = *static_cast<Worker *>(data);

	worker.context->maps.Progress(worker.map, share, true);
}

}
