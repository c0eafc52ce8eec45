#pragma once
// The scenes that ship, for benchmarks.
#include "kaustik/loader/scene_format.h"
#include "kaustik/photon/light_pass.h"
#include "kaustik/scene/scene.h"

namespace kaustik::bench {

inline Description load_shipped(const std::string& name) {
  return load_scene(std::string(KAUSTIK_SOURCE_DIR) + "/scenes/" + name + "/" + name + ".xml");
}

/// The caustic photons of the metal ring: at least `count` of them.
inline PhotonMap ring_caustic(size_t count) {
  const auto scene = build_scene(load_shipped("metal_ring"));
  LightPassSettings settings;
  settings.caustic_photons = uint32_t(count);
  for (;;) {
    PhotonMaps maps = LightPass(*scene, settings, 1).trace(1, 0);
    if (maps.caustic.size() >= count || settings.caustic_photons > (1u << 30))
      return std::move(maps.caustic);
    settings.caustic_photons *= 2;
  }
}

}  // namespace kaustik::bench
