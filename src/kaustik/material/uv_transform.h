#pragma once
#include "kaustik/base/transform.h"

namespace kaustik {

/// The part of a 4×4 transform that acts on texture coordinates: x, y and their offset.
class UvTransform {
 public:
  explicit UvTransform(const Transform& t)
      : u_(float(t.at(0, 0)), float(t.at(0, 1)), float(t.at(0, 3))),
        v_(float(t.at(1, 0)), float(t.at(1, 1)), float(t.at(1, 3))) {}

  Vec2f operator()(const Vec2f& uv) const {
    return {u_.x * uv.x + u_.y * uv.y + u_.z, v_.x * uv.x + v_.y * uv.y + v_.z};
  }
  /// Of an extent along u and v.
  Vec2f width(const Vec2f& w) const {
    return {std::hypot(u_.x * w.x, u_.y * w.y), std::hypot(v_.x * w.x, v_.y * w.y)};
  }
  /// Of a gradient by the transformed coordinates, back to one by the original ones.
  Vec2f gradient(const Vec2f& g) const {
    return {u_.x * g.x + v_.x * g.y, u_.y * g.x + v_.y * g.y};
  }

 private:
  Vec3f u_, v_;  ///< rows
};

}  // namespace kaustik
