#include <gtest/gtest.h>

#include "kaustik/base/parallel.h"
#include "kaustik/photon/shadow_pass.h"
#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using test::make_scene;
using test::mirror_bsdf;
using test::object;
using test::ObjectPointer;
using test::sphere;

ObjectPointer white() { return object("bsdf", "diffuse"); }

ObjectPointer floor_at(double height, const ObjectPointer& bsdf) {
  return test::placed("rectangle",
                      Transform::translate(Vec3d(0, 0, height)) * Transform::scale(Vec3d(9, 9, 1)),
                      bsdf);
}

ShadowMap trace(const Scene& scene, uint32_t count, ShadowReport& report) {
  return trace_shadow_photons(scene, count, 1, 0, {}, report);
}

/// The spot's whole cone falls on each of the floors: every ray lights the first and shadows the
/// others.
TEST(ShadowPass, CountsThroughAStackOfFloors) {
  const auto scene = make_scene(
      {test::light("spot"), floor_at(0.5, white()), floor_at(0, white()), floor_at(-0.5, white())});
  ShadowReport report;
  const ShadowMap map = trace(*scene, 5000, report);
  const ShadowCounts counts = report.lights.at(0);
  EXPECT_EQ(counts.emitted, 5000u);
  EXPECT_EQ(counts.lit, 5000u);
  EXPECT_EQ(counts.shadowed, 10'000u);
  EXPECT_EQ(report.rays, 20'000u);
  EXPECT_EQ(map.size(), 15'000u);
  for (uint32_t i = 0; i < map.size(); ++i) {
    const bool first = map.tree().tree().key(i).z > 0.25f;
    EXPECT_EQ(map.tree().tree().data(i).shadowed, first ? 0u : 1u);
  }
}

/// A mirror keeps no photons, but its shadow is one.
TEST(ShadowPass, MirrorsThrowShadows) {
  const auto scene =
      make_scene({test::light("spot"), floor_at(0.5, mirror_bsdf()), floor_at(0, white())});
  ShadowReport report;
  const ShadowMap map = trace(*scene, 1000, report);
  EXPECT_EQ(report.lights.at(0).lit, 0u);
  EXPECT_EQ(report.lights.at(0).shadowed, 1000u);
}

TEST(ShadowPass, LightsWithoutPhotonsAreTold) {
  const auto warning = [](const std::vector<ObjectPointer>& objects) {
    ShadowReport report;
    trace(*make_scene(objects), 100, report);
    const auto warnings = report.warnings();
    EXPECT_LE(warnings.size(), 1u);
    return warnings.empty() ? std::string() : warnings[0];
  };
  const auto dim = object("emitter", "point",
                          {{"position", Vec3d(1, 0, 3)}, {"intensity", Rgb{1e-6, 1e-6, 1e-6}}});
  EXPECT_EQ(warning({test::light("spot"), floor_at(0, white())}), "");
  EXPECT_NE(
      warning({test::light("spot"), floor_at(0, mirror_bsdf())}).find("the shadow map is empty"),
      std::string::npos);
  EXPECT_NE(warning({test::light("spot"), dim, floor_at(0, white())}).find("some lights"),
            std::string::npos);
}

/// Through a pile of more surfaces than rays are followed through.
TEST(ShadowPass, RaysAreFollowedThroughSoManySurfaces) {
  std::vector<ObjectPointer> objects = {test::light("spot")};
  for (int i = 0; i < most_surfaces + 4; ++i) objects.push_back(floor_at(-0.001 * i, white()));
  ShadowReport report;
  const ShadowMap map = trace(*make_scene(objects), 1, report);
  EXPECT_EQ(map.size(), uint32_t(most_surfaces));
  EXPECT_EQ(report.cut, 1u);
  ASSERT_EQ(report.warnings().size(), 1u);
  EXPECT_NE(report.warnings()[0].find("given up behind"), std::string::npos);
}

/// Of point lights every photon can be checked by a shadow ray; its side faces the light.
TEST(ShadowPass, FlagsAreWhatShadowRaysFind) {
  std::vector<ObjectPointer> objects = {
      floor_at(0, white()), object("emitter", "point", {{"position", Vec3d(1, 0, 3)}}),
      object("emitter", "point", {{"position", Vec3d(-2, 1, 2)}, {"intensity", Rgb{3, 3, 3}}})};
  for (int i = 0; i < 12; ++i)
    objects.push_back(sphere(Vec3d(2 * std::cos(i), 2 * std::sin(i), 0.2 + 0.1 * i), 0.3, white()));
  const auto scene = make_scene(objects);
  ShadowReport report;
  const ShadowMap map = trace(*scene, 20'000, report);
  const Vec3f lights[] = {Vec3f(1, 0, 3), Vec3f(-2, 1, 2)};
  uint64_t counted[2][2] = {};
  int wrong = 0;
  for (uint32_t i = 0; i < map.size(); ++i) {
    const ShadowPhoton& photon = map.tree().tree().data(i);
    ++counted[photon.light][photon.shadowed];
    const Vec3f at = map.tree().tree().key(i), to = lights[photon.light] - at;
    EXPECT_GT(photon.side.dot(to), -1e-2f * 127 * length(to));
    // From the light, so that the point's own surface is where the ray ends.
    const Ray ray{lights[photon.light], normalize(-to), length(to) * 0.999f};
    wrong += scene->occluded(ray) != (photon.shadowed != 0);
  }
  EXPECT_LT(wrong, int(map.size() / 1000));  // at silhouettes
  for (size_t light = 0; light < 2; ++light) {
    EXPECT_EQ(counted[light][0], report.lights[light].lit);
    EXPECT_EQ(counted[light][1], report.lights[light].shadowed);
    EXPECT_GT(counted[light][1], 200u);
  }
  EXPECT_EQ(report.lights[0].emitted + report.lights[1].emitted, 20'000u);
  EXPECT_NEAR(double(report.lights[0].emitted), 5'000, 100);  // a quarter of the power
}

TEST(ShadowPass, SameForAnyNumberOfThreads) {
  const auto scene = make_scene({test::light("ball"), test::light("constant"), floor_at(0, white()),
                                 sphere(Vec3d(0, 0, 1), 0.3, white())});
  const auto traced = [&](int threads) {
    ShadowMap map;
    ShadowReport report;
    with_threads(threads, [&] { map = trace(*scene, 10'000, report); });
    return map;
  };
  const ShadowMap one = traced(1), two = traced(2);
  ASSERT_EQ(one.size(), two.size());
  ASSERT_GT(one.size(), 2000u);
  for (uint32_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one.tree().tree().key(i), two.tree().tree().key(i));
    ASSERT_EQ(one.tree().tree().data(i).light, two.tree().tree().data(i).light);
    ASSERT_EQ(one.tree().tree().data(i).shadowed, two.tree().tree().data(i).shadowed);
  }
}

/// Photons put by hand around a point of a floor, and what they say there.
class Sight : public testing::Test {
 protected:
  void add(int light, bool shadowed, double x, bool on_front = true) {
    ShadowPhoton photon;
    photon.side = CoarseNormal(Vec3f(0, 0, on_front ? 1 : -1));
    photon.on_front = on_front;
    photon.light = uint32_t(light);
    photon.shadowed = shadowed;
    positions_.push_back(Vec3f(float(x), 0, 0));
    photons_.push_back(photon);
  }
  VisibilityEstimate seen(int light, int level = 0) {
    const ShadowMap map(positions_, photons_);
    const SurfaceVertex vertex = vertex_at(0);
    return ShadowVisibility(&map, settings_, vertex, level, scratch_).of(light);
  }
  SurfaceVertex vertex_at(float x) const {
    const Ray ray{Vec3f(x, 0, 1), Vec3f(0, 0, -1)};
    Hit hit;
    EXPECT_TRUE(scene_->intersect(ray, hit));
    return {*scene_, ray, hit, TransportMode::radiance};
  }
  std::shared_ptr<const Scene> scene_ = make_scene({floor_at(0, white())});
  ShadowSettings settings_{8, 1, 1};
  std::vector<Vec3f> positions_;
  std::vector<ShadowPhoton> photons_;
  Scratch scratch_;
};

void expect_sight(const VisibilityEstimate& sight, float known, float by_ray) {
  EXPECT_FLOAT_EQ(sight.known, known);
  EXPECT_FLOAT_EQ(sight.by_ray, by_ray);
}

TEST_F(Sight, KnowsLightShadowAndPenumbra) {
  for (int i = 0; i < 2; ++i) {
    add(0, false, 0.01 * i);
    add(1, true, 0.01 * i);
    add(2, false, 0.1 + 0.01 * i);
    add(2, true, 0.2 + 0.01 * i);
  }
  expect_sight(seen(0), 1, 0);
  expect_sight(seen(1), 0, 0);
  expect_sight(seen(2), 0, 1);
  expect_sight(seen(2, 1), 0.5, 0);
  expect_sight(seen(3), 0, 1);
  add(2, false, 0.3);  // the ninth is one too many
  expect_sight(seen(2, 1), 0.5, 0);
  settings_.neighbors = 9;
  expect_sight(seen(2, 1), 0.6f, 0);
  settings_.accurate_levels = 2;
  expect_sight(seen(2, 1), 0, 1);
}

TEST_F(Sight, KnowsNothingOfTheOtherSideAndOfFarPhotons) {
  add(0, true, 0, false);
  add(1, false, 2);
  expect_sight(seen(0), 0, 1);
  expect_sight(seen(1), 0, 1);
  settings_.maximum_radius = 3;
  expect_sight(seen(1), 1, 0);
}

/// What is asked at another vertex meanwhile changes nothing.
TEST_F(Sight, TwoAtATimeKnowTheirOwn) {
  for (int i = 0; i < 2; ++i) {
    add(0, false, 0.01 * i);
    add(0, true, 5 + 0.01 * i);
  }
  const ShadowMap map(positions_, photons_);
  const SurfaceVertex lit_vertex = vertex_at(0), dark_vertex = vertex_at(5);
  ShadowVisibility lit(&map, settings_, lit_vertex, 0, scratch_);
  expect_sight(lit.of(0), 1, 0);
  ShadowVisibility dark(&map, settings_, dark_vertex, 0, scratch_);
  expect_sight(dark.of(0), 0, 0);
  expect_sight(lit.of(0), 1, 0);
  expect_sight(dark.of(0), 0, 0);
}

TEST_F(Sight, KnowsNothingWithoutPhotons) { expect_sight(seen(0), 0, 1); }

/// Over the states of n photons, each lit with probability p, the mean answer is p if rays say p;
/// that of deciding wherever all agree, and by a ray elsewhere, is not.
TEST(VisibilityEstimate, MeanIsTheVisibility) {
  for (const bool accurate : {true, false})
    for (int n = 1; n <= 8; ++n)
      for (const double p : {0.0, 0.1, 0.5, 0.8, 1.0}) {
        double mean = 0, naive = 0;
        for (int lit = 0; lit <= n; ++lit) {
          const double binomial = std::tgamma(n + 1) / std::tgamma(lit + 1) /
                                  std::tgamma(n - lit + 1) * std::pow(p, lit) *
                                  std::pow(1 - p, n - lit);
          const VisibilityEstimate sight = sight_of(lit, n - lit, accurate);
          mean += binomial * (double(sight.known) + double(sight.by_ray) * p);
          naive += binomial * (lit == n ? 1 : lit == 0 ? 0 : p);
        }
        EXPECT_NEAR(mean, p, 1e-6) << n << " " << p;
        if (n == 5 && p == 0.8) {
          EXPECT_GT(naive, p + 0.06);
        }
      }
}

}  // namespace
}  // namespace kaustik
