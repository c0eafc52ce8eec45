#include "kaustik/light/spot_arguments.h"

#include <fmt/format.h>

namespace kaustik {

std::vector<Parameter> spot_cone_parameters() {
  return {number_parameter("cutoff_angle", 20, "Angle from the axis from which on it is dark.")
              .range(0, 180)
              .in("degrees"),
          optional(number_parameter("beam_width", 15,
                                    "Angle from the axis from which on intensity falls, linearly "
                                    "with the angle; 3/4 of `cutoff_angle` if not given.")
                       .range(0, 180)
                       .in("degrees"))};
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
  return SpotCone(cutoff * radians, beam * radians);
}

}  // namespace kaustik
