#include "kaustik/photon/irradiance_map.h"

#include <atomic>
#include <optional>

#include "kaustik/base/parallel.h"

namespace kaustik {
namespace {

/// Places that are asked about where nearer ones are hidden.
constexpr int most_asked = 8;

/// The i-th point of a sequence that fills [0, 1) evenly (van der Corput 1935).
float radical_inverse(uint32_t i) {
  i = (i & 0x55555555u) << 1 | (i >> 1 & 0x55555555u);
  i = (i & 0x33333333u) << 2 | (i >> 2 & 0x33333333u);
  i = (i & 0x0f0f0f0fu) << 4 | (i >> 4 & 0x0f0f0f0fu);
  i = (i & 0x00ff00ffu) << 8 | (i >> 8 & 0x00ff00ffu);
  i = i << 16 | i >> 16;
  return float(i >> 8) * 0x1p-24f;
}

}  // namespace

IrradianceMap::IrradianceMap(const PhotonMap& map, const std::vector<SurfaceSide>& places,
                             const EstimateSettings& settings, const Scene* scene,
                             const std::stop_token& stop) {
  if (map.empty() || settings.neighbors <= 0) return;
  maximum_radius_ = settings.maximum_radius;
  std::vector<Vec3f> positions(places.size());
  std::vector<Entry> entries(places.size());
  std::atomic<uint64_t> all_rays{0};
  parallel_blocks(places.size(), 256, [&](size_t begin, size_t end, size_t) {
    uint64_t block_rays = 0;
    Scratch scratch;
    for (size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      positions[i] = places[i].position;
      PhotonVisibility visibility;
      std::optional<SurfaceSight> sight;
      if (scene)
        visibility = {&sight.emplace(*scene, positions[i], SurfaceSight::no_shape, block_rays),
                      radical_inverse(uint32_t(i))};
      const DensityEstimate estimate =
          map.irradiance(positions[i], places[i].side.unpack(), settings, scratch, visibility);
      entries[i].irradiance = estimate.value;
      entries[i].side = places[i].side;
    }
    all_rays.fetch_add(block_rays, std::memory_order_relaxed);
  });
  rays_ = all_rays;
  if (stop.stop_requested()) return;
  tree_ = {std::move(positions), std::move(entries), stop};
}

bool IrradianceMap::lookup(const Vec3f& position, const Vec3f& side, Spectrum& irradiance,
                           Scratch& scratch, const SurfaceSight* sight) const {
  if (empty()) return false;
  const auto borrowed = scratch.borrow<SidedTree<Entry>::Neighbors>();
  SidedTree<Entry>::Neighbors& neighbors = *borrowed;
  const auto take = [&](size_t i) {
    const uint32_t index = neighbors.index(i);
    const Entry& entry = tree_.tree().data(index);
    if (sight && !sight->sees(side, tree_.tree().key(index), entry.side.unpack())) return false;
    irradiance = entry.irradiance.spectrum();
    return true;
  };
  tree_.nearest(position, side, false, 1, maximum_radius_, neighbors);
  if (neighbors.empty()) return false;
  if (take(0)) return true;
  tree_.nearest(position, side, false, most_asked, maximum_radius_, neighbors);
  neighbors.sort();
  for (size_t i = 1; i < neighbors.size(); ++i)
    if (take(i)) return true;
  return false;
}

}  // namespace kaustik
