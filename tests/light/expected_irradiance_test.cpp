// What lights promise to give a point, against what they give; the falloff of classical ray
// tracing.

#include <gtest/gtest.h>

#include "tests/light/light_testing.h"
#include "tests/light/photometric_samples.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

struct IrradianceCase {
  std::string name;
  std::shared_ptr<const Light> light;
};

std::vector<IrradianceCase> lights_at_the_origin() {
  const Value colored(Rgb{1, 2, 0.5});
  const std::vector<Property> radiance = {{"radiance", colored, {}}};
  const Value aimed(Transform::look_at({0, 0, 0}, {1, 2, 0}, {0, 0, 1}));
  std::vector<IrradianceCase> cases;
  cases.push_back({"point", make_light("point", {{"intensity", colored, {}}})});
  cases.push_back({"spot", make_light("spot", {{"intensity", colored, {}},
                                               {"cutoff_angle", Value(60.0), {}},
                                               {"to_world", aimed, {}}})});
  cases.push_back({"spot with a slide",
                   make_light("spot", {{"cutoff_angle", Value(60.0), {}}, {"to_world", aimed, {}}},
                              nullptr, test_bounds(), fields_pattern())});
  cases.push_back(
      {"projector", make_light("projector", {{"fov", Value(100.0), {}}, {"to_world", aimed, {}}},
                               nullptr, test_bounds(), fields_pattern())});
  const auto lobes = [](double c, double v) { return v < 80 ? 200 + c : 0; };
  cases.push_back(
      {"luminaire",
       make_light("goniometric",
                  {{"profile", Value(ies_text(even_angles(0, 90, 9), {0, 60, 180}, lobes)), {}},
                   {"to_world", aimed, {}}})});
  cases.push_back({"directional", make_light("directional", {{"irradiance", colored, {}}})});
  cases.push_back({"constant", make_light("constant", radiance)});
  cases.push_back({"disk", make_light("area", radiance, make_disk({0, 0, 0}, {0, 0, 1}, 0.5f))});
  cases.push_back({"ball", make_light("area", radiance, make_ball({0, 0, 0}, 0.5f))});
  cases.push_back(
      {"quad",
       make_light("area", radiance, make_quad({-0.4f, 0, -0.2f}, {0.8f, 0, 0}, {0, 0.3f, 0.4f}))});
  return cases;
}

/// Irradiance by sampling the light, sum of the lanes, on the normal's side of the surface.
double measured_irradiance(const Light& light, const LightQuery& query, Random& random) {
  RunningStatistics irradiance;
  for (int i = 0; i < 400; ++i) {
    const LightSample s = light.sample_toward(query, random.next_2d());
    const bool has_normal = length_sq(query.normal) > 0;
    const double cosine = has_normal ? dot(query.normal, s.direction) : 1.0f;
    const double light_of_one = s.pdf_solid_angle > 0 ? s.radiance.sum() / s.pdf_solid_angle : 0.0f;
    irradiance.add(light_of_one * std::max(cosine, 0.0));
    if (s.delta) break;
  }
  return irradiance.mean();
}

LightQuery random_query(Random& random, float farthest) {
  const auto direction = [&] { return normalize(random.next_3d() - Vec3f(0.5f)); };
  LightQuery query(direction() * (0.1f + farthest * random.next()));
  if (random.next() < 0.7f) query.normal = direction();
  return query;
}

TEST(ExpectedIrradiance, IsZeroOnlyWhereNothingArrives) {
  for (const IrradianceCase& test : lights_at_the_origin()) {
    SCOPED_TRACE(test.name);
    Random random(41);
    for (int i = 0; i < 500; ++i) {
      const LightQuery query = random_query(random, 3);
      if (measured_irradiance(*test.light, query, random) > 0) {
        ASSERT_GT(test.light->expected_irradiance(query), 0);
      }
    }
  }
}

/// Ten times as far as they are large, lights give what they promise, but for the cosines at the
/// surface and at the light, which the promise takes at their best over the light's bounds.
TEST(ExpectedIrradiance, IsNearTheTruthFromAfar) {
  for (const IrradianceCase& test : lights_at_the_origin()) {
    SCOPED_TRACE(test.name);
    Random random(43);
    RunningStatistics measured, expected;
    for (int i = 0; i < 500; ++i) {
      LightQuery query = random_query(random, 0);
      query.reference *= 10 / length(query.reference);
      query.normal = normalize(random.next_3d() - Vec3f(0.5f));
      measured.add(measured_irradiance(*test.light, query, random));
      expected.add(test.light->expected_irradiance(query));
    }
    EXPECT_GT(expected.mean(), 0.95 * measured.mean());  // whose brighter side is noise as well
    EXPECT_LT(expected.mean(), 1.5 * measured.mean());
  }
}

TEST(ExpectedIrradiance, OfADarkLightIsZero) {
  const auto dark = make_light("area", {{"radiance", Value(0.0), {}}}, make_ball({0, 0, 0}, 0.5f));
  EXPECT_EQ(dark->expected_irradiance(Vec3f(0, 0, 2)), 0);
}

std::shared_ptr<const Light> lamp(const std::string& type, const Vec3d& attenuation) {
  return make_light(type, {{"attenuation", Value(attenuation), {}}});
}

TEST(ClassicalAttenuation, ReplacesTheInverseSquare) {
  for (const std::string type : {"point", "spot"}) {
    const auto light = lamp(type, {0.5, 0.25, 0.125});
    const Vec3f at(0, 0, 4);
    const float given =
        light->sample_toward(at, {0, 0}).radiance[0] * light->traits().attenuation.factor(at);
    EXPECT_FLOAT_EQ(given, float(1 / (0.5 + 0.25 * 4 + 0.125 * 16)));
    EXPECT_EQ(make_light(type, {})->traits().attenuation.factor(at), 1);
    // What is physical does not see it.
    EXPECT_EQ(light->traits().power, make_light(type, {})->traits().power);
    EXPECT_FLOAT_EQ(light->sample_toward(at, {0, 0}).radiance[0], 1.0f / 16);
  }
  EXPECT_EQ(make_light("constant", {})->traits().attenuation.factor({1, 2, 3}), 1);
}

TEST(ClassicalAttenuation, RefusesWhatGrowsWithoutBound) {
  EXPECT_THROW(lamp("point", {0, 0, 0}), Error);
  EXPECT_THROW(lamp("point", {1, -0.1, 0}), Error);
  EXPECT_THROW(lamp("spot", {0, 0, -1}), Error);
}

}  // namespace
}  // namespace kaustik
