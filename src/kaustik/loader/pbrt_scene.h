#pragma once
#include <string>
#include <string_view>

#include "kaustik/loader/load_options.h"
#include "kaustik/scene/description.h"

namespace kaustik {

// Scenes of pbrt-v4, and of v3 in terms of v4: docs/formats/pbrt.md.

/// Whether a text begins as one of these: by a directive, behind comments.
bool is_pbrt(std::string_view head);
/// Reads a file, which gzip may have packed, and all that it includes. Throws Error(input).
Description load_pbrt(const std::string& path, const LoadOptions& options = {});
/// The same from text, see parse_scene().
Description parse_pbrt(std::string_view text, std::string name_for_messages,
                       const std::string& base_folder, const LoadOptions& options = {});

}  // namespace kaustik
