#include "kaustik/photon/photon_order.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "kaustik/base/to_integer.h"

namespace kaustik {
namespace {

constexpr int bits_per_axis = 16;

/// Bit 3 i of the result is bit i of `x`.
uint64_t spread(uint64_t x) {
  x = (x | x << 16) & 0x0000ff0000ff;
  x = (x | x << 8) & 0x00f00f00f00f;
  x = (x | x << 4) & 0x0c30c30c30c3;
  return (x | x << 2) & 0x249249249249;
}

/// The number of a cube along the curve, from its coordinates.
uint64_t hilbert_number(std::array<uint32_t, 3> x) {
  constexpr uint32_t top = 1u << (bits_per_axis - 1);
  // From the largest cubes to the smallest: undo how the curve is turned in each.
  for (uint32_t bit = top; bit > 1; bit >>= 1) {
    const uint32_t below = bit - 1;
    for (uint32_t& of_axis : x) {
      if (of_axis & bit) {
        x[0] ^= below;
      } else {
        const uint32_t swapped = (x[0] ^ of_axis) & below;
        x[0] ^= swapped;
        of_axis ^= swapped;
      }
    }
  }
  // To Gray code.
  x[1] ^= x[0];
  x[2] ^= x[1];
  uint32_t turned = 0;
  for (uint32_t bit = top; bit > 1; bit >>= 1)
    if (x[2] & bit) turned ^= bit - 1;
  return spread(x[0] ^ turned) << 2 | spread(x[1] ^ turned) << 1 | spread(x[2] ^ turned);
}

}  // namespace

void PhotonBounds::add(const PhotonBounds& other) {
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = std::min(lower[axis], other.lower[axis]);
    upper[axis] = std::max(upper[axis], other.upper[axis]);
  }
}

PhotonOrder::PhotonOrder(const PhotonBounds& bounds) : lower_(bounds.lower) {
  if (bounds.empty()) return;
  const Vec3f size = bounds.upper - bounds.lower;
  const float longest = std::max({size.x, size.y, size.z});
  if (longest > 0) scale_ = float(1 << bits_per_axis) / longest;
}

uint64_t PhotonOrder::place_on_curve(const Vec3f& position) const {
  constexpr uint32_t last = (1u << bits_per_axis) - 1;
  std::array<uint32_t, 3> cube;
  for (int axis = 0; axis < 3; ++axis)
    cube[size_t(axis)] =
        to_integer<uint32_t>((position[axis] - lower_[axis]) * scale_, uint32_t(0), last);
  return hilbert_number(cube);
}

bool PhotonOrder::is_before(const PhotonRecord& a, const PhotonRecord& b) {
  if (a.coordinates != b.coordinates) return a.coordinates < b.coordinates;
  return std::memcmp(&a.photon, &b.photon, sizeof(Photon)) < 0;
}

}  // namespace kaustik
