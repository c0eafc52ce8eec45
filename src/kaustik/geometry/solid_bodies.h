#pragma once
#include <memory>
#include <span>
#include <vector>

#include "kaustik/geometry/body_part.h"
#include "kaustik/geometry/embree_scene.h"

namespace kaustik {

/// Solid bodies that overlap. Where two fill the same place the one that stands earlier wins: of
/// the other neither inside nor surface is there (Schmidt and Budge, "Simple Nested Dielectrics in
/// Ray Traced Images", Journal of Graphics Tools 7(2), 2002). They follow a path through its stack
/// of bodies. Here the point alone is asked, by a ray to each body that may contain it: the answer
/// is the same for every path, so that all techniques agree on it, and nothing is carried along.
class SolidBodies {
 public:
  /// `bodies`: indices into `shapes`, the ones that win first. A body contains what sees the back
  /// of its surface, so that it should be closed, with normals that point outward.
  SolidBodies(const std::shared_ptr<EmbreeDevice>& device,
              const std::vector<std::shared_ptr<const Shape>>& shapes,
              std::span<const uint32_t> bodies);

  /// All parts of surfaces that there may be beside those in the open.
  const std::vector<BodyPart>& parts() const { return parts_; }
  /// The part in which a point of a shape lies, as an index into parts(); −1: in the open, or the
  /// shape is no body.
  int part_at(const Vec3f& position, uint32_t shape) const;

 private:
  struct Neighbour {
    size_t body;
    int part;
  };
  struct Body {
    uint32_t shape = 0;
    const Shape* geometry = nullptr;
    std::unique_ptr<const EmbreeScene> structure;  ///< of a mesh
    Bounds3f bounds;
    std::vector<Neighbour> neighbours;  ///< that it overlaps, those that win first
  };
  static bool contains(const Body& body, const Vec3f& position);

  std::vector<Body> bodies_;
  std::vector<int> body_of_shape_;  ///< −1: none
  std::vector<BodyPart> parts_;
};

}  // namespace kaustik
