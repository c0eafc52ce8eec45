#include "kit/sculpture.h"

#include "kit/random.h"
#include "kit/sweep.h"

namespace kaustik::scenes {
namespace {

double trunk(const Vec3d& p) {
  double d = distance_to_ellipsoid(p, {0.02, 0.01, 1.00}, {0.165, 0.125, 0.13});
  d = blended(d, distance_to_ellipsoid(p, {0.01, 0.0, 1.14}, {0.112, 0.085, 0.14}), 0.08);
  d = blended(d, distance_to_ellipsoid(p, {-0.005, 0.005, 1.30}, {0.138, 0.098, 0.14}), 0.07);
  d = blended(d, distance_to_bar(p, {-0.155, 0.01, 1.415}, 0.046, {0.15, 0.01, 1.395}, 0.046),
              0.07);
  for (const double side : {-1.0, 1.0})
    d = blended(d, distance_to_ball(p, {side * 0.062 - 0.005, -0.078, 1.30}, 0.050), 0.045);
  return blended(d, distance_to_bar(p, {0, 0.012, 1.43}, 0.045, {-0.008, -0.004, 1.54}, 0.040),
                 0.05);
}

double head(const Vec3d& p) {
  const Vec3d c(-0.012, -0.02, 1.63);
  double d = distance_to_ellipsoid(p, c, {0.070, 0.086, 0.098});
  d = blended(d, distance_to_ellipsoid(p, c + Vec3d(0, -0.035, -0.055), {0.047, 0.048, 0.052}),
              0.04);
  d = blended(
      d,
      distance_to_bar(p, c + Vec3d(0, -0.083, 0.012), 0.007, c + Vec3d(0, -0.098, -0.022), 0.011),
      0.018);
  for (const double side : {-1.0, 1.0})  // sockets of the eyes
    d = carved(d, distance_to_ball(p, c + Vec3d(side * 0.030, -0.101, 0.012), 0.020), 0.02);
  d = blended(d,
              distance_to_bar(p, c + Vec3d(-0.016, -0.080, -0.052), 0.008,
                              c + Vec3d(0.016, -0.080, -0.052), 0.008),
              0.012);
  const double strands = 0.0035 * std::sin(70 * (p.z - c.z) + 30 * std::fabs(p.x - c.x));
  double hair =
      distance_to_ellipsoid(p, c + Vec3d(0, 0.018, 0.018), {0.080, 0.088, 0.098}) + strands;
  hair = carved(hair, distance_to_ellipsoid(p, c + Vec3d(0, -0.090, -0.035), {0.070, 0.085, 0.095}),
                0.02);
  hair = blended(hair, distance_to_ball(p, c + Vec3d(0, 0.115, 0.045), 0.044) + strands, 0.03);
  return blended(d, hair, 0.008);
}

double arm(const Vec3d& p, const Vec3d& shoulder, const Vec3d& elbow, const Vec3d& wrist,
           const Vec3d& tips) {
  double d = distance_to_bar(p, shoulder, 0.043, elbow, 0.032);
  d = blended(d, distance_to_bar(p, elbow, 0.032, wrist, 0.021), 0.02);
  const Vec3d along = tips - wrist;
  d = blended(d, distance_to_bar(p, wrist + along * 0.25, 0.024, wrist + along * 0.6, 0.019), 0.03);
  return blended(d, distance_to_bar(p, wrist + along * 0.5, 0.017, tips, 0.009), 0.02);
}

/// A skirt that widens toward the floor in swinging folds.
double skirt(const Vec3d& p) {
  const double down = std::clamp((1.06 - p.z) / 1.06, 0.0, 1.0);
  const double sway = 0.07 * std::sin(2.4 * down);
  const Vec3d q(p.x - sway, p.y - 0.05 * down, p.z);
  const double angle = std::atan2(q.y, q.x), turn = 1.1 * down;
  const double radius = 0.128 + 0.07 * std::sin(pi_d * std::min(1.0, 2.2 * down)) * (1 - down) +
                        0.25 * std::pow(down, 1.5);
  const double folds = std::sin(7 * (angle + turn)) +
                       0.55 * std::sin(13 * (angle - 0.6 * turn) + 1) +
                       0.3 * std::sin(3 * angle + 2);
  const double side = std::hypot(q.x, q.y) - radius - 0.055 * std::pow(down, 1.2) * folds;
  const double top = p.z - 1.08 - 0.02 * std::sin(angle), bottom = -p.z;
  return 0.6 * std::max({side, top, bottom});
}

/// Point `t` of 0 … 1 of a trefoil knot, about 1 high.
Vec3d trefoil(double t) {
  const double a = 2 * pi_d * t;
  return {0.145 * (std::sin(a) + 2 * std::sin(2 * a)), -0.15 * std::sin(3 * a),
          0.145 * (std::cos(a) - 2 * std::cos(2 * a))};
}

}  // namespace

Mesh dancer(double cell) {
  const Field body = [](const Vec3d& p) {
    double d = trunk(p);
    const double arms = std::min(arm(p, {-0.165, 0.01, 1.415}, {-0.315, -0.03, 1.585},
                                     {-0.155, -0.07, 1.79}, {-0.03, -0.10, 1.86}),
                                 arm(p, {0.16, 0.01, 1.395}, {0.335, 0.03, 1.22},
                                     {0.47, -0.11, 1.34}, {0.585, -0.19, 1.33}));
    d = blended(d, arms, 0.05);
    d = blended(d, head(p), 0.02);
    return blended(d, skirt(p), 0.03);
  };
  return contoured(body, {-0.72, -0.62, -0.05}, {0.72, 0.72, 1.98}, cell);
}

Mesh knot(double height) {
  constexpr int points = 150;
  Mesh mesh;
  // Sections stand square to the curve; their frame turns evenly by what is missing at the end.
  constexpr int around = 16;
  const double radius = 0.088;
  for (int i = 0; i <= points; ++i) {
    const double t = double(i % points) / points;
    const Vec3d at = trefoil(t);
    const Vec3d along = (trefoil(t + 1e-4) - trefoil(t - 1e-4)).normalized();
    const Vec3d outward = (at - Vec3d(0, at.y, 0) * 0.5).normalized();
    const Vec3d x = (outward - along * outward.dot(along)).normalized(), y = along.cross(x);
    for (int k = 0; k <= around; ++k) {
      const double a = 2 * pi_d * (k % around) / around;
      mesh.add(at + x * (radius * std::cos(a)) + y * (radius * std::sin(a)),
               {double(k) / around, double(i) / points});
    }
  }
  for (uint32_t i = 0; i < points; ++i)
    for (uint32_t k = 0; k < around; ++k) {
      const uint32_t a = i * (around + 1) + k;
      mesh.quad(a, a + 1, a + around + 2, a + around + 1);
    }
  double lowest = 0, highest = 0;
  for (const Vertex& v : mesh.vertices) {
    lowest = std::min(lowest, v.position.z);
    highest = std::max(highest, v.position.z);
  }
  const double factor = height / (highest - lowest);
  return shaded(scaled(moved(mesh, {0, 0, -lowest}), Vec3d(factor)), 180);
}

Mesh snail_shell(double size) {
  Path path;
  std::vector<double> widths;
  constexpr int points = 130;
  for (int i = 0; i <= points; ++i) {
    const double t = double(i) / points, angle = 2 * pi_d * 4.2 * t;
    const double growth = std::exp(2.6 * (t - 1));
    path.push_back(Vec3d(0.26 * growth * std::cos(angle), 0.26 * growth * std::sin(angle),
                         1.05 - 0.80 * growth) *
                   size);
    widths.push_back(growth);
  }
  SweepOptions options;
  options.crease_degrees = 60;
  options.scale = [&](double share) {
    // The share of the path's length grows as the width does: length up to t is ~ growth.
    return std::max(0.07, 0.074 + (1 - 0.074) * share);
  };
  Curve ribbed;
  for (int k = 0; k < 20; ++k) {
    const double a = 2 * pi_d * k / 20;
    ribbed.emplace_back(0.25 * size * std::cos(a), 0.25 * size * std::sin(a));
  }
  return swept(ribbed, path, {0, 0, 1}, options);
}

Mesh crystal_cluster(double height, int count, uint64_t seed) {
  Random random(seed);
  Mesh cluster;
  for (int i = 0; i < count; ++i) {
    const double share = double(i) / count;
    const double length = height * (1 - 0.65 * share) * random.between(0.85, 1.1);
    const double radius = length * random.between(0.10, 0.15);
    Mesh one =
        revolved({{0, 0}, {0.75 * radius, 0}, {radius, 0.75 * length}, {0, length}}, 6, false, 0);
    one = turned(std::move(one), {0, 0, 1}, random.between(0, 60));
    const double azimuth = 137.5 * i, lean = 8 + 62 * share;
    one = turned(turned(std::move(one), {0, 1, 0}, lean), {0, 0, 1}, azimuth);
    cluster.append(moved(std::move(one), {0, 0, 0.02 * height}));
  }
  Mesh root = ball({0, 0, 0}, 0.30 * height, 20);
  root = bent(root, [&](const Vec3d& p) {
    const double rough = 1 + 0.25 * noise(p * (9 / height), seed + 5);
    return Vec3d(p.x * rough, p.y * rough, std::max(p.z, 0.0) * 0.55 * rough);
  });
  cluster.append(shaded(root, 20));
  return cluster;
}

Mesh idol_head(double height, double cell) {
  const Field form = [](const Vec3d& p) {
    double d = distance_to_ellipsoid(p, {0, 0.02, 0.62}, {0.20, 0.15, 0.36});
    d = carved(d, p.y + 0.07 + 0.18 * (p.z - 0.62), 0.06);  // the plane of the face
    d = blended(d, distance_to_bar(p, {0, -0.10, 0.74}, 0.022, {0, -0.135, 0.50}, 0.036), 0.03);
    d = blended(d, distance_to_bar(p, {0, 0.03, 0.05}, 0.105, {0, 0.03, 0.40}, 0.085), 0.06);
    return std::max(d, 0.005 - p.z);
  };
  const Mesh mesh = contoured(form, {-0.3, -0.3, -0.05}, {0.3, 0.3, 1.05}, cell / height);
  return scaled(mesh, Vec3d(height));
}

}  // namespace kaustik::scenes
