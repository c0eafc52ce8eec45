#include "kaustik/light/spot_arguments.h"

#include <fmt/format.h>

namespace kaustik {

std::vector<Parameter> spot_cone_parameters() {
  return {number_parameter("cutoff_angle", 20, "Angle from the axis from which on it is dark.")
              .range(0, 180)
              .in("degrees"),
          optional(number_parameter("beam_width", 15,
                                    "Angle from the axis from which on intensity falls; 3/4 of "
                                    "`cutoff_angle` if not given.")
                       .range(0, 180)
                       .in("degrees")),
          choice_parameter("falloff", "linear", {"linear", "smooth", "square", "none"},
                           "How intensity falls from the beam to the cutoff: linearly with the "
                           "angle (Mitsuba), as a smooth step of the cosine (pbrt), with the "
                           "square of its share (glTF), or not at all before the cutoff "
                           "(Radiance).")};
}

SpotCone spot_cone_argument(const Arguments& arguments) {
  const double cutoff = arguments.number("cutoff_angle");
  const double beam = arguments.has("beam_width") ? arguments.number("beam_width") : 0.75 * cutoff;
  if (!(cutoff > 0))
    throw Error(ErrorKind::input, "'cutoff_angle' is 0: this spot would be dark",
                "give an angle of more than 0 up to 180 degrees",
                arguments.place_of("cutoff_angle"));
  if (beam > cutoff)
    throw Error(ErrorKind::input,
                fmt::format("'beam_width' is {}, more than the 'cutoff_angle' of {}", beam, cutoff),
                "the beam lies inside of the cutoff angle", arguments.place_of("beam_width"));
  const double radians = std::numbers::pi / 180;
  const std::string& falloff = arguments.text("falloff");
  if (falloff == "none") return SpotCone(cutoff * radians, cutoff * radians);
  return SpotCone(cutoff * radians, beam * radians,
                  falloff == "smooth"   ? SpotFalloff::smooth
                  : falloff == "square" ? SpotFalloff::square
                                        : SpotFalloff::linear);
}

}  // namespace kaustik
