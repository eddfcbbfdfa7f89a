// SPDX-License-Identifier: AGPL-3.0-or-later

#include <dlfcn.h>
#include <unistd.h>

#include <mutex>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/shadow/shadowplugin.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;

namespace
{

const char kPlaceFromProgram[] = "/../lib/povray-3.7/deepshadow.so";

string LibraryPath()
{
	char program[4096];
	ssize_t length = readlink("/proc/self/exe", program, sizeof(program) - 1);

	if(length <= 0)
		throw POV_EXCEPTION(kCannotOpenFileErr, "Deep shadows: cannot find out where this program is, and so not where its shadow library is.");
	program[length] = '\0';

	string folder(program);
	return folder.substr(0, folder.rfind('/')) + kPlaceFromProgram;
}

const dsm_api_table *Load(string& why)
{
	const string path(LibraryPath());
	void *library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);

	if(library == NULL)
	{
		const char *reason = dlerror();
		why = "Deep shadows: cannot load the shadow library " + path + (reason != NULL ? string(": ") + reason : string()) + ".";
		return NULL;
	}

	const dsm_api_table *api = reinterpret_cast<const dsm_api_table *>(dlsym(library, "dsm_api"));

	if(api == NULL)
		why = "Deep shadows: " + path + " is not a shadow library (it has no symbol dsm_api).";
	else if((api->abi != DSM_ABI) || (api->size < sizeof(dsm_api_table)))
	{
		std::ostringstream sentence;
		sentence << "Deep shadows: the shadow library " << path << " has interface " << api->abi << " (" << api->size
		         << " bytes), this program needs interface " << DSM_ABI << " (" << sizeof(dsm_api_table) << " bytes).";
		why = sentence.str();
	}
	else
		return api; // never closed: its table lives as long as the process

	dlclose(library);
	return NULL;
}

}

const dsm_api_table& ShadowPlugin::Api()
{
	static std::mutex once;
	static const dsm_api_table *api = NULL;

	std::lock_guard<std::mutex> lock(once);

	if(api == NULL)
	{
		string why;
		api = Load(why);
		if(api == NULL)
			throw POV_EXCEPTION(kCannotOpenFileErr, why);
	}

	return *api;
}

}
