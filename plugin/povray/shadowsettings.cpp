// SPDX-License-Identifier: AGPL-3.0-or-later

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/shadow/shadowsettings.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

ShadowSettings::ShadowSettings() : settings(ShadowPlugin::Api().settings_create())
{
	if(settings == NULL)
		throw POV_EXCEPTION_CODE(kOutOfMemoryErr);
}

ShadowSettings::~ShadowSettings()
{
	ShadowPlugin::Api().settings_destroy(settings);
}

string ShadowSettings::Set(unsigned int parameter, const char *choice, const double *numbers, unsigned int count)
{
	char why[512] = "";

	if(ShadowPlugin::Api().settings_set(settings, parameter, choice, numbers, count, why, sizeof(why)) == DSM_OK)
		return string();
	return why;
}

}
