// Lights at four wavelengths, against closed forms.
#include "kaustik/base/spectral_value.h"
#include "tests/light/light_testing.h"
#include "tests/light/photometric_samples.h"

namespace kaustik {
namespace {

using namespace testing;

const Wavelengths four(440, 500, 580, 660);
/// 0 at 400 nm, 1 at 800 nm.
const SpectralCurve ramp{{{400, 0}, {800, 1}}};
const Spectrum ramp_lanes(0.1f, 0.25f, 0.45f, 0.65f);

void expect_lanes(const Spectrum& found, const Spectrum& expected) {
  for (int lane = 0; lane < 4; ++lane)
    EXPECT_NEAR(found[lane], expected[lane], 1e-5f * std::fabs(expected[lane])) << lane;
}

/// Planck's law in steps of 5 nm, as a scene may give it.
SpectralCurve planck(double kelvin) {
  SpectralCurve curve;
  for (int nm = 360; nm <= 830; nm += 5) curve.samples.emplace_back(nm, blackbody(kelvin)->at(nm));
  return curve;
}

TEST(LightWavelengths, PlacedLightsSendTheirCurve) {
  const LightQuery below(Vec3f(0, 0, -2), Vec3f(0, 0, 1), 0, four);
  const auto point = make_light("point", {{"intensity", Value(ramp), {}}});
  expect_lanes(point->sample_toward(below, {0.5f, 0.5f}).radiance, ramp_lanes * 0.25f);
  expect_lanes(point->emitted({}, {0, 0, -1}, four), ramp_lanes);
  expect_lanes(point->sample_emission({}, {0.3f, 0.4f}, four).flux, ramp_lanes * (4 * pi));

  const auto spot = make_light("spot", {{"intensity", Value(ramp), {}}});
  expect_lanes(spot->emitted({}, {0, 0, 1}, four), ramp_lanes);
  const LightQuery before(Vec3f(0, 0, 2), Vec3f(0, 0, -1), 0, four);
  expect_lanes(spot->sample_toward(before, {}).radiance, ramp_lanes * 0.25f);

  // A white slide, or half a one, changes no colour.
  class Half final : public EmissionPattern {
   public:
    Spectrum radiance(const SurfacePoint&, const Wavelengths&) const override {
      return Spectrum(0.5f);
    }
    float maximum() const override { return 0.5f; }
  };
  const auto slide = make_light("spot", {{"intensity", Value(ramp), {}}}, nullptr, test_bounds(),
                                std::make_shared<Half>());
  expect_lanes(slide->emitted({}, {0, 0, 1}, four), ramp_lanes * 0.5f);
  expect_lanes(slide->sample_toward(before, {}).radiance, ramp_lanes * 0.125f);
  const auto projector = make_light("projector", {{"irradiance", Value(ramp), {}}});
  expect_lanes(projector->emitted({}, {0, 0, 1}, four), ramp_lanes * pi);
  expect_lanes(projector->sample_toward(before, {}).radiance, ramp_lanes * (pi / 4));

  const std::string even = ies_text({0, 180}, {0}, [](double, double) { return 179; });
  const auto luminaire =
      make_light("goniometric", {{"profile", Value(even), {}}, {"intensity", Value(ramp), {}}});
  expect_lanes(luminaire->emitted({}, {0, 0, 1}, four), ramp_lanes);
  expect_lanes(luminaire->sample_toward(before, {}).radiance, ramp_lanes * 0.25f);

  const auto area =
      make_light("area", {{"radiance", Value(ramp), {}}}, make_disk({0, 0, 0}, {0, 0, -1}, 0.5f));
  expect_lanes(area->sample_toward(below, {0.2f, 0.7f}).radiance, ramp_lanes);
  const EmissionSample ray = area->sample_emission({0.2f, 0.7f}, {0.5f, 0.5f}, four);
  expect_lanes(ray.flux, ramp_lanes * (pi * pi * 0.25f));
  expect_lanes(area->emitted(ray.point, ray.direction, four), ramp_lanes);

  const auto ball = make_light("distributed", {{"intensity", Value(ramp), {}}});
  const EmissionSample from_ball = ball->sample_emission({0.2f, 0.7f}, {0.5f, 0.5f}, four);
  expect_lanes(from_ball.flux, ramp_lanes * (4 * pi));
}

TEST(LightWavelengths, DistantLightsSendTheirCurve) {
  const LightQuery query(Vec3f(0, 0, 0), Vec3f(0, 0, -1), 0, four);
  const auto sun = make_light("directional", {{"irradiance", Value(ramp), {}}});
  expect_lanes(sun->sample_toward(query, {}).radiance, ramp_lanes);
  const auto sky = make_light("constant", {{"radiance", Value(ramp), {}}});
  expect_lanes(sky->distant().background({0, 1, 0}, four), ramp_lanes);
  expect_lanes(sky->sample_toward(query, {0.4f, 0.4f}).radiance, ramp_lanes);
  const EmissionSample ray = sky->sample_emission({0.3f, 0.3f}, {0.4f, 0.4f}, four);
  expect_lanes(ray.flux * (ray.pdf_position * ray.pdf_direction), ramp_lanes);
}

TEST(LightWavelengths, ABlackBodyHasPlancksLaw) {
  const auto lamp = make_light("constant", {{"radiance", Value(planck(3000)), {}}});
  const Wavelengths w(450, 550, 650, 750);
  Spectrum expected;
  for (int i = 0; i < 4; ++i) expected.set(i, float(blackbody(3000)->at(double(w[i]))));
  expect_lanes(lamp->distant().background({0, 0, 1}, w), expected);
}

TEST(LightWavelengths, PicturesAndPatternsAreUplifted) {
  const auto envmap = make_envmap(4, 3, std::vector<Rgb>(12, Rgb{0.2, 0.5, 0.7}));
  const Spectrum rgb = envmap->distant().background({1, 0, 0}, {});
  expect_lanes(envmap->distant().background({1, 0, 0}, four), lanes_from_emission(rgb, four));
  EXPECT_GT(envmap->distant().background({1, 0, 0}, four)[3], 0);

  class White final : public EmissionPattern {
   public:
    Spectrum radiance(const SurfacePoint&, const Wavelengths& wavelengths) const override {
      return white_light(wavelengths) * 2;
    }
    float maximum() const override { return 2; }
  };
  const auto area = make_light("area", {}, make_disk({0, 0, 0}, {0, 0, 1}, 0.5f), test_bounds(),
                               std::make_shared<White>());
  const LightQuery query(Vec3f(0, 0, 1), Vec3f(0, 0, -1), 0, four);
  expect_lanes(area->sample_toward(query, {0.3f, 0.6f}).radiance, white_light(four) * 2);
}

// What samples are shared out by is the same, whatever is rendered.
TEST(LightWavelengths, ChancesDoNotFollowThem) {
  const auto lamp =
      make_light("area", {{"radiance", Value(ramp), {}}}, make_disk({0, 0, 0}, {0, 0, 1}, 0.5f));
  const LightQuery rgb(Vec3f(0, 0, 1), Vec3f(0, 0, -1)),
      spectral(Vec3f(0, 0, 1), Vec3f(0, 0, -1), 0, four);
  EXPECT_EQ(lamp->expected_irradiance(rgb), lamp->expected_irradiance(spectral));
  EXPECT_EQ(lamp->sample_toward(rgb, {0.3f, 0.6f}).pdf_solid_angle,
            lamp->sample_toward(spectral, {0.3f, 0.6f}).pdf_solid_angle);
}

}  // namespace
}  // namespace kaustik
