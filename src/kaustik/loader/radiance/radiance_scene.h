#pragma once
// The loader for scenes of Radiance: scene files (.rad), rad's control files (.rif) and view files
// (.vf).

#include <string>
#include <string_view>

#include "kaustik/loader/load_options.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// Whether text begins as a scene file, a control file or a view file does.
bool is_radiance(std::string_view head);

/// Reads a scene with all files that it names. No command is run: those that only write scenes are
/// built in. Throws Error(input). A view file shows the scene whose control file lies beside it.
Description load_radiance(const std::string& path, const LoadOptions& options = {});

/// The same from text, see parse_scene().
Description parse_radiance(std::string_view text, std::string name_for_messages,
                           const std::string& base_folder, const LoadOptions& options = {});

}  // namespace kaustik
