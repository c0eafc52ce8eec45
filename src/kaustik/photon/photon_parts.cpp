#include "kaustik/photon/photon_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "kaustik/photon/photon_tree_builder.h"

namespace kaustik {
namespace {

PhotonBounds bounds_of(const PhotonMap& map) {
  PhotonBounds bounds;
  if (map.empty()) return bounds;
  // The last node is above all others.
  const KdBuckets::Node& top = map.tree().buckets().nodes().back();
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lower[axis] = *std::ranges::min_element(top.lower[axis]);
    bounds.upper[axis] = *std::ranges::max_element(top.upper[axis]);
  }
  return bounds;
}

PhotonBounds bounds_of(const std::vector<const PhotonMap*>& maps) {
  PhotonBounds bounds;
  for (const PhotonMap* map : maps) bounds.add(bounds_of(*map));
  return bounds;
}

constexpr size_t most_photons = KdTree<3, Vec3f, Photon>::max_size;

size_t count_of(const std::vector<const PhotonMap*>& maps) {
  size_t count = 0;
  for (const PhotonMap* map : maps) count += map->size();
  if (count > most_photons)
    throw Error(ErrorKind::input,
                fmt::format("the parts have {} photons for one map, which holds {} at most", count,
                            most_photons),
                "trace fewer photons, or render with passes of their own");
  return count;
}

/// Puts the photons of all in order.
class GatheredPhotons {
 public:
  /// `added` is called with how many there are so far.
  GatheredPhotons(const std::vector<const PhotonMap*>& maps, const SortMemory& memory,
                  const std::function<void(size_t)>& added = {})
      : sort_(bounds_of(maps), memory), count_(count_of(maps)) {
    size_t count = 0;
    for (const PhotonMap* map : maps)
      for (uint32_t i = 0; i < map->size(); ++i) {
        sort_.add({map->tree().key(i), map->tree().data(i)});
        if (++count % told_every == 0 && added) added(count);
      }
  }
  /// Both can be asked for once.
  PhotonMap map() { return BuiltPhotonTree(sort_, count_).map(); }
  float build(const TakeItems& take) { return build_photon_tree(sort_, count_, take); }

 private:
  static constexpr size_t told_every = size_t{1} << 16;
  PhotonSort sort_;
  size_t count_;
};

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

/// Which of the two maps.
using MapOf = PhotonMap PhotonMaps::*;
constexpr std::array<MapOf, 2> both_maps{&PhotonMaps::global, &PhotonMaps::caustic};

/// All of a whole pass but its maps, and its parts in the order of their numbers, so that sums of
/// flux are the same however they are given.
struct Whole {
  explicit Whole(std::span<const StoredPhotons> parts) : in_order(parts.size()) {
    check(parts);
    for (const StoredPhotons& part : parts) in_order[part.settings.part.index] = &part;
    const StoredPhotons& first = parts.front();
    photons = {first.scene, first.fingerprint, first.seed, first.wavelengths, first.settings, {}};
    photons.settings.part = {};
    for (const StoredPhotons* part : in_order) {
      add_report(part->maps.global_report, photons.maps.global_report);
      add_report(part->maps.caustic_report, photons.maps.caustic_report);
    }
  }
  std::vector<const PhotonMap*> maps(MapOf of) const {
    std::vector<const PhotonMap*> all;
    for (const StoredPhotons* part : in_order) all.push_back(&(part->maps.*of));
    return all;
  }

  std::vector<const StoredPhotons*> in_order;
  StoredPhotons photons;
};

}  // namespace

void sort_photons(PhotonMaps& maps) {
  for (const MapOf of : both_maps) maps.*of = GatheredPhotons({&(maps.*of)}, {}).map();
}

StoredPhotons merged_photons(std::span<const StoredPhotons> parts) {
  Whole whole(parts);
  for (const MapOf of : both_maps)
    whole.photons.maps.*of = GatheredPhotons(whole.maps(of), {}).map();
  return std::move(whole.photons);
}

PhotonCounts write_merged_photons(const std::string& path, std::span<const StoredPhotons> parts,
                                  const ProgressFunction& progress, size_t photons_in_memory) {
  const Whole whole(parts);
  PhotonCounts counts;
  for (size_t i = 0; i < both_maps.size(); ++i) counts[i] = count_of(whole.maps(both_maps[i]));
  // A photon is read and put in order, then it comes into the tree, then into the checksum.
  const auto steps = double(std::max<size_t>(3 * (counts[0] + counts[1]), 1));
  size_t before = 0;
  const auto tell = [&](size_t more) {
    if (progress) progress(double(before + more) / steps);
  };
  PhotonFileWriter writer(path, whole.photons, counts);
  for (size_t i = 0; i < both_maps.size(); ++i) {
    GatheredPhotons photons(whole.maps(both_maps[i]), {photons_in_memory, path}, tell);
    before += counts[i];
    const float mean_flux =
        photons.build([&](TreePart part, uint64_t first, std::span<const uint8_t> items) {
          writer.put(i, part, first, items);
          if (part == TreePart::photons) tell(size_t(first));
        });
    before += counts[i];
    writer.set_mean_flux(i, mean_flux);
  }
  writer.finish();
  return counts;
}

}  // namespace kaustik
