// SPDX-License-Identifier: AGPL-3.0-or-later

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/shadow/shadowsettings.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

ShadowSettings::ShadowSettings(const string& name) : block(FindBlock(name)), settings(NULL), blurred(false), refined(false)
{
	const dsm_api_table& api = ShadowPlugin::Api();

	if(block == NULL)
		throw POV_EXCEPTION(kParamErr, "Deep shadows: the shadow library has no " + name + ".");
	settings = api.settings_create(static_cast<uint32_t>(block - api.blocks));
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

	if(ShadowPlugin::Api().settings_set(settings, parameter, choice, numbers, count, why, sizeof(why)) != DSM_OK)
		return why;
	if((string(block->parameters[parameter].name) == "blur") && (count > 0))
		blurred = (numbers[0] > 0.0);
	if(string(block->parameters[parameter].name) == "accuracy")
		refined = true;
	return string();
}

const dsm_block *ShadowSettings::FindBlock(const string& name)
{
	const dsm_api_table& api = ShadowPlugin::Api();

	for(unsigned int i = 0; i < api.block_count; i++)
		if(name == api.blocks[i].name)
			return &api.blocks[i];
	return NULL;
}

unsigned int ShadowSettings::Find(const string& word) const
{
	unsigned int row = 0;

	while((row < block->parameter_count) && (word != block->parameters[row].name))
		row++;
	return row;
}

string ShadowSettings::Text(const char *word) const
{
	const char *text = ShadowPlugin::Api().settings_text(settings, Find(word));

	return (text != NULL) ? text : "";
}

}
