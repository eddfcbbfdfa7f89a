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

unsigned int ShadowSettings::Find(const string& name)
{
	const dsm_api_table& api = ShadowPlugin::Api();
	unsigned int row = 0;

	while((row < api.parameter_count) && (name != api.parameters[row].name))
		row++;
	return row;
}

string ShadowSettings::Text(const char *word) const
{
	const char *text = ShadowPlugin::Api().settings_text(settings, Find(word));

	return (text != NULL) ? text : "";
}

}
