#include "kaustik/material/fresnel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "kaustik/material/metal_fresnel.h"

namespace kaustik {
namespace {

float cosine(double degrees) { return float(std::cos(degrees * std::numbers::pi / 180)); }

TEST(fresnel_dielectric, at_normal_incidence) {
  for (const float n : {1.333f, 1.5f, 1.5168f, 2.4175f}) {
    const float expected = std::pow((n - 1) / (n + 1), 2.0f);
    EXPECT_NEAR(fresnel_dielectric(1, n).reflectance, expected, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(-1, n).reflectance, expected, 1e-6f);
    EXPECT_FLOAT_EQ(fresnel_dielectric(1, n).eta, n);
    EXPECT_FLOAT_EQ(fresnel_dielectric(-1, n).eta, 1 / n);
  }
}

// (R_s + R_p)/2 computed in double precision from the textbook's formulas.
TEST(fresnel_dielectric, at_oblique_incidence) {
  struct Figure {
    float n;
    double degrees, reflectance;
  };
  for (const Figure& f : {Figure{1.333f, 30, 0.021436466}, Figure{1.333f, 45, 0.027898365},
                          Figure{1.333f, 60, 0.059690919}, Figure{1.333f, 75, 0.21237758},
                          Figure{1.333f, 85, 0.58352348}, Figure{1.5f, 30, 0.041522626},
                          Figure{1.5f, 45, 0.050239911}, Figure{1.5f, 60, 0.089186713},
                          Figure{1.5f, 75, 0.25306056}, Figure{1.5f, 85, 0.61279965}})
    EXPECT_NEAR(fresnel_dielectric(cosine(f.degrees), f.n).reflectance, f.reflectance, 2e-6)
        << f.n << " " << f.degrees;
}

TEST(fresnel_dielectric, reflects_only_s_polarised_light_at_brewsters_angle) {
  const double n = 1.5, angle = std::atan(n);
  // There R_p = 0 and R_s = cos²(2θ).
  const double expected = 0.5 * std::pow(std::cos(2 * angle), 2);
  EXPECT_NEAR(fresnel_dielectric(float(std::cos(angle)), float(n)).reflectance, expected, 1e-6);
}

TEST(fresnel_dielectric, reflects_all_beyond_the_critical_angle) {
  const double critical = std::asin(1 / 1.5) * 180 / std::numbers::pi;
  EXPECT_EQ(fresnel_dielectric(-cosine(critical + 0.1), 1.5f).reflectance, 1);
  EXPECT_LT(fresnel_dielectric(-cosine(critical - 0.1), 1.5f).reflectance, 0.9f);
  EXPECT_EQ(fresnel_dielectric(0, 1.5f).reflectance, 1);
}

TEST(fresnel_dielectric, is_the_same_both_ways_along_one_path) {
  for (double degrees = 1; degrees < 90; degrees += 4) {
    const DielectricFresnel in = fresnel_dielectric(cosine(degrees), 1.7f);
    const DielectricFresnel out = fresnel_dielectric(-in.cos_transmitted, 1.7f);
    EXPECT_NEAR(in.reflectance, out.reflectance, 1e-4f);
    EXPECT_NEAR(out.cos_transmitted, cosine(degrees), 1e-5f);
  }
}

TEST(fresnel_dielectric, hemispherical_reflectance) {
  // 2 ∫ R(μ) μ dμ by the midpoint rule.
  const auto diffuse_reflectance = [](float n, float side) {
    double sum = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const double cos_theta = (i + 0.5) / steps;
      sum += 2 * cos_theta * fresnel_dielectric(side * float(cos_theta), n).reflectance / steps;
    }
    return sum;
  };
  EXPECT_NEAR(diffuse_reflectance(1.333f, 1), 0.066405761, 1e-5);
  EXPECT_NEAR(diffuse_reflectance(1.333f, -1), 0.47459057, 1e-5);
  EXPECT_NEAR(diffuse_reflectance(1.5f, 1), 0.091777955, 1e-5);
  EXPECT_NEAR(diffuse_reflectance(1.5f, -1), 0.59634576, 1e-5);
}

TEST(fresnel_conductor, without_absorption_is_the_dielectric) {
  for (double degrees = 0; degrees < 90; degrees += 7) {
    const Spectrum r = fresnel_conductor(cosine(degrees), {Spectrum(1.5f), Spectrum(0)});
    EXPECT_NEAR(r[0], fresnel_dielectric(cosine(degrees), 1.5f).reflectance, 1e-5f);
  }
}

// The definition with complex numbers in double precision.
double reference(double cos_theta, double n, double k) {
  const std::complex<double> eta(n, -k);
  const std::complex<double> cos_t = std::sqrt(1.0 - (1 - cos_theta * cos_theta) / (eta * eta));
  const auto s = (cos_theta - eta * cos_t) / (cos_theta + eta * cos_t);
  const auto p = (eta * cos_theta - cos_t) / (eta * cos_theta + cos_t);
  return 0.5 * (std::norm(s) + std::norm(p));
}

TEST(fresnel_conductor, agrees_with_complex_arithmetic) {
  for (const auto& [n, k] : {std::pair{0.05, 3.3}, {0.96, 6.7}, {3.1, 3.3}, {0.2, 0.1}, {1.4, 1.9}})
    for (double degrees = 0; degrees < 89.9; degrees += 5.5) {
      const double c = cosine(degrees);
      const Spectrum r = fresnel_conductor(float(c), {Spectrum(float(n)), Spectrum(float(k))});
      EXPECT_NEAR(r[2], reference(c, n, k), 3e-6) << n << " " << k << " " << degrees;
    }
}

TEST(fresnel_conductor, of_the_perfect_mirror_is_one) {
  const ComplexIor none = conductor_ior("none").at({});
  for (double degrees = 0; degrees <= 90; degrees += 5)
    EXPECT_EQ(fresnel_conductor(cosine(degrees), none), Spectrum(1));
}

TEST(metals, reflect_as_measured) {
  struct Figure {
    const char* name;
    int lane;
    float reflectance, tolerance;
  };
  // Normal reflectances in the middle of each primary: near 610, 550 and 465 nm.
  for (const Figure& f : {Figure{"Ag", 1, 0.960f, 0.01f}, Figure{"Al", 1, 0.921f, 0.01f},
                          Figure{"Cr", 1, 0.555f, 0.01f}, Figure{"Cu", 0, 0.93f, 0.04f},
                          Figure{"Au", 1, 0.79f, 0.06f}, Figure{"Au", 2, 0.36f, 0.06f}}) {
    const Spectrum r = fresnel_conductor(1, conductor_ior(f.name).at({}));
    EXPECT_NEAR(r[f.lane], f.reflectance, f.tolerance) << f.name << " " << f.lane;
  }
}

double normal_reflectance(double n, double k) {
  return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k);
}

// What others than the sources of the tables have measured, away from the edges where metals take
// on colour: gold and copper of Babar and Weaver (Appl. Opt. 54, 2015), silver of Johnson and
// Christy (Phys. Rev. B 6, 1972), aluminium of Mathewson and Myers (Phys. Scr. 4, 1971).
TEST(metals, reflect_at_each_wavelength_as_others_have_measured) {
  struct Figure {
    const char* name;
    double nm, n, k;
  };
  const Figure figures[] = {{"Au", 459.2, 1.457, 1.736},      {"Au", 590.4, 0.1823, 2.880},
                            {"Au", 652.5, 0.1091, 3.529},     {"Au", 688.8, 0.08524, 3.871},
                            {"Cu", 442.8, 1.168, 2.299},      {"Cu", 495.9, 1.121, 2.485},
                            {"Cu", 652.5, 0.0878, 3.759},     {"Cu", 688.8, 0.07277, 4.123},
                            {"Ag", 495.9, 0.05, 3.093},       {"Ag", 548.6, 0.06, 3.586},
                            {"Ag", 659.5, 0.05, 4.483},       {"Al", 495.94, 0.77909, 5.84012},
                            {"Al", 551.04, 1.00461, 6.51991}, {"Al", 604.8, 1.30548, 7.0855},
                            {"Al", 688.8, 1.94186, 7.82757}};
  const float tolerance = 0.045f;
  for (const Figure& f : figures) {
    const auto nm = float(f.nm);
    const ComplexIor ior = conductor_ior(f.name).at(Wavelengths(nm, nm, nm, nm));
    const float found = fresnel_conductor(1, ior)[0];
    EXPECT_NEAR(found, normal_reflectance(f.n, f.k), tolerance) << f.name << " " << f.nm;
  }
  // Another metal's table would be found out: copper beside gold, silver beside aluminium.
  const auto at = [](const char* name, float nm) {
    return fresnel_conductor(1, conductor_ior(name).at(Wavelengths(nm, nm, nm, nm)))[0];
  };
  EXPECT_GT(std::fabs(at("Cu", 459.2f) - normal_reflectance(1.457, 1.736)), 2 * tolerance);
  EXPECT_GT(std::fabs(at("Al", 688.8f) - normal_reflectance(0.07277, 4.123)), tolerance);
}

TEST(metals, of_two_colours_reflect_these) {
  const Spectrum color(0.9f, 0.5f, 0.05f, 0.999f);
  for (const float edge : {0.0f, 0.4f, 1.0f}) {
    const ComplexIor ior = ior_of_metal(color, Spectrum(edge));
    for (int lane = 0; lane < 4; ++lane) {
      EXPECT_NEAR(fresnel_conductor(1, ior)[lane], color[lane], 1e-4f);
      EXPECT_NEAR(fresnel_conductor(1e-7f, ior)[lane], 1, 0.01f);
    }
  }
  // The tint raises what is reflected toward the edge; Gulbrandsen 2014, figure 3.
  const float c = cosine(75);
  const float low = fresnel_conductor(c, ior_of_metal(color, Spectrum(0.0f)))[0],
              high = fresnel_conductor(c, ior_of_metal(color, Spectrum(1.0f)))[0];
  EXPECT_LT(low, 0.88f);
  EXPECT_GT(high, 0.9f);
}

TEST(metals, are_all_known_by_name_in_any_case) {
  for (const std::string& name : conductor_names()) {
    const ComplexIor ior = conductor_ior(name).at({});
    for (const float c : {1.0f, 0.5f, 0.01f, 0.0f}) {
      const Spectrum r = fresnel_conductor(c, ior);
      ASSERT_TRUE(r.is_finite()) << name;
      ASSERT_LE(r.max_lane(), 1.000001f) << name;
      // Mitsuba's names hold some that are no metals: tin telluride, magnesia, thorium fluoride.
      ASSERT_GE(r[0], 0.03f) << name;
    }
  }
  EXPECT_EQ(conductor_ior("AU").eta.rgb(), conductor_ior("au").eta.rgb());
  EXPECT_THROW(conductor_ior("unobtainium"), std::out_of_range);
}

TEST(metals, of_constant_curves_are_these_constants) {
  const ComplexIor ior =
      conductor_ior(SpectralCurve{{{400, 0.3}, {700, 0.3}}}, SpectralCurve{{{500, 2.5}}}).at({});
  for (int lane = 0; lane < 3; ++lane) {
    EXPECT_NEAR(ior.eta[lane], 0.3f, 1e-5f);
    EXPECT_NEAR(ior.k[lane], 2.5f, 1e-4f);
  }
}

TEST(dielectrics, by_name) {
  EXPECT_FLOAT_EQ(dielectric_ior("water"), 1.333f);
  EXPECT_FLOAT_EQ(dielectric_ior("diamond"), 2.419f);
  EXPECT_THROW(dielectric_ior("jelly"), std::out_of_range);
}

}  // namespace
}  // namespace kaustik
