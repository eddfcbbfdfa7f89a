// SPDX-License-Identifier: AGPL-3.0-or-later

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/scene/scene.h"
#include "backend/scene/view.h"
#include "backend/shadow/shadowbaketask.h"
#include "backend/shadow/shadowcontext.h"
#include "backend/shadow/shadowmaps.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

void ShadowFilesTask::Run()
{
	ShadowMaps& maps = *GetSceneData()->shadowMaps;
	ShadowContext& context = *maps.Current();
	std::set<string> saved;

	for(size_t i = 0; i < maps.Count(); i++)
	{
		const ShadowMap& map = maps[i];

		if(!map.loadPath.empty())
			context.Load(i, map.loadPath);
		if(map.savePath.empty())
			continue;
		if(!saved.insert(map.savePath).second)
			throw POV_EXCEPTION(kParamErr, "Deep shadows: two light sources have the save_file '" + map.savePath + "'; each needs a file of its own.");
		context.BeginSave(i, map.savePath);
	}
}

void ShadowBakeTask::Run()
{
	ShadowMaps& maps = *GetSceneData()->shadowMaps;
	ShadowContext& context = *maps.Current();

	for(size_t i = 0; i < maps.Count(); i++)
	{
		double share = 0.0;

		if(maps[i].savePath.empty())
			continue;
		while(context.BakeNext(i, share))
		{
			maps.Progress(i, share, false);
			Cooperate();
		}
		if(maps.LeaveBake(i))
			context.EndSave(i);
	}
}

}
