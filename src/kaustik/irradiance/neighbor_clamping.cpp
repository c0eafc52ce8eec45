#include "kaustik/irradiance/neighbor_clamping.h"

namespace kaustik {

void NeighborClamping::add(const Vec3f& position, const Vec3f& normal, float distance) {
  const size_t lane = count_++ % 4;
  if (lane == 0) {
    blocks_.emplace_back();
    blocks_.back().distance = Lanes{} + infinity;  // unused lanes clamp nothing
  }
  Block& block = blocks_.back();
  for (int axis = 0; axis < 3; ++axis) {
    block.position[axis][lane] = position[axis];
    block.normal[axis][lane] = normal[axis];
  }
  block.distance[lane] = distance;
}

float NeighborClamping::clamped(const Vec3f& p, const Vec3f& n, float distance,
                                size_t first) const {
  for (size_t i = first / 4; i < blocks_.size(); ++i) {
    const Block& b = blocks_[i];
    const Lanes dx = p.x - b.position[0], dy = p.y - b.position[1], dz = p.z - b.position[2];
    const Lanes apart_sq = dx * dx + dy * dy + dz * dz;
    const Lanes cosine = n.x * b.normal[0] + n.y * b.normal[1] + n.z * b.normal[2];
    const Lanes room = distance - b.distance;
    const Mask clamps = (room > 0) & (apart_sq < room * room) & (cosine >= 0);
    for (int lane = 0; lane < 4; ++lane)
      if (clamps[lane] != 0)
        distance = std::min(distance, b.distance[lane] + std::sqrt(apart_sq[lane]));
  }
  return distance;
}

}  // namespace kaustik
