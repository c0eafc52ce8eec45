// The camera that files without one get.

#include <algorithm>
#include <cmath>

#include "kaustik/loader/scene_format.h"
#include "tests/loader/gltf_support.h"

namespace kaustik::test {
namespace {

/// How far a box reaches to the edges of its picture along each axis: 1 is the edge itself.
struct Reach {
  double across = 0, upward = 0;
};

Reach reach_of_box(const Vec3f& low, const Vec3f& high) {
  std::string text;
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    const Vec3f& p = corners.back();
    text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  }
  text += "f 1 2 4\nf 5 6 8\nf 1 3 7\n";
  kaustik::TemporaryFolder folder;
  const Description description = load_scene(folder.write("box.obj", text));
  const Object& sensor = only_in(*description.scene, "sensor");
  const Transform to_camera = value<Transform>(sensor, "to_world").inverse();
  const Object& film = only_in(sensor, "film");
  const double aspect =
      double(value<int64_t>(film, "width")) / double(value<int64_t>(film, "height"));
  EXPECT_GE(aspect, 1);
  const double tangent = std::tan(value<double>(sensor, "fov") / 2 * std::numbers::pi / 180);
  Reach reach;
  for (const Vec3f& corner : corners) {
    const Vec3f seen = to_camera.point(corner);
    EXPECT_GT(seen.z, 0);
    const double edge = tangent * double(seen.z);
    reach.across = std::max(reach.across, std::abs(double(seen.x)) / (edge * aspect));
    reach.upward = std::max(reach.upward, std::abs(double(seen.y)) / edge);
  }
  return reach;
}

TEST(Framing, FillsThePictureWithBoxesOfAnyForm) {
  const std::pair<Vec3f, Vec3f> boxes[] = {
      {Vec3f(-1, -1, -1), Vec3f(1, 1, 1)},        // a cube
      {Vec3f(-10, 0, -10), Vec3f(10, 0.1f, 10)},  // a floor
      {Vec3f(100, 0, 3), Vec3f(101, 30, 4)},      // a tower
      {Vec3f(-50, -1, -1), Vec3f(50, 1, 1)},      // a wall seen from its side
      {Vec3f(-1, -1, -500), Vec3f(1, 1, 500)}};   // a tunnel
  for (const auto& [low, high] : boxes) {
    const Reach reach = reach_of_box(low, high);
    EXPECT_LT(reach.across, 0.96);
    EXPECT_LT(reach.upward, 0.96);
    EXPECT_GT(std::max(reach.across, reach.upward), 0.94);
  }
}

/// How far from the origin the camera stands that sees these spheres, each a radius.
double distance_of_camera(std::initializer_list<double> radii) {
  std::string text = "void plastic p 0 0 5 .5 .5 .5 0 0\n";
  for (const double radius : radii) text += fmt::format("p sphere s 0 0 4 0 0 0 {}\n", radius);
  kaustik::TemporaryFolder folder;
  const Description description = load_scene(folder.write("spheres.rad", text));
  const Object& sensor = only_in(*description.scene, "sensor");
  return Vec3d(value<Transform>(sensor, "to_world").point({0, 0, 0})).length();
}

TEST(Framing, SkiesAroundAllElseDoNotCount) {
  const double alone = distance_of_camera({1});
  EXPECT_NEAR(distance_of_camera({1, 500}), alone, 1e-3);
  EXPECT_NEAR(distance_of_camera({500, 1}), alone, 1e-3);
  EXPECT_NEAR(distance_of_camera({500, 1, 40}), alone, 1e-3);  // one in the other
  // No room for a camera between the two.
  EXPECT_NEAR(distance_of_camera({1, 3}), 3 * alone, 1e-3);
}

}  // namespace
}  // namespace kaustik::test
