#pragma once
#include "kaustik/base/parameters.h"

namespace kaustik {

/// How light falls off with distance in classical ray tracing, in place of the inverse square:
/// 1/(constant + linear·d + quadratic·d²). Nothing physical knows it: photons ignore it.
class ClassicalAttenuation {
 public:
  /// The inverse square.
  ClassicalAttenuation() = default;
  /// From attenuation_parameter(). Throws Error(input) if a number is negative or all are zero.
  explicit ClassicalAttenuation(const Arguments& arguments);

  /// That falloff over the inverse square of `distance`: what physical light is multiplied by.
  float factor(float distance) const;

 private:
  double constant_ = 0, linear_ = 0, quadratic_ = 1;
};

/// The row `attenuation`.
Parameter attenuation_parameter();

}  // namespace kaustik
