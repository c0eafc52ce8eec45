// Glasses whose index was measured: prisms, balls and drops send each wavelength where closed forms
// say.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "kaustik/material/fresnel.h"
#include "tests/material/bsdf_support.h"

namespace kaustik {
namespace {

constexpr double degree = std::numbers::pi / 180;

double index(const char* name, double nm) {
  const auto x = float(nm);
  return double(named_ior(name).at({x, x, x, x})[0]);
}

TEST(dispersion, catalogues_have_these_indices_and_abbe_numbers) {
  struct Listed {
    const char* name;
    double n_d, abbe;
  };
  // Of the makers' and authors' tables.
  for (const auto& [name, n_d, abbe] :
       {Listed{"bk7", 1.51680, 64.17}, Listed{"sf10", 1.72825, 28.41},
        Listed{"sf11", 1.78472, 25.76}, Listed{"fused silica", 1.45846, 67.82},
        Listed{"sapphire", 1.76817, 72.2}}) {
    EXPECT_NEAR(index(name, 587.562), n_d, 2e-5) << name;
    const double found = (index(name, 587.562) - 1) / (index(name, 486.134) - index(name, 656.281));
    EXPECT_NEAR(found, abbe, 0.003 * abbe) << name;
  }
  EXPECT_NEAR(index("water", 589.3), 1.33335, 2e-5);
  EXPECT_NEAR(index("diamond", 589.3), 2.4173, 5e-4);
}

TEST(dispersion, abbe_numbers_are_what_they_say) {
  const SpectralValue glass = ior_by_abbe_number(1.6f, 36);
  EXPECT_FLOAT_EQ(glass.rgb()[0], 1.6f);
  const Spectrum n = glass.at({486.134f, 587.562f, 656.281f, 700});
  EXPECT_NEAR(n[1], 1.6, 1e-6);
  EXPECT_NEAR((n[1] - 1) / (n[0] - n[2]), 36, 0.01);
  EXPECT_LT(n[3], n[2]);
}

TEST(dispersion, rgb_mode_keeps_mitsubas_indices) {
  EXPECT_FLOAT_EQ(named_ior("bk7").rgb()[0], 1.5046f);
  EXPECT_FLOAT_EQ(named_ior("water").rgb()[0], 1.333f);
  EXPECT_TRUE(named_ior("air").is_constant());
  EXPECT_NEAR(named_ior("sf11").rgb()[0], 1.78446, 1e-5);
}

/// The direction in which one of the wavelengths goes on, where all arrive from `wo`, in the frame
/// of the surface.
Vec3f refracted(const Bsdf& glass, const Wavelengths& wavelengths, int lane, const Vec3f& wo) {
  BsdfContext context({}, TransportMode::radiance, wavelengths.only(lane));
  const BsdfSample sample = glass.sample(context, wo, one_minus_epsilon, {0.5f, 0.5f}, Lobes::all);
  EXPECT_TRUE(sample.transmission);
  EXPECT_EQ(sample.only_lane, lane);
  return sample.wi;
}

/// Angle between surface and ray in a plane, after refraction: `angle` from the normal, rad.
double refracted_angle(const Bsdf& glass, const Wavelengths& wavelengths, int lane, double angle,
                       bool from_outside) {
  const auto z = float(std::cos(angle) * (from_outside ? 1 : -1));
  const Vec3f wi = refracted(glass, wavelengths, lane, {float(std::sin(angle)), 0, z});
  return std::asin(-double(wi.x));
}

// 60° of flint: light enters at 55° and leaves by the other face. Closed form: Snell's law twice.
TEST(dispersion, a_prism_deviates_twelve_wavelengths_as_sellmeier_says) {
  constexpr double apex = 60 * degree, incidence = 55 * degree;
  for (const char* name : {"bk7", "sf10", "fused silica"}) {
    const auto glass = test::make_bsdf("dielectric", {test::property("int_ior", std::string(name)),
                                                      test::property("ext_ior", 1.0)});
    double least = 1e9, most = 0;
    for (int i = 0; i < 12; i += 4) {
      const auto nm = [&](int lane) { return 400 + 30.0f * float(i + lane); };
      const Wavelengths four(nm(0), nm(1), nm(2), nm(3));
      for (int lane = 0; lane < 4; ++lane) {
        const double inside = refracted_angle(*glass, four, lane, incidence, true);
        const double outside = refracted_angle(*glass, four, lane, apex - inside, false);
        const double found = incidence + outside - apex;
        const double n = index(name, double(nm(lane)));
        const double first = std::asin(std::sin(incidence) / n);
        const double expected = incidence + std::asin(n * std::sin(apex - first)) - apex;
        EXPECT_NEAR(found / degree, expected / degree, 0.02) << name << ' ' << nm(lane);
        least = std::min(least, found), most = std::max(most, found);
      }
    }
    // One index for all would be wrong by more.
    EXPECT_GT((most - least) / degree, 0.5) << name;
  }
}

/// Least deviation of light that is reflected so often in a drop, rad: where the rainbow stands.
double least_deviation(const Bsdf& water, const Wavelengths& four, int lane, int reflections) {
  double least = 1e9;
  for (int i = 1; i < 4000; ++i) {
    const double incidence = std::asin(i / 4000.0);
    const double inside = refracted_angle(water, four, lane, incidence, true);
    least =
        std::min(least, 2 * (incidence - inside) + reflections * (std::numbers::pi - 2 * inside));
  }
  return least;
}

TEST(dispersion, rainbows_stand_where_they_stand_in_the_sky) {
  const auto water = test::make_bsdf("dielectric", {test::property("int_ior", std::string("water")),
                                                    test::property("ext_ior", 1.0)});
  const Wavelengths four(404.7f, 486.1f, 587.6f, 656.3f);
  for (const int lane : {0, 3})
    for (const int reflections : {1, 2}) {
      // Descartes' ray: cos² i = (n² − 1)/((k + 1)² − 1).
      const double n = index("water", double(four[lane])), k = reflections;
      const double incidence = std::acos(std::sqrt((n * n - 1) / (k * k + 2 * k)));
      const double inside = std::asin(std::sin(incidence) / n);
      const double expected = 2 * (incidence - inside) + k * (std::numbers::pi - 2 * inside);
      EXPECT_NEAR(least_deviation(*water, four, lane, reflections) / degree, expected / degree, 0.1)
          << four[lane] << ' ' << reflections;
    }
  // From the antisolar point, as listed for 20 °C: hydrogen's red at 42.3°, mercury's violet at
  // 40.6°.
  EXPECT_NEAR(180 - least_deviation(*water, four, 3, 1) / degree, 42.3, 0.1);
  EXPECT_NEAR(180 - least_deviation(*water, four, 0, 1) / degree, 40.6, 0.1);
}

// Parallel light near the axis meets at f = n R/(2 (n − 1)) from the centre.
TEST(dispersion, a_ball_lens_has_its_focal_length_at_every_wavelength) {
  const auto glass = test::make_bsdf("dielectric", {test::property("int_ior", std::string("bk7")),
                                                    test::property("ext_ior", 1.0)});
  const Wavelengths four(420, 500, 580, 680);
  constexpr double height = 0.01;
  for (int lane = 0; lane < 4; ++lane) {
    const double incidence = std::asin(height);
    const double inside = refracted_angle(*glass, four, lane, incidence, true);
    // Symmetric: it leaves as it came, turned by twice the difference, at that height.
    const double turn = 2 * (incidence - inside);
    const double polar = incidence + 2 * (std::numbers::pi / 2 - inside) - std::numbers::pi;
    const double x = std::cos(polar), y = -std::sin(polar);
    const double found = x + y / std::tan(turn);
    const double n = index("bk7", double(four[lane]));
    EXPECT_NEAR(found, n / (2 * (n - 1)), 1e-3) << four[lane];
  }
}

}  // namespace
}  // namespace kaustik
