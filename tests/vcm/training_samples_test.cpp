// Pairs of samples that passes teach by, and means over blocks of pixels.

#include "kaustik/vcm/lessons/training_samples.h"

#include <numeric>

#include "kaustik/transport/block_means.h"
#include "tests/vcm/hollow_ball.h"

namespace kaustik {
namespace {

using namespace test;

TEST(BlockMeans, AreOfTheBlocksAround) {
  const std::vector<double> values{1, 2, 3,  //
                                   4, 5, 6};
  EXPECT_EQ(means_around(values, {3, 2}, 0), values);
  // At the borders of those that there are.
  EXPECT_EQ(means_around(values, {3, 2}, 1), (std::vector<double>{3, 3.5, 4, 3, 3.5, 4}));
  EXPECT_EQ(means_around(values, {2, 3}, 1), (std::vector<double>{2.5, 2.5, 3.5, 3.5, 4.5, 4.5}));
  EXPECT_EQ(means_around(values, {3, 2}, 9), std::vector<double>(6, 3.5));
}

TEST(BlockMeans, OutliersCountAsTheLargestOfTheOthers) {
  std::vector<double> values(101);
  std::iota(values.rbegin(), values.rend(), 0);
  std::vector<double> clipped = values;
  clip_outliers(clipped, 0.05);
  for (size_t i = 0; i < values.size(); ++i) EXPECT_EQ(clipped[i], std::min(values[i], 95.0));
  clipped = values;
  clip_outliers(clipped, 0);
  EXPECT_EQ(clipped, values);
}

/// 1/(light around² + (a tenth of the mean)²).
TEST(TrainingSamples, NoiseIsRelativeToTheLightAround) {
  const std::vector<double> scale = relative_scale({2, 0, 0, 0}, {4, 1}, 0);
  const double floor = sqr(0.1 * 0.5);
  EXPECT_DOUBLE_EQ(scale[0], 1 / (4 + floor));
  EXPECT_DOUBLE_EQ(scale[3], 1 / floor);
  // Means over the neighbours are 1, 2/3, 0 and 0.
  const double wider = sqr(0.1 * (1 + 2.0 / 3) / 4);
  EXPECT_DOUBLE_EQ(relative_scale({2, 0, 0, 0}, {4, 1}, 1)[1], 1 / (4.0 / 9 + wider));
  EXPECT_EQ(relative_scale({0, 0}, {2, 1}, 1), std::vector<double>(2, 0.0));
}

/// Samples of light 0 or 6 in three lanes, of 2 rays or 5, as their own numbers tell.
void take_coin(const Vec2f&, Sampler& sampler, SampleSink& sink) {
  const bool heads = sampler.next_1d() < 0.5f;
  if (heads) sink.add(Component::direct, Spectrum(2, 2, 2, 0));
  sink.add(Component::caustic, Spectrum(100));  // nobody wants it
  sink.count_rays(heads ? 5 : 2);
}

/// Pairs are of one pixel of the block, independent, and tell the variance by their difference.
TEST(TrainingSamples, PairsTellTheVariance) {
  ComponentSet wanted;
  wanted.add(Component::direct);
  const PixelFilter filter;
  constexpr uint32_t pairs = 4000;
  int same = 0;
  RunningStatistics variance, light;
  std::array<std::array<int, 2>, 3> seen{};
  PlanWindow window;
  window.size = {10, 7};
  const BlockGrid grid(window, 4);
  const Pass pass{5, 0, 4, {}};
  std::vector<Vec2f> where;
  const TakeSample take = [&](const Vec2f& at, Sampler& sampler, SampleSink& to) {
    where.push_back(at);
    take_coin(at, sampler, to);
  };
  for (uint32_t i = 0; i < pairs; ++i) {
    // The block at the lower right corner, of which the picture has 2 × 3 pixels.
    where.clear();
    const TrainingPair pair = training_pair(
        {.grid = grid, .filter = filter, .components = wanted, .pass = pass, .take = take}, {5, i});
    ASSERT_EQ(where.size(), 2u);
    const Vec2i pixel(int(where[0].x), int(where[0].y));
    ASSERT_TRUE(pixel.x >= 8 && pixel.x < 10 && pixel.y >= 4 && pixel.y < 7);
    EXPECT_EQ(pixel, Vec2i(int(where[1].x), int(where[1].y)));
    ++seen[size_t(pixel.y - 4)][size_t(pixel.x - 8)];
    variance.add(pair.variance);
    light.add(pair.light);
    same += pair.rays[0] == pair.rays[1];
    // Half of 6² where they differ, of light 3.
    EXPECT_EQ(pair.variance, pair.rays[0] == pair.rays[1] ? 0 : 18);
    EXPECT_EQ(pair.light, double(pair.rays[0] + pair.rays[1] - 4));
  }
  expect_known_mean("variance of a coin", variance, 9, 0.15);
  expect_known_mean("light of a coin", light, 3, 0.15);
  EXPECT_NEAR(same, pairs / 2, 4 * std::sqrt(pairs / 4.0));
  // Stratified, so that no pixel is left out.
  for (const auto& row : seen)
    for (const int count : row) EXPECT_NEAR(count, pairs / 6, 0.1 * pairs / 6);
}

}  // namespace
}  // namespace kaustik
