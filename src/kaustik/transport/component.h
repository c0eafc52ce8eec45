#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace kaustik {

/// The parts of the picture, one owner for every light path (read from the light; G: an event of a
/// specular lobe, D: of a diffuse lobe or in a medium; x: where the camera's path is scattered
/// first, on a surface except in `volume`).
enum class Component : uint8_t {
  emission,  ///< L seen by the camera itself
  direct,    ///< L → x, reflected by any lobe but a delta one
  caustic,   ///< L G⁺ → x, reflected by the diffuse lobe
  indirect,  ///< at least one D before x, reflected by the diffuse lobe
  specular,  ///< all that a specular lobe of x reflects or transmits, but direct light on glossy
             ///< lobes
  volume     ///< all that is scattered at x in a medium
};
inline constexpr int component_count = 6;
inline constexpr std::array<std::string_view, component_count> component_names = {
    "emission", "direct", "caustic", "indirect", "specular", "volume"};

/// A set of components, as bits.
class ComponentSet {
 public:
  constexpr ComponentSet() = default;
  static constexpr ComponentSet all() {
    ComponentSet set;
    set.bits_ = (1u << component_count) - 1;
    return set;
  }
  constexpr void add(Component c) { bits_ |= 1u << unsigned(c); }
  constexpr ComponentSet without(Component c) const {
    ComponentSet rest = *this;
    rest.bits_ &= ~(1u << unsigned(c));
    return rest;
  }
  constexpr bool has(Component c) const { return bits_ >> unsigned(c) & 1u; }
  constexpr bool empty() const { return bits_ == 0; }
  friend constexpr bool operator==(ComponentSet, ComponentSet) = default;

 private:
  unsigned bits_ = 0;
};

}  // namespace kaustik
