#include "kaustik/scene/look_through.h"

#include <gtest/gtest.h>

#include "kaustik/scene/scene_report.h"
#include "tests/scene/scene_support.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// Floors one over the other, at heights 0, 1, 2 …
std::shared_ptr<const Scene> floors(int count, const std::string& bsdf = diffuse("0.5")) {
  std::string all;
  for (int i = 0; i < count; ++i)
    all += flat("rectangle", translate(fmt::format("0, 0, {}", i)), bsdf);
  return scene_of(any_camera + all + point_light("0, 0, 9", 1));
}

const Ray down{{0.1f, 0.2f, 4.5f}, {0, 0, -1}};

TEST(LookThrough, PassesWhatDoesNotStopIt) {
  const auto scene = floors(3);
  std::vector<float> heights;
  const auto note = [&](const SurfacePoint& point, const Hit&, const Ray&) {
    heights.push_back(point.position.z);
    return false;
  };
  EXPECT_EQ(probe_through(*scene, down, 4, note), Look::free);
  EXPECT_EQ(heights, (std::vector<float>{2, 1, 0}));
  // Whether nothing lies behind the last one is not known.
  heights.clear();
  EXPECT_EQ(probe_through(*scene, down, 3, note), Look::too_deep);
  EXPECT_EQ(heights.size(), 3u);
}

TEST(LookThrough, EndsWhereItIsStopped) {
  const auto scene = floors(3);
  int asked = 0;
  EXPECT_EQ(probe_through(*scene, down, 9,
                          [&](const SurfacePoint& point, const Hit&, const Ray&) {
                            ++asked;
                            return point.position.z < 1.5f;
                          }),
            Look::stopped);
  EXPECT_EQ(asked, 2);
}

/// The way on is the caller's: here it ends between the floors.
TEST(LookThrough, GoesOnAsItIsTold) {
  const auto scene = floors(3);
  int met = 0;
  const Look look = look_through(
      *scene, down, 9,
      [&](const Ray& ray, Hit& hit) { return ray.origin.z > 1.5f && scene->intersect(ray, hit); },
      [&](const SurfacePoint&, const Hit&, const Ray&) { return ++met == 9; }, straight_on);
  EXPECT_EQ(look, Look::free);
  EXPECT_EQ(met, 2);
  EXPECT_EQ(
      look_through(
          *scene, down, 9, [&](const Ray& ray, Hit& hit) { return scene->intersect(ray, hit); },
          [&](const SurfacePoint&, const Hit&, const Ray&) { return false; },
          [](const SurfacePoint&, const Hit&, Ray&) { return false; }),
      Look::free);
}

/// The camera sees what lies behind boundaries of media; but no ray is followed for ever.
TEST(SceneReport, LooksThroughBoundaries) {
  const auto sees_something = [](int boundaries, const std::string& behind) {
    std::string all = behind;
    for (int i = 1; i <= boundaries; ++i)
      all += flat("rectangle", scale("9, 9, 1") + translate(fmt::format("0, 0, {}", 0.001 * i)),
                  R"(<bsdf type="null"/>)");
    const auto scene = build_scene(parse_mitsuba_xml(
        "<scene version=\"3.0.0\">" + test::camera("0, 0, 9", "0, 0, 0", 5, 8, "0, 1, 0") + all +
            point_light("0, 0, 9", 1) + "</scene>",
        "test.xml", ""));
    for (const std::string& warning : describe_scene(*scene).warnings)
      if (warning.find("sees no shape") != std::string::npos) return false;
    return true;
  };
  const std::string floor = flat("rectangle", scale("9, 9, 1"), diffuse("0.5"));
  EXPECT_TRUE(sees_something(0, floor));
  EXPECT_TRUE(sees_something(300, floor));
  EXPECT_FALSE(sees_something(300, ""));
  EXPECT_FALSE(sees_something(1100, floor));
}

}  // namespace
}  // namespace kaustik
