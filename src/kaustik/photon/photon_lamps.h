#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/photon/light_pass.h"

namespace kaustik {

/// Which lamp each photon of a whole pass comes from. Maps do not keep that, for a photon's memory
/// is precious. But light paths are numbered lamp by lamp, first those for the global map, and the
/// reports tell how many each lamp began.
class PhotonLamps {
 public:
  /// Of maps of a whole pass, not of a part of one.
  PhotonLamps(const LightPassSettings& settings, const PhotonMaps& maps);

  /// Index into Scene::lights() of a Photon's `path`; `unknown` for numbers of no path.
  uint32_t of_path(uint32_t path) const;
  static constexpr uint32_t unknown = 0xFFFFFFFF;

 private:
  uint32_t first_caustic_;
  /// The ends of the lamps' numbers; those for the caustic map count from its first one.
  std::vector<uint64_t> global_, caustic_;
};

}  // namespace kaustik
