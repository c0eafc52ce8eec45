#pragma once
// OBJ files as scenes of their own, with the materials of their MTL files.

#include <string>
#include <string_view>

#include "kaustik/loader/load_options.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// Whether the lines of a text are those of an OBJ file.
bool is_obj(std::string_view head);

/// Reads an OBJ file as a scene: a shape for each material, those of its MTL files, and a camera
/// and light where nothing shines. Throws Error(input) for a file without faces, and one that is
/// packed.
Description load_obj_scene(const std::string& path, const LoadOptions& options = {});

/// Throws Error(input): a mesh is read from its file.
Description parse_obj_scene(std::string_view text, std::string name_for_messages,
                            const std::string& base_folder, const LoadOptions& options = {});

}  // namespace kaustik
