// Closed forms of panes, rough glass and coats.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kaustik/base/sampler.h"
#include "kaustik/material/fresnel.h"
#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

using namespace test;

Vec3f at_angle(double degrees, float side = 1) {
  const double theta = degrees * std::numbers::pi / 180;
  return {float(std::sin(theta)), 0, side * float(std::cos(theta))};
}

/// Walsh's closed form of what even light meets, n > 1 (J. W. T. Walsh 1926).
double walsh(double n) {
  const double n2 = n * n;
  return 0.5 + (n - 1) * (3 * n + 1) / (6 * (n + 1) * (n + 1)) +
         n2 * (n2 - 1) * (n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
         2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n2 * n2 - 1)) +
         8 * n2 * n2 * (n2 * n2 + 1) / ((n2 + 1) * (n2 * n2 - 1) * (n2 * n2 - 1)) * std::log(n);
}

TEST(even_light, is_reflected_as_walsh_says) {
  for (const double n : {1.1, 1.333, 1.5, 2.4}) {
    EXPECT_NEAR(reflectance_of_even_light(float(n)), walsh(n), 2e-5) << n;
    // What goes in is what comes out, in a solid angle that is n² as large.
    EXPECT_NEAR((1 - reflectance_of_even_light(float(1 / n))) * n * n, 1 - walsh(n), 2e-4) << n;
  }
}

TEST(pane, reflects_between_its_sides) {
  const auto pane =
      make_bsdf("thindielectric", {property("int_ior", 1.5), property("ext_ior", 1.0)});
  for (const float side : {1.0f, -1.0f}) {
    const Vec3f wo = at_angle(0, side);
    // R = 0.04 at each side: 2R/(1 + R).
    const BsdfSample back = pane->sample(radiance(), wo, 0, {}, Lobes::all);
    EXPECT_NEAR(back.weight[0], 0.08 / 1.04, 1e-6);
    EXPECT_EQ(back.pdf_solid_angle, 1);
    EXPECT_FALSE(back.transmission);
    EXPECT_NEAR(pane->straight(radiance(), wo)[0], 1 - 0.08 / 1.04, 1e-6);
    const Vec3f oblique = at_angle(50, side);
    EXPECT_NEAR(
        pane->straight(radiance(), oblique)[0] + pane->albedo(radiance(), oblique, Lobes::all)[0],
        1, 1e-6);
  }
}

TEST(ground_glass, is_smooth_glass_in_the_limit) {
  const std::vector<Property> iors = {property("int_ior", 1.5), property("ext_ior", 1.0)};
  std::vector<Property> smooth = iors;
  smooth.push_back(property("alpha", 1e-3));
  const auto rough = make_bsdf("roughdielectric", smooth), glass = make_bsdf("dielectric", iors);
  for (const double degrees : {0.0, 30.0, 60.0})
    for (const float side : {1.0f, -1.0f}) {
      const Vec3f wo = at_angle(degrees, side);
      EXPECT_NEAR(rough->albedo(flux(), wo, Lobes::all)[0], 1, 2e-3);
      // Both ways, where smooth glass sends all light.
      for (const float u_lobe : {0.0f, one_minus_epsilon}) {
        const BsdfSample sharp = glass->sample(flux(), wo, u_lobe, {0.5f, 0.5f}, Lobes::all);
        double farthest = 0;
        int same = 0;
        for (uint32_t i = 0; i < 256; ++i) {
          Sampler sampler(3, i);
          const BsdfSample s = rough->sample(flux(), wo, u_lobe, sampler.next_2d(), Lobes::all);
          if (s.transmission != sharp.transmission) continue;
          ++same;
          farthest = std::max(farthest, double(length(s.wi - sharp.wi)));
        }
        EXPECT_GT(same, 250) << degrees << " " << side;
        EXPECT_LT(farthest, 0.06) << degrees << " " << side;
        EXPECT_GT(farthest, 1e-4) << degrees << " " << side;
      }
    }
}

TEST(ground_glass, scales_radiance_by_the_square_of_the_index) {
  const auto glass =
      make_bsdf("roughdielectric",
                {property("int_ior", 1.5), property("ext_ior", 1.0), property("alpha", 0.3)});
  const Vec3f outside = at_angle(20), inside = at_angle(-15, -1);
  const float of_radiance = glass->eval(radiance(), outside, inside, Lobes::all)[0];
  EXPECT_GT(of_radiance, 0.1f);
  EXPECT_NEAR(glass->eval(flux(), outside, inside, Lobes::all)[0] / of_radiance, 2.25f, 1e-4f);
  EXPECT_NEAR(glass->eval(flux(), inside, outside, Lobes::all)[0] / of_radiance, 1, 1e-4f);
  const Vec3f mirror = at_angle(-15);
  EXPECT_EQ(glass->eval(flux(), outside, mirror, Lobes::all),
            glass->eval(radiance(), outside, mirror, Lobes::all));
}

TEST(ground_glass, needs_two_indices) {
  EXPECT_THROW(make_bsdf("roughdielectric", {property("int_ior", 1.3), property("ext_ior", 1.3)}),
               Error);
}

// A white base takes nothing: all light comes back, from the coat or from beneath it.
TEST(plastic, white_is_white) {
  for (const bool nonlinear : {false, true}) {
    const auto plastic = make_bsdf(
        "plastic", {property("diffuse_reflectance", 1.0), property("nonlinear", nonlinear)});
    for (const double degrees : {0.0, 45.0, 80.0, 89.0})
      EXPECT_NEAR(plastic->albedo(radiance(), at_angle(degrees), Lobes::all)[1], 1, 1e-4)
          << degrees;
  }
}

// Mitsuba: a grey of 0.5 has its own colour, and darkens where it may take on more of it.
TEST(plastic, colour_of_what_is_scattered_several_times) {
  const auto of = [](bool nonlinear) {
    return make_bsdf("plastic", {property("diffuse_reflectance", 0.5), property("int_ior", 1.5),
                                 property("ext_ior", 1.0), property("nonlinear", nonlinear)});
  };
  const Vec3f up(0, 0, 1);
  const double inside = 1 - (1 - walsh(1.5)) / 2.25, enters = 0.96 * 0.96 / 2.25;
  EXPECT_NEAR(of(false)->eval(radiance(), up, up, Lobes::all)[0] * pi, 0.5 * enters / (1 - inside),
              1e-4);
  EXPECT_NEAR(of(true)->eval(radiance(), up, up, Lobes::all)[0] * pi,
              0.5 * enters / (1 - 0.5 * inside), 1e-4);
}

TEST(roughplastic, is_plastic_in_the_limit) {
  std::vector<Property> properties = {property("diffuse_reflectance", Rgb{0.9, 0.5, 0.1}),
                                      property("nonlinear", true)};
  const auto smooth = make_bsdf("plastic", properties);
  properties.push_back(property("alpha", 1e-3));
  const auto rough = make_bsdf("roughplastic", properties);
  for (const double degrees : {5.0, 40.0, 70.0}) {
    const Vec3f wo = at_angle(degrees), wi = at_angle(-25);
    for (int lane = 0; lane < 3; ++lane) {
      const float expected = smooth->eval(radiance(), wo, wi, Lobes::diffuse)[lane];
      EXPECT_NEAR(rough->eval(radiance(), wo, wi, Lobes::diffuse)[lane], expected,
                  0.01f * expected);
    }
    EXPECT_NEAR(rough->albedo(radiance(), wo, Lobes::glossy)[0],
                smooth->albedo(radiance(), wo, Lobes::delta)[0], 1e-3f);
  }
}

TEST(roughdiffuse, without_roughness_is_lambert) {
  const auto smooth = make_bsdf("roughdiffuse", {property("roughness", 0.0)});
  EXPECT_NEAR(smooth->eval(radiance(), at_angle(30), at_angle(-70), Lobes::all)[0], 0.5 * inv_pi,
              1e-6);
}

// sinα tanβ cosφ · B/A of Oren and Nayar's qualitative model is what it says of a slope.
TEST(roughdiffuse, scatters_backward_as_oren_and_nayar_say) {
  const double slope = 0.4, sigma_sq = 0.5 * slope * slope;
  const double ratio =
      0.45 * sigma_sq / (sigma_sq + 0.09) / (1 - 0.5 * sigma_sq / (sigma_sq + 0.33));
  // Of black facets what is scattered between them does not show.
  const auto rough =
      make_bsdf("roughdiffuse", {property("alpha", slope), property("reflectance", 1e-4)});
  const Vec3f wi = at_angle(60);
  const float across = rough->eval(radiance(), at_angle(0), wi, Lobes::all)[0];
  const double larger = std::numbers::pi / 3, smaller = std::numbers::pi / 6;
  EXPECT_NEAR(rough->eval(radiance(), at_angle(30), wi, Lobes::all)[0] / across,
              1 + ratio * std::sin(larger) * std::tan(smaller), 1e-3);
}

}  // namespace
}  // namespace kaustik
