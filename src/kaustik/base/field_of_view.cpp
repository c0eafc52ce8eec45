#include "kaustik/base/field_of_view.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "kaustik/base/error.h"

namespace kaustik {
namespace {

/// tan of half the field of view along x, from the axis that `fov` is measured on.
double tan_half_x(double fov_degrees, const std::string& axis, double aspect) {
  const double t = std::tan(0.5 * fov_degrees * std::numbers::pi / 180.0);
  if (axis == "y" || (axis == "smaller" && aspect > 1) || (axis == "larger" && aspect < 1))
    return t * aspect;
  if (axis == "diagonal") return t * aspect / std::sqrt(aspect * aspect + 1);
  return t;
}

}  // namespace

std::vector<Parameter> field_of_view_parameters() {
  return {optional(number_parameter("fov", 50, "Field of view along fov_axis.")
                       .range(1e-4, 179.9)
                       .in("degrees")),
          optional(text_parameter("focal_length", "50mm",
                                  "Focal length on 35 mm film, instead of fov: a number and mm."))
              .instead_of("fov"),
          choice_parameter("fov_axis", "x", {"x", "y", "diagonal", "smaller", "larger"},
                           "Axis along which fov is measured.")};
}

Vec2f tan_half_fov(const Arguments& arguments, double aspect) {
  double fov = 0;
  std::string axis = arguments.text("fov_axis");
  if (arguments.given("fov")) {
    fov = arguments.number("fov");
  } else {
    // Mitsuba: the focal length refers to the diagonal of 36 × 24 mm film.
    const std::string& text =
        arguments.given("focal_length") ? arguments.text("focal_length") : "50mm";
    char* end = nullptr;
    const double millimetres = std::strtod(text.c_str(), &end);
    while (*end == ' ') ++end;
    const std::string unit = end;
    if (!(millimetres > 0) || (!unit.empty() && unit != "mm"))
      throw Error(ErrorKind::input, "'focal_length' is '" + text + "'",
                  "give a positive number of millimetres, such as 35mm",
                  arguments.place_of("focal_length"));
    fov =
        2 * std::atan(std::sqrt(36.0 * 36 + 24 * 24) / (2 * millimetres)) * 180 / std::numbers::pi;
    axis = "diagonal";
  }
  const auto x = float(tan_half_x(fov, axis, aspect));
  return {x, float(x / aspect)};
}

}  // namespace kaustik
