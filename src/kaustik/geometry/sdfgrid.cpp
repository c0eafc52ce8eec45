// The surface where a grid of distances is zero, as Mitsuba's `sdfgrid`: within each cell rays meet
// the zero of a cubic.

#include <algorithm>
#include <mutex>

#include "kaustik/geometry/grid_field.h"
#include "kaustik/geometry/shape_creators.h"
#include "kaustik/geometry/shape_support.h"
#include "kaustik/geometry/zero_set.h"
#include "kaustik/volume/volume_samples.h"

namespace kaustik {
namespace {

/// How far beside the surface rounding may put a point, in cells.
constexpr double grid_precision = 1e-9;

class SdfGrid : public Shape {
 public:
  SdfGrid(GridField field, const Transform& world_from_unit, bool is_smooth)
      : field_(std::move(field)), is_smooth_(is_smooth) {
    const Vec3d cells = field_.extent();
    world_from_grid_ = world_from_unit * Transform::scale({1 / cells.x, 1 / cells.y, 1 / cells.z});
    grid_from_world_ = world_from_grid_.inverse();
    for (const Vec3d& axis : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)})
      largest_scale_ = std::max(largest_scale_, transform_vector(world_from_grid_, axis).length());
  }

  Bounds3f bounds() const override { return box_in_world({Vec3d(0, 0, 0), field_.extent()}); }
  float area() const override {
    std::call_once(area_once_, [this] { area_ = float(mesh_area(tessellate(3))); });
    return area_;
  }
  std::optional<ShapeHit> intersect(const Ray& ray) const override;
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  bool can_sample() const override { return false; }
  ShapeSample sample_area(const Vec2f&) const override { return {}; }
  TriangleMesh tessellate(int level) const override {
    const Vec3d high = field_.extent();
    const int cells =
        std::min(int(std::max({high.x, high.y, high.z})), 8 << std::clamp(level, 0, 5));
    return zero_set([this](const Vec3d& p) { return field_.value(p); }, Vec3d(0, 0, 0), high, cells,
                    world_from_grid_);
  }
  std::vector<Bounds3f> bounding_boxes(int budget) const override {
    std::vector<Bounds3f> boxes;
    for (const Imath::Box3d& box : field_.surface_boxes(budget)) boxes.push_back(box_in_world(box));
    return boxes;
  }

 private:
  Bounds3f box_in_world(const Imath::Box3d& box) const {
    Imath::Box3d world;
    for (int i = 0; i < 8; ++i)
      world.extendBy(transform_point(world_from_grid_,
                                     {i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                                      i & 4 ? box.max.z : box.min.z}));
    return rounded_outward(world.min, world.max);
  }
  /// By the inverse transpose; unit, or `other` if there is no slope.
  Vec3d world_normal(const Vec3d& n, const Vec3d& other) const {
    Vec3d result;
    for (int i = 0; i < 3; ++i)
      result[i] = grid_from_world_.at(0, i) * n.x + grid_from_world_.at(1, i) * n.y +
                  grid_from_world_.at(2, i) * n.z;
    const double length = result.length();
    return length > 0 && std::isfinite(length) ? result / length : other;
  }

  GridField field_;
  bool is_smooth_;
  Transform world_from_grid_, grid_from_world_;
  double largest_scale_ = 0;
  mutable std::once_flag area_once_;
  mutable float area_ = 0;
};

std::optional<ShapeHit> SdfGrid::intersect(const Ray& ray) const {
  const Vec3d from = transform_point(grid_from_world_, Vec3d(ray.origin));
  const Vec3d direction = transform_vector(grid_from_world_, Vec3d(ray.direction));
  const auto t = field_.crossing(from, direction, double(ray.t_max));
  if (!t || !(float(*t) > 0)) return std::nullopt;
  const Vec3d against = -Vec3d(ray.direction).normalized();
  return ShapeHit{float(*t), 0, 0,
                  Vec3f(world_normal(field_.gradient(from + direction * *t), against))};
}

SurfacePoint SdfGrid::surface_point(const Ray& ray, const Hit& hit) const {
  const Vec3d p = Vec3d(ray.origin) + Vec3d(ray.direction) * double(hit.t);
  const Vec3d at = transform_point(grid_from_world_, p);
  SurfacePoint point;
  point.position = Vec3f(p);
  // The hit has the normal of its own cell: the point may have been rounded into the next one.
  const Vec3d ng = Vec3d(hit.ng).normalized();
  point.ng = Vec3f(ng);
  point.ns = point.ng;
  if (is_smooth_) {
    const Vec3d ns = world_normal(field_.smooth_gradient(at), ng);
    if (ns.dot(ng) > 1e-3) point.ns = Vec3f(ns);
  }
  point.error = float(grid_precision * largest_scale_) +
                position_rounding(point.position, point.ng) +
                4 * float_rounding * std::fabs(hit.t) * length(ray.direction);
  return point;
}

}  // namespace

const TypeInfo& sdfgrid_info() {
  static const TypeInfo info{
      "shape",
      "sdfgrid",
      "The zero surface of a grid of signed distances over the cube from (0, 0, 0) to (1, 1, 1). "
      "It cannot be a light.",
      {file_parameter("filename", "File of Mitsuba's format VOL, with one channel."),
       array_parameter("grid", {},
                       "Distances [z, y, x] from a buffer, instead of the file; negative inside.")
           .instead_of("filename"),
       choice_parameter("normals", "smooth", {"smooth", "analytic"},
                        "Shading normals: blended between cells, or the surface's own."),
       to_world_parameter("Places the cube in the world.")}};
  return info;
}

std::unique_ptr<Shape> create_sdfgrid(const Arguments& arguments) {
  const bool is_buffer = arguments.given("grid");
  const Place place = arguments.place_of(is_buffer ? "grid" : "filename");
  VolumeSamples samples =
      is_buffer ? samples_of_array(*arguments.array("grid")) : read_vol(arguments.text("filename"));
  if (samples.channels != 1)
    throw Error(ErrorKind::input, "the grid of distances has several channels",
                "give one number for each place", place);
  if (*std::min_element(samples.size.begin(), samples.size.end()) < 2)
    throw Error(ErrorKind::input, "the grid of distances is flat",
                "give it at least 2 numbers along each axis", place);
  GridField field(samples.size, std::move(samples.values));
  if (!field.has_surface())
    throw Error(ErrorKind::input, "the distances in the grid have one sign: there is no surface",
                "let them be negative inside of it, and positive outside", place);
  return std::make_unique<SdfGrid>(std::move(field), affine_to_world(arguments),
                                   arguments.text("normals") == "smooth");
}

}  // namespace kaustik
