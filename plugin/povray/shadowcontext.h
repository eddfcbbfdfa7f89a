// SPDX-License-Identifier: AGPL-3.0-or-later
// What one thread bakes and looks up with.

#ifndef POVRAY_BACKEND_SHADOWCONTEXT_H
#define POVRAY_BACKEND_SHADOWCONTEXT_H

#include <exception>

#include <boost/scoped_ptr.hpp>

#include "backend/shadow/shadowevents.h"

namespace pov
{

class ShadowMaps;
class ViewData;
class ViewThreadData;

/// What a light ray goes through outside of all objects. Fog and atmospheric media are in no map; Trace::ComputeShadowMedia takes this.
struct ShadowAir
{
	Ray ray;
	Intersection end;

	ShadowAir(const Ray& toLight, double depth) : ray(toLight)
	{
		ray.SetFlags(Ray::OtherRay, true, false);
		end.Depth = depth;
		end.Object = NULL;
	}
};

/// Has its own tracing objects, so that baking does not disturb the render that it interrupts, and its own workers.
class ShadowContext
{
	public:
		ShadowContext(ShadowMaps& maps, ViewData *viewData, ViewThreadData *threadData);
		~ShadowContext();

		/// Asks a map. Throws what baking has thrown, after the library has unwound.
		/// @return     DSM_OK or DSM_OUTSIDE with rgb set, or DSM_TRACE
		dsm_result LookUp(size_t map, const dsm_receiver& receiver, double rgb[3]);

		/// Whole maps and their files; see dsm.h. All throw the library's sentence if they fail.
		void Load(size_t map, const string& path);
		void BeginSave(size_t map, const string& path);
		void EndSave(size_t map);
		/// @param[out]     share       of the map that is baked
		/// @return                     false when there was no tile left to bake
		bool BakeNext(size_t map, double& share);

		/// What a look-up would need, and one tile of it. See dsm.h.
		void TilesWanted(size_t map, const dsm_receiver& receiver, void (*wanted)(void *data, const dsm_tiles *tiles), void *data);
		void BakeTile(size_t map, const dsm_tiles& tile);

		/// A place of the picture, for a map that chooses by itself how fine it is.
		void Explore(size_t map, const dsm_receiver& receiver);

		/// What baking a map has cost; all of it while this is the only context that bakes.
		double BakeWork(size_t map) const;

		/// An error that the library reports in this thread.
		/// @return                     false if nobody here would pass it on
		bool Complain(const char *sentence);

		POV_ULONG LookUps(size_t map) const { return workers[map].lookUps; }
		POV_ULONG RayTraced(size_t map) const { return workers[map].rayTraced; }

		ShadowMaps& Maps() { return maps; }
		/// How light rays were traced; NULL: none was.
		const ShadowHits *Hits() const { return events ? &events->Hits() : NULL; }

		/// What the library calls while a context looks up; see dsm_host.
		static dsm_result Trace(void *worker, const dsm_ray *rays, uint32_t count, double tolerance, dsm_sink *sink);
		static int32_t Pause(void *worker);
	private:
		static void SaveProgress(void *worker, double share);

		/// Hands a map's requests to this thread.
		struct Worker
		{
			ShadowContext *context;
			size_t map;
			dsm_worker *worker;
			POV_ULONG lookUps, rayTraced;
		};

		ShadowMaps& maps;
		ViewData *viewData;
		TraceThreadData *thread;
		boost::scoped_ptr<ShadowEvents> events; ///< with the first light ray: many scenes ask for none, and its random numbers take time
		vector<Worker> workers;
		std::exception_ptr failure; ///< no exception may cross the library, so it waits here
		bool inFile;                ///< a file's call is under way
		string complaint;           ///< of that call

		ShadowEvents& Events();
		void PassOnFailure();
		void Check(dsm_result result);
};

}

#endif
