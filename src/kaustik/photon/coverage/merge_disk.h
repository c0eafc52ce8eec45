#pragma once
#include <algorithm>
#include <optional>

#include "kaustik/base/sampler.h"
#include "kaustik/photon/coverage/disk_kernel.h"
#include "kaustik/photon/photon.h"
#include "kaustik/transport/vertex.h"

namespace kaustik {

/// The disk around a vertex within which vertices of light paths merge with it.
class MergeDisk {
 public:
  /// `vertex` must outlive this. What lies farther than `flatness`, m, from the plane does not
  /// count where that is less than usual.
  MergeDisk(const SurfaceVertex& vertex, float radius, float flatness = infinity)
      : vertex_(vertex),
        ng_(vertex.point().ng),
        radius_(radius),
        depth_(std::min(flatness_ * radius, flatness)) {}

  /// How much light counts at a point of a surface, that far from the vertex, with normal `side`:
  /// as much as its surface covers of the tangent plane, the cosine between the two, for relief has
  /// more surface than plane; 0 where it lies too far from the plane or stands across.
  float share(const Vec3f& offset, const CoarseNormal& side) const {
    if (std::fabs(dot(offset, ng_)) > flatness()) return 0;
    const float cosine = std::fabs(side.dot(ng_)) / side.length();
    return cosine > least_cosine_ ? std::min(cosine, 1.0f) : 0.0f;
  }
  /// A point counts in disks that are at least so many times as wide as it is far from the plane.
  static constexpr float inverse_flatness() { return 1 / flatness_; }
  const SurfaceVertex& vertex() const { return vertex_; }
  float radius() const { return radius_; }
  /// The geometric normal on the side that is seen.
  Vec3f side() const { return vertex_.on_front() ? ng_ : -ng_; }
  /// Whether light counts that arrives on either side: then surfaces whose own normal is turned
  /// away do not count, else the side on which light arrives tells.
  bool both_sides() const { return vertex_.transmits(); }
  /// Light vertices are kept at surfaces with any of these.
  static constexpr Lobes keeping() { return Lobes::diffuse | Lobes::glossy; }
  /// Farthest that something may lie from the plane, m …
  float flatness() const { return depth_; }
  /// … and the least cosine between its normal and the vertex's.
  static float least_cosine() { return least_cosine_; }

 private:
  static constexpr float flatness_ = 0.3f;      ///< share of the radius
  static constexpr float least_cosine_ = 0.5f;  ///< of the normals

  const SurfaceVertex& vertex_;
  const Vec3f ng_;
  float radius_;
  float depth_;  ///< flatness()
};

/// What is reached of the disks around a vertex: from a height over the vertex along the tangent
/// plane, and from there straight down. Light vertices merge where they are reached, so that none
/// comes from behind what is opaque; and their light is divided by the share of the disk where a
/// surface on which light vertices merge is reached, or it would be too dark.
class DiskCoverage {
 public:
  /// For disks up to the size of `widest`, whose vertex must outlive this. Counts its rays; one is
  /// traced here, but where it is known that the disk is clear (DiskBounds).
  DiskCoverage(const Scene& scene, const MergeDisk& widest, uint64_t& rays,
               float clear_flatness = 0);
  /// No ray sets out from higher over the vertex, m.
  static float highest(float radius);

  /// What hangs so low over the vertex shades it as sharply as that: wider disks, of those that
  /// this was made for, would blur it, m.
  float clear_radius() const;

  /// Whether a light vertex at a point of the tangent plane, `distance` away in the direction
  /// `angle`, would merge in the disk of that radius, as far as what is reached there tells …
  bool holds(float radius, float distance, float angle) const {
    return merging_at(radius, distance, angle).has_value();
  }
  /// … and how much it would count, relative to one in the plane: less than 1 where the surface
  /// lies off the plane, for the kernel goes by distances in space.
  float held(float radius, float distance, float angle) const;
  /// Whether the light vertex that lies so far from the vertex is reached.
  bool reaches(float radius, const Vec3f& offset) const;
  /// An estimate of one over the share that is covered of what edges leave of the disk, by the
  /// weights 1 − distance²/radius² of the kernel; unbiased but for shares of a few percent.
  float inverse_share(float radius, const DiskEdges& edges, Sampler numbers) const;

  /// What is met first of what hides what lies behind, at that height over the plane, on the way in
  /// the direction `angle`.
  std::optional<SurfacePoint> obstacle(float height, float angle, float reach) const;
  /// The same of what refracts: light behind it has come another way.
  std::optional<SurfacePoint> interface(float height, float angle, float reach) const;
  /// What is met first from that height over a point of the plane down to that depth below it.
  std::optional<SurfacePoint> surface_at(float height, float depth, float distance,
                                         float angle) const;
  /// Whether light vertices at a point of a surface merge, as far as its normal tells.
  bool merges_at(const SurfacePoint& point) const;

 private:
  Vec3f across(float angle) const {
    return frame_.x * std::cos(angle) + frame_.y * std::sin(angle);
  }
  /// A height over the plane, `wanted` or less, at which nothing hangs over the vertex.
  float free_height(float wanted) const { return wanted < free_ ? wanted : 0.5f * free_; }
  /// What light passes through hides nothing, but for the vertex's own shape.
  bool hides(const SurfacePoint& point) const;
  template <typename Stops>
  std::optional<SurfacePoint> first_on_way(float height, const Vec3f& direction, float reach,
                                           const Stops& stops) const;
  std::optional<SurfacePoint> merging_at(float radius, float distance, float angle) const;
  bool is_way_free(float height, const Vec3f& direction, float distance) const;
  /// How far away the ray meets a point where stops(point) holds; infinite: nowhere.
  template <typename Stops>
  float distance_to(const Ray& ray, const Stops& stops) const;

  const Scene& scene_;
  const SurfaceVertex& vertex_;
  const Frame frame_;  ///< z: the side that is seen
  const bool both_sides_;
  uint64_t& rays_;
  const float clear_flatness_;  ///< m; 0: something may stand in the way
  float free_ = infinity;       ///< height over the vertex up to which nothing hangs, m
};

}  // namespace kaustik
