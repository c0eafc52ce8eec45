#pragma once
// The skies of gensky and gendaylit as functions of direction; +z is the zenith.

#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "kaustik/base/vec.h"

namespace kaustik::radiance {

/// A sky by the arguments of one of Radiance's functions: `skybr` of skybright.cal (3 or 7) or
/// `skybright` of perezlum.cal (10). Near the horizon it passes over into the ground.
class SkyModel {
 public:
  /// Nothing for other functions, and where arguments are missing.
  static std::optional<SkyModel> of(std::string_view function, std::string_view file,
                                    std::span<const double> arguments);
  /// W/(sr·m²); `direction` has the length 1.
  double radiance(const Vec3d& direction) const;

 private:
  enum class Type { clear, overcast, uniform, intermediate, perez };
  double above_horizon(const Vec3d& direction) const;

  Type type_ = Type::uniform;
  double zenith_ = 0, ground_ = 0;
  double norm_ = 1;                ///< of clear and intermediate skies: their value at the zenith
  std::array<double, 5> perez_{};  ///< a to e
  Vec3d to_sun_{0, 0, 1};
};

}  // namespace kaustik::radiance
