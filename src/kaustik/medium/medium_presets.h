#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/base/parameters.h"

namespace kaustik {

/// What light meets in a substance, measured: absorption and scattering per millimetre in linear
/// red, green and blue, and the mean cosine of the angle of scattering.
struct MediumPreset {
  const char* name;  ///< in lower case
  Rgb sigma_s, sigma_a, g;

  /// What scatters evenly in all directions as far as this does: σs (1 − g).
  Rgb reduced_sigma_s() const {
    return {sigma_s.r * (1 - g.r), sigma_s.g * (1 - g.g), sigma_s.b * (1 - g.b)};
  }
};

/// By the names of Mitsuba 0.6: Jensen et al. 2001, table 2, whose scattering is the reduced one
/// already, and Narasimhan et al. 2006.
std::span<const MediumPreset> medium_presets();
std::vector<std::string> medium_preset_names();
/// Null: there is none of that name.
const MediumPreset* find_medium_preset(std::string_view name);

}  // namespace kaustik
