#include "kaustik/medium/phase_function.h"

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"
#include "kaustik/base/warp.h"
#include "kaustik/medium/medium.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int phase_count = 20'000;
constexpr double planted_phase_error = 0.1;
#else
constexpr int phase_count = 200'000;
constexpr double planted_phase_error = 0.025;
#endif
constexpr double phase_level = 1e-4;
constexpr int rings = 16, sectors = 4;

const Vec3f wo = normalize({0.3f, -0.5f, 0.8f});

/// Integral of the phase function over a range of the cosine, divided by 2π, by Simpson's rule in
/// double precision on its own values.
double ring_integral(const PhaseFunction& phase, double low, double high) {
  const Frame frame(-wo);
  constexpr int steps = 256;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double cosine = low + (high - low) * i / steps;
    const auto sine = float(std::sqrt(std::max(0.0, 1 - cosine * cosine)));
    const Vec3f wi = frame.to_world({sine, 0, float(cosine)});
    sum += double(phase.eval(wo, wi)) * (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2);
  }
  return sum * (high - low) / steps / 3;
}

struct Kind {
  std::string name;
  std::shared_ptr<const PhaseFunction> phase;
};

class EveryPhaseFunction : public testing::TestWithParam<Kind> {};

TEST_P(EveryPhaseFunction, IsNormalisedAndHasItsMeanCosine) {
  const PhaseFunction& phase = *GetParam().phase;
  double whole = 0, cosine_mean = 0;
  constexpr int parts = 64;
  for (int i = 0; i < parts; ++i) {
    // Finer toward the forward and the backward direction.
    const auto edge = [](int k) { return -std::cos(std::numbers::pi * k / parts); };
    const double part = 2 * std::numbers::pi * ring_integral(phase, edge(i), edge(i + 1));
    whole += part;
    cosine_mean += part * (edge(i) + edge(i + 1)) / 2;
  }
  EXPECT_NEAR(whole, 1, 2e-4);
  EXPECT_NEAR(cosine_mean, double(phase.mean_cosine()), 2e-3);
}

/// Chi-square of sampled directions, over rings of the cosine and sectors of the azimuth, against
/// the integral of eval().
TEST_P(EveryPhaseFunction, SamplesByItsValue) {
  const PhaseFunction& phase = *GetParam().phase;
  const Frame frame(-wo);
  std::vector<double> hits(rings * sectors, 0.0), expected(rings * sectors, 0.0);
  for (int i = 0; i < phase_count; ++i) {
    const Vec3f wi = phase.sample(wo, Sampler(hash_mix(7, uint64_t(i)), 0).next_2d());
    ASSERT_NEAR(length(wi), 1, 1e-5f);
    const Vec3f local = frame.to_local(wi);
    const double turn = std::atan2(double(local.y), double(local.x)) / (2 * std::numbers::pi) + 0.5;
    const int ring = std::clamp(int((double(local.z) + 1) / 2 * rings), 0, rings - 1);
    hits[size_t(ring * sectors + std::clamp(int(turn * sectors), 0, sectors - 1))] += 1;
  }
  for (int i = 0; i < rings * sectors; ++i) {
    const double low = -1 + 2.0 * (i / sectors) / rings;
    expected[size_t(i)] =
        phase_count * 2 * std::numbers::pi / sectors * ring_integral(phase, low, low + 2.0 / rings);
  }
  double total = 0;
  for (const double e : expected) total += e;
  for (double& e : expected) e *= phase_count / total;
  EXPECT_GT(chi_square_p_value(hits, expected), phase_level);
  for (size_t i = 0; i < expected.size(); ++i)
    expected[i] *= i % 2 ? 1 + planted_phase_error : 1 - planted_phase_error;
  EXPECT_LT(chi_square_p_value(hits, expected), phase_level);
}

std::shared_ptr<const PhaseFunction> blend(float weight) {
  return blended_phase_function(rayleigh_phase_function(), henyey_greenstein_phase_function(0.7f),
                                weight);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, EveryPhaseFunction,
    testing::Values(Kind{"isotropic", isotropic_phase_function()},
                    Kind{"forward", henyey_greenstein_phase_function(0.8f)},
                    Kind{"backward", henyey_greenstein_phase_function(-0.5f)},
                    Kind{"even", henyey_greenstein_phase_function(0)},
                    Kind{"nearly_even", henyey_greenstein_phase_function(9e-4f)},
                    Kind{"sharp", henyey_greenstein_phase_function(0.95f)},
                    Kind{"rayleigh", rayleigh_phase_function()}, Kind{"blend", blend(0.3f)},
                    Kind{"first", blend(0)}, Kind{"second", blend(1)},
                    Kind{"table", tabulated_phase_function({1, 0, 2, 7, 3})},
                    Kind{"ramp", tabulated_phase_function({0, 5e300})}),
    [](const auto& kind) { return kind.param.name; });

/// At θ = 0 and π the closed form is (1 ± g)/(4π (1 ∓ g)²); above zero, light goes on forward.
TEST(HenyeyGreenstein, HasItsValues) {
  const auto phase = henyey_greenstein_phase_function(0.6f);
  EXPECT_NEAR(phase->eval(wo, -wo), 1.6 / (4 * std::numbers::pi * 0.16), 1e-5);
  EXPECT_NEAR(phase->eval(wo, wo), 0.4 / (4 * std::numbers::pi * 2.56), 1e-7);
}

/// The branch for small g meets the closed form.
TEST(HenyeyGreenstein, IsSmoothWhereTheFormulaChanges) {
  const auto below = henyey_greenstein_phase_function(0.99e-3f);
  const auto above = henyey_greenstein_phase_function(1.01e-3f);
  for (int i = 0; i < 1000; ++i) {
    const Vec2f u = Sampler(hash_mix(9, uint64_t(i)), 0).next_2d();
    EXPECT_NEAR(dot(below->sample(wo, u), wo), dot(above->sample(wo, u), wo), 2e-4f);
  }
}

TEST(HenyeyGreenstein, IsFiniteForAnyDirection) {
  for (const float g : {-0.999999f, 0.999999f}) {
    const auto phase = henyey_greenstein_phase_function(g);
    for (const Vec3f& wi : {wo, -wo, wo * 1.0000002f, wo * -1.0000002f})
      EXPECT_TRUE(std::isfinite(phase->eval(wo, wi)));
  }
}

TEST(Rayleigh, HasItsValues) {
  const auto phase = rayleigh_phase_function();
  const double per_sr = 3 / (16 * std::numbers::pi);
  EXPECT_NEAR(phase->eval(wo, wo), 2 * per_sr, 1e-7);
  EXPECT_NEAR(phase->eval(wo, -wo), 2 * per_sr, 1e-7);
  EXPECT_NEAR(phase->eval(wo, Frame(wo).x), per_sr, 1e-7);
}

/// Of a blend the mean cosine is the mean of both; of a ramp from 0 to f it is ∫ μ (1 + μ)/2 dμ.
TEST(PhaseFunctions, HaveTheMeanCosinesOfTheirClosedForms) {
  EXPECT_FLOAT_EQ(blend(0.3f)->mean_cosine(), 0.3f * 0.7f);
  EXPECT_FLOAT_EQ(tabulated_phase_function({0, 2})->mean_cosine(), 1.0f / 3);
  EXPECT_FLOAT_EQ(tabulated_phase_function({2, 0})->mean_cosine(), -1.0f / 3);
  EXPECT_FLOAT_EQ(tabulated_phase_function({1, 1, 1})->mean_cosine(), 0);
  EXPECT_FLOAT_EQ(tabulated_phase_function({4, 4})->eval(wo, wo), sphere_pdf);
  // The last value is that of light that goes straight on.
  EXPECT_FLOAT_EQ(tabulated_phase_function({0, 1})->eval(wo, -wo), 4 * sphere_pdf / 2);
}

}  // namespace
}  // namespace kaustik
