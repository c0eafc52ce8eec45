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

 private:
  Vec3f u_, v_;  ///< rows
};

}  // namespace kaustik
