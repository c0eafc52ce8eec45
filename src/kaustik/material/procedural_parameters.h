#pragma once
// Rows that several procedural textures have.

#include "kaustik/material/texture.h"

namespace kaustik {

/// A colour of a texture with a default that is no grey.
inline Parameter texture_color(std::string name, const Rgb& value, std::string sentence) {
  Parameter parameter = color_parameter(std::move(name), 0, std::move(sentence)).range(0, 1);
  parameter.default_value = Value(value);
  return parameter;
}
inline Parameter seed_parameter() {
  return integer_parameter("seed", 0, "Seed: each number gives another pattern.").range(0, 1e9);
}
inline SpectralValue color_argument(const Arguments& arguments, std::string_view name) {
  return SpectralValue::reflectance(arguments.color(name));
}
inline Spectrum mixed(const Spectrum& a, const Spectrum& b, float share_of_b) {
  return a + (b - a) * std::clamp(share_of_b, 0.0f, 1.0f);
}

}  // namespace kaustik
