// Disks around gauges: which ones a ray passes, against all of them one by one, and how much of
// them is in sight.

#include "kaustik/transport/gauge_disks.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"
#include "tests/transport/scene_of.h"

namespace kaustik {
namespace {

using namespace test;

/// With gauges at those places.
std::shared_ptr<const Scene> scene_with_gauges(const std::string& objects,
                                               const std::vector<Gauge>& gauges) {
  Description description =
      parse_mitsuba_xml("<scene version=\"3.0.0\">" + objects + "</scene>", "test.xml", "");
  std::vector<float> points, normals;
  for (const Gauge& gauge : gauges)
    for (int axis = 0; axis < 3; ++axis) {
      points.push_back(gauge.position[axis]);
      normals.push_back(gauge.normal[axis]);
    }
  const auto sensor = std::make_shared<Object>();
  sensor->family = "sensor";
  sensor->type = "irradiancepoints";
  sensor->properties = {{"points", Array::of<float>({gauges.size(), 3}, points), {}},
                        {"normals", Array::of<float>({gauges.size(), 3}, normals), {}}};
  description.scene->children.push_back({"", sensor});
  return build_scene(description);
}

Vec3f direction_of(Sampler& sampler) { return normalize(square_to_sphere(sampler.next_2d())); }

TEST(GaugeDisks, CrossedAsOneByOne) {
  std::vector<Gauge> gauges;
  for (uint32_t i = 0; i < 200; ++i) {
    Sampler sampler(1, i);
    const Vec2f u = sampler.next_2d();
    gauges.push_back({{u.x, u.y, sampler.next_1d()}, direction_of(sampler)});
  }
  // Along the axes, where boxes are flat and rays run within their sides.
  for (int axis = 0; axis < 3; ++axis) {
    Gauge gauge;
    gauge.position = {0.5f, 0.5f, 0.5f};
    gauge.normal = {0, 0, 0};
    gauge.normal[axis] = 1;
    gauges.push_back(gauge);
  }
  const auto scene = scene_with_gauges("", gauges);
  uint64_t rays = 0;
  std::vector<float> radii(gauges.size(), 0.05f);
  radii[7] = 0;
  const GaugeDisks disks(*scene, radii, 0.3f, rays);
  size_t found = 0;
  for (uint32_t i = 0; i < 4000; ++i) {
    Sampler sampler(2, i);
    const Vec2f u = sampler.next_2d();
    Ray ray{{u.x, u.y, sampler.next_1d()}, direction_of(sampler), infinity};
    if (i % 4 == 0) {
      ray.origin = {0.5f, 0.5f, 0.5f};
      ray.direction = {0, 0, 0};
      ray.direction[int(i / 4 % 3)] = i % 8 == 0 ? -1.0f : 1.0f;
      ray.origin -= ray.direction * 0.3f;
    }
    const float length = i % 3 == 0 ? float(infinity) : 0.5f;
    std::vector<uint32_t> expected, crossed;
    for (uint32_t g = 0; g < gauges.size(); ++g) {
      const SurfacePoint& at = scene->gauges()[g].point;
      const Vec3d normal(at.ng), to_gauge = Vec3d(at.position) - Vec3d(ray.origin);
      const double speed = normal.dot(Vec3d(ray.direction));
      const double distance = normal.dot(to_gauge) / speed;
      const double reach = double(GaugeDisks::wide_factor * radii[g]);
      if (speed < 0 && distance > 0 && distance < double(length) &&
          (Vec3d(ray.direction) * distance - to_gauge).length() < reach)
        expected.push_back(g);
    }
    disks.visit_crossed(ray, length, [&](const GaugeDisks::Crossing& at) {
      crossed.push_back(at.gauge);
      EXPECT_LT(length_sq(at.position - (ray.origin + ray.direction * at.distance)), 1e-10f);
    });
    std::sort(crossed.begin(), crossed.end());
    EXPECT_EQ(crossed, expected) << i;
    found += crossed.size();
  }
  EXPECT_GT(found, 1000u);
}

// A wall through the middle hides half of a disk, one far away nothing.
TEST(GaugeDisks, ShareInSight) {
  const std::string wall =
      R"(<shape type="rectangle"><transform name="to_world"><rotate y="1" angle="90"/></transform></shape>)";
  const auto scene = scene_with_gauges(
      wall, {{{1e-4f, 0, 0}, {0, 0, 1}}, {{0.5f, 0, 0}, {0, 0, 1}}, {{0.5f, 0, 0}, {0, 0, 1}}});
  uint64_t rays = 0;
  const GaugeDisks disks(*scene, {0.1f, 0.1f, 0.4f}, 0, rays);
  EXPECT_NEAR(disks.inverse_share(0), 2, 0.05);
  EXPECT_NEAR(disks.inverse_share_of_wide(0), 2, 0.05);
  EXPECT_EQ(disks.inverse_share(1), 1);
  EXPECT_EQ(disks.inverse_share_of_wide(1), 1);
  EXPECT_EQ(disks.inverse_share(2), 1);
  // Of the kernel 1 − d²/r² with r = 0.8 what lies beyond x = −0.5 counts little.
  EXPECT_GT(disks.inverse_share_of_wide(2), 1.01f);
  EXPECT_LT(disks.inverse_share_of_wide(2), 1.2f);
  EXPECT_GT(rays, 300u);
}

}  // namespace
}  // namespace kaustik
