#pragma once
#include "kaustik/base/parameters.h"
#include "kaustik/light/spot_cone.h"

namespace kaustik {

/// The rows `cutoff_angle`, `beam_width` and `falloff`, and the cone that they stand for. Throws
/// Error(input) where the cone is empty or the beam is wider than the cutoff.
std::vector<Parameter> spot_cone_parameters();
SpotCone spot_cone_argument(const Arguments& arguments);

}  // namespace kaustik
