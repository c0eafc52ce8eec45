#include "kaustik/integrator/local_light.h"

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
      ambient_(SpectralValue::emission(arguments.color("ambient"))) {}

void LocalLight::add_to(CameraWalk& walk, Lobes lobes) const {
  walk.add_direct_light(0, 0, sampling_, rules_);
  if (!walk.wants_photon_light(Component::indirect)) return;
  const Spectrum ambient = ambient_.at(walk.wavelengths());
  if (ambient.is_zero()) return;
  // What a surface reflects of light that is the same from everywhere is its albedo.
  walk.add_photon_light(Component::indirect, ambient * walk.vertex().albedo(lobes));
}

}  // namespace kaustik
