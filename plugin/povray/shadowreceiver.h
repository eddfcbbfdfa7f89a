// SPDX-License-Identifier: AGPL-3.0-or-later
// The surface that is being shaded: a map's own answer for it depends on where the surface lies.

#ifndef POVRAY_BACKEND_SHADOWRECEIVER_H
#define POVRAY_BACKEND_SHADOWRECEIVER_H

namespace pov
{

class ShadowContext;

/// Part of every Trace object. Empty while media are lit.
struct ShadowReceiver
{
	const ObjectBase *object; ///< NULL: no surface
	const ObjectBase *csg;    ///< the outermost CSG object it is part of, or NULL
	Vector3d normal;          ///< unperturbed, either side
	ShadowContext *context;   ///< of the thread that the Trace object works in; NULL before its first look-up

	ShadowReceiver() : object(NULL), csg(NULL), context(NULL) { }
};

/// Sets the receiver for as long as a surface is shaded, or clears it, and puts the last one back.
class ShadowReceiverScope
{
	public:
		ShadowReceiverScope(ShadowReceiver& r, const Intersection& isect, const Vector3d& normal) : receiver(r), saved(r)
		{
			receiver.object = isect.Object;
			receiver.csg = isect.Csg;
			receiver.normal = normal;
		}
		explicit ShadowReceiverScope(ShadowReceiver& r) : receiver(r), saved(r) { receiver.object = receiver.csg = NULL; }
		~ShadowReceiverScope()
		{
			receiver.object = saved.object;
			receiver.csg = saved.csg;
			receiver.normal = saved.normal;
		}
	private:
		ShadowReceiver& receiver;
		const ShadowReceiver saved;
};

}

#endif
