// The light of a luminaire's file: lux by closed forms, where its axes point, how well it is
// sampled.

#include <cmath>

#include "kaustik/base/array.h"
#include "kaustik/base/photometric_units.h"
#include "kaustik/light/measured_light.h"
#include "tests/light/light_testing.h"
#include "tests/light/photometric_samples.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

std::unique_ptr<Light> luminaire(const std::string& profile, std::vector<Property> others = {}) {
  others.push_back({"profile", Value(profile), {}});
  return make_light("goniometric", others);
}

/// Of a surface that faces it.
double lux(const Light& light, const Vec3f& at) {
  return lumens_per_watt_white * double(light.sample_toward(LightQuery(at), {}).radiance[1]);
}

TEST(Goniometric, LuxInClosedForm) {
  // 100 lm alike in all directions: 7.958 lx at 1 m.
  const auto even = [](double, double) { return 100 / (4 * double_pi); };
  EXPECT_NEAR(lux(*luminaire(ies_text({0, 90, 180}, {0}, even)), {0, 0.6f, 0.8f}), 7.958, 1e-3);
  // 100 lm by the cosine: 31.831 lx straight ahead.
  const auto matt = [](double, double v) {
    return 100 / double_pi * std::cos(v * double_pi / 180);
  };
  const auto lambertian = luminaire(ies_text(even_angles(0, 90, 90), {0}, matt));
  EXPECT_NEAR(lux(*lambertian, {0, 0, 1}), 31.831, 1e-3);
  EXPECT_NEAR(lux(*lambertian, {0, 0, 2}), 31.831 / 4, 1e-3);
  EXPECT_EQ(lux(*lambertian, {0, 0, -1}), 0);
  // 100 cd: 100 lx at 1 m.
  const auto flat = [](double, double) { return 100; };
  EXPECT_NEAR(lux(*luminaire(ies_text({0, 180}, {0}, flat)), {0.6f, 0, -0.8f}), 100, 1e-3);
}

TEST(Goniometric, PowerIsTheFlux) {
  const auto flat = [](double, double) { return 100; };
  const std::string profile = ies_text({0, 180}, {0}, flat);
  const double lumens = 400 * double_pi;
  EXPECT_NEAR(luminaire(profile)->traits().power[1], lumens / 179, 1e-3);
  EXPECT_NEAR(luminaire(profile, {{"scale", Value(0.5), {}}})->traits().power[1], lumens / 358,
              1e-3);
  EXPECT_NEAR(luminaire(profile, {{"intensity", Value(Rgb{2, 1, 0}), {}}})->traits().power[0],
              lumens * 2 / 179, 1e-2);
  EXPECT_NEAR(luminaire(profile, {{"power", Value(7.0), {}}})->traits().power[2], 7, 1e-5);
  const auto light = luminaire(profile);
  const std::string& report = dynamic_cast<const MeasuredLight&>(*light).report();
  EXPECT_NE(report.find("1256.6 lm in its file, at most 100 cd"), std::string::npos) << report;
}

TEST(Goniometric, AxesPointAsTheManualSays) {
  // Bright toward C 0, and less toward C 90.
  const auto lobes = [](double c, double) { return c == 0 ? 300 : c == 90 ? 200 : 10; };
  const std::string profile =
      ies_text({0, 60, 90, 180}, {0, 90, 180, 270, 360},
               [&](double c, double v) { return v == 90 ? lobes(c == 360 ? 0 : c, v) : 1; });
  const auto own = luminaire(profile);
  EXPECT_NEAR(lux(*own, {-1, 0, 0}), 300, 1e-3);
  EXPECT_NEAR(lux(*own, {0, 1, 0}), 200, 1e-3);
  EXPECT_NEAR(lux(*own, {1, 0, 0}), 10, 1e-3);
  EXPECT_NEAR(lux(*own, {0, 0, 1}), 1, 1e-3);
  // Hung up by a lookat: C 0 is to the right of the up vector as seen from above.
  const auto hung = luminaire(
      profile, {{"to_world", Value(Transform::look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0})), {}}});
  EXPECT_NEAR(lux(*hung, {1, 0, 3}), 300, 1e-3);
  EXPECT_NEAR(lux(*hung, {0, 1, 3}), 200, 1e-3);
  EXPECT_NEAR(lux(*hung, {0, 0, 2}), 1, 1e-3);
  // The same by a rotation.
  const auto turned =
      luminaire(profile, {{"to_world", Value(Transform::rotate({0, 1, 0}, 180)), {}}});
  EXPECT_NEAR(lux(*turned, {1, 0, 0}), 300, 1e-3);
  EXPECT_NEAR(lux(*turned, {0, 1, 0}), 200, 1e-3);
}

TEST(Goniometric, PicturesLieAsThoseOfEnvmaps) {
  std::vector<float> pixels(8 * 5, 0.5f);
  pixels[2 * 8 + 4] = 4;  // in the middle row, between −x and +z … of the picture's turn 4.5/8
  const auto data = Array::of<float>({5, 8}, pixels);
  const auto light =
      make_light("goniometric", {{"data", Value(data), {}}, {"scale", Value(2.0), {}}});
  const auto sky = make_light("envmap", {{"data", Value(data), {}}, {"scale", Value(2.0), {}}});
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vec3f d = normalize(random.next_3d() - Vec3f(0.5f));
    EXPECT_NEAR(light->emitted({}, d, {})[1], sky->distant().background(d, {})[1], 1e-4);
  }
}

/// Where the sampler is in proportion to the intensity each ray carries the same flux.
TEST(Goniometric, RaysCarryAboutTheSameFlux) {
  const auto uneven = [](double c, double v) {
    return 200 * std::pow(std::cos(v * double_pi / 360), 6) * (1.5 + std::cos(c * double_pi / 180));
  };
  const auto spread = [&](const std::vector<double>& vertical, const std::vector<double>& planes) {
    const auto light = luminaire(ies_text(vertical, planes, uneven));
    Random random(7);
    RunningStatistics flux;
    for (int i = 0; i < 20'000; ++i)
      flux.add(light->sample_emission({}, random.next_2d(), {}).flux[1]);
    return flux.standard_deviation() / flux.mean();
  };
  EXPECT_LT(spread(even_angles(0, 180, 36), even_angles(0, 360, 24)), 0.02);
  EXPECT_LT(spread({0, 3.7, 11, 12.34, 40, 77.7, 180}, {0, 17, 99, 180}), 0.1);
}

}  // namespace
}  // namespace kaustik
