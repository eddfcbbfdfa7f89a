// SPDX-License-Identifier: AGPL-3.0-or-later

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/interior/interior.h"
#include "backend/interior/media.h"
#include "backend/math/vector.h"
#include "backend/scene/objects.h"
#include "backend/texture/pigment.h"
#include "backend/shadow/shadowvolumes.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

namespace
{

/// First steps across the shortest side of a container. What is thinner than one, and of a density that nothing is known
/// of, may be missed.
const double kStepsAcross = 24.0;

/// Extinction beyond any world's size is as dark as that, and can still be reckoned with. So is what is no number, to ray tracing as well.
const double kMostExtinction = 1.0e30;

DblRGBColour Bounded(DblRGBColour extinction)
{
	for(int k = 0; k < 3; k++)
	{
		if(!(extinction[k] < kMostExtinction))
			extinction[k] = kMostExtinction;
		else if(extinction[k] < -kMostExtinction)
			extinction[k] = -kMostExtinction;
	}
	return extinction;
}

}

ShadowMedium::ShadowMedium(const Media& media, double length) :
	pigment(media.Density), extinction(Bounded(DblRGBColour(media.Extinction))), scale(extinction), mapped(NULL), grows(false), step(length)
{
	for(const PIGMENT *p = pigment; p != NULL; p = static_cast<const PIGMENT *>(p->Next))
	{
		const ShadowDensity density(p);
		if(density.GetKind() == ShadowDensity::kConstant)
			scale = Bounded(scale * density.Colour());
		else
			densities.push_back(density);
	}
	if((densities.size() == 1) && (densities[0].GetKind() == ShadowDensity::kMapped))
		mapped = &densities[0];
	if(mapped != NULL)
		for(int k = 0; k < 3; k++)
			grows = grows || (min(mapped->Least()[k] * scale[k], mapped->Most()[k] * scale[k]) < 0.0);
}

DblRGBColour ShadowMedium::Extinction(const Vector3d& point, TraceThreadData *thread) const
{
	RGBColour density;

	if(densities.empty())
		return scale;
	Evaluate_Density_Pigment(pigment, point, density, thread);
	return Bounded(DblRGBColour(density) * extinction);
}

void ShadowVolumes::Add(const ObjectBase *object)
{
	if(object->interior != NULL)
	{
		const BBOX_VECT& lengths = object->BBox.Lengths;
		const double step = min(lengths[X], min(lengths[Y], lengths[Z])) / kStepsAcross;

		for(vector<Media>::const_iterator i(object->interior->media.begin()); i != object->interior->media.end(); i++)
		{
			boost::shared_ptr<ShadowMedium>& medium = media[&*i];
			if(!i->use_extinction)
				continue;
			if(medium == NULL)
				medium.reset(new ShadowMedium(*i, step));
			else
				medium->Shorten(step);
		}
	}
	if(object->Type & IS_COMPOUND_OBJECT)
	{
		const CompoundObject *compound = static_cast<const CompoundObject *>(object);
		for(vector<ObjectPtr>::const_iterator child(compound->children.begin()); child != compound->children.end(); child++)
			Add(*child);
	}
}

const ShadowMedium *ShadowVolumes::Find(const Media *m) const
{
	const std::map<const Media *, boost::shared_ptr<ShadowMedium> >::const_iterator found = media.find(m);
	return (found == media.end()) ? NULL : found->second.get();
}

}
