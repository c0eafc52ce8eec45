// Materials at four wavelengths, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/material/fresnel.h"
#include "kaustik/material/metal_data.h"
#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

using namespace test;

const Wavelengths four(440, 500, 580, 660);
const Vec3f up(0, 0, 1);
/// 0 at 400 nm, 1 at 800 nm.
const SpectralCurve ramp{{{400, 0}, {800, 1}}};
const Spectrum ramp_lanes(0.1f, 0.25f, 0.45f, 0.65f);

BsdfContext at(const Wavelengths& wavelengths, TransportMode mode = TransportMode::flux) {
  return {{}, mode, wavelengths};
}

void expect_lanes(const Spectrum& found, const Spectrum& expected, float tolerance = 1e-6f) {
  for (int lane = 0; lane < 4; ++lane) EXPECT_NEAR(found[lane], expected[lane], tolerance) << lane;
}

TEST(material_wavelengths, a_reflectance_curve_stays_a_curve) {
  const auto matt = make_bsdf("diffuse", {property("reflectance", ramp)});
  expect_lanes(matt->albedo(at(four), up, Lobes::all), ramp_lanes);
  expect_lanes(matt->eval(at(four), up, up, Lobes::all), ramp_lanes * inv_pi);
  expect_lanes(matt->sample(at(four), up, 0.5f, {0.3f, 0.3f}, Lobes::all).weight, ramp_lanes);
  const auto grey = make_bsdf("diffuse", {property("reflectance", 0.3)});
  expect_lanes(grey->albedo(at(four), up, Lobes::all), Spectrum(0.3f));
}

TEST(material_wavelengths, a_context_forgets_what_it_knew_at_other_wavelengths) {
  const auto matt = make_bsdf("diffuse", {property("reflectance", ramp)});
  BsdfContext context = at(four);
  expect_lanes(matt->albedo(context, up, Lobes::all), ramp_lanes);
  context.move_to({}, {800, 700, 600, 500});
  expect_lanes(matt->albedo(context, up, Lobes::all), Spectrum(1, 0.75f, 0.5f, 0.25f));
}

TEST(material_wavelengths, textures_mix_curves) {
  const auto board =
      make_texture("checkerboard", {property("color0", ramp), property("color1", 0.5)});
  TextureCoordinates where;
  where.uv = {0.25f, 0.25f};
  expect_lanes(board->eval(where, four), ramp_lanes);
  where.uv = {0.75f, 0.25f};
  expect_lanes(board->eval(where, four), Spectrum(0.5f));
  where.uv_width = {1e3f, 1e3f};
  expect_lanes(board->eval(where, four), (ramp_lanes + Spectrum(0.5f)) * 0.5f, 1e-3f);
}

// What is no colour is the same at every wavelength, though its texture is a curve.
TEST(material_wavelengths, scalars_do_not_follow_the_wavelengths) {
  const auto board = make_texture("checkerboard", {property("color0", ramp)});
  const float scalar = board->scalar({});
  EXPECT_EQ(scalar, luminance_of(board->eval({}, {})));
  EXPECT_GT(std::fabs(luminance_of(board->eval({}, four)) - scalar), 0.05f);  // the wrong way
  const auto white = make_bsdf("diffuse", {property("reflectance", 1.0)});
  const auto black = make_bsdf("diffuse", {property("reflectance", 0.0)});
  const auto blend = make_bsdf("blendbsdf", {}, {black, white}, {{"weight", board}});
  expect_lanes(blend->albedo(at(four), up, Lobes::all), Spectrum(scalar));
  const auto mask = make_bsdf("mask", {}, {black}, {{"opacity", board}});
  expect_lanes(mask->straight(at(four), up), Spectrum(1 - scalar));
  // One texture may be asked for both by one context.
  const auto both =
      make_bsdf("blendbsdf", {}, {black, make_bsdf("diffuse", {}, {}, {{"reflectance", board}})},
                {{"weight", board}});
  const BsdfContext context = at(four);
  for (int i = 0; i < 2; ++i)
    expect_lanes(both->albedo(context, up, Lobes::all), ramp_lanes * scalar);
}

TEST(material_wavelengths, metals_have_their_measured_index) {
  const MeasuredMetal& gold =
      *std::find_if(measured_metals().begin(), measured_metals().end(),
                    [](const auto& m) { return m.name[0] == 'A' && m.name[1] == 'u'; });
  ASSERT_GT(gold.samples.size(), 8u);
  const auto mirror = make_bsdf("conductor", {property("material", "Au")});
  const auto rough = make_bsdf("roughconductor", {property("material", "Au")});
  const auto ideal = make_bsdf("roughconductor", {property("material", "none")});
  for (size_t i = 0; i + 3 < gold.samples.size(); i += 4) {
    const auto nm = [&](size_t k) { return float(gold.samples[i + k].wavelength_nm); };
    const Wavelengths w(nm(0), nm(1), nm(2), nm(3));
    Spectrum expected;
    for (size_t k = 0; k < 4; ++k) {
      const MetalSample& s = gold.samples[i + k];
      expected.set(int(k), float((sqr(s.n - 1) + sqr(s.k)) / (sqr(s.n + 1) + sqr(s.k))));
    }
    expect_lanes(mirror->albedo(at(w), up, Lobes::all), expected, 1e-5f);
    expect_lanes(rough->eval(at(w), up, up, Lobes::all),
                 ideal->eval(at(w), up, up, Lobes::all) * expected, 1e-4f);
    // The estimate takes the angles of the facets for that of the surface.
    expect_lanes(rough->albedo(at(w), up, Lobes::all), expected, 0.03f);
  }
}

/// Cauchy's formula.
class Cauchy final : public SpectralFunction {
 public:
  double at(double nm) const override { return 1.5 + 2e4 / (nm * nm); }
};

std::shared_ptr<const Bsdf> prism() {
  const auto white = make_constant_texture(SpectralValue(1.0f));
  return make_dielectric(dispersive_ior(std::make_shared<Cauchy>()), SpectralValue(1.0f), white,
                         white);
}

TEST(material_wavelengths, refraction_follows_the_index_of_one_lane) {
  const auto glass = prism();
  const Vec3f wo = outgoing_directions()[1];
  std::array<int, 4> found{};
  for (const float u : {0.1f, 0.3f, 0.6f, 0.9f}) {
    const BsdfSample s = glass->sample(at(four), wo, one_minus_epsilon, {u, 0.5f}, Lobes::all);
    ASSERT_TRUE(s.transmission);
    ASSERT_GE(s.only_lane, 0);
    ++found[size_t(s.only_lane)];
    const double eta = Cauchy().at(double(four[s.only_lane]));
    EXPECT_NEAR(s.eta, eta, 1e-6);
    EXPECT_NEAR(s.wi.x * eta, -wo.x, 1e-6);
    EXPECT_NEAR(s.wi.y * eta, -wo.y, 1e-6);
    for (int lane = 0; lane < 4; ++lane) EXPECT_EQ(s.weight[lane] > 0, lane == s.only_lane);
  }
  EXPECT_EQ(found, (std::array<int, 4>{1, 1, 1, 1}));
}

TEST(material_wavelengths, in_rgb_mode_glass_has_one_index) {
  const BsdfSample s = prism()->sample(at({}), up, one_minus_epsilon, {}, Lobes::all);
  EXPECT_EQ(s.only_lane, -1);
  EXPECT_FLOAT_EQ(s.eta, float(Cauchy().at(589.3)));
  EXPECT_EQ(s.weight, Spectrum(1));
}

/// Mean of the weights of reflection and refraction by lane, over evenly spread numbers.
struct MeanWeights {
  std::array<double, 4> reflected{}, transmitted{};
};
MeanWeights mean_weights(const Wavelengths& wavelengths, const Vec3f& wo) {
  constexpr int side = 512;
  MeanWeights mean;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const float u = (float(i) + 0.5f) / side, v = (float(j) + 0.5f) / side;
      const BsdfSample s = prism()->sample(at(wavelengths), wo, u, {v, 0.5f}, Lobes::all);
      for (size_t lane = 0; lane < 4; ++lane)
        (s.transmission ? mean.transmitted : mean.reflected)[lane] +=
            double(s.weight[int(lane)]) / (side * side);
    }
  return mean;
}

TEST(material_wavelengths, every_lane_gets_its_share_of_reflection_and_refraction) {
  // From inside at an angle at which blue is reflected totally, and red is not.
  const Vec3f inside = normalize(Vec3f(0.635f, 0, -std::sqrt(1 - 0.635f * 0.635f)));
  for (const Vec3f& wo : {outgoing_directions()[1], outgoing_directions()[3], inside}) {
    const MeanWeights mean = mean_weights(four, wo);
    for (int lane = 0; lane < 4; ++lane) {
      const float reflectance =
          fresnel_dielectric(wo.z, float(Cauchy().at(double(four[lane])))).reflectance;
      EXPECT_NEAR(mean.reflected[size_t(lane)], reflectance, 5e-3) << lane;
      EXPECT_NEAR(mean.transmitted[size_t(lane)], 1 - reflectance, 5e-3) << lane;
    }
    expect_lanes(prism()->albedo(at(four), wo, Lobes::all), Spectrum(1));
  }
  EXPECT_EQ(fresnel_dielectric(inside.z, float(Cauchy().at(440))).reflectance, 1);
  EXPECT_LT(fresnel_dielectric(inside.z, float(Cauchy().at(660))).reflectance, 0.5f);
}

TEST(material_wavelengths, a_lane_that_is_alone_already_is_not_scaled_again) {
  const Vec3f wo = outgoing_directions()[1];
  const MeanWeights mean = mean_weights(four.only(2), wo);
  const float reflectance = fresnel_dielectric(wo.z, float(Cauchy().at(580))).reflectance;
  EXPECT_NEAR(mean.transmitted[2], 1 - reflectance, 5e-3);
  for (const size_t dead : {0u, 1u, 3u}) EXPECT_EQ(mean.transmitted[dead], 0);
}

}  // namespace
}  // namespace kaustik
