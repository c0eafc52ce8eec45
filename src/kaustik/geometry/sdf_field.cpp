#include "kaustik/geometry/sdf_field.h"

#include <cmath>

namespace kaustik {
namespace {

Vec3d absolute(const Vec3d& v) { return {std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}; }

double distance_to_cube(const Vec3d& p) {
  const Vec3d q = absolute(p) - Vec3d(1, 1, 1);
  const Vec3d outside(std::max(q.x, 0.0), std::max(q.y, 0.0), std::max(q.z, 0.0));
  return outside.length() + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

/// The cube minus, for each level, the infinite crosses of square bars of its cells (after Quilez,
/// "Menger fractal", 2011). The maximum of functions of Lipschitz constant 1 has that constant.
double menger(const Vec3d& p, int iterations) {
  double distance = distance_to_cube(p);
  double scale = 1;
  for (int i = 0; i < iterations; ++i) {
    Vec3d cell;
    for (int axis = 0; axis < 3; ++axis) {
      const double x = p[axis] * scale;
      cell[axis] = x - 2 * std::floor(0.5 * x) - 1;  // in [-1, 1), the bar at its ends
    }
    scale *= 3;
    const Vec3d bar = absolute(Vec3d(1, 1, 1) - absolute(cell) * 3.0);
    const double cross =
        std::min({std::max(bar.x, bar.y), std::max(bar.y, bar.z), std::max(bar.z, bar.x)});
    distance = std::max(distance, (cross - 1) / scale);
  }
  return distance;
}

/// White and Nylander's power-8 bulb with Hart's distance estimate ½ r log r / r' (Hart, Sandin and
/// Kauffman 1989); halved once more, as the estimate is a bound only for complex polynomials.
double mandelbulb(const Vec3d& p, int iterations) {
  constexpr double extent = 1.25;  // the bulb fits into this radius
  const Vec3d c = p * extent;
  Vec3d z = c;
  double derivative = 1;
  double r = z.length();
  for (int i = 0; i < iterations && r < 16; ++i) {
    const double theta = 8 * std::acos(r > 0 ? std::clamp(z.z / r, -1.0, 1.0) : 1.0);
    const double phi = 8 * std::atan2(z.y, z.x);
    const double r7 = std::pow(r, 7);
    derivative = 8 * r7 * derivative + 1;
    z = Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)) *
            (r7 * r) +
        c;
    r = z.length();
  }
  return r > 0 ? 0.25 * std::log(r) * r / (derivative * extent) : -1e-3;
}

}  // namespace

double SdfField::value(const Vec3d& p) const {
  return kind == SdfKind::menger ? menger(p, iterations) : mandelbulb(p, iterations);
}

Vec3d SdfField::gradient(const Vec3d& p) const {
  constexpr double h = 1e-6;
  const auto slope = [&](const Vec3d& step) { return value(p + step) - value(p - step); };
  const Vec3d g(slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h}));
  const double length = g.length();
  return length > 0 ? g / length : Vec3d(0, 0, 1);
}

}  // namespace kaustik
