#include "kaustik/integrator/local_light.h"

#include "kaustik/base/color.h"

namespace kaustik {

std::vector<Parameter> LocalLight::parameters() {
  return {
      integer_parameter("light_samples", 1,
                        "Samples of direct light at a surface, shared among the lights by incident "
                        "flux; each has one at least.")
          .range(1, 4096),
      boolean_parameter("shadows", true,
                        "Light that another surface holds off is left out; without, lamps shine "
                        "through everything."),
      color_parameter("ambient", 0,
                      "Ambient light, in place of all that surfaces send one another: radiance "
                      "that comes evenly from everywhere.")
          .range(0, 1e30)
          .in("W/(sr m²)"),
  };
}

LocalLight::LocalLight(const Arguments& arguments)
    : sampling_{LightChoice::all, int(arguments.integer("light_samples"))},
      rules_{arguments.boolean("shadows"), true},
      ambient_(emission_spectrum(arguments.color("ambient"))) {}

void LocalLight::add_to(CameraWalk& walk, Lobes lobes) const {
  walk.add_direct_light(0, 0, sampling_, rules_);
  if (ambient_.is_zero() || !walk.wants_photon_light(Component::indirect)) return;
  // What a surface reflects of light that is the same from everywhere is its albedo.
  walk.add_photon_light(Component::indirect, ambient_ * walk.vertex().albedo(lobes));
}

}  // namespace kaustik
