#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kaustik/base/memory.h"
#include "kaustik/base/parameters.h"
#include "kaustik/geometry/ray.h"

namespace kaustik {

/// A point sampled on a shape.
struct ShapeSample {
  SurfacePoint point;
  float pdf_area = 0;  ///< 1/m²; zero if sampling failed
};

/// Density per solid angle at `reference` of a density per area at `point`; zero where the surface
/// is seen edge-on.
float solid_angle_density(const Vec3f& reference, const SurfacePoint& point, float pdf_area);

/// Colours or numbers that go with a mesh: one for each vertex, linear between them, or one for
/// each triangle.
struct MeshAttribute {
  std::string name;                ///< "vertex_…" or "face_…", after what has it
  int components = 3;              ///< 1: numbers; 3: linear Rec. 709
  std::vector<float> values = {};  ///< of one vertex or triangle after the other; finite

  bool is_of_faces() const { return name.starts_with("face_"); }
};

/// The corners of triangles, as numbers of vertices.
using TriangleList = UnsetVector<std::array<uint32_t, 3>>;

/// Triangles with shared vertices, in world space (in group space for shapes of a shape group).
struct TriangleMesh {
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;  ///< per vertex, unit; empty: flat faces
  std::vector<Vec2f> uvs;      ///< per vertex; empty: barycentric
  TriangleList triangles;
  std::vector<MeshAttribute> attributes = {};  ///< of different names
};

/// A hit of an analytic or procedural shape.
struct ShapeHit {
  float t;
  float u = 0, v = 0;
  Vec3f ng;  ///< outward, need not be normalised
};

/// Geometry without a material. Immutable; all in world space (or the space of its group).
class Shape {
 public:
  virtual ~Shape() = default;

  virtual Bounds3f bounds() const = 0;
  /// m². For procedural shapes an estimate from the tessellation.
  virtual float area() const = 0;

  /// The mesh itself where the shape is one (ray tracing uses it as it is); null: the shape
  /// intersects by itself.
  virtual const TriangleMesh* mesh() const { return nullptr; }
  /// Nearest hit with t in (0, t_max); for shapes without a mesh. Thread-safe.
  virtual std::optional<ShapeHit> intersect(const Ray& ray) const;

  /// Geometry at a hit of this shape, `shape` and `instance` not filled in.
  virtual SurfacePoint surface_point(const Ray& ray, const Hit& hit) const = 0;

  /// At a point of this shape. Not part of the point because few materials ask.
  virtual UvDerivatives uv_derivatives(const SurfacePoint& at) const {
    (void)at;
    return {};
  }

  /// False where the shape cannot be sampled by area (procedural ones): it cannot be a light then.
  virtual bool can_sample() const { return true; }
  /// Uniform by area.
  virtual ShapeSample sample_area(const Vec2f& u) const = 0;
  /// The numbers for which sample_area() gives this point of the shape, but for rounding; nothing
  /// from shapes that do not know them.
  virtual std::optional<Vec2f> area_coordinates(const SurfacePoint& point) const {
    (void)point;
    return std::nullopt;
  }
  /// A point for lighting `reference`: the default samples by area; shapes may do better (a sphere
  /// samples the cone it subtends). `pdf_solid_angle` is with respect to solid angle at
  /// `reference`.
  virtual ShapeSample sample_toward(const Vec3f& reference, const Vec2f& u,
                                    float& pdf_solid_angle) const;
  /// Density of sample_toward for a point of this shape that `reference` sees.
  virtual float pdf_toward(const Vec3f& reference, const SurfacePoint& point) const;

  /// An inscribed approximation, finer for higher `level` (0: a dozen triangles or so); a mesh
  /// returns itself.
  virtual TriangleMesh tessellate(int level) const = 0;
  /// At most about `budget` boxes that together contain the whole surface. What aims photons at
  /// the shape builds on them: nothing of the shape may lie outside.
  virtual std::vector<Bounds3f> bounding_boxes(int budget) const {
    (void)budget;
    return {bounds()};
  }
};

/// Everything of one type of shape: its table and how to make it. `place` of arguments that are
/// wrong in ways the table cannot tell (unreadable mesh, NaN vertex) goes into the Error thrown.
struct ShapeType {
  const TypeInfo& info;
  std::unique_ptr<Shape> (*create)(const Arguments&);
};

/// The registry: one row per type ("obj", "ply", "serialized", "mesh", "heightfield", "rectangle",
/// "cube", "disk", "sphere", "cylinder", "sdf", "sdfgrid"). Shape groups and instances are the
/// scene's own.
const std::vector<ShapeType>& shape_types();

}  // namespace kaustik
