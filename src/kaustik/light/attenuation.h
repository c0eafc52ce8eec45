#pragma once
#include "kaustik/base/parameters.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// How light falls off with distance in classical ray tracing, in place of the inverse square:
/// 1/(constant + linear·d + quadratic·d²). Nothing physical knows it: photons ignore it.
class ClassicalAttenuation {
 public:
  /// The inverse square.
  ClassicalAttenuation() = default;
  /// From attenuation_parameter(), of a light about `center`. Throws Error(input) if a number is
  /// negative or all are zero.
  ClassicalAttenuation(const Arguments& arguments, const Vec3f& center);

  /// That falloff over the inverse square of the distance of `reference`: what physical light that
  /// arrives there is multiplied by.
  float factor(const Vec3f& reference) const;

 private:
  Vec3f center_{0, 0, 0};
  bool is_inverse_square_ = true;
  double constant_ = 0, linear_ = 0, quadratic_ = 1;
};

/// The row `attenuation`.
Parameter attenuation_parameter();

}  // namespace kaustik
