// SPDX-License-Identifier: AGPL-3.0-or-later
// The settings of one deep_shadow { } block, and how a light names them.

#ifndef POVRAY_BACKEND_SHADOWSETTINGS_H
#define POVRAY_BACKEND_SHADOWSETTINGS_H

#include "backend/shadow/shadowplugin.h"

namespace pov
{

/// Settings begin at their defaults. A scene owns them in SceneData::shadowSettings; a light holds 1 + its index there,
/// so that copies of lights (one set a thread) stay plain data.
class ShadowSettings
{
	public:
		ShadowSettings();
		~ShadowSettings();

		/// @return empty, or a sentence that names the word, the value and the range; nothing is changed then
		string Set(unsigned int parameter, const char *choice, const double *numbers, unsigned int count);

		const dsm_settings *Get() const { return settings; }
	private:
		dsm_settings *settings;

		ShadowSettings(const ShadowSettings&);
		ShadowSettings& operator=(const ShadowSettings&);
};

}

#endif
