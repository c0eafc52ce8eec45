#include "kaustik/light/attenuation.h"

namespace kaustik {

ClassicalAttenuation::ClassicalAttenuation(const Arguments& arguments, const Vec3f& center)
    : center_(center) {
  if (!arguments.given("attenuation")) return;
  const Vec3d given = arguments.point("attenuation");
  if (!(given.x >= 0 && given.y >= 0 && given.z >= 0 && given.x + given.y + given.z > 0))
    throw Error(ErrorKind::input,
                "'attenuation' has a number below zero, or nothing but zeros: light would grow "
                "without bound",
                "give the constant, the linear and the quadratic part, each at least 0",
                arguments.place_of("attenuation"));
  is_inverse_square_ = false;
  constant_ = given.x;
  linear_ = given.y;
  quadratic_ = given.z;
}

float ClassicalAttenuation::factor(const Vec3f& reference) const {
  if (is_inverse_square_) return 1;
  const double d = length(center_ - reference),
               falloff = constant_ + d * (linear_ + d * quadratic_);
  return falloff > 0 ? float(d * d / falloff) : 1.0f;
}

Parameter attenuation_parameter() {
  return optional(point_parameter("attenuation", {0, 0, 1},
                                  "Constant, linear and quadratic attenuation with distance. Only "
                                  "classical ray tracing uses it; physical methods ignore it."));
}

}  // namespace kaustik
