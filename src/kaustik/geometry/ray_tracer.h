#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kaustik/geometry/body_part.h"
#include "kaustik/geometry/shape.h"

namespace kaustik {

/// A shape placed once more by a transform.
struct Instance {
  uint32_t group = 0;  ///< index into RayTracer's groups
  Transform world_from_group;
};

/// Shapes to trace rays against. `shapes` stand in the world; each group is a list of shapes that
/// only appear through instances. Indices in Hit::shape count world shapes first, then the shapes
/// of the groups one after another. Those in SurfacePoint::shape go on with
/// RayTracer::body_parts().
struct Geometry {
  std::vector<std::shared_ptr<const Shape>> shapes;
  std::vector<std::vector<std::shared_ptr<const Shape>>> groups;
  std::vector<Instance> instances;
  /// Shapes of the world that are solid bodies, those first that win where they overlap.
  std::vector<uint32_t> bodies = {};
};

/// A piece of a surface, in the world: a triangle, or the box around a shape without a mesh.
struct SurfacePiece {
  std::array<Vec3f, 8> corners;  ///< of a triangle the first three
  bool is_box = false;
};

/// Gets pieces, one by one; false: no more are wanted.
struct PieceSink {
  bool (*take)(void* context, const SurfacePiece& piece);
  void* context;
};

/// How many of its structures a RayTracer has built itself.
struct StructuresBuilt {
  int groups = 0;
  bool top_level = false;  ///< that over all shapes of the world and all instances
};

/// The acceleration structure (Embree; the meshes' own arrays are shared with it). Immutable after
/// construction and shared by all threads. The build is deterministic.
class RayTracer {
 public:
  /// Shares the structures of `previous`, null: none, that would be built of the same shapes (the
  /// same objects) again: those of groups, each by itself, and the one over the whole world, all
  /// shapes of which are in one tree: it is built anew when one of them has changed. Rays are hit
  /// and rounded as if all had been built anew. `previous` may be tracing meanwhile, and need not
  /// outlive this. Throws Error(system) if Embree runs out of memory or cannot start.
  explicit RayTracer(Geometry geometry, const RayTracer* previous = nullptr);
  ~RayTracer();
  RayTracer(const RayTracer&) = delete;
  RayTracer& operator=(const RayTracer&) = delete;

  /// Closest hit in (0, ray.t_max); false if none. Here and below a ray that floats cannot carry
  /// through the scene (not finite, or farther out than `largest_coordinate()`) hits nothing, and
  /// is counted.
  bool intersect(const Ray& ray, Hit& hit) const;
  /// The same for many rays at once, which is faster, most of all if they are alike: hits[i]
  /// belongs to rays[i], its `t` is infinite if there is none; `hits` is as long as `rays` or
  /// longer. How rays are grouped may change the last bits of a hit.
  void intersect(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// Whether anything lies in (0, ray.t_max).
  bool occluded(const Ray& ray) const;
  /// All pieces of surfaces that meet the ball, and maybe others nearby, in an order that is the
  /// same for the same scene.
  void pieces_near(const Vec3f& center, float radius, const PieceSink& sink) const;
  /// How many rays were no rays, of all that were traced so far.
  uint64_t refused_rays() const;
  /// What no component of a ray's origin and direction may exceed: Embree's own limit, 1.8e18, or
  /// less where an instance magnifies what it shows.
  float largest_coordinate() const;

  /// World-space geometry of a hit.
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const;

  /// The same point's derivatives by its texture coordinates.
  UvDerivatives uv_derivatives(const SurfacePoint& point) const;

  /// Of a body's part: the body's.
  const Shape& shape(uint32_t index) const;
  size_t shape_count() const;
  /// What surfaces of bodies are cut into where bodies overlap.
  std::span<const BodyPart> body_parts() const;
  /// What it was made from.
  const Geometry& geometry() const;
  Bounds3f bounds() const;
  /// Of the acceleration structure, without the shapes themselves.
  size_t size_in_bytes() const;
  StructuresBuilt structures_built() const;
  /// Whether both share all structures and place them alike: every ray hits the same.
  bool traces_like(const RayTracer& other) const;
  /// RTCScene, for benchmarks that compare with bare Embree.
  void* embree_scene() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kaustik
