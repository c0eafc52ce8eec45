#pragma once
#include <stop_token>
#include <string>
#include <vector>

#include "kaustik/photon/emission/emission.h"
#include "kaustik/photon/shadow_map.h"

namespace kaustik {

/// Surfaces that a ray is followed through: only rounding or a thicket passes this.
inline constexpr int most_surfaces = 4096;

/// What became of the rays of one light that make shadow photons.
struct ShadowCounts {
  uint64_t emitted = 0;            ///< rays that left the light
  uint64_t lit = 0, shadowed = 0;  ///< photons stored
};

struct ShadowReport {
  std::vector<ShadowCounts> lights;  ///< parallel to the scene's lights
  uint64_t rays = 0;                 ///< segments traced
  uint64_t cut = 0;                  ///< rays that were given up behind most_surfaces

  /// Whole sentences on lights that left no photons, and on rays that were given up.
  std::vector<std::string> warnings() const;
};

/// Shadow photons of a pass: `count` rays, shared among the lights by power, each followed straight
/// on through all surfaces until it leaves the scene (Jensen and Christensen 1995, Schregle 1998).
/// Photons are stored where sampled light can be reflected: not on surfaces that are only mirror or
/// clear glass, which throw shadows all the same. The same for any number of threads; once `stop`
/// is requested, only the rays that were finished by then: unusable.
ShadowMap trace_shadow_photons(const Scene& scene, uint32_t count, uint64_t seed, uint32_t pass,
                               std::stop_token stop, ShadowReport& report);

}  // namespace kaustik
