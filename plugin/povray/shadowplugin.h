// SPDX-License-Identifier: AGPL-3.0-or-later
// The shadow library: found, loaded and checked once a process.

#ifndef POVRAY_BACKEND_SHADOWPLUGIN_H
#define POVRAY_BACKEND_SHADOWPLUGIN_H

#define DSM_IMPORT
#include "backend/shadow/dsm.h"

namespace pov
{

class ShadowPlugin
{
	public:
		/// The library's table of functions. The library is looked for in one place only, fixed when the program
		/// was built: relative to the program's own file, so that an installed and an uninstalled tree both work
		/// and no scene can name another.
		/// @throw pov_base::Exception with a sentence that names the path and, where they differ, both versions
		static const dsm_api_table& Api();
};

}

#endif
