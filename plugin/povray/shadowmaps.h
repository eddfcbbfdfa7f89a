// SPDX-License-Identifier: AGPL-3.0-or-later
// The shadow maps of one render: which lights have one, and who may ask them.

#ifndef POVRAY_BACKEND_SHADOWMAPS_H
#define POVRAY_BACKEND_SHADOWMAPS_H

#include <boost/thread.hpp>

#include "base/timer.h"
#include "backend/shadow/shadowcasters.h"
#include "backend/shadow/shadowsettings.h"

namespace pov
{

class ShadowContext;
class TaskQueue;
class ViewData;
class ViewThreadData;

/// A light that has a map.
struct ShadowMap
{
	const LightSource *light;
	shared_ptr<dsm_map> map;
	bool photons;     ///< receivers of photons from this light are ray-traced
	bool atmosphere;  ///< fog and atmospheric media dim this light, and are multiplied in at the look-up
	bool deep;        ///< else it holds one depth a pixel
	bool explores;    ///< wants to see a few places of the picture before it is asked
	string loadPath, savePath; ///< empty: no file
	bool HasFile() const { return !loadPath.empty() || !savePath.empty(); }

	enum Choice { kNone, kOpen, kMap, kRays };
	Choice choice;    ///< kNone: it had none; kOpen: not before the survey is over
	double cost;      ///< of the map, in that of its rays; 0: nobody seems to ask for it
};

struct ShadowSampling;

class ShadowMaps
{
	public:
		/// Made before the first render task: what a context copies from the scene is not safe to copy later.
		/// @param[in]      method      one of kPOVList_ShadowMethod_*
		/// @param[in,out]  threads     the contexts' thread data is added here, for statistics and clean-up
		/// @return                     NULL if every light is ray-traced anyway
		static shared_ptr<ShadowMaps> New(ViewData *viewData, int method, int threadCount, vector<ViewThreadData *>& threads);
		ShadowMaps(ViewData *viewData, int method, int threadCount, vector<ViewThreadData *>& threads);
		~ShadowMaps();

		bool Unshadowed() const { return unshadowed; }

		/// The light's place in the list of maps, or kNone.
		size_t Find(const LightSource& light) const
		{
			const vector<size_t>& places = light.lightGroupLight ? groupLights : globalLights;
			return light.index < places.size() ? places[light.index] : kNone;
		}
		/// Whether this light's shadows come from a map. To ask or not to ask then changes no random number.
		static bool Answers(TraceThreadData& thread, const LightSource& light);
		const ShadowMap& operator[](size_t map) const { return maps[map]; }
		size_t Count() const { return maps.size(); }

		const ShadowCasters& Casters() const { return casters; }

		/// Queues what has to be done before anything is shaded: files are opened, and maps that are saved are baked and saved.
		/// Then comes the survey, if a light has a choice.
		/// @param[in,out]  threads     the tasks' thread data is added here
		/// @param[in]      method, threshold, depth    of antialiasing
		void AppendTasks(TaskQueue& queue, vector<ViewThreadData *>& threads, unsigned int method, double threshold, unsigned int depth);

		/// Lights that may be ray-traced instead, if that costs less. Decided once, before the first look-up, by one thread.
		bool IsUndecided(size_t map) const { return maps[map].choice == ShadowMap::kOpen; }
		bool HasUndecided() const;
		bool Explores() const;
		void Explored(POV_ULONG cameraRays, double raysAcross);
		void Decide(size_t map, bool useMap, double cost);

		/// How many of the finest tiles a map has.
		double FinestTiles(size_t map) const;

		/// Tells the front end how far the map is, now and then.
		void Progress(size_t map, double share, bool saving);

		/// The next map that has a file and that nobody has taken yet, or kNone.
		size_t TakeFile();

		/// To be called by each bake task when the map has no tile left to take.
		/// @return                     true for the last of them: all tiles are baked
		bool LeaveBake(size_t map);

		/// The calling thread's context. Lives as long as the thread works on one task.
		ShadowContext *Current();

		/// The section for the render statistics; empty if no light has a map.
		string Statistics() const;
		string Statistics(bool deep) const;
		string Comparison() const;
		string Choices() const;

		static const size_t kNone = static_cast<size_t>(-1);
	private:
		ViewData *viewData;
		ShadowCasters casters;
		bool unshadowed;
		vector<ShadowMap> maps;
		vector<size_t> globalLights, groupLights;
		size_t rayTracedLights;

		vector<shared_ptr<ShadowContext> > contexts;
		vector<ShadowContext *> idle;
		boost::mutex idleMutex;
		boost::condition_variable idleChanged;
		boost::thread_specific_ptr<ShadowContext> current;

		boost::mutex bakeMutex;         ///< guards what follows
		size_t nextFile;                ///< no map before this one is left for TakeFile
		vector<size_t> bakers;          ///< for each map, the tasks that are still baking it
		std::set<string> stages;        ///< that the front end knows of
		Timer sinceProgress;

		size_t Add(const LightSource& light, int method);
		string Name(const LightSource& light) const;
		static string Times(double cost);
		bool CanHaveMap(const LightSource& light) const;
		bool Create(const LightSource& light, const ShadowSettings& settings);
		void Tell(int severity, const string& sentence) const;

		static void Release(ShadowContext *context);
		static void Report(void *data, int32_t severity, const char *sentence);
};

}

#endif
