#include "kaustik/photon/photon_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <tuple>

namespace kaustik {
namespace {

struct Photons {
  std::vector<Vec3f> positions;
  std::vector<Photon> photons;

  void append(const PhotonMap& map) {
    for (uint32_t i = 0; i < map.size(); ++i) {
      positions.push_back(map.tree().key(i));
      photons.push_back(map.tree().data(i));
    }
  }
  bool before(uint32_t a, uint32_t b) const {
    const Vec3f &p = positions[a], &q = positions[b];
    const auto left = std::tie(p.x, p.y, p.z), right = std::tie(q.x, q.y, q.z);
    if (left != right) return left < right;
    return std::memcmp(&photons[a], &photons[b], sizeof(Photon)) < 0;
  }
  PhotonMap sorted_map() const {
    std::vector<uint32_t> order(photons.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), [this](uint32_t a, uint32_t b) { return before(a, b); });
    Photons sorted;
    sorted.positions.reserve(order.size());
    sorted.photons.reserve(order.size());
    for (const uint32_t i : order) {
      sorted.positions.push_back(positions[i]);
      sorted.photons.push_back(photons[i]);
    }
    return {std::move(sorted.positions), std::move(sorted.photons)};
  }
};

PhotonMap sorted(const PhotonMap& map) {
  Photons photons;
  photons.append(map);
  return photons.sorted_map();
}

void add_report(const MapReport& part, MapReport& whole) {
  whole.rays += part.rays;
  whole.target_count = part.target_count;
  whole.lights.resize(part.lights.size());
  for (size_t i = 0; i < part.lights.size(); ++i) whole.lights[i].add(part.lights[i]);
}

auto settings_key(const LightPassSettings& s) {
  return std::make_tuple(s.global_photons, s.caustic_photons, s.maximum_events, s.traced,
                         s.reradiate, s.aim, s.target_budget, s.part.count);
}

void check(std::span<const StoredPhotons> parts) {
  const auto refuse = [](const std::string& message, const std::string& remedy) {
    throw Error(ErrorKind::input, message, remedy);
  };
  if (parts.empty()) refuse("there is no photon map to put together", "give the parts of a pass");
  const StoredPhotons& first = parts.front();
  const uint32_t count = first.settings.part.count;
  std::vector<bool> found(count);
  for (const StoredPhotons& part : parts) {
    if (!part.fingerprint.matches(first.fingerprint))
      refuse("the photon maps are of different scenes: " + first.scene + " and " + part.scene,
             "trace all parts from the same scene");
    if (part.wavelengths != first.wavelengths)
      refuse("the photon maps were traced at different wavelengths",
             "trace all parts at the same ones");
    if (part.seed != first.seed || settings_key(part.settings) != settings_key(first.settings))
      refuse("the photon maps were traced with different seeds or settings",
             "trace all parts with the same seed and settings, and the same number of parts");
    const uint32_t index = part.settings.part.index;
    if (found[index])
      refuse(fmt::format("part {} of {} comes twice", index + 1, count), "give each part once");
    found[index] = true;
  }
  for (uint32_t i = 0; i < count; ++i)
    if (!found[i])
      refuse(fmt::format("part {} of {} is missing", i + 1, count),
             fmt::format("trace part {} of {}, and give all", i + 1, count));
}

}  // namespace

void sort_photons(PhotonMaps& maps) {
  maps.global = sorted(maps.global);
  maps.caustic = sorted(maps.caustic);
}

StoredPhotons merged_photons(std::span<const StoredPhotons> parts) {
  check(parts);
  // In the order of their numbers, so that the sums of flux are the same however they are given.
  std::vector<const StoredPhotons*> in_order(parts.size());
  for (const StoredPhotons& part : parts) in_order[part.settings.part.index] = &part;
  StoredPhotons whole;
  whole.scene = parts.front().scene;
  whole.fingerprint = parts.front().fingerprint;
  whole.seed = parts.front().seed;
  whole.wavelengths = parts.front().wavelengths;
  whole.settings = parts.front().settings;
  whole.settings.part = {};
  Photons global, caustic;
  for (const StoredPhotons* part : in_order) {
    global.append(part->maps.global);
    caustic.append(part->maps.caustic);
    add_report(part->maps.global_report, whole.maps.global_report);
    add_report(part->maps.caustic_report, whole.maps.caustic_report);
  }
  whole.maps.global = global.sorted_map();
  whole.maps.caustic = caustic.sorted_map();
  return whole;
}

}  // namespace kaustik
