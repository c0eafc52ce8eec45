#pragma once
#include <algorithm>

#include "kaustik/photon/photon.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// The disk around a vertex within which vertices of light paths merge with it.
class MergeDisk {
 public:
  MergeDisk(const Scene& scene, const SurfaceVertex& vertex, float radius)
      : scene_(scene),
        ng_(vertex.point().ng),
        frame_(vertex.on_front() ? ng_ : -ng_),
        center_(vertex.position()),
        shape_(vertex.point().shape),
        radius_(radius),
        height_(0.25f * radius) {}

  /// Whether a point of a surface counts, that far from the vertex, with normal `side`: it lies
  /// near enough to the tangent plane, and its surface does not stand across.
  bool counts(const Vec3f& offset, const CoarseNormal& side) const {
    return std::fabs(dot(offset, ng_)) <= flatness() &&
           std::fabs(side.dot(ng_)) > least_cosine_ * 127;
  }
  /// Square of the radius of the smallest disk around the vertex in which counts() holds for the
  /// point, as far as its normal allows, m².
  float least_radius_sq(const Vec3f& offset) const {
    return std::max(length_sq(offset), sqr(dot(offset, ng_) / flatness_));
  }
  /// Whether the surface goes on, and light may fall on it, at a point of the tangent plane
  /// `distance` away in the direction `angle`. A few rays, which are counted.
  bool is_covered(float distance, float angle, uint64_t& rays) const;
  /// Where something hangs closely over the vertex, is_covered() has to look from below it: one
  /// ray, which is counted. Returns whether that changes its answers.
  bool look_from_below(uint64_t& rays);
  const Vec3f& side() const { return frame_.z; }
  /// Farthest that something may lie from the plane, m …
  float flatness() const { return flatness_ * radius_; }
  /// … and the least cosine between its normal and the vertex's.
  float least_cosine() const { return least_cosine_; }

 private:
  bool meets(Ray ray, Hit& hit, uint64_t& rays) const;

  static constexpr float flatness_ = 0.3f;      ///< share of the radius
  static constexpr float least_cosine_ = 0.5f;  ///< of the normals

  const Scene& scene_;
  const Vec3f ng_;
  const Frame frame_;
  const Vec3f center_;
  const uint32_t shape_;
  float radius_;
  float height_;  ///< over the tangent plane, from where it is looked for the surface, m
};

}  // namespace kaustik
