// SPDX-License-Identifier: AGPL-3.0-or-later
// What has to be done to maps with files before anything is shaded.

#ifndef POVRAY_BACKEND_SHADOWBAKETASK_H
#define POVRAY_BACKEND_SHADOWBAKETASK_H

#include "backend/render/rendertask.h"

namespace pov
{

/// Opens the files of maps, with as many others of its kind as there are threads, and nothing else beside them: a file that cannot be used
/// stops the render before any work is lost.
class ShadowFilesTask : public RenderTask
{
	public:
		explicit ShadowFilesTask(ViewData *viewData) : RenderTask(viewData) { }
	protected:
		virtual void Run();
		virtual void Stopped() { }
		virtual void Finish() { }
};

/// Bakes the maps that are saved, one map after the other, with as many others of its kind as there are threads. Who
/// leaves a map last saves it, while the others go on with the next one.
class ShadowBakeTask : public RenderTask
{
	public:
		explicit ShadowBakeTask(ViewData *viewData) : RenderTask(viewData) { }
	protected:
		virtual void Run();
		virtual void Stopped() { }
		virtual void Finish() { }
};

}

#endif
