#include "kaustik/geometry/unit_sphere.h"

#include <map>

#include "kaustik/geometry/shape_support.h"

namespace kaustik {

std::optional<double> sphere_hit(const Vec3d& f, const Vec3d& d, double radius, double t_max) {
  const double a = d.dot(d), b = -f.dot(d);
  // The discriminant by the distance of the line from the centre: no cancellation for spheres that
  // are small or far away (Haines et al., "Precision Improvements for Ray/Sphere Intersection",
  // Ray Tracing Gems 2019, eq. 5).
  const Vec3d nearest = f + d * (b / a);
  const double distance_sq = nearest.dot(nearest);
  const double discriminant = radius * radius - distance_sq;
  if (!(discriminant >= 0)) return std::nullopt;
  const double f_length = f.length();
  const double c = (f_length - radius) * (f_length + radius);
  const double q = b + std::copysign(std::sqrt(a * discriminant), b);
  if (q == 0) return std::nullopt;
  const double t0 = std::min(c / q, q / a), t1 = std::max(c / q, q / a);
  const double t = t0 > 0 ? t0 : t1;
  if (!(t > 0) || !(t < t_max)) return std::nullopt;
  return t;
}

std::optional<SphereCone> SphereCone::make(const Vec3d& to_center, double radius) {
  SphereCone cone;
  cone.to_center_ = to_center;
  cone.distance_sq_ = to_center.length2();
  cone.sin_max_sq_ = radius * radius / cone.distance_sq_;
  if (!(cone.sin_max_sq_ < 1)) return std::nullopt;
  cone.one_minus_cos_ = cone.sin_max_sq_ / (1 + std::sqrt(1 - cone.sin_max_sq_));
  if (!(cone.one_minus_cos_ > 0)) return std::nullopt;
  return cone;
}

Vec3d SphereCone::sample(const Vec2f& u) const {
  // Angle θ at the point → angle α at the centre, both from the axis between the two.
  const double h = double(u.x) * one_minus_cos_, cos_theta = 1 - h, sin_theta_sq = h * (2 - h);
  const double cos_alpha = sin_theta_sq / std::sqrt(sin_max_sq_) +
                           cos_theta * std::sqrt(std::max(0.0, 1 - sin_theta_sq / sin_max_sq_));
  const double sin_alpha = std::sqrt(std::max(0.0, 1 - cos_alpha * cos_alpha));
  const double phi = 2 * std::numbers::pi * double(u.y);
  const Vec3d z = -to_center_ / std::sqrt(distance_sq_);
  const Vec3d x = orthogonal_to(z), y = z.cross(x);
  return (x * (sin_alpha * std::cos(phi)) + y * (sin_alpha * std::sin(phi)) + z * cos_alpha)
      .normalized();
}

Icosphere icosphere(int level) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3d> units = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                              {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                              {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3d& unit : units) unit.normalize();
  TriangleList triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                            {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                            {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                            {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int i = 0; i < std::clamp(level, 0, 8); ++i) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), uint32_t(units.size()));
      if (is_new) units.push_back((units[a] + units[b]).normalized());
      return it->second;
    };
    TriangleList finer;
    for (const auto& [a, b, c] : triangles) {
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  return {std::move(units), std::move(triangles)};
}

std::vector<SpherePatch> sphere_patches(int side) {
  // On each face of a cube, at even angles.
  const auto tangent = [&](int i) { return std::tan(std::numbers::pi * (0.5 * i / side - 0.25)); };
  std::vector<SpherePatch> patches;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const auto corner = [&](int i, int j) {
      Vec3d p;
      p[axis] = face % 2 == 0 ? 1 : -1;
      p[(axis + 1) % 3] = tangent(i);
      p[(axis + 2) % 3] = tangent(j);
      return p.normalized();
    };
    for (int i = 0; i < side; ++i)
      for (int j = 0; j < side; ++j) {
        SpherePatch patch{{corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)},
                          0};
        Vec3d middle(0, 0, 0);
        for (const Vec3d& unit : patch.corners) middle += unit;
        middle.normalize();
        // A point of the patch is one of the corners' hull, farther out: by no more than the hull's
        // distance from the centre, which is at least that of the corners along the middle.
        double nearest = 1;
        for (const Vec3d& unit : patch.corners) nearest = std::min(nearest, unit.dot(middle));
        patch.reach = 1 / nearest;
        patches.push_back(patch);
      }
  }
  return patches;
}

Vec2f square_from_unit(const Vec3d& unit) {
  const Vec3d p = unit / (std::fabs(unit.x) + std::fabs(unit.y) + std::fabs(unit.z));
  if (p.z >= 0) return {float(p.x), float(p.y)};
  return {float(std::copysign(1 - std::fabs(p.y), p.x)),
          float(std::copysign(1 - std::fabs(p.x), p.y))};
}

Vec3d unit_from_square(const Vec2f& at) {
  const double x = double(at.x), y = double(at.y), z = 1 - std::fabs(x) - std::fabs(y);
  const double folded = std::max(-z, 0.0);
  return Vec3d(x - std::copysign(folded, x), y - std::copysign(folded, y), z).normalized();
}

}  // namespace kaustik
