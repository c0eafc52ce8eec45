#pragma once
#include "kaustik/material/fresnel.h"

namespace kaustik {

/// The rows that all conductors share: material, eta, k, specular_reflectance.
std::vector<Parameter> conductor_parameters();
/// What they say. Throws Error(input) if both a material and eta or k are given, or only one of
/// these.
SpectralIor conductor_ior(const Arguments& arguments);

}  // namespace kaustik
