// The sphere under an uneven transform. Rays are taken to the space where it is the unit sphere, in
// double precision, and meet it exactly.

#include <fmt/format.h>

#include "kaustik/base/warp.h"
#include "kaustik/geometry/elliptic_integral.h"
#include "kaustik/geometry/linear_map.h"
#include "kaustik/geometry/make_ellipsoid.h"
#include "kaustik/geometry/shape_support.h"
#include "kaustik/geometry/unit_sphere.h"

namespace kaustik {
namespace {

/// Half lengths of its axes of symmetry, the longest first: `axes` are turned in pairs until they
/// are orthogonal (Hestenes, "Inversion of Matrices by Biorthogonalization and Related Results",
/// J. SIAM 1958), which keeps the relative precision of short ones.
Vec3d half_axes(std::array<Vec3d, 3> axes) {
  constexpr int most_sweeps = 40;
  bool is_orthogonal = false;
  for (int sweep = 0; sweep < most_sweeps && !is_orthogonal; ++sweep) {
    is_orthogonal = true;
    for (const auto& [i, j] : {std::pair<size_t, size_t>(0, 1), {0, 2}, {1, 2}}) {
      const double a = axes[i].length2(), b = axes[j].length2(), c = axes[i].dot(axes[j]);
      if (std::fabs(c) <= 1e-15 * std::sqrt(a) * std::sqrt(b)) continue;
      is_orthogonal = false;
      const double zeta = (b - a) / (2 * c);
      const double tangent = std::copysign(1 / (std::fabs(zeta) + std::hypot(1.0, zeta)), zeta);
      const double cosine = 1 / std::hypot(1.0, tangent), sine = cosine * tangent;
      const Vec3d before = axes[i];
      axes[i] = before * cosine - axes[j] * sine;
      axes[j] = before * sine + axes[j] * cosine;
    }
  }
  std::array<double, 3> lengths = {axes[0].length(), axes[1].length(), axes[2].length()};
  std::sort(lengths.begin(), lengths.end());
  return {lengths[2], lengths[1], lengths[0]};
}

class Ellipsoid : public Shape {
 public:
  Ellipsoid(const Vec3d& center, const std::array<Vec3d, 3>& axes, bool flipped)
      : center_(center), map_(axes), side_(flipped ? -1.0f : 1.0f) {
    const Vec3d half = half_axes(axes);
    const double xy = sqr(half.x * half.y), yz = sqr(half.y * half.z), zx = sqr(half.z * half.x);
    area_ = float(4 * std::numbers::pi * carlson_rg(xy, yz, zx));
    most_stretch_ = (1 + 1e-9) / half.z;
  }

  Bounds3f bounds() const override {
    const auto half = [&](int i) {
      return std::hypot(map_.columns[0][i], map_.columns[1][i], map_.columns[2][i]);
    };
    const Vec3d extent(half(0), half(1), half(2));
    return rounded_outward(center_ - extent, center_ + extent);
  }
  float area() const override { return area_; }
  std::optional<ShapeHit> intersect(const Ray& ray) const override;
  SurfacePoint surface_point(const Ray&, const Hit& hit) const override {
    return point_at(unit_from_square({hit.u, hit.v}));
  }
  UvDerivatives uv_derivatives(const SurfacePoint& at) const override;
  ShapeSample sample_area(const Vec2f& u) const override;
  ShapeSample sample_toward(const Vec3f& reference, const Vec2f& u,
                            float& pdf_solid_angle) const override;
  float pdf_toward(const Vec3f& reference, const SurfacePoint& point) const override;
  TriangleMesh tessellate(int level) const override;
  std::vector<Bounds3f> bounding_boxes(int budget) const override;

 private:
  /// Of a point of the unit sphere.
  SurfacePoint point_at(const Vec3d& unit) const;
  /// As of the sphere, where the ellipsoid is one.
  std::optional<SphereCone> cone_from(const Vec3f& reference) const {
    if (side_ < 0) return std::nullopt;
    return SphereCone::make(map_.undo(center_ - Vec3d(reference)), 1);
  }
  /// Density per solid angle at a point of the world, of a direction that has `pdf` where the
  /// ellipsoid is a sphere; `to_point` is of any length.
  float world_pdf(const Vec3d& to_point, double pdf) const;

  Vec3d center_;
  LinearMap map_;
  float side_;  ///< −1: normals point inward
  float area_ = 0;
  double most_stretch_ = 0;  ///< of map_.normal, of a unit vector
};

std::optional<ShapeHit> Ellipsoid::intersect(const Ray& ray) const {
  const Vec3d f = map_.undo(Vec3d(ray.origin) - center_), d = map_.undo(Vec3d(ray.direction));
  const std::optional<double> t = sphere_hit(f, d, 1, double(ray.t_max));
  if (!t) return std::nullopt;
  const Vec3d unit = (f + d * *t).normalized();
  const Vec2f at = square_from_unit(unit);
  return ShapeHit{float(*t), at.x, at.y, Vec3f(map_.normal(unit).normalized() * double(side_))};
}

SurfacePoint Ellipsoid::point_at(const Vec3d& unit) const {
  SurfacePoint point;
  const Vec3f n(map_.normal(unit).normalized());
  point.position = Vec3f(center_ + map_.apply(unit));
  point.ng = point.ns = n * side_;
  const double phi = std::atan2(unit.y, unit.x);
  point.uv = {float((phi < 0 ? phi + 2 * std::numbers::pi : phi) / (2 * std::numbers::pi)),
              float(std::atan2(std::hypot(unit.x, unit.y), unit.z) / std::numbers::pi)};
  point.error = position_rounding(point.position, n);
  return point;
}

UvDerivatives Ellipsoid::uv_derivatives(const SurfacePoint& at) const {
  const auto& [x, y, z] = map_.columns;
  const Vec3d n(at.ng * side_);
  const Vec3d unit = Vec3d(n.dot(x), n.dot(y), n.dot(z)).normalized();
  const double sin_theta = std::hypot(unit.x, unit.y);
  // At the poles any meridian serves.
  const double cos_phi = sin_theta > 0 ? unit.x / sin_theta : 1;
  const double sin_phi = sin_theta > 0 ? unit.y / sin_theta : 0;
  return {Vec3f((y * unit.x - x * unit.y) * (2 * std::numbers::pi)),
          Vec3f(((x * cos_phi + y * sin_phi) * unit.z - z * sin_theta) * std::numbers::pi)};
}

ShapeSample Ellipsoid::sample_area(const Vec2f& u) const {
  // Uniform on the unit sphere, and taken as often as pieces of area grow there, |det M| |M⁻ᵀ n|:
  // at least every second time, since |M⁻ᵀ n| is no shorter than its part where it is longest.
  FurtherNumbers further(u);
  Vec3d unit(square_to_sphere(u));
  for (int i = 0; i < most_draws; ++i) {
    const double stretch = map_.normal(unit).length();
    if (double(further.next()) * most_stretch_ < stretch) break;
    unit = Vec3d(square_to_sphere(further.next_2d()));
  }
  return {point_at(unit.normalized()), 1.0f / area_};
}

float Ellipsoid::world_pdf(const Vec3d& to_point, double pdf) const {
  const Vec3d local = map_.undo(to_point);
  // dω' = |det M⁻¹| (|v| / |M⁻¹ v|)³ dω.
  const double ratio = to_point.length() / local.length();
  const double density = pdf * ratio * ratio * ratio / std::fabs(map_.determinant());
  return density < double(std::numeric_limits<float>::max()) ? float(density) : 0.0f;
}

ShapeSample Ellipsoid::sample_toward(const Vec3f& reference, const Vec2f& u,
                                     float& pdf_solid_angle) const {
  const std::optional<SphereCone> cone = cone_from(reference);
  if (!cone) return Shape::sample_toward(reference, u, pdf_solid_angle);
  const SurfacePoint point = point_at(cone->sample(u));
  pdf_solid_angle = world_pdf(Vec3d(point.position) - Vec3d(reference), cone->pdf());
  return sample_of(point, reference, pdf_solid_angle);
}

float Ellipsoid::pdf_toward(const Vec3f& reference, const SurfacePoint& point) const {
  const std::optional<SphereCone> cone = cone_from(reference);
  if (!cone) return Shape::pdf_toward(reference, point);
  return world_pdf(Vec3d(point.position) - Vec3d(reference), cone->pdf());
}

TriangleMesh Ellipsoid::tessellate(int level) const {
  Icosphere ball = icosphere(level);
  TriangleMesh mesh;
  for (const Vec3d& unit : ball.units) {
    mesh.positions.push_back(Vec3f(center_ + map_.apply(unit)));
    mesh.normals.push_back(Vec3f(map_.normal(unit).normalized()) * side_);
  }
  if ((map_.determinant() < 0) != (side_ < 0))
    for (auto& corner : ball.triangles) std::swap(corner[1], corner[2]);
  mesh.triangles = std::move(ball.triangles);
  return mesh;
}

std::vector<Bounds3f> Ellipsoid::bounding_boxes(int budget) const {
  const Bounds3f whole = bounds();
  const int side = int(std::sqrt(std::max(0, budget) / 6));
  if (side == 0) return {whole};
  std::vector<Bounds3f> boxes;
  for (const SpherePatch& patch : sphere_patches(side)) {
    Imath::Box3d box;
    for (const Vec3d& unit : patch.corners) {
      box.extendBy(center_ + map_.apply(unit));
      box.extendBy(center_ + map_.apply(unit * patch.reach));
    }
    boxes.push_back(common_part(rounded_outward(box.min, box.max), whole));
  }
  return boxes;
}

}  // namespace

std::unique_ptr<Shape> make_ellipsoid(const Vec3d& center, const std::array<Vec3d, 3>& axes,
                                      bool flipped, const Place& place) {
  const double thickness = half_axes(axes).z;
  if (!(thickness >= smallest_length))
    throw Error(ErrorKind::input,
                fmt::format("the sphere is flattened to {:g} m, less than single floats carry",
                            2 * thickness),
                fmt::format("let it be at least {:g} m thick, or use a disk", 2 * smallest_length),
                place);
  return std::make_unique<Ellipsoid>(center, axes, flipped);
}

}  // namespace kaustik
