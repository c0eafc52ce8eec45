#include "kaustik/transport/integrator_parameters.h"

#include <fmt/format.h>

#include <algorithm>

namespace kaustik {
namespace {

std::vector<std::string> valid_components() {
  return {component_names.begin(), component_names.end()};
}

}  // namespace

Parameter components_parameter() {
  return text_parameter("components", "all",
                        "Components to compute, separated by commas: emission, direct, caustic, "
                        "indirect, specular, volume, or all.");
}

ComponentSet read_components(const Arguments& arguments) {
  const std::string& text = arguments.text("components");
  if (text == "all") return ComponentSet::all();
  ComponentSet set;
  for (size_t start = 0; start <= text.size();) {
    const size_t end = std::min(text.find(',', start), text.size());
    std::string name = text.substr(start, end - start);
    std::erase(name, ' ');
    bool known = false;
    for (int i = 0; i < component_count; ++i)
      if (name == component_names[size_t(i)]) {
        set.add(Component(i));
        known = true;
      }
    if (!known)
      throw Error(ErrorKind::input, fmt::format("'components' names '{}'", name),
                  suggest(name, valid_components()), arguments.place_of("components"));
    start = end + 1;
  }
  return set;
}

Parameter max_depth_parameter() {
  return integer_parameter(
             "max_depth", -1,
             "Longest path in segments (1: only lamps, 2: direct light); -1: no limit.")
      .range(-1, 1 << 20);
}

Parameter rr_depth_parameter() {
  return integer_parameter("rr_depth", 5, "Scattering events before Russian roulette starts.")
      .range(1, 1 << 20);
}

Parameter hide_emitters_parameter() {
  return boolean_parameter(
      "hide_emitters", false,
      "Hides all lamps and surroundings from the camera, as if each had 'visible' = false.");
}

int read_maximum_events(const Arguments& arguments) {
  const auto depth = arguments.integer("max_depth");
  return depth < 0 ? any_number_of_events : std::max(0, int(depth) - 1);
}

}  // namespace kaustik
