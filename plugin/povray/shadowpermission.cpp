// SPDX-License-Identifier: AGPL-3.0-or-later
// The rules are those that POV-Ray's sample povray.conf states.

#include <cerrno>
#include <cstdlib>
#include <fstream>

#include <boost/algorithm/string.hpp>

// frame.h must always be the first POV file included (pulls in platform config)
#include "backend/frame.h"
#include "backend/shadow/shadowpermission.h"

// this must be the last file included
#include "base/povdebug.h"

namespace pov
{

using namespace pov_base;
using boost::algorithm::starts_with;
using boost::algorithm::trim_copy;

namespace
{

const char kName[] = "/povray.conf";

string Home()
{
	const char *home = getenv("HOME");

	return (home != NULL) ? home : "";
}

/// Absolute and without links, as far as it exists; empty where even that cannot be known. Without a slash at the end.
string Resolved(const string& name)
{
	string known(name), beyond;

	while(true)
	{
		char *found = realpath(known.empty() ? "." : known.c_str(), NULL);
		if(found != NULL)
		{
			const string place(found);
			free(found);
			return ((place == "/") ? "" : place) + beyond;
		}

		const size_t end = known.find_last_not_of('/');
		if((errno != ENOENT) || (end == string::npos))
			return string();
		const size_t slash = known.find_last_of('/', end); // npos + 1 is 0
		const string last(known.substr(slash + 1, end - slash));
		if((last == ".") || (last == ".."))
			return string();
		beyond = "/" + last + beyond;
		known.erase(slash + 1);
	}
}

struct PermittedFolder
{
	string folder; ///< with a slash at its end
	bool known;
	bool descend; ///< whether the folders in it count, too
	bool writable;

	PermittedFolder(string name, bool descend, bool writable) : descend(descend), writable(writable)
	{
		boost::algorithm::replace_all(name, "%INSTALLDIR%", kInstallationFolder);
		boost::algorithm::replace_all(name, "%HOME%", Home());
		folder = Resolved(name) + "/";
		known = (folder != "/") || (name == "/");
	}

	bool Holds(const string& file) const
	{
		return known && starts_with(file, folder) && (descend || (file.find('/', folder.size()) == string::npos));
	}
};

class Configuration
{
	public:
		/// @param folder where its povray.conf is, in which maps are never written
		explicit Configuration(const string& folder);

		bool Permits(const string& file, bool write) const;

	private:
		PermittedFolder own;
		enum { kNothing, kWriting, kEverything } restricted;
		vector<PermittedFolder> permitted;

		void ReadFolder(const string& line);
};

Configuration::Configuration(const string& folder) : own(folder, true, false), restricted(kNothing)
{
	std::ifstream lines((folder + kName).c_str());
	string line, section;

	while(std::getline(lines, line))
	{
		line = trim_copy(line.substr(0, line.find(';')));
		if(starts_with(line, "["))
			section = line.substr(0, line.find(']') + 1);
		else if((section == "[File I/O Security]") && !line.empty()) // what is neither of the milder ones is taken for the strictest
			restricted = (line == "none") ? kNothing : (line == "read-only") ? kWriting : kEverything;
		else if(section == "[Permitted Paths]")
			ReadFolder(line);
	}
	if(permitted.empty())
	{
		permitted.push_back(PermittedFolder(kInstallationFolder, true, false));
		permitted.push_back(PermittedFolder(kConfigurationFolder, false, false));
	}
}

/// `read = folder`, `read+write = folder`; with a star, what is in it too. Lines that are not understood permit nothing.
void Configuration::ReadFolder(const string& line)
{
	const size_t equal = line.find('=');

	if(equal == string::npos)
		return;

	string mode(trim_copy(line.substr(0, equal))), folder(trim_copy(line.substr(equal + 1)));
	const bool descend = boost::algorithm::ends_with(mode, "*");

	if(descend)
		mode.erase(mode.size() - 1);
	if(starts_with(folder, "\"") || starts_with(folder, "'"))
	{
		const size_t end = folder.find(folder[0], 1);

		folder = (end == string::npos) ? "" : folder.substr(1, end - 1);
	}
	else
		folder = folder.substr(0, folder.find_first_of(" \t"));
	if(!folder.empty() && ((mode == "read") || (mode == "read+write")))
		permitted.push_back(PermittedFolder(folder, descend, mode == "read+write"));
}

bool Configuration::Permits(const string& file, bool write) const
{
	if((restricted == kNothing) || ((restricted == kWriting) && !write))
		return true;
	if(file.empty() || (write && own.Holds(file)))
		return false;
	for(vector<PermittedFolder>::const_iterator i(permitted.begin()); i != permitted.end(); i++)
		if((i->writable || !write) && i->Holds(file))
			return true;
	return false;
}

}

string ShadowFileForbiddenBy(const string& file, bool write)
{
	const string home(Home());
	const string resolved(Resolved(file));
	vector<string> folders(1, kConfigurationFolder);

	if(!home.empty())
		folders.push_back(home + "/.povray/3.7");
	for(vector<string>::const_iterator i(folders.begin()); i != folders.end(); i++)
		if(!Configuration(*i).Permits(resolved, write))
			return *i + kName;
	return string();
}

}
