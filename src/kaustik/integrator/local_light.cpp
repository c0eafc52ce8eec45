#include "kaustik/integrator/local_light.h"

namespace kaustik {

std::vector<Parameter> LocalLight::parameters() {
  return {
      integer_parameter("light_samples", 1,
                        "Samples of direct light at a surface. They are divided among the lights "
                        "by incident flux, at least one each.")
          .range(1, 4096),
      boolean_parameter("shadows", true,
                        "Surfaces cast shadows. If false, lamps shine through everything."),
      color_parameter(
          "ambient", 0,
          "Ambient light: uniform radiance from all directions, instead of interreflection.")
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
