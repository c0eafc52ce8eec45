#pragma once
#include <cmath>
#include <cstdint>

#include "kaustik/base/stored_spectrum.h"
#include "kaustik/base/to_integer.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Halves away from zero, as std::lround does, but inline; within ±`most`.
inline int nearest_integer(float x, int most) {
  return to_integer(x + std::copysign(0.5f, x), -most, most);
}

/// A unit vector in 3 × 8 bits, exact enough to tell half spaces apart.
class CoarseNormal {
 public:
  CoarseNormal() = default;
  explicit CoarseNormal(const Vec3f& n)
      : x_(int8_t(nearest_integer(n.x * 127, 127))),
        y_(int8_t(nearest_integer(n.y * 127, 127))),
        z_(int8_t(nearest_integer(n.z * 127, 127))) {}
  /// Dot product, times 127.
  float dot(const Vec3f& v) const { return float(x_) * v.x + float(y_) * v.y + float(z_) * v.z; }
  /// About 127: how long it is in the units of dot(). Over that cosines are off by 0.005 × sine.
  float length() const { return std::sqrt(float(x_ * x_ + y_ * y_ + z_ * z_)); }
  int8_t x() const { return x_; }
  int8_t y() const { return y_; }
  int8_t z() const { return z_; }
  Vec3f unpack() const { return normalize({float(x_), float(y_), float(z_)}); }
  bool same_side(const CoarseNormal& o) const { return x_ * o.x_ + y_ * o.y_ + z_ * o.z_ > 0; }

 private:
  int8_t x_ = 0, y_ = 0, z_ = 0;
};

/// A unit vector in 2 × 16 bits by the octahedral map (Cigolle et al. 2014); error below 1e-4.
class PackedDirection {
 public:
  PackedDirection() = default;
  explicit PackedDirection(const Vec3f& d) {
    const float scale = 1.0f / (std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z));
    float x = d.x * scale, y = d.y * scale;
    if (d.z < 0) {
      const float folded = (1 - std::fabs(y)) * std::copysign(1.0f, x);
      y = (1 - std::fabs(x)) * std::copysign(1.0f, y);
      x = folded;
    }
    x_ = int16_t(nearest_integer(x * 32767, 32767));
    y_ = int16_t(nearest_integer(y * 32767, 32767));
  }
  Vec3f unpack() const {
    float x = float(x_) / 32767, y = float(y_) / 32767;
    const float z = 1 - std::fabs(x) - std::fabs(y);
    if (z < 0) {
      const float folded = (1 - std::fabs(y)) * std::copysign(1.0f, x);
      y = (1 - std::fabs(x)) * std::copysign(1.0f, y);
      x = folded;
    }
    return normalize({x, y, z});
  }

 private:
  int16_t x_ = 0, y_ = 0;
};

/// Flux that arrived at a surface; its position is the key in the photon map. 32 bytes.
struct Photon {
  StoredSpectrum flux;        ///< W that arrives, before any attenuation
  float distance = 0;         ///< to the origin, m
  PackedDirection direction;  ///< toward the origin
  CoarseNormal side;          ///< geometric normal on the side on which it arrived
  uint8_t on_front = 1;       ///< whether that side is the side of the surface's own normal
  /// Number of its light path in the pass: photons of one path may lie in a cluster.
  uint32_t path = 0;

  /// Unit direction toward the origin from a point `at` near the photon's position: what
  /// separates the two is taken into account.
  Vec3f incident_direction(const Vec3f& position, const Vec3f& at) const {
    const Vec3f d = direction.unpack();
    if (!std::isfinite(distance)) return d;
    return normalize(position + d * distance - at);
  }
};
static_assert(sizeof(Photon) == 32);

}  // namespace kaustik
