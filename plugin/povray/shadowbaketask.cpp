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
	size_t i = maps.TakeFile();

	// while the first one waits for the library that reads files, another makes what the files' probe rays are found with; alone, as the
	// system makes no threads while it loads a library
	if(i > 0)
		maps.Casters().Prepare(1);
	for(; i != ShadowMaps::kNone; i = maps.TakeFile())
	{
		const ShadowMap& map = maps[i];

		if(!map.loadPath.empty())
			context.Load(i, map.loadPath);
		if(map.savePath.empty())
			continue;
		for(size_t other = 0; other < i; other++)
			if(maps[other].savePath == map.savePath)
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
