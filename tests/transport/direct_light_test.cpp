// Light sampled at a receiver: the recursion level that lights are asked with.

#include "kaustik/transport/direct_light.h"

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "tests/support/strip_mesh.h"

namespace kaustik {
namespace {

std::shared_ptr<const Scene> scene_of(const std::string& objects) {
  return build_scene(parse_mitsuba_xml(
      "<scene version=\"3.0.0\"><sensor type=\"perspective\"/>" + objects + "</scene>", "test.xml",
      ""));
}

/// The floor at the origin, seen from above.
SurfaceVertex vertex_at(const Scene& scene, const Vec3f& position) {
  const Ray ray{position + Vec3f(0, 0, 0.1f), {0, 0, -1}};
  Hit hit;
  EXPECT_TRUE(scene.intersect(ray, hit));
  return {scene, ray, hit, TransportMode::radiance};
}

/// A long strip of lamps over one end of a floor: by area alone most samples are wasted on its far
/// end.
class FloorUnderAStrip {
 public:
  std::shared_ptr<const Scene> scene() const {
    return scene_of(
        "<shape type=\"rectangle\"/>" +
        strip_.shape(R"(<scale value="4,0.1,1"/><rotate x="1" angle="180"/>
                                    <translate x="3.8" z="0.5"/>)",
                     R"(<emitter type="area"><rgb name="radiance" value="3"/></emitter>)"));
  }

 private:
  test::StripMesh strip_{64};
};

/// The deeper the level the noisier, and the mean stays.
TEST(RecursionLevel, MakesLightsCoarserAndKeepsTheirMean) {
  const auto scene = FloorUnderAStrip().scene();
  std::vector<RunningStatistics> irradiances;
  for (const int level : {0, 1, 7}) {
    const Receiver receiver(vertex_at(*scene, {0, 0, 0}), level);
    RunningStatistics irradiance;
    for (uint32_t i = 0; i < (level == 7 ? 1'000'000u : 200'000u); ++i) {
      Sampler sampler(hash_mix(21 + uint64_t(level), i), 0);
      DirectLight light;
      double value = 0;
      if (sample_direct_light(*scene, receiver, sampler, light) &&
          !scene->occluded(light.shadow_ray))
        value = double(light.radiance[0]) * std::max(0.0, double(light.wi.z));
      irradiance.add(value);
    }
    EXPECT_LT(irradiance.standard_error(), 0.003 * irradiance.mean()) << level;
    irradiances.push_back(irradiance);
  }
  for (const size_t deep : {1, 2}) {
    const RunningStatistics &a = irradiances[0], &b = irradiances[deep];
    const double error = std::hypot(a.standard_error(), b.standard_error());
    EXPECT_GT(z_test_p_value(a.mean(), error, b.mean()), 1e-3) << deep;
    EXPECT_LT(z_test_p_value(1.02 * a.mean(), error, b.mean()), 1e-3) << deep;
  }
  EXPECT_GT(irradiances[2].variance(), 2 * irradiances[0].variance());
}

/// What a sample reports is what is answered for its point later, at the same level.
TEST(RecursionLevel, DensitiesFollowIt) {
  const auto scene = FloorUnderAStrip().scene();
  const SurfaceVertex vertex = vertex_at(*scene, {0, 0, 0});
  for (const int level : {0, 2, 3, 7}) {
    const Receiver receiver(vertex, level), at_next(vertex, level == 0 ? 7 : 0);
    double largest_difference = 0;
    for (uint32_t i = 0; i < 2000; ++i) {
      Sampler sampler(hash_mix(29, i), 0);
      DirectLight light;
      if (!sample_direct_light(*scene, receiver, sampler, light)) continue;
      const Ray ray = spawn_ray(vertex.point(), light.wi);
      Hit hit;
      // Grazing rays may miss the triangle for a neighbour.
      if (!scene->intersect(ray, hit)) continue;
      const SurfacePoint on_light = scene->tracer().surface_point(ray, hit);
      if (dot(on_light.ng, light.wi) > -0.05f || scene->occluded(light.shadow_ray)) continue;
      const auto pdf = [&](const Receiver& asked, LightChoice choice) {
        return double(direct_light_pdf(*scene, asked, choice, 0, on_light));
      };
      const double reported = double(light.pdf_solid_angle);
      ASSERT_NEAR(pdf(receiver, LightChoice::one), reported, 2e-3 * reported) << level;
      ASSERT_NEAR(pdf(receiver, LightChoice::all), reported, 2e-3 * reported) << level;
      largest_difference = std::max(
          largest_difference, std::fabs(pdf(at_next, LightChoice::one) - reported) / reported);
    }
    EXPECT_GT(largest_difference, 0.1) << level;
  }
}

}  // namespace
}  // namespace kaustik
