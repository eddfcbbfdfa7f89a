// SPDX-License-Identifier: AGPL-3.0-or-later
// Parsing deep_shadow { } and shadow_map { } in a light_source. The blocks and their words come from the shadow library's own
// tables and are matched by their text, so that none of them is reserved.

#include <cstring>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/lighting/point.h"
#include "backend/parser/parse.h"
#include "backend/scene/objects.h"
#include "backend/scene/scene.h"
#include "backend/shadow/shadowpermission.h"
#include "backend/shadow/shadowsettings.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

namespace
{

string WordList(const dsm_block& block)
{
	string list;
	for(unsigned int row = 0; row < block.parameter_count; row++)
		list += (row > 0 ? ", " : "") + string(block.parameters[row].name);
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
	const string name(Shadow_Word());
	shared_ptr<ShadowSettings> settings(name.empty() ? NULL : New_Shadow_Settings(name));

	if(settings == NULL)
		return false;
	if(light->shadowSettings != 0)
	{
		const string other(sceneData->shadowSettings[light->shadowSettings - 1]->Block().name);

		if(other == name)
			Error("Only one %s block allowed per light_source.", name.c_str());
		Error("A light_source can have a %s or a %s block, not both.", other.c_str(), name.c_str());
	}

	const dsm_block& block = settings->Block();
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
		const unsigned int row = settings->Find(word);

		if(row == block.parameter_count)
			Error("'%s' is not a word of %s. Its words are: %s.", Token.Token_String != NULL ? Token.Token_String : "", block.name, WordList(block).c_str());
		if(!seen.insert(row).second)
			Error("'%s' is given twice in one %s block.", word.c_str(), block.name);

		Parse_Shadow_Parameter(*settings, row);
	}
	Parse_End();
	Find_Shadow_Files(*settings);

	sceneData->shadowSettings.push_back(settings);
	light->shadowSettings = sceneData->shadowSettings.size();

	return true;
}

/// What a light_source does not know may be a block of the shadow library. Without the library, the parser's error adds file
/// and line to the reason.
/// @return     NULL if there is no such block
ShadowSettings *Parser::New_Shadow_Settings(const string& name)
{
	string why;

	try
	{
		return (ShadowSettings::FindBlock(name) != NULL) ? new ShadowSettings(name) : NULL;
	}
	catch(pov_base::Exception& e)
	{
		why = e.what();
	}

	Error("%s", why.c_str());
	return NULL;
}

/// Reads the value of one word: a quoted text, numbers, or both. Commas stand between them; vectors count as numbers.
void Parser::Parse_Shadow_Parameter(ShadowSettings& settings, unsigned int row)
{
	const dsm_parameter& parameter = settings.Block().parameters[row];
	vector<double> numbers;
	string text;
	bool numbersFollow = (parameter.type == DSM_NUMBERS);

	if(!numbersFollow)
	{
		char *quoted = Parse_C_String(parameter.type == DSM_TEXT);
		text = quoted;
		POV_FREE(quoted);
		numbersFollow = Parse_Shadow_Comma();
	}

	while(numbersFollow)
	{
		EXPRESS terms;
		const int count = Parse_Unknown_Vector(terms);

		numbers.insert(numbers.end(), terms, terms + count);
		numbersFollow = Parse_Shadow_Comma();
	}

	const string why(settings.Set(row, (parameter.type == DSM_NUMBERS) ? NULL : text.c_str(), numbers.empty() ? NULL : &numbers[0], numbers.size()));
	if(!why.empty())
		Error("%s", why.c_str());
}

bool Parser::Parse_Shadow_Comma()
{
	Get_Token();
	if(Token.Token_Id == COMMA_TOKEN)
		return true;
	Unget_Token();
	return false;
}

/// Turns names into paths as POV-Ray does for its other files: one that is read is looked for in the library path, and
/// povray.conf has its say on both. A file that is missing is no error before its light wants it.
void Parser::Find_Shadow_Files(ShadowSettings& settings)
{
	const string load(settings.Text("load_file")), save(settings.Text("save_file"));

	if(!load.empty() && !save.empty())
		Error("A %s block can have a load_file or a save_file, not both.", settings.Block().name);
	if(settings.IsRefined() && !(load.empty() && save.empty()))
		Error("A %s block with accuracy can have neither load_file nor save_file: its map is only as fine as what one picture looks at.", settings.Block().name);

	if(!load.empty())
	{
		UCS2String path(ASCIItoUCS2String(load.c_str()));
		const UCS2String found(sceneData->FindFile(GetPOVMSContext(), path, POV_File_Unknown));

		if(!found.empty())
			path = found;
		settings.loadPath = UCS2toASCIIString(path);
		const string forbidding(ShadowFileForbiddenBy(settings.loadPath, false));
		if(!forbidding.empty() || (POV_ALLOW_FILE_READ(path.c_str(), POV_File_Unknown) == false))
			Error("IO Restrictions prohibit read access to '%s': see %s.", settings.loadPath.c_str(), forbidding.empty() ? "povray.conf" : forbidding.c_str());
	}

	if(!save.empty())
	{
		settings.savePath = save;
		const string forbidding(ShadowFileForbiddenBy(save, true));
		if(!forbidding.empty() || (POV_ALLOW_FILE_WRITE(ASCIItoUCS2String(save.c_str()).c_str(), POV_File_Unknown) == false))
			Error("IO Restrictions prohibit write access to '%s': see %s.", save.c_str(), forbidding.empty() ? "povray.conf" : forbidding.c_str());
	}
}

/// Called when the whole light_source has been read: says which lights cannot have a map.
void Parser::Check_Shadow_Block(const LightSource *light)
{
	if(light->shadowSettings == 0)
		return;

	const char *block = sceneData->shadowSettings[light->shadowSettings - 1]->Block().name;

	if(light->Light_Type == FILL_LIGHT_SOURCE)
		Warning(0, "A shadowless light_source has no shadows; its %s block is ignored.", block);
	else if(light->Area_Light)
		Warning(0, "An area_light cannot have a %s yet; its shadows are ray-traced.", (string(block) == "deep_shadow") ? "deep shadow map" : "shadow map");
	else if(light->Projected_Through_Object != NULL)
		Warning(0, "A light_source with projected_through cannot have a %s; its shadows are ray-traced.", (string(block) == "deep_shadow") ? "deep shadow map" : "shadow map");
}

}
