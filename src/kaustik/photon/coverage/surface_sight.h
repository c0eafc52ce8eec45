#pragma once
#include "kaustik/photon/coverage/clear_disk.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

/// Whether something opaque stands between a point of a surface and what lies near it on the same
/// surface: light there is light here only if nothing does. What light passes through hides
/// nothing, but for the point's own shape. Thread-safe but for `rays`.
class SurfaceSight {
 public:
  /// Of a shape without a number.
  static constexpr uint32_t no_shape = 0xffffffffu;

  /// `position` lies on the shape of that number, at the center of a disk of which it is known what
  /// is clear. Counts its rays. Holds references.
  SurfaceSight(const Scene& scene, const Vec3f& position, uint32_t shape, uint64_t& rays,
               const ClearDisk& clear = {})
      : scene_(scene), position_(position), shape_(shape), rays_(rays), clear_(clear) {}

  /// Whether the points see one another along the surface or over it: straight from a little above
  /// the one to a little above the other, or by way of a point over the middle, as high as a
  /// quarter of the distance between them, for a surface that bends away is in its own way.
  /// `normal` and `other_normal`: unit, on the side of the light.
  bool sees(const Vec3f& normal, const Vec3f& other, const Vec3f& other_normal) const;

  /// Whether what stands on the way of a ray as far as t_max hides nothing.
  bool is_free(const Ray& ray) const;

 private:
  const Scene& scene_;
  const Vec3f position_;
  const uint32_t shape_;
  uint64_t& rays_;
  const ClearDisk clear_;
};

}  // namespace kaustik
