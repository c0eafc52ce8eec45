// Guided directions: their density, and their samples.

#include "kaustik/transport/scatter_guide.h"

#include <gtest/gtest.h>

#include <random>

#include "kaustik/base/statistics.h"
#include "kaustik/base/warp.h"

namespace kaustik {
namespace {

/// Balls of which one holds the place, one is far away, and two overlap.
ScatterGuide guide() {
  ScatterGuide::Parts parts;
  parts.balls = {{{0.2f, 0, 0}, 0.5f}, {{0, 30, 1}, 2}, {{-2, 1, 2}, 1}, {{-2, 2, 2}, 1.5f}};
  parts.shares = {{0, 0.1f}, {1, 0.25f}, {2, 0.2f}, {3, 0.15f}};
  parts.cells = {{0.7f, 0, 4}, {0, 0, 0}};
  parts.nodes.resize(ScatterGuide::side_count, {-1, 0, 1});
  // On the upper side: cells to the left and to the right.
  parts.nodes[4] = {0, 1, ScatterGuide::side_count};
  parts.nodes.push_back({-1, 0, 0});
  parts.nodes.push_back({-1, 0, 1});
  return ScatterGuide(std::move(parts));
}

constexpr float plain_pdf = sphere_pdf;

/// Samples of guided and other directions in cells of the sphere; `factor`: planted into the
/// density of one half.
double chi_square(double factor) {
  const ScatterGuide all = guide();
  const ScatterGuide::Place place = all.place({0, 0, 0}, ScatterGuide::side_of({0, 0.1f, 1}));
  constexpr int side = 24, fine = 64;
  std::vector<double> found(2 * side * side), expected(2 * side * side);
  const auto cell = [](const Vec3f& d) {
    const double z = 0.5 * (1 - double(d.z)), phi = std::atan2(double(d.y), double(d.x));
    const double turn = phi / (2 * M_PI) + (phi < 0 ? 1 : 0);
    return size_t(std::min(int(z * side), side - 1)) * 2 * side +
           size_t(std::min(int(turn * 2 * side), 2 * side - 1));
  };
  constexpr uint32_t samples = 200'000;
  // Numbers that stratify one another would hide small deviations.
  std::mt19937 numbers(1);
  const auto next = [&] { return float(numbers() >> 8) * 0x1p-24f; };
  for (uint32_t i = 0; i < samples; ++i) {
    const Vec2f u(next(), next());
    const float choice = next();
    ++found[cell(choice < place.guided() ? place.sample(choice, u) : square_to_sphere(u))];
  }
  for (int i = 0; i < side * fine; ++i)
    for (int j = 0; j < 2 * side * fine; ++j) {
      const Vec3f d = square_to_sphere(
          {(float(i) + 0.5f) / (side * fine), (float(j) + 0.5f) / (2 * side * fine)});
      expected[cell(d)] += double(place.pdf(plain_pdf, d)) / double(sphere_pdf) * samples /
                           (2.0 * side * side * fine * fine);
    }
  for (size_t i = 0; i < expected.size(); ++i) expected[i] *= i % 2 == 0 ? factor : 2 - factor;
  return chi_square_p_value(found, expected);
}

TEST(ScatterGuide, SamplesFollowTheDensity) {
  EXPECT_GT(chi_square(1), 1e-3);
  EXPECT_LT(chi_square(1.05), 1e-6);
}

/// Narrow cones too, whose cosine is nearly 1 in floats.
TEST(ScatterGuide, DensityOfAFarBall) {
  const ScatterGuide::Ball ball{{3000, 4000, 0}, 10};
  const double sine_sq = 1 / (500.0 * 500.0);
  const double solid_angle = M_PI * sine_sq;  // to within its square
  EXPECT_NEAR(double(ScatterGuide::pdf(ball, {0, 0, 0}, {0.6f, 0.8f, 0})) * solid_angle, 1, 1e-5);
  EXPECT_EQ(ScatterGuide::pdf(ball, {0, 0, 0}, normalize(Vec3f(0.6f, 0.8f, 2.2e-3f))), 0);
}

/// Whatever is drawn from a cone has its density, however narrow that is.
TEST(ScatterGuide, WhatIsDrawnHasADensity) {
  std::mt19937 numbers(2);
  const auto next = [&] { return float(numbers() >> 8) * 0x1p-24f; };
  for (const float radius : {0.3f, 1e-2f, 1e-3f, 1e-4f, 1e-6f}) {
    int lost = 0;
    for (int i = 0; i < 20'000; ++i) {
      const ScatterGuide::Ball ball{square_to_sphere({next(), next()}), radius};
      ScatterGuide::Parts parts;
      parts.balls = {ball};
      parts.shares = {{0, 0.3f}};
      parts.cells = {{0.3f, 0, 1}};
      parts.nodes.resize(ScatterGuide::side_count);
      const ScatterGuide one(std::move(parts));
      const Vec3f direction = one.place({0, 0, 0}, 0).sample(0.1f, {next(), next()});
      lost += ScatterGuide::pdf(ball, {0, 0, 0}, direction) > 0 ? 0 : 1;
    }
    EXPECT_EQ(lost, 0) << radius;
  }
}

TEST(ScatterGuide, PlacesHaveCellsOfTheirOwn) {
  const ScatterGuide all = guide();
  EXPECT_FLOAT_EQ(all.place({0.9f, 5, 5}, 4).guided(), 0.7f);
  EXPECT_EQ(all.place({1.1f, 5, 5}, 4).guided(), 0);
  EXPECT_EQ(all.place({0.9f, 5, 5}, 5).guided(), 0);
  EXPECT_EQ(all.place({1.1f, 5, 5}, 4).pdf(0.3f, {0, 0, 1}), 0.3f);
  EXPECT_EQ(ScatterGuide::side_of({0.1f, -0.9f, 0.4f}), 3);
}

}  // namespace
}  // namespace kaustik
