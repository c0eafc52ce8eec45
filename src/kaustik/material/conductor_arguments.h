#pragma once
#include "kaustik/material/metal_fresnel.h"

namespace kaustik {

/// The rows that all conductors share: material, eta, k, ext_eta, reflectance, edge_tint,
/// specular_reflectance.
std::vector<Parameter> conductor_parameters();
/// What they say. Throws Error(input) if a metal is given twice (by its name, by eta and k, by its
/// colours), or one of eta and k alone, or edge_tint alone.
MetalFresnel metal_fresnel_of(const BsdfInputs& inputs);

}  // namespace kaustik
