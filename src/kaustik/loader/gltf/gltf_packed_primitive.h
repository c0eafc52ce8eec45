#pragma once
#include "kaustik/loader/gltf/gltf_accessor.h"

namespace kaustik::gltf {

/// Unpacks a primitive that KHR_draco_mesh_compression has packed, and supplies its accessors. Does
/// nothing for others, and for those whose plain numbers are there, too. Throws MissingData where
/// the packed data are damaged, or do not fit the accessors.
void supply_unpacked(File& file, Accessors& accessors, const JsonValue& primitive);

}  // namespace kaustik::gltf
