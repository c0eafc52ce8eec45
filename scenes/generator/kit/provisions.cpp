#include "kit/provisions.h"

#include "kit/random.h"
#include "kit/sweep.h"

namespace kaustik::scenes {
namespace {

/// The solid about z that the profile (millimetres) makes, swollen by soft noise of `height`
/// metres.
Mesh grown(const Curve& millimetres, int segments, double height, uint64_t seed) {
  Curve profile = smooth_curve(millimetres, 5);
  for (Vec2d& p : profile) p *= 0.001;
  const auto swelling = [=](const Vec3d& p) { return height * fractal_noise(p * 28, 2, seed); };
  return shaded(displaced(revolved(profile, segments), swelling), 50);
}

}  // namespace

Pear pear(uint64_t seed) {
  Mesh flesh = grown({{0, 4},
                      {5, 2.2},
                      {11, 0.3},
                      {21, 2.5},
                      {30, 10},
                      {36, 23},
                      {37, 37},
                      {33.5, 51},
                      {27, 64},
                      {21, 76},
                      {17, 87},
                      {12.5, 95.5},
                      {7, 99},
                      {3, 98},
                      {0, 96.5}},
                     96, 0.0022, seed);
  const auto lean = [](const Vec3d& p) {
    const double up = std::max(0.0, p.z - 0.03) / 0.07;
    return Vec3d(p.x + 0.007 * up * up, p.y, p.z);
  };
  flesh = shaded(bent(std::move(flesh), lean), 50);
  const double low = lowest(flesh);
  SweepOptions round;
  round.crease_degrees = 60;
  round.scale = [](double t) { return 1 - 0.45 * std::sin(pi_d * std::min(t, 0.85)); };
  const Mesh stalk = tube(
      0.0021,
      smooth_path(
          {{0.006, 0, 0.093}, {0.0075, 0, 0.103}, {0.011, 0.001, 0.113}, {0.018, 0.001, 0.121}}, 6),
      16, round);
  return {moved(flesh, {0, 0, -low}), moved(stalk, {0, 0, -low})};
}

Mesh lemon(uint64_t seed) {
  Mesh mesh = grown({{0, 0},
                     {2.5, 0.3},
                     {4.5, 2.5},
                     {8, 6.5},
                     {16, 12},
                     {23.5, 21},
                     {27.5, 33},
                     {27.5, 45},
                     {23.5, 57},
                     {16, 66},
                     {9, 71},
                     {5.5, 75},
                     {3.5, 78.5},
                     {0, 79.5}},
                    96, 0.0012, seed);
  mesh = turned(moved(mesh, {0, 0, -0.04}), {0, 1, 0}, 90);
  return moved(mesh, {0, 0, -lowest(mesh)});
}

Book book(double spine, double depth, double thickness) {
  constexpr double board = 0.003, square = 0.004, joint = 0.007;  // square: the cover's overhang
  const double x = 0.5 * spine, y = 0.5 * depth, middle = 0.5 * thickness;
  Book b;
  for (const double z : {0.0, thickness - board})
    b.cover.append(bevelled_box({-x, -y + joint, z}, {x, y, z + board}, 0.0008, 2));
  // The spine: an arc of leather that bulges toward low y, and rolls over the joints.
  const auto arc = [&](double bulge, double inset, double from, double to) {
    Path path;
    for (int i = 0; i <= 24; ++i) {
      const double a = from + (to - from) * i / 24;
      path.emplace_back(0, -y + 0.006 - (bulge - inset) * std::cos(a),
                        middle + (middle - 0.0011 - inset) * std::sin(a));
    }
    return path;
  };
  const double quarter = pi_d / 2;
  Path leather = arc(0.012, 0, -quarter, quarter);
  leather.insert(leather.begin(), Vec3d(0, -y + 0.013, 0.0011));
  leather.emplace_back(0, -y + 0.013, thickness - 0.0011);
  b.cover.append(swept(rectangle(0.0022, spine), leather, {1, 0, 0}));
  // Raised bands, each with gilt fillets beside it.
  SweepOptions round;
  round.crease_degrees = 60;
  for (const double share : {-0.33, -0.11, 0.11, 0.33}) {
    const Vec3d at(share * spine, 0, 0);
    Mesh band = tube(0.0024, arc(0.0128, 0, -0.74 * quarter, 0.74 * quarter), 12, round);
    b.cover.append(moved(band, at));
    for (const double side : {-0.006, 0.006}) {
      Mesh fillet = tube(0.0005, arc(0.0131, 0, -0.74 * quarter, 0.74 * quarter), 8, round);
      b.gilding.append(moved(fillet, at + Vec3d(side, 0, 0)));
    }
  }
  b.pages = box({-x + square, -y + 0.006, board}, {x - square, y - square, thickness - board});
  return b;
}

}  // namespace kaustik::scenes
