// SPDX-License-Identifier: AGPL-3.0-or-later
// What one thread bakes and looks up with.

#ifndef POVRAY_BACKEND_SHADOWCONTEXT_H
#define POVRAY_BACKEND_SHADOWCONTEXT_H

#include <exception>

#include "backend/shadow/shadowevents.h"

namespace pov
{

class ShadowMaps;
class ViewData;
class ViewThreadData;

/// Has its own tracing objects, so that baking does not disturb the render that it interrupts, and its own workers.
class ShadowContext
{
	public:
		ShadowContext(ShadowMaps& maps, ViewData *viewData, ViewThreadData *threadData);
		~ShadowContext();

		/// Asks a map. Throws what baking has thrown, after the library has unwound.
		/// @return     DSM_OK or DSM_OUTSIDE with rgb set, or DSM_TRACE
		dsm_result LookUp(size_t map, const dsm_receiver& receiver, double rgb[3]);

		POV_ULONG lookUps, rayTraced;

		ShadowMaps& Maps() { return maps; }

		/// What the library calls while a context looks up; see dsm_host.
		static dsm_result Trace(void *worker, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink);
		static int32_t Pause(void *worker);
	private:
		/// Hands a map's requests to this thread.
		struct Worker
		{
			ShadowContext *context;
			size_t map;
			dsm_worker *worker;
		};

		ShadowMaps& maps;
		ShadowEvents events;
		vector<Worker> workers;
		std::exception_ptr failure; ///< no exception may cross the library, so it waits here
};

}

#endif
