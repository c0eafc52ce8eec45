#include "kaustik/integrator/path_parameters.h"

namespace kaustik {

Parameter max_depth_parameter() {
  return integer_parameter("max_depth", -1,
                           "Longest path in segments (1: lamps alone, 2: direct light); -1: any.")
      .range(-1, 1 << 20);
}

Parameter rr_depth_parameter() {
  return integer_parameter("rr_depth", 5, "Scattering events before Russian roulette starts.")
      .range(1, 1 << 20);
}

int read_maximum_events(const Arguments& arguments) {
  const auto depth = arguments.integer("max_depth");
  return depth < 0 ? 1 << 20 : std::max(0, int(depth) - 1);
}

}  // namespace kaustik
