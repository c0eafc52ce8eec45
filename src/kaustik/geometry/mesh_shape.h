#pragma once
#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/geometry/shape.h"
#include "kaustik/geometry/spherical_rectangle.h"

namespace kaustik {

/// A shape that is a triangle mesh. Where the mesh has vertex normals, triangles whose winding
/// disagrees with them are turned round, so that the outside is where the normals point (Mitsuba
/// decides by the shading normal).
class MeshShape : public Shape {
 public:
  /// Sizes and indices of `mesh` must be consistent and its positions finite.
  explicit MeshShape(TriangleMesh mesh, std::vector<std::string> remarks = {});

  Bounds3f bounds() const override { return bounds_; }
  /// Found out when it is first asked for: only lamps are.
  float area() const override;
  const TriangleMesh* mesh() const override { return &mesh_; }
  /// What its file has that was left out, a sentence each.
  const std::vector<std::string>& remarks() const { return remarks_; }
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  UvDerivatives uv_derivatives(const SurfacePoint& at) const override;
  ShapeSample sample_area(const Vec2f& u) const override;
  std::optional<Vec2f> area_coordinates(const SurfacePoint& point) const override;
  /// A rectangle by its solid angle, where that is better.
  ShapeSample sample_toward(const Vec3f& reference, const Vec2f& u,
                            float& pdf_solid_angle) const override;
  float pdf_toward(const Vec3f& reference, const SurfacePoint& point) const override;
  TriangleMesh tessellate(int level) const override;
  std::vector<Bounds3f> bounding_boxes(int budget) const override;

 private:
  void build_distribution() const;
  /// The point of a rectangle at x, y in [−1, 1]².
  SurfacePoint rectangle_point(const Vec2f& at) const;

  TriangleMesh mesh_;
  std::vector<std::string> remarks_;
  Bounds3f bounds_;
  mutable std::atomic<float> area_{-1};  ///< negative: nobody has asked yet
  /// Of meshes that are one: two triangles that share the diagonal from the first vertex to the
  /// third, as the shape `rectangle` has them.
  std::optional<SphericalRectangle> rectangle_;
  mutable std::once_flag distribution_once_;
  mutable std::vector<double> cumulative_area_;  ///< up to and with each triangle, m²; only for
                                                 ///< meshes that are sampled
};

/// What a mesh file is turned into on its way to a MeshShape.
struct MeshOptions {
  Transform to_world;
  bool face_normals = false;     ///< drop vertex normals
  bool flip_normals = false;     ///< turn the surface inside out
  bool flip_tex_coords = false;  ///< v becomes 1 − v
  /// Makes the normals anew, see split_at_creases().
  std::optional<double> max_smooth_angle = {};
};

/// `mesh` placed in the world. Its front stays the front under mirroring transforms, too: Mitsuba
/// transforms normals, not the winding. A mesh without normals gets smooth ones unless
/// `face_normals`, as in Mitsuba 3; where some vertices have none, these get them. Throws
/// Error(input) at `place` if a vertex becomes infinite.
TriangleMesh prepare_mesh(TriangleMesh mesh, const MeshOptions& options, const Place& place);

/// Unit vertex normals: the face normals weighted by the angle at the vertex (Thürmer and Wüthrich,
/// "Computing Vertex Normals from Polygonal Facets", JGT 1998). Vertices of no area get +z.
std::vector<Vec3f> smooth_normals(const TriangleMesh& mesh);
/// What one triangle adds to the normals of its corners; zero if it has no area.
std::array<Vec3f, 3> weighted_normals(const TriangleMesh& mesh,
                                      const std::array<uint32_t, 3>& corner);

/// The mesh with normals that are smooth but at its creases: edges between faces whose normals are
/// more than so many degrees apart. Vertices are doubled there; those at the same place count as
/// one (Mitsuba 0.6's `maxSmoothAngle`).
TriangleMesh split_at_creases(TriangleMesh mesh, double degrees);

/// At most `budget` boxes that hold all triangles, split top-down.
std::vector<Bounds3f> triangle_boxes(const TriangleMesh& mesh, int budget);

}  // namespace kaustik
