#pragma once
// Scene files in the XML of Mitsuba 3. Files of version 2.x and 0.6 are upgraded while loading, as
// Mitsuba itself does it.

#include <string>
#include <string_view>

#include "kaustik/loader/load_options.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// Whether text begins as such a file does: with the tag <scene>, which comments may stand before,
/// and is none of Nori's, which have that tag too.
bool is_mitsuba_xml(std::string_view head);

/// Reads a scene file and what it includes, packed by gzip or not. Properties `filename` and
/// `photon_map` are searched in the folders of the file's `<path>` elements (the last one first),
/// in the file's own folder, then in those of the files that include it; what is nowhere gets the
/// own folder. A constant `<spectrum>` becomes a number, a list or file a SpectralCurve. Objects
/// nest at most 100 levels deep, also by reference, and never in circles. Throws Error(input) with
/// all the problems that were found.
Description load_mitsuba_xml(const std::string& path, const LoadOptions& options = {});

/// The same from text: `name_for_messages` takes the place of the file's name in messages and
/// `base_folder` ("" for the working folder) that of its folder.
Description parse_mitsuba_xml(std::string_view text, std::string name_for_messages,
                              const std::string& base_folder, const LoadOptions& options = {});

}  // namespace kaustik
