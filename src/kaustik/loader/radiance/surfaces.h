#pragma once
// Surfaces of Radiance as shapes.

#include <map>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "kaustik/loader/radiance/compiled_reader.h"
#include "kaustik/loader/radiance/luminaires.h"
#include "kaustik/loader/radiance/materials.h"

namespace kaustik::radiance {

/// A surface, and where it stands.
struct PlacedSurface {
  const Primitive* primitive = nullptr;
  Transform placed;                    ///< world from the space of its file
  bool is_inverted = false;            ///< its other side is the front
  const Modifier* modifier = nullptr;  ///< null: void
};

/// Collects surfaces and describes them. Polygons of one material become one mesh, but those that
/// shine.
class SurfaceMaker {
 public:
  SurfaceMaker(MaterialMaker& materials, Deviations& deviations, Object& scene)
      : materials_(materials), deviations_(deviations), scene_(scene) {}

  /// Any but sources, octrees and meshes. Throws Error(input) for arguments that are missing.
  void add(const PlacedSurface& surface);
  /// The triangles of a mesh that have that material of its own.
  void add_mesh_part(const PlacedSurface& surface, const CompiledMesh& mesh, int32_t material);
  /// Describes the meshes.
  void finish();

 private:
  /// Triangles with one appearance.
  struct Mesh {
    std::shared_ptr<const Appearance> appearance;
    Place place;
    std::vector<float> positions, normals, uvs;  ///< normals and uvs: none, or of each vertex
    std::vector<uint32_t> faces;
  };
  using Corner = std::pair<Vec3d, Vec3d>;  ///< position and normal

  void add_polygon(const PlacedSurface& surface);
  void add_sphere(const PlacedSurface& surface);
  void add_ring(const PlacedSurface& surface);
  void add_cylinder(const PlacedSurface& surface);
  void add_cone(const PlacedSurface& surface);
  /// A band between two circles about an axis: `normals` of the first and the second circle as
  /// shares along the radius and the axis.
  void add_band(const PlacedSurface& surface, const Vec3d& from, const Vec3d& to, const Vec3d& axis,
                double from_radius, double to_radius, bool is_smooth);

  /// `lamp`: of what is flat or a sphere.
  std::shared_ptr<const Appearance> look_at(const PlacedSurface& surface, bool is_mesh,
                                            const std::vector<PatternPoint>& samples,
                                            const std::optional<LampSurface>& lamp = {});
  /// What a surface looks like whose light is another one in each direction: dark, with a point
  /// lamp before it; or the same as before, shining by its mean, where it is neither flat nor a
  /// sphere, or there are too many. Both are told.
  std::shared_ptr<const Appearance> with_luminaire(
      const std::shared_ptr<const Appearance>& appearance, const std::optional<LampSurface>& lamp,
      const Place& place);
  /// The mesh that takes triangles of that look.
  Mesh& mesh_of(const PlacedSurface& surface, const std::shared_ptr<const Appearance>& appearance,
                bool is_smooth, bool has_uvs);
  void add_shape(const ObjectPointer& shape, const Appearance& appearance);
  void add_mesh(Mesh& mesh);
  void add_beam(const Appearance::Beam& beam, const Vec3d& middle, double area, const Vec3d& normal,
                const Place& place);
  /// Tells the pattern of an appearance, if it has one, that a surface is there.
  static void extend(const Vec3d& point, const Vec3d& normal, const Appearance* appearance);

  MaterialMaker& materials_;
  Deviations& deviations_;
  Object& scene_;
  std::map<std::tuple<const Appearance*, bool, bool>, Mesh> meshes_;
  std::vector<std::tuple<const Appearance*, bool, bool>> order_;  ///< of meshes, for the same scene
  std::map<const Appearance*, std::shared_ptr<const Appearance>> dark_;  ///< of luminaires
  int luminaires_ = 0;
};

}  // namespace kaustik::radiance
