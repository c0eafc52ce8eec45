#pragma once
// Scenes in glTF 2.0: .gltf with its buffers and pictures beside it or within it, and .glb.

#include <string>
#include <string_view>

#include "kaustik/loader/load_options.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// Whether bytes begin as such a file does.
bool is_gltf(std::string_view head);

/// Reads a file, packed by gzip or not: the scene that it shows by itself, as it stands in the
/// file. Meshes are buffers that share the file's memory where they lie as needed. Lamps in candela
/// and lux, and emission in cd/m², become watts by lumens_per_watt_white. Without a camera or light
/// it gets some. Definitions: see gltf::Options. Throws Error(input) for what is no such file, and
/// for extensions that it requires and that cannot be read.
Description load_gltf(const std::string& path, const LoadOptions& options = {});

/// The same from the file's bytes: `name_for_messages` takes the place of its name in messages and
/// `base_folder` ("" for the working folder) that of its folder.
Description parse_gltf(std::string_view bytes, std::string name_for_messages,
                       const std::string& base_folder, const LoadOptions& options = {});

}  // namespace kaustik
