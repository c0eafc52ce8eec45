#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// How estimates at points and along rays are made where nothing else is said: by an integrator
/// that finds all light, whatever the scene's is, in as many passes as there are replicates.
struct MeasuringDefaults {
  static constexpr const char* integrator = "auto";
  static constexpr uint32_t passes = 16, samples_per_pass = 64;
};

/// The scene with this sensor for its only camera, in the medium that its own first camera is in:
/// "irradiancepoints" with 'points' and 'normals', or "radiancerays" with 'origins' and
/// 'directions'. Whether the scene has cameras does not matter. Messages about a list have its name
/// for their place. The description stays as it is; objects are shared with it. Throws Error.
Description measuring(const Description& description, const std::string& sensor,
                      std::vector<Property> lists);

}  // namespace kaustik
