// SPDX-License-Identifier: AGPL-3.0-or-later

#include <dlfcn.h>
#include <unistd.h>

#include <sstream>

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

const dsm_api_table& Load()
{
	const string path(LibraryPath());
	void *library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);

	if(library == NULL)
	{
		const char *reason = dlerror();
		throw POV_EXCEPTION(kCannotOpenFileErr, "Deep shadows: cannot load the shadow library " + path + (reason != NULL ? string(": ") + reason : string()) + ".");
	}

	const dsm_api_table *api = reinterpret_cast<const dsm_api_table *>(dlsym(library, "dsm_api"));
	std::ostringstream why;

	if(api == NULL)
		why << "Deep shadows: " << path << " is not a shadow library (it has no symbol dsm_api).";
	else if((api->abi != DSM_ABI) || (api->size < sizeof(dsm_api_table)))
		why << "Deep shadows: the shadow library " << path << " has interface " << api->abi << " (" << api->size
		    << " bytes), this program needs interface " << DSM_ABI << " (" << sizeof(dsm_api_table) << " bytes).";
	else
		return *api; // never closed: its table lives as long as the process

	dlclose(library);
	throw POV_EXCEPTION(kCannotOpenFileErr, why.str());
}

}

/// Every look-up comes here, so there is no lock once the library is loaded. A failure is tried again by the next call.
const dsm_api_table& ShadowPlugin::Api()
{
	static const dsm_api_table& api = Load();

	return api;
}

}
