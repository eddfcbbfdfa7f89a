// SPDX-License-Identifier: AGPL-3.0-or-later
// The settings of one deep_shadow { } or shadow_map { } block, and how a light names them.

#ifndef POVRAY_BACKEND_SHADOWSETTINGS_H
#define POVRAY_BACKEND_SHADOWSETTINGS_H

#include "backend/shadow/shadowplugin.h"

namespace pov
{

/// Settings begin at their defaults. A scene owns them in SceneData::shadowSettings; a light holds 1 + its index there,
/// so that copies of lights (one set a thread) stay plain data.
class ShadowSettings
{
	public:
		/// @param[in]      name        of one of the library's blocks
		explicit ShadowSettings(const string& name);
		~ShadowSettings();

		/// @return empty, or a sentence that names the word, the value and the range; nothing is changed then
		string Set(unsigned int parameter, const char *choice, const double *numbers, unsigned int count);

		const dsm_settings *Get() const { return settings; }

		const dsm_block& Block() const { return *block; }

		/// The library's block with this name, or NULL.
		static const dsm_block *FindBlock(const string& name);

		/// The row of the block's table with this name, or the table's row count.
		unsigned int Find(const string& word) const;

		/// What a word that takes the name of a file was given; empty if nothing.
		string Text(const char *word) const;

		/// Whether look-ups are softened beyond what one camera ray stands for.
		bool IsBlurred() const { return blurred; }
		/// Whether the map is as fine as what looks at it needs, place by place.
		bool IsRefined() const { return refined; }

		/// Where the two files are; empty: none. The names alone do not tell.
		string loadPath, savePath;
	private:
		const dsm_block *block;
		dsm_settings *settings;
		bool blurred, refined;

		ShadowSettings(const ShadowSettings&);
		ShadowSettings& operator=(const ShadowSettings&);
};

}

#endif
