#include "kit/glassware.h"

namespace kaustik::scenes {
namespace {

constexpr int around = 144;
constexpr double millimetre = 0.001;

Curve in_metres(Curve millimetres) {
  for (Vec2d& p : millimetres) p *= millimetre;
  return millimetres;
}

double eased(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Ribs of a mould about z, from the height `low` to `high`, that wind by `twist` radians for each
/// metre; grooves `depth` deep between them. Metres.
struct Ribs {
  int count = 0;
  double depth = 0, twist = 0, low = 0, high = 0;
};

Mesh ribbed(const Mesh& mesh, const Ribs& ribs) {
  return bent(mesh, [=](const Vec3d& p) {
    const double radius = std::hypot(p.x, p.y);
    if (radius == 0) return p;
    const double there = eased((p.z - ribs.low) / 0.03) * eased((ribs.high - p.z) / 0.03);
    const double angle = ribs.count * (std::atan2(p.y, p.x) + ribs.twist * p.z);
    const double factor = 1 - ribs.depth * there * 0.5 * (1 - std::cos(angle)) / radius;
    return Vec3d(p.x * factor, p.y * factor, p.z);
  });
}

/// A vessel of the outside and the inside, in millimetres from the axis upward, that meet at the
/// rim; ribs are in all of its wall.
Vessel blown(const Curve& outside, const Curve& inside, double level, const Ribs& ribs = {}) {
  const Curve hollow = in_metres(smooth_curve(inside, 5));
  Curve profile = in_metres(smooth_curve(outside, 5));
  profile.insert(profile.end(), hollow.rbegin(), hollow.rend());
  const Mesh round = revolved(profile, ribs.count > 0 ? 16 * ribs.count : around, false, 50);
  return {ribs.count > 0 ? shaded(ribbed(round, ribs), 50) : round,
          filling(hollow, level, 0.6 * millimetre, 1.2 * millimetre, around)};
}

}  // namespace

Mesh filling(const Curve& inside, double level, double overlap, double meniscus, int segments) {
  Curve profile;
  for (size_t i = 0; i + 1 < inside.size() && inside[i].y < level; ++i) {
    const Vec2d along = (inside[i + 1] - inside[i]).normalized();
    const Vec2d out(along.y, -along.x);
    profile.push_back(inside[i] + out * overlap);
    if (inside[i].x == 0) profile.back().x = 0;
  }
  const double at_wall = profile.back().x - overlap, width = 1.5 * meniscus;
  while (profile.back().y > level - 0.2 * meniscus) profile.pop_back();
  profile.emplace_back(at_wall + overlap, level + meniscus);
  for (const double t : {0.4, 0.8, 1.2, 1.7, 2.4, 3.5, 5.0})
    profile.emplace_back(at_wall - t * width, level + meniscus * std::exp(-t));
  profile.emplace_back(0, level);
  return revolved(profile, segments, false, 50);
}

Vessel decanter(double level) {
  return blown({{0, 1.5},  {20, 1.2}, {36, 0},   {44, 1.5}, {51, 8},   {57, 20},  {60, 35},
                {59, 52},  {54, 70},  {45, 88},  {34, 104}, {25, 120}, {20, 137}, {18.2, 155},
                {18, 172}, {19, 189}, {22, 205}, {27, 218}, {32, 227}, {33, 229}},
               {{0, 7},        {16, 7.2},   {32, 8.2},     {41, 10.5},    {48.5, 16},
                {54.3, 25},    {57.2, 38},  {56.3, 53},    {51.4, 69.4},  {42.6, 86.6},
                {31.6, 102.6}, {22.6, 119}, {17.6, 136},   {15.9, 155},   {15.8, 172.3},
                {16.8, 189.4}, {19.8, 206}, {24.9, 219.4}, {30.8, 228.6}, {32, 230}},
               level, {.count = 14, .depth = 0.0009, .twist = 6, .low = 0.010, .high = 0.150});
}

Vessel wine_glass(double level) {
  return blown({{0, 1},      {16, 0.6},   {32, 0},   {34.6, 0.7}, {33, 1.8}, {24, 3.2},
                {14, 5.5},   {7.5, 10},   {4.6, 18}, {3.8, 30},   {3.6, 45}, {3.8, 60},
                {4.8, 72},   {9, 80},     {20, 87},  {31, 97},    {38, 112}, {40.5, 128},
                {39.5, 146}, {36.5, 164}, {33, 181}, {32.4, 184}},
               {{0, 82},
                {9, 84.6},
                {19, 90},
                {29.6, 99.2},
                {36.6, 113.2},
                {39.1, 128},
                {38.1, 145.8},
                {35.1, 163.6},
                {31.8, 181},
                {31.5, 184}},
               level);
}

Mesh fluted_cup(int flutes) {
  const Curve outside = smooth_curve(
      {{26, 1.5}, {29, 6}, {29.5, 14}, {30.5, 30}, {32.5, 50}, {35.5, 70}, {39.5, 88}}, 8);
  const Curve inside = smooth_curve(
      {{38.6, 88.5}, {34.6, 70}, {31.6, 50}, {29.6, 30}, {28.6, 14}, {26, 7}, {16, 4}}, 8);
  Curve profile = {{0, 0}, {24.5, 0}};
  profile.insert(profile.end(), outside.begin(), outside.end());
  profile.insert(profile.end(), inside.begin(), inside.end());
  profile.emplace_back(0, 3);
  const auto fluted = [flutes](const Vec3d& p) {
    const double depth = 0.05 * eased((p.z - 0.012) / 0.03) * eased((0.085 - p.z) / 0.025);
    const double factor = 1 - depth * std::fabs(std::cos(0.5 * flutes * std::atan2(p.y, p.x)));
    return Vec3d(p.x * factor, p.y * factor, p.z);
  };
  return shaded(bent(revolved(in_metres(profile), 16 * flutes), fluted), 40);
}

}  // namespace kaustik::scenes
