#include "kaustik/scene/aperture.h"

#include <algorithm>
#include <cmath>

#include "kaustik/base/error.h"
#include "kaustik/base/warp.h"

namespace kaustik {

Aperture::Aperture(const Arguments& arguments)
    : radius_(float(arguments.number("aperture_radius"))),
      blades_(int(arguments.integer("blades"))),
      blade_angle_(float(arguments.number("blade_rotation")) * pi / 180) {
  if (blades_ == 1 || blades_ == 2)
    throw Error(ErrorKind::input, "an aperture of so few blades has no area",
                "give 3 or more 'blades', or 0 for a round one", arguments.place_of("blades"));
}

Vec2f Aperture::at(const Vec2f& u) const {
  if (blades_ == 0) return square_to_disk(u) * radius_;
  // One of the triangles between the middle and a side, and a point of it.
  const float at = u.x * float(blades_), side = std::min(std::floor(at), float(blades_ - 1));
  const float rest = std::clamp(at - side, 0.0f, 1.0f), root = std::sqrt(u.y);
  const auto corner = [&](float i) {
    const float angle = blade_angle_ + 2 * pi * i / float(blades_);
    return Vec2f(std::cos(angle), std::sin(angle));
  };
  return (corner(side) * (root * (1 - rest)) + corner(side + 1) * (root * rest)) * radius_;
}

std::vector<Parameter> lens_parameters(Parameter aperture_radius) {
  return {aperture_radius.range(0, 1e6).in("m"),
          number_parameter("focus_distance", 1e4, "Distance at which the picture is sharp.")
              .range(1e-6, 1e12)
              .in("m"),
          integer_parameter("blades", 0, "Sides of the aperture; 0: round.").range(0, 100),
          number_parameter("blade_rotation", 0, "Turns an aperture with blades.")
              .range(-360, 360)
              .in("degrees")};
}

}  // namespace kaustik
