// SPDX-License-Identifier: AGPL-3.0-or-later
// Parsing deep_shadow { } in a light_source. Its words come from the shadow library's own table and are matched by
// their text, so that none of them is reserved.

#include <cstring>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/lighting/point.h"
#include "backend/parser/parse.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/shadow/shadowsettings.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

namespace
{

/// The row of the table with this name, or the row count.
unsigned int FindParameter(const dsm_api_table& api, const string& name)
{
	unsigned int row = 0;
	while((row < api.parameter_count) && (name != api.parameters[row].name))
		row++;
	return row;
}

string WordList(const dsm_api_table& api)
{
	string list;
	for(unsigned int row = 0; row < api.parameter_count; row++)
		list += (row > 0 ? ", " : "") + string(api.parameters[row].name);
	return list;
}

}

/// The text of the current token if it is a word; empty for quoted strings and punctuation.
string Parser::Shadow_Word()
{
	if((Token.Token_Id == STRING_LITERAL_TOKEN) || (Token.Token_String == NULL) || !(isalpha(*Token.Token_String) || (*Token.Token_String == '_')))
		return string();
	return string(Token.Token_String);
}

/// Called with the token that Parse_Light_Source does not know.
/// @return whether it was a shadow block, which has then been read to its end
bool Parser::Parse_Shadow_Block(LightSource *light)
{
	if(Shadow_Word() != "deep_shadow")
		return false;

	if(light->shadowSettings != 0)
		Error("Only one deep_shadow block allowed per light_source.");

	shared_ptr<ShadowSettings> settings(New_Shadow_Settings());
	const dsm_api_table& api = ShadowPlugin::Api();
	std::set<unsigned int> seen;

	Parse_Begin();
	while(true)
	{
		Get_Token();
		if(Token.Token_Id == RIGHT_CURLY_TOKEN)
		{
			Unget_Token();
			break;
		}

		const string word(Shadow_Word());
		const unsigned int row = FindParameter(api, word);

		if(row == api.parameter_count)
			Error("'%s' is not a word of deep_shadow. Its words are: %s.", Token.Token_String != NULL ? Token.Token_String : "", WordList(api).c_str());
		if(!seen.insert(row).second)
			Error("'%s' is given twice in one deep_shadow block.", word.c_str());

		Parse_Shadow_Parameter(*settings, row);
	}
	Parse_End();

	sceneData->shadowSettings.push_back(settings);
	light->shadowSettings = sceneData->shadowSettings.size();

	return true;
}

/// A block needs the shadow library; without it the parser's error adds file and line to the reason.
ShadowSettings *Parser::New_Shadow_Settings()
{
	string why;

	try
	{
		return new ShadowSettings();
	}
	catch(pov_base::Exception& e)
	{
		why = e.what();
	}

	Error("%s", why.c_str());
	return NULL;
}

/// Reads the value of one word: a quoted choice, or numbers, singly or as a vector.
void Parser::Parse_Shadow_Parameter(ShadowSettings& settings, unsigned int row)
{
	const dsm_parameter& parameter = ShadowPlugin::Api().parameters[row];
	EXPRESS numbers;
	unsigned int count = 0;
	string choice;
	bool numbersFollow = true;

	if(parameter.type == DSM_CHOICE)
	{
		char *text = Parse_C_String();
		choice = text;
		POV_FREE(text);

		Get_Token();
		numbersFollow = (Token.Token_Id == COMMA_TOKEN);
		if(!numbersFollow)
			Unget_Token();
	}

	if(numbersFollow)
		count = Parse_Unknown_Vector(numbers);

	const string why(settings.Set(row, parameter.type == DSM_CHOICE ? choice.c_str() : NULL, numbers, count));
	if(!why.empty())
		Error("%s", why.c_str());
}

/// Called when the whole light_source has been read: says which lights cannot have a map.
void Parser::Check_Shadow_Block(const LightSource *light)
{
	if(light->shadowSettings == 0)
		return;

	if(light->Light_Type == FILL_LIGHT_SOURCE)
		Warning(0, "A shadowless light_source has no shadows; its deep_shadow block is ignored.");
	else if(light->Area_Light)
		Warning(0, "An area_light cannot have a deep shadow map yet; its shadows are ray-traced.");
	else if(light->Projected_Through_Object != NULL)
		Warning(0, "A light_source with projected_through cannot have a deep shadow map; its shadows are ray-traced.");
}

}
