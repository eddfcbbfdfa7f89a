// SPDX-License-Identifier: AGPL-3.0-or-later

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/support/statistics.h"
#include "backend/shadow/shadowevents.h"
#include "backend/shadow/shadowwork.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

struct Weight
{
	IntStatsIndex counter;
	double work; ///< of one
};

/// Shapes that solve equations or walk through parts of their own are dearer than the rest.
const double kShapeTest = 50.0;
const Weight kBeyondShapeTest[] =
{
	{ Ray_RBezier_Tests, 1000.0 }, { Ray_Bicubic_Tests, 1000.0 }, { Ray_Blob_Tests, 300.0 }, { Ray_CSG_Intersection_Tests, 150.0 },
	{ Ray_CSG_Merge_Tests, 150.0 }, { Ray_CSG_Union_Tests, 50.0 }, { Ray_Fractal_Tests, 3000.0 }, { Ray_HField_Tests, 200.0 },
	{ Ray_IsoSurface_Tests, 500.0 }, { Ray_Lathe_Tests, 500.0 }, { Ray_Mesh_Tests, 200.0 }, { Ray_Parametric_Tests, 5000.0 },
	{ Ray_Poly_Tests, 1000.0 }, { Ray_Prism_Tests, 200.0 }, { Ray_Sphere_Sweep_Tests, 1500.0 }, { Ray_Superellipsoid_Tests, 1500.0 },
	{ Ray_Sor_Tests, 500.0 }, { Ray_Torus_Tests, 400.0 }, { Ray_TTF_Tests, 500.0 }, { Ray_Ovus_Tests, 500.0 },
	{ Bounding_Region_Tests, 50.0 }, { Clipping_Region_Tests, 50.0 }, { Ray_Function_VM_Calls, 150.0 },
	{ nChecked, 8.0 }, { nEnqueued, 15.0 },
	// a shadow ray is copied with all its room for containers, and each surface on the way starts another one
	{ Shadow_Ray_Tests, 250.0 },
	{ Media_Samples, 700.0 }
};

const double kAsk = 60.0, kDraw = 120.0, kWalk = 200.0, kShade = 400.0, kEvaluate = 500.0;
const double kLightRay = 60.0, kVertex = 140.0;

}

const double kShadowLookUpWork = 600.0;
const double kShadowLeastTileWork = 16 * 16 * 16 * 40.0;

double ShadowWorkOf(const RenderStatistics& stats)
{
	double work = 0.0;

	// tests and successes take turns; isosurfaces take back tests of their containers, and sometimes more than there were
	for(int i = Ray_RBezier_Tests; i <= Ray_TTF_Tests; i += 2)
		work += kShapeTest * POV_LONG(stats[IntStatsIndex(i)]);
	for(size_t i = 0; i < sizeof(kBeyondShapeTest) / sizeof(kBeyondShapeTest[0]); i++)
		work += kBeyondShapeTest[i].work * POV_LONG(stats[kBeyondShapeTest[i].counter]);
	return work;
}

double ShadowWorkOf(const ShadowEvents& events)
{
	const ShadowHits& hits = events.Hits();
	return kAsk * hits.asks + kDraw * hits.drawn + kWalk * hits.walks + kShade * events.Shaded() + kEvaluate * events.Evaluations();
}

double ShadowWorkOf(const dsm_statistics& map)
{
	return kLightRay * map.rays + kVertex * map.vertices_in;
}

}
