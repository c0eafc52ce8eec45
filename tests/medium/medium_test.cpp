#include "kaustik/medium/homogeneous.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <vector>
#include "kaustik/base/sampler.h"

#include "kaustik/base/statistics.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int count = 20'000;
constexpr double planted_error = 0.1;
#else
constexpr int count = 200'000;
constexpr double planted_error = 0.03;
#endif
constexpr double level = 1e-4;

Vec2f point(uint64_t key, int i) { return Sampler(hash_mix(key, uint64_t(i)), 0).next_2d(); }

const Spectrum sigma_t(0.4f, 1.0f, 2.5f, 1.3f), albedo(0.9f, 0.5f, 0.8f, 0.7f);
const Spectrum shares(0.2f, 0.7f, 0.4f, 0);

/// With lanes of its own in RGB mode, whatever it is at other wavelengths.
HomogeneousMedium medium_of(const Spectrum& extinction, const Spectrum& its_albedo) {
  return {SpectralValue().with_rgb(extinction), SpectralValue().with_rgb(extinction * its_albedo)};
}

TEST(medium, follows_beer_and_lambert) {
  const HomogeneousMedium medium = medium_of(Spectrum(0, 0.5f, 2, 1), Spectrum(0));
  const Spectrum t = medium.transmittance(1.5f, {});
  EXPECT_EQ(t[0], 1);
  EXPECT_FLOAT_EQ(t[1], std::exp(-0.75f));
  EXPECT_FLOAT_EQ(t[2], std::exp(-3.0f));
  const Spectrum two = medium.transmittance(0.7f, {}) * medium.transmittance(0.8f, {});
  for (int lane = 0; lane < 4; ++lane) EXPECT_NEAR(two[lane], t[lane], 1e-6f);
}

TEST(medium, at_the_ends) {
  const HomogeneousMedium medium = medium_of(Spectrum(0, 0.5f, 2, 1), Spectrum(0));
  EXPECT_EQ(medium.transmittance(0, {}), Spectrum(1));
  EXPECT_EQ(medium.transmittance(infinity, {}), Spectrum(1, 0, 0, 0));
  EXPECT_FALSE(medium.scatters());
  // A lane without extinction goes on for ever.
  const Medium::Flight flight =
      medium.sample_flight(infinity, Spectrum(1, 0, 0, 0), {}, Vec2f(0.5f, 0.5f));
  EXPECT_FALSE(flight.scattered);
  EXPECT_EQ(flight.weight, Spectrum(1, 0, 0, 0));
  EXPECT_FALSE(medium.sample_collision(1, Spectrum(1), {}, Vec2f(0.5f, 0.5f)).scattered);
}

/// ∫ σ_s exp(−σ_t t) g(t) dt over the segment in closed form for g = 1, and what is left behind it.
double scattered_share(int lane, double limit) {
  return double(albedo[lane]) * (1 - std::exp(-double(sigma_t[lane]) * limit));
}

/// Means of the weights are what the medium scatters within the segment and lets through, for every
/// lane whichever was sampled.
TEST(medium, free_flight_has_the_right_weights) {
  const HomogeneousMedium medium = medium_of(sigma_t, albedo);
  const float limit = 0.8f;
  std::array<RunningStatistics, 3> scattered, passed, collided;
  for (int i = 0; i < count; ++i) {
    const Medium::Flight flight = medium.sample_flight(limit, shares, {}, point(1, i));
    const Medium::Flight collision = medium.sample_collision(limit, shares, {}, point(2, i));
    ASSERT_LE(flight.distance, limit);
    ASSERT_TRUE(collision.scattered && collision.distance <= limit);
    for (int lane = 0; lane < 3; ++lane) {
      scattered[size_t(lane)].add(flight.scattered ? double(flight.weight[lane]) : 0);
      passed[size_t(lane)].add(flight.scattered ? 0 : double(flight.weight[lane]));
      collided[size_t(lane)].add(double(collision.weight[lane]));
    }
  }
  for (int lane = 0; lane < 3; ++lane) {
    const double expected = scattered_share(lane, double(limit));
    const double through = std::exp(-double(sigma_t[lane]) * double(limit));
    EXPECT_GT(z_test_p_value(scattered[size_t(lane)], expected), level) << lane;
    EXPECT_LT(z_test_p_value(scattered[size_t(lane)], expected * (1 + planted_error)), level);
    EXPECT_GT(z_test_p_value(collided[size_t(lane)], expected), level) << lane;
    EXPECT_LT(z_test_p_value(collided[size_t(lane)], expected * (1 + planted_error)), level);
    EXPECT_GT(z_test_p_value(passed[size_t(lane)], through), level) << lane;
    EXPECT_LT(z_test_p_value(passed[size_t(lane)], through * (1 + planted_error)), level);
  }
}

/// Distances of `sample` in cells of equal chance, if their density is that of `shares`.
void expect_distances(const std::function<Medium::Flight(int)>& sample, float limit) {
  constexpr int cells = 20;
  std::vector<double> hits(cells, 0.0), expected(cells, 0.0);
  double drawn = 0;
  for (int i = 0; i < count; ++i) {
    const Medium::Flight flight = sample(i);
    if (!flight.scattered) continue;
    hits[size_t(std::min(int(flight.distance / limit * cells), cells - 1))] += 1;
    drawn += 1;
  }
  // For collisions lanes count by what they scatter.
  const auto chance = [&](double from, double to) {
    double sum = 0;
    for (int lane = 0; lane < 3; ++lane) {
      const double s = double(sigma_t[lane]);
      sum += double(shares[lane]) * (std::exp(-s * from) - std::exp(-s * to));
    }
    return sum;
  };
  for (int i = 0; i < cells; ++i)
    expected[size_t(i)] = drawn *
                          chance(double(limit) * i / cells, double(limit) * (i + 1) / cells) /
                          chance(0, double(limit));
  EXPECT_GT(chi_square_p_value(hits, expected), level);
  for (size_t i = 0; i < cells; ++i) expected[i] *= i % 2 ? 1 + planted_error : 1 - planted_error;
  EXPECT_LT(chi_square_p_value(hits, expected), level);
}

TEST(medium, free_flight_has_its_density) {
  const HomogeneousMedium medium = medium_of(sigma_t, albedo);
  expect_distances([&](int i) { return medium.sample_flight(1.5f, shares, {}, point(3, i)); },
                   1.5f);
}

TEST(medium, collisions_have_their_density) {
  // Shares that make each lane as likely as its free flight before the limit ends in a collision.
  const HomogeneousMedium medium = medium_of(sigma_t, Spectrum(1));
  Spectrum lanes;
  for (int lane = 0; lane < 3; ++lane)
    lanes.set(lane, shares[lane] / sigma_t[lane] * -std::expm1(-sigma_t[lane] * 1.5f));
  expect_distances([&](int i) { return medium.sample_collision(1.5f, lanes, {}, point(4, i)); },
                   1.5f);
}

/// Nearly transparent and nearly opaque media stay finite.
TEST(medium, extremes_are_finite) {
  for (const float sigma : {1e-30f, 1e-8f, 1.0f, 1e8f, 1e30f}) {
    const HomogeneousMedium medium = medium_of(Spectrum(sigma, sigma / 3, 0, sigma), Spectrum(1));
    for (const float limit : {1e-20f, 1.0f, 1e20f, infinity})
      for (const float u : {0.0f, 0.5f, one_minus_epsilon}) {
        const Medium::Flight flight = medium.sample_flight(limit, Spectrum(1), {}, {0.3f, u});
        const Medium::Flight collision = medium.sample_collision(limit, Spectrum(1), {}, {0.3f, u});
        EXPECT_TRUE(flight.weight.is_finite()) << sigma << " " << limit << " " << u;
        EXPECT_TRUE(collision.weight.is_finite()) << sigma << " " << limit << " " << u;
      }
  }
}

}  // namespace
}  // namespace kaustik
