#include "kaustik/light/spot_arguments.h"

#include <fmt/format.h>

namespace kaustik {

std::vector<Parameter> spot_cone_parameters() {
  return {
      number_parameter("cutoff_angle", 20, "Angle to the axis beyond which there is no light.")
          .range(0, 180)
          .in("degrees"),
      optional(number_parameter("beam_width", 15,
                                "Angle to the axis at which the intensity begins to fall; 3/4 of "
                                "`cutoff_angle` if absent.")
                   .range(0, 180)
                   .in("degrees")),
      choice_parameter("falloff", "linear", {"linear", "smooth", "square", "none"},
                       "Fall of the intensity from beam to cutoff: linear in the angle (Mitsuba), "
                       "a smooth step of the cosine (pbrt), the square of the linear step of the "
                       "cosine (glTF), or none before the cutoff (Radiance).")};
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
