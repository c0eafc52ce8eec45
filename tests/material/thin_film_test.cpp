// Films whose two sides interfere: closed forms, limits, and colours as means over wavelengths.
#include "kaustik/material/thin_film.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kaustik/base/color.h"
#include "kaustik/material/fresnel.h"
#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

constexpr float water = 1.33f;

double film_at(float cosine, float eta, float thickness_nm, float nm) {
  return double(
      film_reflectance(cosine, Spectrum(eta), Spectrum(thickness_nm), {nm, nm, nm, nm})[0]);
}

Spectrum film_in_rgb(float cosine, float eta, float thickness_nm) {
  return film_reflectance(cosine, Spectrum(eta), Spectrum(thickness_nm), {});
}

TEST(ThinFilm, AQuarterOfAWaveReflectsMostAndHalfOfOneNothing) {
  const double n_sq = double(water) * double(water);
  const double most = std::pow((1 - n_sq) / (1 + n_sq), 2);
  EXPECT_NEAR(film_at(1, water, 550 / (4 * water), 550), most, 1e-6);
  EXPECT_NEAR(film_at(1, water, 3 * 550 / (4 * water), 550), most, 1e-6);
  EXPECT_NEAR(film_at(1, water, 550 / (2 * water), 550), 0, 1e-6);
  // Much thinner than a wave it is black, as soap bubbles are before they burst.
  EXPECT_LT(film_at(1, water, 2, 550), 0.001);
}

/// The index times the cosine inside.
double inside_of(double cosine, double n) { return std::sqrt(n * n - 1 + cosine * cosine); }

TEST(ThinFilm, ItHasRoomForAHalfWaveWhereThatLiesAslant) {
  const auto inside = float(inside_of(0.5, double(water)));
  EXPECT_NEAR(film_at(0.5f, water, 550 / (2 * inside), 550), 0, 1e-6);
  EXPECT_GT(film_at(0.5f, water, 550 / (4 * inside), 550), 0.05);
}

TEST(ThinFilm, AtBrewstersAngleOnlyOnePolarisationIsReflected) {
  const double cosine = std::cos(std::atan(double(water)));
  const double inside = inside_of(cosine, double(water));
  const double r = std::pow((cosine - inside) / (cosine + inside), 2);
  const double finesse = 4 * r / std::pow(1 - r, 2);
  EXPECT_NEAR(film_at(float(cosine), water, float(550 / (4 * inside)), 550),
              0.5 * finesse / (1 + finesse), 1e-5);
}

TEST(ThinFilm, ManyPhasesAreAPane) {
  for (const float cosine : {1.0f, 0.6f, 0.2f}) {
    double sum = 0;
    constexpr int count = 4000;
    for (int i = 0; i < count; ++i) sum += film_at(cosine, water, 2e5f + 1.37f * float(i), 550);
    // Each polarisation is a pane of its own.
    const double n = double(water), c = double(cosine), inside = inside_of(c, n);
    double pane = 0;
    for (const double a : {c, n * n * c}) {
      const double r = std::pow((a - inside) / (a + inside), 2);
      pane += r / (1 + r);
    }
    EXPECT_NEAR(sum / count, pane, 0.003) << cosine;
    for (int lane = 0; lane < 3; ++lane)
      EXPECT_NEAR(film_in_rgb(cosine, water, 1e5f)[lane], pane, 2e-3) << cosine;
  }
}

TEST(ThinFilm, LightTunnelsThroughANarrowGap) {
  // Air between glass, beyond the critical angle of 41.8°.
  const float eta = 1 / 1.5f, cosine = std::cos(0.9f);
  EXPECT_NEAR(film_at(cosine, eta, 0, 550), 0, 1e-9);
  EXPECT_NEAR(film_at(cosine, eta, 20'000, 550), 1, 1e-6);
  double before = 0;
  for (float gap = 50; gap < 1000; gap += 50) {
    const double now = film_at(cosine, eta, 1.5f * gap, 550);
    EXPECT_GT(now, before);
    EXPECT_LE(now, 1);
    before = now;
  }
  // Where that begins the share is continuous.
  const float critical = std::sqrt(1 - eta * eta);
  EXPECT_NEAR(film_at(critical * 1.0001f, eta, 300, 550),
              film_at(critical * 0.9999f, eta, 300, 550), 2e-3);
}

TEST(ThinFilm, RedGreenAndBlueAreMeansOverWavelengths) {
  for (const float thickness : {90.0f, 250.0f, 480.0f, 1300.0f})
    for (const float cosine : {1.0f, 0.7f, 0.3f}) {
      SpectralCurve curve;
      for (int nm = 360; nm <= 830; ++nm)
        curve.samples.emplace_back(nm, film_at(cosine, water, thickness, float(nm)));
      const Rgb expected = rgb_from_reflectance(curve);
      const Spectrum found = film_in_rgb(cosine, water, thickness);
      EXPECT_NEAR(found[0], expected.r, 0.002) << thickness << " nm at " << cosine;
      EXPECT_NEAR(found[1], expected.g, 0.002) << thickness << " nm at " << cosine;
      EXPECT_NEAR(found[2], expected.b, 0.002) << thickness << " nm at " << cosine;
    }
}

TEST(ThinFilm, NothingIsOutOfBounds) {
  for (const float eta : {0.01f, 0.5f, 1.0f, 1.0001f, 2.4f, 100.0f})
    for (const float cosine : {0.0f, 1e-6f, 0.3f, 1.0f})
      for (const float thickness : {0.0f, 0.001f, 300.0f, 1e6f}) {
        const double one = film_at(cosine, eta, thickness, 450);
        EXPECT_TRUE(one >= 0 && one <= 1) << eta << ' ' << cosine << ' ' << thickness;
        for (int c = 0; c < 3; ++c) {
          const float lane = film_in_rgb(cosine, eta, thickness)[c];
          EXPECT_TRUE(lane >= 0 && lane <= 1) << eta << ' ' << cosine << ' ' << thickness;
        }
      }
}

TEST(ThinFilm, APaneOfSomeThicknessIsAFilm) {
  const auto film = test::make_bsdf(
      "thindielectric", {test::property("int_ior", 1.33), test::property("ext_ior", 1.0),
                         test::property("thickness", 300.0)});
  const BsdfContext context = test::radiance();
  const Vec3f wo = normalize(Vec3f(0.3f, 0.1f, 0.8f));
  const Spectrum reflected = film->albedo(context, wo, Lobes::all);
  const Spectrum expected = film_in_rgb(wo.z, water, 300);
  for (int c = 0; c < 3; ++c) {
    EXPECT_FLOAT_EQ(reflected[c], expected[c]);
    EXPECT_FLOAT_EQ(film->straight(context, wo)[c], 1 - expected[c]);
  }
}

}  // namespace
}  // namespace kaustik
