#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/material/fresnel.h"
#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

using namespace test;

std::shared_ptr<const Bsdf> glass() {
  return make_bsdf("dielectric", {property("int_ior", 1.5), property("ext_ior", 1.0)});
}

TEST(dielectric, obeys_snell) {
  for (const Vec3f& outside : outgoing_directions())
    for (const float side : {1.0f, -1.0f}) {
      const Vec3f wo(outside.x, outside.y, side * outside.z);
      const BsdfSample s = glass()->sample(flux(), wo, one_minus_epsilon, {0.5f, 0.5f}, Lobes::all);
      const double eta = side > 0 ? 1.5 : 1 / 1.5;
      if (fresnel_dielectric(wo.z, 1.5f).reflectance == 1) {
        EXPECT_FALSE(s.transmission);
        continue;
      }
      EXPECT_TRUE(s.transmission);
      EXPECT_FLOAT_EQ(s.eta, float(eta));
      EXPECT_LT(s.wi.z * wo.z, 0);
      EXPECT_NEAR(s.wi.x * eta, -wo.x, 1e-6);
      EXPECT_NEAR(s.wi.y * eta, -wo.y, 1e-6);
      EXPECT_NEAR(length(s.wi), 1, 1e-6);
    }
}

TEST(dielectric, scales_radiance_but_not_flux_by_the_square_of_the_index) {
  const Vec3f wo = outgoing_directions()[1];
  const BsdfSample of_flux = glass()->sample(flux(), wo, 0.99f, {}, Lobes::all);
  const BsdfSample in = glass()->sample(radiance(), wo, 0.99f, {}, Lobes::all);
  EXPECT_FLOAT_EQ(of_flux.weight[1], 1);
  EXPECT_FLOAT_EQ(in.weight[1], 1 / (1.5f * 1.5f));
  EXPECT_FLOAT_EQ(in.eta, 1.5f);
  // Reflection is not scaled; in and out again neither.
  EXPECT_FLOAT_EQ(glass()->sample(radiance(), wo, 0.0f, {}, Lobes::all).weight[1], 1);
  const BsdfSample out = glass()->sample(radiance(), in.wi, 0.99f, {}, Lobes::all);
  EXPECT_FLOAT_EQ(in.weight[1] * out.weight[1], 1);
  EXPECT_FLOAT_EQ(out.eta, 1 / 1.5f);
}

TEST(dielectric, is_reciprocal_along_the_refracted_path) {
  for (const Vec3f& wo : outgoing_directions()) {
    const BsdfSample in = glass()->sample(flux(), wo, one_minus_epsilon, {}, Lobes::all);
    const BsdfSample out = glass()->sample(flux(), in.wi, one_minus_epsilon, {}, Lobes::all);
    EXPECT_NEAR(in.pdf_solid_angle, out.pdf_solid_angle, 1e-4f);
    EXPECT_LT(length(out.wi - wo), 1e-4f);
  }
}

TEST(dielectric, reflects_as_often_as_fresnel_says) {
  const Vec3f wo = outgoing_directions()[2];
  const double expected = fresnel_dielectric(wo.z, 1.5f).reflectance;
  RunningStatistics reflected;
  for (int i = 0; i < 4 * quick.samples; ++i) {
    const float u = Sampler(hash_mix(9, uint64_t(i)), 0).next_1d();
    const BsdfSample s = glass()->sample(flux(), wo, u, {}, Lobes::all);
    reflected.add(s.transmission ? 0 : 1);
    ASSERT_NEAR(s.pdf_solid_angle, s.transmission ? 1 - expected : expected, 1e-6);
  }
  EXPECT_GT(z_test_p_value(reflected, expected), 1e-3);
  EXPECT_LT(z_test_p_value(reflected, expected * (1 + quick.planted_error)), 1e-3);
}

TEST(dielectric, of_equal_indices_lets_everything_through) {
  const auto nothing =
      make_bsdf("dielectric", {property("int_ior", 1.3), property("ext_ior", 1.3)});
  for (const Vec3f& wo : outgoing_directions()) {
    const BsdfSample s = nothing->sample(radiance(), wo, 1e-4f, {}, Lobes::all);
    EXPECT_TRUE(s.transmission);
    EXPECT_LT(length(s.wi + wo), 1e-5f);
    EXPECT_FLOAT_EQ(s.weight[0], 1);
  }
}

TEST(dielectric, knows_materials_by_name) {
  const auto water =
      make_bsdf("dielectric", {property("int_ior", "Water"), property("ext_ior", 1.0)});
  const BsdfSample s = water->sample(flux(), {0, 0, 1}, 0.99f, {}, Lobes::all);
  EXPECT_FLOAT_EQ(s.eta, 1.333f);
  const BsdfSample standard =
      make_bsdf("dielectric")->sample(flux(), {0, 0, 1}, 0.99f, {}, Lobes::all);
  EXPECT_FLOAT_EQ(standard.eta, 1.5046f / 1.000277f);
}

}  // namespace
}  // namespace kaustik
