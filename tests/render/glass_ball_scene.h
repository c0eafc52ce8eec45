#pragma once
// A glass ball over a floor: every component but media.

#include <memory>
#include <string>

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik::test {

/// As a picture of that many pixels a side.
inline std::string glass_ball_scene(int size) {
  return camera("0, -4, 2", "0, 0, 0.5", 45, size) + flat("rectangle", scale("3"), diffuse("0.5")) +
         sphere("0, 0, 0.6", 0.6, glass()) +
         flat("rectangle", scale("0.5") + rotate("1, 0, 0", 180) + translate("0, 0, 3"),
              area_light("9"));
}

/// With few photons, which such a picture has enough of.
inline std::unique_ptr<Integrator> quick_integrator(const TestScene& scene, const std::string& type,
                                                    std::string parameters = "") {
  if (type == "photonmap")
    parameters +=
        set("global_photons", 2000) + set("caustic_photons", 2000) + set("cache_samples", 16);
  return scene.integrator(type, parameters);
}

}  // namespace kaustik::test
