#pragma once
#include "kaustik/material/bsdf.h"

namespace kaustik {

/// The rows of the indices on both sides of a boundary, int_ior and ext_ior …
std::vector<Parameter> dielectric_ior_parameters(std::string_view usual_interior = "bk7");
/// … and what one of them says.
SpectralValue dielectric_ior_of(const Arguments& arguments, std::string_view name);

/// The row of the dispersion of what is inside, which dielectric_ior_of() heeds where it is there.
Parameter abbe_number_parameter();

/// The name of the row by which solid bodies of this material win where they overlap, and the row.
inline constexpr const char* priority_name = "priority";
Parameter priority_parameter();

/// The rows of glass: both indices, dispersion, and the factors below.
std::vector<Parameter> dielectric_parameters();

/// The rows of the factors on what such a boundary reflects and transmits, specular_reflectance and
/// specular_transmittance.
Parameter specular_reflectance_parameter();
Parameter specular_transmittance_parameter();

}  // namespace kaustik
