#pragma once
#include "kaustik/geometry/shape.h"
#include "kaustik/light/emission_pattern.h"
#include "kaustik/light/light_tree.h"

namespace kaustik {

/// Chooses the triangles of a shining mesh by what each may give to a point: its area by its
/// cosines over its squared distance, by a tree over them (see LightTree), then a point on the
/// triangle uniformly by area. Triangles that turn their back to the point are left out. What a
/// pattern makes of a triangle's radiance counts as well, in the mean.
///
/// At deeper recursion levels (LightQuery::level) the tree is asked less: from level 1 on, only its
/// upper nodes are told apart by the point, and below them triangles are chosen by area alone, as
/// if the mesh had been tessellated more coarsely.
class MeshFaces {
 public:
  /// `shape` has a mesh, and must outlive this. `two_sided`: both faces shine. `pattern` may be
  /// null: all shine alike.
  MeshFaces(const Shape& shape, bool two_sided, const EmissionPattern* pattern);

  /// `pdf_solid_angle` is zero if nothing was found.
  ShapeSample sample_toward(const LightQuery& query, const Vec2f& u, float& pdf_solid_angle) const;
  /// Density of sample_toward for a point on the mesh.
  float pdf_toward(const LightQuery& query, const SurfacePoint& point) const;

  /// Fewer triangles than this are as well sampled by area.
  static constexpr size_t least_triangles = 3;

 private:
  /// Density by area of the points of a triangle that is chosen, over the density by area of the
  /// whole shape.
  float density_ratio(uint32_t triangle, float probability) const {
    return probability * inverse_share_[triangle];
  }

  const Shape& shape_;
  LightTree tree_;
  std::vector<float> inverse_share_;  ///< area of the shape over that of the triangle
};

}  // namespace kaustik
