#include "kaustik/material/energy_scale.h"

#include <fmt/format.h>

#include <algorithm>

namespace kaustik {

float energy_scale(const std::vector<const Texture*>& factors, const Arguments& arguments) {
  Spectrum sum;
  float maximum = 0;
  bool constant = true;
  for (const Texture* texture : factors) {
    sum += texture->mean();
    maximum += texture->maximum();
    constant = constant && texture->is_constant();
  }
  if (!constant) return 1 / std::max(1.0f, maximum);
  if (sum.max_lane() > 1 + 1e-5f) {
    std::vector<std::string> names;
    for (const Parameter& parameter : arguments.info().parameters)
      if (parameter.kind == ParameterKind::color) names.push_back("'" + parameter.name + "'");
    throw Error(ErrorKind::input,
                fmt::format("{} add up to {:.4g}, more light than arrives",
                            fmt::join(names, " and "), sum.max_lane()),
                "make their sum at most 1 in every channel",
                arguments.place_of(arguments.info().parameters.front().name));
  }
  return 1;
}

}  // namespace kaustik
