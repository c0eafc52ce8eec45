// A procedural shape: no mesh, no closed form, only a distance to step by (Hart, "Sphere Tracing",
// The Visual Computer 1996). Nothing else in the renderer knows.

#include <mutex>
#include <queue>

#include "kaustik/geometry/sdf_field.h"
#include "kaustik/geometry/shape_creators.h"
#include "kaustik/geometry/shape_support.h"
#include "kaustik/geometry/zero_set.h"

namespace kaustik {
namespace {

/// What counts as touching, in the field's own space (whose cube has edges of 2).
constexpr double precision = 1e-5;
/// Beyond the unit cube the surface has nothing but what `precision` adds.
constexpr double extent = 1.0 + 4 * precision;

class SdfShape : public Shape {
 public:
  SdfShape(const SdfField& field, const Transform& world_from_field)
      : field_(field),
        world_from_field_(world_from_field),
        field_from_world_(world_from_field.inverse()) {
    for (const Vec3d& axis : {Vec3d(1, 0, 0), Vec3d(0, 1, 0), Vec3d(0, 0, 1)})
      largest_scale_ = std::max(largest_scale_, transform_vector(world_from_field, axis).length());
    // Bounds what a unit vector of any direction can become, under shears as well.
    largest_scale_ *= std::sqrt(3.0);
  }

  Bounds3f bounds() const override { return cell_bounds(Vec3d(0, 0, 0), extent); }
  float area() const override;
  std::optional<ShapeHit> intersect(const Ray& ray) const override;
  SurfacePoint surface_point(const Ray& ray, const Hit& hit) const override;
  bool can_sample() const override { return false; }
  ShapeSample sample_area(const Vec2f&) const override { return {}; }
  TriangleMesh tessellate(int level) const override;
  std::vector<Bounds3f> bounding_boxes(int budget) const override;

 private:
  struct Span {
    double begin, end;
  };
  static std::optional<Span> clip(const Vec3d& o, const Vec3d& d, double t_max);
  std::optional<double> enter(const Vec3d& o, const Vec3d& d, const Span& span) const;
  std::optional<double> leave(const Vec3d& o, const Vec3d& d, const Span& span) const;
  double refine(const Vec3d& o, const Vec3d& d, double t, double step) const;
  double crossing(const Vec3d& o, const Vec3d& d, double from, double to, bool from_inside) const;
  Bounds3f cell_bounds(const Vec3d& middle, double half_width) const;
  bool may_hold_surface(const Vec3d& middle, double half_width) const {
    return field_.value(middle) <= half_width * std::sqrt(3.0);
  }
  /// By the inverse transpose; unit.
  Vec3d world_normal(const Vec3d& n) const {
    Vec3d result;
    for (int i = 0; i < 3; ++i)
      result[i] = field_from_world_.at(0, i) * n.x + field_from_world_.at(1, i) * n.y +
                  field_from_world_.at(2, i) * n.z;
    return result.normalized();
  }

  SdfField field_;
  Transform world_from_field_, field_from_world_;
  double largest_scale_ = 0;
  mutable std::once_flag area_once_;
  mutable float area_ = 0;
};

std::optional<SdfShape::Span> SdfShape::clip(const Vec3d& o, const Vec3d& d, double t_max) {
  Span span{0, t_max};
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0) {
      if (std::fabs(o[i]) > extent) return std::nullopt;
      continue;
    }
    const double a = (-extent - o[i]) / d[i], b = (extent - o[i]) / d[i];
    span.begin = std::max(span.begin, std::min(a, b));
    span.end = std::min(span.end, std::max(a, b));
  }
  if (!(span.begin < span.end)) return std::nullopt;
  return span;
}

std::optional<ShapeHit> SdfShape::intersect(const Ray& ray) const {
  const Vec3d o = transform_point(field_from_world_, Vec3d(ray.origin));
  const Vec3d direction = transform_vector(field_from_world_, Vec3d(ray.direction));
  const double scale = direction.length();  // field units per t
  const Vec3d d = direction / scale;
  const auto span = clip(o, d, double(ray.t_max) * scale);
  if (!span) return std::nullopt;

  // The sign at the start tells the side that the ray is on; it stops where the other one begins.
  const bool is_inside = field_.value(o + d * span->begin) < 0;
  const auto t = is_inside ? leave(o, d, *span) : enter(o, d, *span);
  if (!t || !(*t < span->end)) return std::nullopt;
  const double t_hit = *t / scale;
  if (!(t_hit > 0) || !(t_hit < double(ray.t_max))) return std::nullopt;
  return ShapeHit{float(t_hit), 0, 0, Vec3f(world_normal(field_.gradient(o + d * *t)))};
}

/// Where a ray from outside meets the surface. It passes through what it has not reached after so
/// many steps, which is finer than `precision` or lies along it.
std::optional<double> SdfShape::enter(const Vec3d& o, const Vec3d& d, const Span& span) const {
  constexpr double smallest_step = 0.25 * precision;
  // A mandelbulb is as fine as that all over, and each of its steps costs much more.
  const int most_steps = field_.kind == SdfKind::mandelbulb ? 4096 : 100'000;
  double t = span.begin;
  for (int i = 0; i < most_steps && t < span.end; ++i) {
    const Vec3d p = o + d * t;
    const double distance = field_.value(p);
    const double step = std::max(smallest_step, distance);
    // Within `precision` of the surface only what goes toward it is a hit: rays start here, too.
    if (distance < precision && d.dot(field_.gradient(p)) < 0) return refine(o, d, t, step);
    t += step;
  }
  return std::nullopt;
}

/// Where a ray from inside meets the surface. What is thinner than a step may be missed.
std::optional<double> SdfShape::leave(const Vec3d& o, const Vec3d& d, const Span& span) const {
  constexpr double even_step = 1e-3, smallest_step = 1e-4;
  double depth = -field_.value(o + d * span.begin);
  for (double t = span.begin; t < span.end;) {
    const double next = t + (field_.knows_depth() ? std::max(smallest_step, depth) : even_step);
    depth = -field_.value(o + d * next);
    if (depth <= 0) return crossing(o, d, t, next, true);
    t = next;
  }
  return std::nullopt;
}

/// From a point outside within reach of the surface to the surface itself, if it is passed soon,
/// else where it is.
double SdfShape::refine(const Vec3d& o, const Vec3d& d, double t, double step) const {
  double reach = std::max(step, precision);
  for (int i = 0; i < 5; ++i, reach *= 2)
    if (field_.value(o + d * (t + reach)) < 0) return crossing(o, d, t, t + reach, false);
  return t;
}

/// By bisection; the side of `from` is `from_inside`, and what is returned lies on it.
double SdfShape::crossing(const Vec3d& o, const Vec3d& d, double from, double to,
                          bool from_inside) const {
  while (to - from > 1e-4 * precision) {
    const double middle = 0.5 * (from + to);
    if (!(from < middle && middle < to)) break;
    ((field_.value(o + d * middle) < 0) == from_inside ? from : to) = middle;
  }
  return from;
}

SurfacePoint SdfShape::surface_point(const Ray& ray, const Hit& hit) const {
  const Vec3d p = Vec3d(ray.origin) + Vec3d(ray.direction) * double(hit.t);
  SurfacePoint point;
  point.position = Vec3f(p);
  point.ng = point.ns = Vec3f(world_normal(field_.gradient(transform_point(field_from_world_, p))));
  point.error = float(2 * precision * largest_scale_) +
                position_rounding(point.position, point.ng) +
                4 * float_rounding * std::fabs(hit.t) * length(ray.direction);
  return point;
}

Bounds3f SdfShape::cell_bounds(const Vec3d& middle, double half_width) const {
  Imath::Box3d box;
  const double half = half_width + precision;
  for (int i = 0; i < 8; ++i)
    box.extendBy(transform_point(
        world_from_field_,
        middle + Vec3d(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half)));
  return rounded_outward(box.min, box.max);
}

std::vector<Bounds3f> SdfShape::bounding_boxes(int budget) const {
  struct Cell {
    Vec3d middle;
    double half_width;
    bool operator<(const Cell& other) const { return half_width < other.half_width; }
  };
  std::priority_queue<Cell> cells;
  cells.push({Vec3d(0, 0, 0), extent});
  while (!cells.empty() && cells.size() + 7 <= size_t(std::max(1, budget)) &&
         cells.top().half_width > 100 * precision) {
    const Cell cell = cells.top();
    cells.pop();
    const double half = 0.5 * cell.half_width;
    for (int i = 0; i < 8; ++i) {
      const Vec3d middle =
          cell.middle + Vec3d(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half);
      if (may_hold_surface(middle, half + precision)) cells.push({middle, half});
    }
  }
  std::vector<Bounds3f> boxes;
  for (; !cells.empty(); cells.pop())
    boxes.push_back(cell_bounds(cells.top().middle, cells.top().half_width));
  return boxes;
}

TriangleMesh SdfShape::tessellate(int level) const {
  const double reach = extent + 0.01;
  const Vec3d corner(reach, reach, reach);
  return zero_set([this](const Vec3d& p) { return field_.value(p); }, -corner, corner,
                  16 << std::clamp(level, 0, 4), world_from_field_);
}

float SdfShape::area() const {
  std::call_once(area_once_, [this] { area_ = float(mesh_area(tessellate(2))); });
  return area_;
}

}  // namespace

const TypeInfo& sdf_info() {
  static const TypeInfo info{
      "shape",
      "sdf",
      "A solid given by a signed distance field. It cannot be a light.",
      {choice_parameter("field", "menger", {"menger", "mandelbulb"}, "Which solid."),
       integer_parameter("iterations", 4, "Levels of detail.").range(1, 16),
       point_parameter("center", Vec3d(0, 0, 0), "Centre of the solid."),
       number_parameter("size", 2.0, "Edge of the cube that holds the solid.")
           .range(smallest_length, largest_length)
           .in("m"),
       to_world_parameter("Places the solid in the world.")}};
  return info;
}

std::unique_ptr<Shape> create_sdf(const Arguments& arguments) {
  const SdfField field{arguments.text("field") == "menger" ? SdfKind::menger : SdfKind::mandelbulb,
                       int(arguments.integer("iterations"))};
  const double half = 0.5 * arguments.number("size");
  return std::make_unique<SdfShape>(field, affine_to_world(arguments) *
                                               Transform::translate(arguments.point("center")) *
                                               Transform::scale({half, half, half}));
}

}  // namespace kaustik
