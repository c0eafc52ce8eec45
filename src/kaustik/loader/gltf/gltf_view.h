#pragma once
// Cameras and lamps of nodes.

#include <memory>
#include <set>
#include <string>

#include "kaustik/loader/gltf/gltf_nodes.h"
#include "kaustik/loader/gltf/gltf_options.h"

namespace kaustik::gltf {

/// Where a node stands and looks to, along its −z, without its scale.
Transform view_of(const File& file, const PlacedNode& placed);

/// The sensor of a node that has a camera; null: it has none. `ids`: those that are taken.
std::shared_ptr<Object> sensor_of(const File& file, const PlacedNode& placed,
                                  std::set<std::string>& ids);

/// The lamp of a node that has one of KHR_lights_punctual; null: it has none.
std::shared_ptr<Object> lamp_of(const File& file, const PlacedNode& placed, const Options& options,
                                Deviations& deviations);

/// The luminaire of a node that has one of EXT_lights_ies; null: it has none, or its file is not
/// there, which is told.
std::shared_ptr<Object> luminaire_of(File& file, const PlacedNode& placed, Deviations& deviations);

}  // namespace kaustik::gltf
