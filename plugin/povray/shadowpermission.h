// SPDX-License-Identifier: AGPL-3.0-or-later
// What povray.conf says about a map's file. The platform layer of 3.7.0.10 reads povray.conf, but loses what it says: it refuses nothing.

#ifndef POVRAY_BACKEND_SHADOWPERMISSION_H
#define POVRAY_BACKEND_SHADOWPERMISSION_H

#include <string>

namespace pov_base
{

/// Where the program was configured to find povray.conf and its own scenes; known to the platform layer only.
extern const char *const kConfigurationFolder;
extern const char *const kInstallationFolder;

}

namespace pov
{

/// Whether a file may be read, or else written, by the system's povray.conf and the user's: each that restricts has to permit it.
/// Links are followed. A povray.conf that cannot be opened restricts nothing; POV-Ray says so when it starts.
/// @return empty if it may, else the path of the povray.conf that does not permit it
std::string ShadowFileForbiddenBy(const std::string& file, bool write);

}

#endif
