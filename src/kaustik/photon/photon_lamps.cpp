#include "kaustik/photon/photon_lamps.h"

#include <algorithm>

namespace kaustik {
namespace {

std::vector<uint64_t> ends_of(const MapReport& report) {
  std::vector<uint64_t> ends;
  ends.reserve(report.lights.size());
  uint64_t end = 0;
  for (const LightCounts& light : report.lights) ends.push_back(end += light.emitted);
  return ends;
}

}  // namespace

PhotonLamps::PhotonLamps(const LightPassSettings& settings, const PhotonMaps& maps)
    : first_caustic_(settings.global_photons),
      global_(ends_of(maps.global_report)),
      caustic_(ends_of(maps.caustic_report)) {}

uint32_t PhotonLamps::of_path(uint32_t path) const {
  const bool is_caustic = path >= first_caustic_;
  const std::vector<uint64_t>& ends = is_caustic ? caustic_ : global_;
  const uint64_t number = is_caustic ? path - first_caustic_ : path;
  const auto lamp = std::upper_bound(ends.begin(), ends.end(), number);
  return lamp == ends.end() ? unknown : uint32_t(lamp - ends.begin());
}

}  // namespace kaustik
