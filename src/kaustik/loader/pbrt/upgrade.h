#pragma once
#include <array>
#include <string>
#include <string_view>

#include "kaustik/loader/deviations.h"
#include "kaustik/loader/pbrt/parameters.h"

namespace kaustik::pbrt {

// Files of pbrt-v3 in terms of v4. Names of v4 stay as they are; what changes in looks is told.

/// Materials that v4 has under other names.
inline constexpr std::array<std::string_view, 9> old_materials = {
    "matte",        "plastic", "substrate", "uber", "translucent",
    "kdsubsurface", "mirror",  "glass",     "metal"};

/// The type that the material has in v4; its parameters are renamed, and its roughness is that of
/// v4 for the same slope of facets. `is_old_file`: types that v4 has, too, are those of v3.
std::string upgraded_material(const std::string& type, ParameterList& list,
                              const std::string& object, Deviations& deviations, bool is_old_file);
/// A light's `scale` is a number, and what its blackbody is multiplied by belongs to it, as does
/// the luminance of that blackbody, whose brightest wavelength has 1 in v3.
void upgrade_light(ParameterList& list, const std::string& object, Deviations& deviations);
/// The type of a medium.
std::string upgraded_medium(const std::string& type);

}  // namespace kaustik::pbrt
