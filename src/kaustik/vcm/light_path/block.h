#pragma once
#include <stop_token>

#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

/// What a block of light paths leaves, path by path.
struct LightBlock {
  std::vector<PathVertex> vertices;
  std::vector<Vec3f> positions;       ///< of the following, which may be merged
  std::vector<LightVertexData> data;  ///< `path` counts within the block, here and below
  std::vector<ConnectibleVertex> connectible;
  std::vector<DiscHierarchy::Disc> discs;  ///< of the following
  std::vector<MergeableMediumVertex> in_media;
  std::vector<GaugeVertex> at_gauges;
  std::vector<LightPathBeginning> beginnings;
  std::vector<LightScattering> scatterings;
  uint64_t rays = 0, splats = 0;
};

/// The vertices of all blocks in their order, of which nothing is left. How many paths there are is
/// for the caller to say. `gauges`: so many; null disks: none. Where `stop` is requested it
/// may be nothing, or not in order for searches.
LightVertices join(std::vector<LightBlock>& blocks, size_t gauges, const GaugeDisks* disks,
                   const std::stop_token& stop);

}  // namespace kaustik
