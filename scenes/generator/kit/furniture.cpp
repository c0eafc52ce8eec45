#include "kit/furniture.h"

#include "kit/random.h"

namespace kaustik::scenes {
namespace {

/// A quarter of the way from `from` to `to` is still nearly the one, three quarters the other.
SweepOptions tapering(double from, double to) {
  SweepOptions options;
  options.crease_degrees = 60;
  options.scale = [=](double share) { return from + (to - from) * share; };
  return options;
}

Mesh ring_bar(const Path& path, double radius, int segments) {
  SweepOptions options;
  options.closed_path = true;
  options.crease_degrees = 60;
  return tube(radius, path, segments, options);
}

}  // namespace

BentwoodChair bentwood_chair() {
  constexpr double seat = 0.46, radius = 0.20;
  BentwoodChair chair;
  chair.wood = moved(torus(radius, 0.017, 40, 10), {0, 0, seat});
  chair.cane = cylinder(radius, seat - 0.002, seat + 0.004, 40);
  for (const double side : {-1.0, 1.0})
    chair.wood.append(tube(0.016,
                           smooth_path({{side * 0.14, -0.14, seat - 0.01},
                                        {side * 0.155, -0.155, 0.25},
                                        {side * 0.18, -0.18, 0}},
                                       4),
                           10, tapering(1, 0.7)));
  // Back legs and the arch of the back are one bent bar; a second arch stands within.
  const auto arch = [](double half_width, double top, double foot_z) {
    Path points;
    if (foot_z == 0) points = {{-0.19, 0.24, 0}, {-0.155, 0.17, 0.28}};
    points.insert(points.end(), {{-half_width, 0.14, seat},
                                 {-half_width * 1.12, 0.18, seat + 0.6 * (top - seat)},
                                 {-half_width * 0.75, 0.215, top - 0.05},
                                 {0, 0.225, top},
                                 {half_width * 0.75, 0.215, top - 0.05},
                                 {half_width * 1.12, 0.18, seat + 0.6 * (top - seat)},
                                 {half_width, 0.14, seat}});
    if (foot_z == 0) points.insert(points.end(), {{0.155, 0.17, 0.28}, {0.19, 0.24, 0}});
    return smooth_path(points, 5);
  };
  SweepOptions round;
  round.crease_degrees = 60;
  chair.wood.append(tube(0.0155, arch(0.14, 0.9, 0), 10, round));
  chair.wood.append(tube(0.011, arch(0.085, 0.79, seat), 8, round));
  Path stretcher;
  for (const Vec2d& p : circle(0.165, 32)) stretcher.emplace_back(p.x, p.y + 0.01, 0.23);
  chair.wood.append(ring_bar(stretcher, 0.010, 8));
  return chair;
}

PottedPlant potted_plant(double height, int leaves, uint64_t seed) {
  constexpr double pot_height = 0.34, pot_radius = 0.19;
  PottedPlant plant;
  plant.pot = revolved({{0, 0},
                        {0.70 * pot_radius, 0},
                        {0.74 * pot_radius, 0.01},
                        {0.95 * pot_radius, 0.82 * pot_height},
                        {1.06 * pot_radius, 0.83 * pot_height},
                        {1.08 * pot_radius, pot_height},
                        {0.96 * pot_radius, pot_height},
                        {0.88 * pot_radius, 0.80 * pot_height},
                        {0, 0.80 * pot_height}},
                       40);
  plant.earth = ball({0, 0, 0.72 * pot_height}, 0.9 * pot_radius, 20);
  plant.earth = bent(plant.earth, [](const Vec3d& p) {
    return Vec3d(p.x, p.y,
                 0.83 * pot_height + 0.2 * (p.z - 0.72 * pot_height) + 0.012 * noise(p * 40.0));
  });
  plant.earth = shaded(plant.earth, 180);
  Random random(seed);
  for (int i = 0; i < leaves; ++i) {
    const double share = (i + 0.5) / leaves;
    const double azimuth = 2.39996 * i + random.between(-0.25, 0.25);  // the golden angle
    const double lean = 0.10 + 0.42 * (1 - share) + random.between(-0.03, 0.05);
    const double top = pot_height + (height - pot_height) * (0.35 + 0.65 * share);
    const Vec3d outward(std::cos(azimuth), std::sin(azimuth), 0);
    const Vec3d root = outward * 0.03 + Vec3d(0, 0, 0.80 * pot_height);
    const Vec3d tip = outward * (lean * (top - pot_height) + 0.04) + Vec3d(0, 0, top);
    const Vec3d middle = (root + tip) * 0.5 - outward * (0.25 * lean * (top - pot_height));
    plant.stems.append(tube(0.007, smooth_path({root, middle, tip}, 4), 6, tapering(1, 0.5)));
    const double length = random.between(0.30, 0.42) * (0.8 + 0.4 * share);
    Mesh blade = leaf(length, 0.42 * length, 0.35, random.between(0.9, 1.5));
    blade = turned(std::move(blade), {0, 1, 0}, random.between(-55, -15));
    blade = turned(std::move(blade), {0, 0, 1}, azimuth * 180 / pi_d);
    plant.leaves.append(moved(std::move(blade), tip));
  }
  return plant;
}

FoldingScreen folding_screen(int panels, double panel_width, double height, double fold_degrees) {
  constexpr double bar = 0.035, depth = 0.026, foot = 0.06, rail = 0.05;
  FoldingScreen panel;
  const double w = panel_width - 0.004;
  for (const double x : {0.5 * bar, w - 0.5 * bar})
    panel.frame.append(bevelled_box({x - 0.5 * bar, -0.5 * depth, 0},
                                    {x + 0.5 * bar, 0.5 * depth, height}, 0.004));
  for (const double z : {foot, 0.62 * height, height - rail})
    panel.frame.append(
        bevelled_box({bar, -0.46 * depth, z}, {w - bar, 0.46 * depth, z + rail}, 0.004));
  panel.cloth = box({bar, -0.0015, foot + rail}, {w - bar, 0.0015, height - rail});
  FoldingScreen screen;
  const double c = std::cos(fold_degrees * pi_d / 180), s = std::sin(fold_degrees * pi_d / 180);
  Vec3d at(-0.5 * panels * panel_width * c, 0, 0);
  for (int i = 0; i < panels; ++i) {
    const double sign = i % 2 == 0 ? 1 : -1;
    const auto place = [&](const Mesh& mesh) {
      return moved(turned(mesh, {0, 0, 1}, sign * fold_degrees), at);
    };
    screen.frame.append(place(panel.frame));
    screen.cloth.append(place(panel.cloth));
    at += Vec3d(c, sign * s, 0) * panel_width;
    if (i + 1 == panels) break;
    for (const double z : {0.15, 0.5, 0.85})
      screen.hinges.append(moved(cylinder(0.006, z * height - 0.03, z * height + 0.03, 12),
                                 at - Vec3d(0, sign * 0.5 * depth, 0)));
  }
  return screen;
}

Bench bench(double length, double depth, double height) {
  constexpr double cushion = 0.09;
  const double x = 0.5 * length, y = 0.5 * depth;
  Bench b;
  b.seat = bevelled_box({-x, -y, height - cushion}, {x, y, height}, 0.03, 3);
  b.legs = bevelled_box({-x + 0.04, -y + 0.04, height - cushion - 0.05},
                        {x - 0.04, y - 0.04, height - cushion}, 0.004);
  for (const double sx : {-1.0, 1.0})
    for (const double sy : {-1.0, 1.0})
      b.legs.append(tube(0.022,
                         {{sx * (x - 0.12), sy * (y - 0.09), height - cushion - 0.05},
                          {sx * (x - 0.08), sy * (y - 0.05), 0}},
                         14, tapering(1, 0.6)));
  return b;
}

Mesh pedestal(double width, double height) {
  const double w = 0.5 * width;
  const auto slab = [&](double half, double z0, double z1) {
    return bevelled_box({-half, -half, z0}, {half, half, z1}, 0.006);
  };
  Mesh mesh = slab(1.12 * w, 0, 0.09);
  mesh.append(slab(1.05 * w, 0.09, 0.12));
  mesh.append(slab(w, 0.12, height - 0.07));
  mesh.append(slab(1.05 * w, height - 0.07, height - 0.045));
  mesh.append(slab(1.1 * w, height - 0.045, height));
  return mesh;
}

Mesh amphora(double h) {
  Curve outside = smooth_curve({{0.10, 0},
                                {0.11, 0.03},
                                {0.19, 0.25},
                                {0.24, 0.50},
                                {0.20, 0.70},
                                {0.10, 0.80},
                                {0.075, 0.88},
                                {0.12, 0.98}},
                               6);
  Curve profile = {{0, 0}};
  profile.insert(profile.end(), outside.begin(), outside.end());
  profile.insert(profile.end(), {{0.12, 1.0}, {0.105, 1.0}, {0.06, 0.90}, {0.06, 0.82}, {0, 0.80}});
  for (Vec2d& p : profile) p *= h;
  Mesh mesh = revolved(profile, 36);
  SweepOptions round;
  round.crease_degrees = 60;
  for (const double side : {-1.0, 1.0})
    mesh.append(tube(0.018 * h,
                     smooth_path({{side * 0.07 * h, 0, 0.90 * h},
                                  {side * 0.19 * h, 0, 0.90 * h},
                                  {side * 0.22 * h, 0, 0.78 * h},
                                  {side * 0.18 * h, 0, 0.68 * h}},
                                 4),
                     8, round));
  return mesh;
}

Mesh bowl(double r) {
  Curve profile = {{0, 0}, {0.35, 0}, {0.37, 0.06}};
  const Curve outside = smooth_curve({{0.37, 0.06}, {0.72, 0.22}, {0.94, 0.52}, {1.0, 0.74}}, 6);
  profile.insert(profile.end(), outside.begin() + 1, outside.end());
  const Curve inside = smooth_curve({{0.96, 0.75}, {0.89, 0.53}, {0.66, 0.27}, {0, 0.12}}, 6);
  profile.insert(profile.end(), inside.begin(), inside.end());
  for (Vec2d& p : profile) p *= r;
  return revolved(profile, 36);
}

Curve frame_outline(double w, double d) {
  Curve outline = {{0, 0}, {w, 0}, {w, 0.55 * d}};
  const Curve top = smooth_curve({{0.92 * w, 0.85 * d},
                                  {0.75 * w, d},
                                  {0.55 * w, 0.72 * d},
                                  {0.35 * w, 0.48 * d},
                                  {0.2 * w, 0.62 * d},
                                  {0.1 * w, 0.6 * d}},
                                 3);
  outline.insert(outline.end(), top.begin(), top.end());
  outline.insert(outline.end(), {{0.08 * w, 0.35 * d}, {0, 0.3 * d}});
  return outline;
}

}  // namespace kaustik::scenes
