#include "kaustik/photon/irradiance_map.h"

namespace kaustik {

IrradianceMap::IrradianceMap(const PhotonMap& map, const std::vector<SurfaceSide>& places,
                             const EstimateSettings& settings) {
  if (map.empty() || settings.neighbors <= 0) return;
  maximum_radius_ = settings.maximum_radius;
  std::vector<Vec3f> positions(places.size());
  std::vector<Entry> entries(places.size());
  parallel_blocks(places.size(), 256, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      positions[i] = places[i].position;
      const DensityEstimate estimate =
          map.irradiance(positions[i], places[i].side.unpack(), settings);
      for (int lane = 0; lane < Spectrum::lane_count; ++lane)
        entries[i].irradiance[size_t(lane)] = estimate.value[lane];
      entries[i].side = places[i].side;
    }
  });
  tree_ = {std::move(positions), std::move(entries)};
}

bool IrradianceMap::lookup(const Vec3f& position, const Vec3f& side, Spectrum& irradiance) const {
  if (empty()) return false;
  static thread_local SidedTree<Entry>::Neighbors neighbors;
  tree_.nearest(position, side, false, 1, maximum_radius_, neighbors);
  if (neighbors.empty()) return false;
  const Entry& entry = tree_.tree().data(neighbors.index(0));
  irradiance = {entry.irradiance[0], entry.irradiance[1], entry.irradiance[2], entry.irradiance[3]};
  return true;
}

}  // namespace kaustik
