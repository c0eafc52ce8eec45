#include "scenes/fountain.h"

#include "kit/random.h"
#include "kit/surface.h"
#include "kit/sweep.h"

namespace kaustik::scenes {
namespace {

/// Rings spread where streams fall in, over a slight unrest.
double ripples(const Vec2d& p, const std::vector<Vec2d>& falls, double height) {
  double z = 0.25 * height * noise({4 * p.x, 4 * p.y, 0.5});
  for (const Vec2d& fall : falls) {
    const double d = (p - fall).length();
    z += height * std::cos(2 * pi_d * d / 0.11) * std::exp(-d / 0.28) / (1 + 4 * d);
  }
  return z;
}

/// A round sheet of water about the z axis.
Mesh water_disk(double inner, double radius, double level, int rings, int segments,
                const std::vector<Vec2d>& falls, double height) {
  return sheet(rings, segments, [&, inner, radius, level, height](double u, double v) {
    const double r = inner + (radius - inner) * u, a = 2 * pi_d * v;
    const Vec2d p(r * std::cos(a), r * std::sin(a));
    return Vec3d(p.x, p.y, level + ripples(p, falls, height));
  });
}

/// Where a body is after `t` seconds that was thrown from `from` with `speed` (m/s).
Vec3d thrown(const Vec3d& from, const Vec3d& speed, double t) {
  return from + speed * t - Vec3d(0, 0, 0.5 * 9.81 * t * t);
}

/// A stream of water from `from` until it is at height `until`, with drops about its end.
Mesh stream(const Vec3d& from, const Vec3d& speed, double until, double radius, Random& random) {
  const double t_end =
      (speed.z + std::sqrt(speed.z * speed.z + 2 * 9.81 * (from.z - until))) / 9.81;
  Path path;
  constexpr int steps = 18;
  for (int i = 0; i <= steps; ++i) path.push_back(thrown(from, speed, t_end * i / steps));
  SweepOptions options;
  options.crease_degrees = 70;
  const double wobble = 10 * random.next();
  options.scale = [wobble](double t) {
    return (1 - 0.35 * t) * (1 + 0.22 * t * std::sin(23 * t + wobble));
  };
  Mesh water = tube(radius, path, 10, options);
  for (int i = 0; i < 4; ++i) {
    const double t = t_end * random.between(0.35, 0.97);
    // In this order, whatever the compiler's for arguments is.
    const double off_z = random.between(-0.04, 0.04), off_y = random.between(-0.05, 0.05),
                 off_x = random.between(-0.05, 0.05);
    const Vec3d off(off_x, off_y, off_z);
    const Vec3d at = thrown(from, speed, t) + off;
    if (at.z > until + 0.02) water.append(ball(at, radius * random.between(0.35, 0.7), 10));
  }
  return water;
}

}  // namespace

void add_fountain(SceneFolder& scene, uint64_t seed) {
  constexpr double pool_level = 0.42, bowl_level = 1.66, pool_radius = 1.72, bowl_radius = 0.80;
  const Curve basin = {{0, 0},       {1.98, 0},    {1.98, 0.10}, {1.90, 0.16},
                       {1.86, 0.34}, {1.92, 0.44}, {2.0, 0.48},  {2.0, 0.55},
                       {1.72, 0.55}, {1.72, 0.14}, {0, 0.14}};
  const Curve foot = {{0, 0.13},    {0.52, 0.13}, {0.52, 0.26}, {0.30, 0.40}, {0.20, 0.62},
                      {0.17, 0.90}, {0.22, 1.08}, {0.20, 1.20}, {0.34, 1.30}, {0, 1.30}};
  const Curve bowl = {{0, 1.28},    {0.30, 1.28},  {0.62, 1.42},  {0.86, 1.64},
                      {0.92, 1.70}, {0.90, 1.735}, {0.84, 1.735}, {0.80, 1.68},
                      {0.58, 1.48}, {0.28, 1.40},  {0, 1.385}};
  const Curve finial = {{0, 1.38},    {0.20, 1.38}, {0.16, 1.50}, {0.08, 1.62}, {0.07, 1.86},
                        {0.12, 1.94}, {0.13, 2.00}, {0.05, 2.06}, {0.03, 2.12}, {0, 2.12}};
  scene.add_mesh("basin", revolved(basin, 96), "marble_pale", {}, "The fountain.");
  scene.add_mesh("fountain_bowl", merged({revolved(smooth_curve(foot, 4), 64), revolved(bowl, 80)}),
                 "marble_green");
  scene.add_mesh("finial", revolved(finial, 40), "bronze");
  Random random(seed + 17);
  Mesh streams;
  std::vector<Vec2d> bowl_falls, pool_falls;
  for (int i = 0; i < 8; ++i) {  // from the finial into the bowl
    const double a = 2 * pi_d * (i + 0.5) / 8;
    const Vec3d out(std::cos(a), std::sin(a), 0), from = out * 0.03 + Vec3d(0, 0, 2.10);
    const Vec3d speed = out * 0.78 + Vec3d(0, 0, 1.9);
    streams.append(stream(from, speed, bowl_level - 0.01, 0.012, random));
    const double t = (1.9 + std::sqrt(1.9 * 1.9 + 2 * 9.81 * (2.10 - bowl_level))) / 9.81;
    bowl_falls.push_back({out.x * (0.03 + 0.78 * t), out.y * (0.03 + 0.78 * t)});
  }
  for (int i = 0; i < 16; ++i) {  // from the bowl's rim into the basin
    const double a = 2 * pi_d * i / 16 + 0.1;
    const Vec3d out(std::cos(a), std::sin(a), 0), from = out * 0.90 + Vec3d(0, 0, 1.725);
    const Vec3d speed = out * 0.75 + Vec3d(0, 0, 0.35);
    streams.append(stream(from, speed, pool_level - 0.01, 0.014, random));
    const double t = (0.35 + std::sqrt(0.35 * 0.35 + 2 * 9.81 * (1.725 - pool_level))) / 9.81;
    pool_falls.push_back({out.x * (0.90 + 0.75 * t), out.y * (0.90 + 0.75 * t)});
  }
  scene.add_mesh("streams", streams, "water", {}, "Moving water: streams, drops, rings.");
  scene.add_mesh("pool_water",
                 water_disk(0.2, pool_radius + 0.003, pool_level, 56, 150, pool_falls, 0.012),
                 "water");
  scene.add_mesh("bowl_water",
                 water_disk(0.05, bowl_radius - 0.012, bowl_level, 26, 90, bowl_falls, 0.007),
                 "water");
}

}  // namespace kaustik::scenes
