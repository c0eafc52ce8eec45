// Where connections pay, by trials made up of known noise.

#include "kaustik/vcm/lessons/connection_learning.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kaustik {
namespace {

/// Standard deviations of what a block shows, whose light is 1, by way.
struct Noise {
  double samples, light_paths, rays;
};
struct Block {
  Noise alone, connected;
};

constexpr Vec2i blocks{80, 60};  // a picture of 640 × 480 pixels
constexpr double other_rays = 5;

/// A trial in which `block_at(x)` tells the noise of a column. Disks reach over blocks, and either
/// way meets the same light paths: four by four blocks share their noise.
template <typename BlockAt>
ConnectionLearning::Choice choice_for(const BlockAt& block_at, unsigned seed = 7) {
  constexpr int shared = 4;
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<std::vector<ConnectionLearning::Trial>> passes(ConnectionLearning::pass_count);
  for (auto& pass : passes) {
    std::vector<double> of_light_paths(size_t(blocks.x * blocks.y));
    for (double& value : of_light_paths) value = normal(random);
    for (int i = 0; i < blocks.x * blocks.y; ++i) {
      const int x = i % blocks.x, y = i / blocks.x;
      const Block block = block_at(x);
      const double light_paths = of_light_paths[size_t(y / shared * blocks.x + x / shared)];
      const double first = normal(random), second = normal(random);
      ConnectionLearning::Trial trial;
      for (const auto way : {ConnectionLearning::alone, ConnectionLearning::connected}) {
        const Noise& noise = way == ConnectionLearning::alone ? block.alone : block.connected;
        const double light = 1 + noise.light_paths * light_paths;
        // Samples find other things if they are connected.
        const bool is_other = way == ConnectionLearning::connected;
        const double a = light + noise.samples * (is_other ? normal(random) : first),
                     b = light + noise.samples * (is_other ? normal(random) : second);
        trial[way] = {(a - b) * (a - b) / 2, (a + b) / 2, noise.rays};
      }
      pass.push_back(trial);
    }
  }
  return ConnectionLearning::choice(passes, blocks, 4, other_rays);
}
template <typename BlockAt>
bool is_chosen(const BlockAt& block_at) {
  return !choice_for(block_at).connects.empty();
}

TEST(ConnectionLearning, WhereTheyTakeOffMoreThanTheyCost) {
  const auto found = choice_for([](int x) {
    const Noise plain{x < 20 ? 1.0 : 0.2, 0.02, 3};
    return Block{plain, {x < 20 ? 0.3 : 0.2, 0.02, 4}};
  });
  ASSERT_EQ(found.connects.size(), size_t(blocks.x * blocks.y));
  EXPECT_GT(found.gain, 2);
  int left = 0, right = 0;
  for (int y = 0; y < blocks.y; ++y) {
    for (int x = 2; x < 16; ++x) left += found.connects[size_t(y * blocks.x + x)] ? 1 : 0;
    for (int x = 26; x < 40; ++x) right += found.connects[size_t(y * blocks.x + x)] ? 1 : 0;
  }
  EXPECT_EQ(left, 14 * blocks.y);
  // By chance, where they make no difference.
  EXPECT_LT(right, 14 * blocks.y / 3);
}

/// They cost four rays, and three for each that they trace: (5 + 3 + 4 + 3)/(5 + 3) = 1.875 times
/// the time here.
TEST(ConnectionLearning, NotWhereTheyCostMore) {
  EXPECT_FALSE(is_chosen([](int) { return Block{{1, 0.02, 3}, {0.8, 0.02, 4}}; }));
  EXPECT_TRUE(is_chosen([](int) { return Block{{1, 0.02, 3}, {0.6, 0.02, 4}}; }));
}

/// Where they take off what they cost some blocks look better by chance; what others choose is no
/// better then.
TEST(ConnectionLearning, NotByChance) {
  const double as_good = std::sqrt(8.0 / 12);
  for (unsigned seed = 1; seed <= 10; ++seed)
    EXPECT_TRUE(choice_for(
                    [&](int) {
                      return Block{{1, 0.02, 3}, {as_good, 0.02, 3}};
                    },
                    seed)
                    .connects.empty())
        << seed;
}

/// What light paths leave as noise, which all samples of a pixel share, they do not take off.
TEST(ConnectionLearning, NotWhereLightPathsAreTheNoise) {
  const auto of = [](double light_paths, double left) {
    return is_chosen([=](int) {
      return Block{{0.5, light_paths, 3}, {0.1, left * light_paths, 4}};
    });
  };
  EXPECT_TRUE(of(0.02, 1));
  EXPECT_FALSE(of(1, 1));
  // If they do, they pay.
  EXPECT_TRUE(of(1, 0.5));
}

/// V = w/4 + light paths, and 1.875 times the time.
TEST(ConnectionLearning, TellsWhatTheyWouldMake) {
  const auto found = choice_for([](int) { return Block{{1, 0.5, 3}, {0.8, 0.5, 4}}; });
  EXPECT_NEAR(found.variance_left, (0.16 + 0.25) / (0.25 + 0.25), 0.1);
  EXPECT_NEAR(found.time_taken, 1.875, 1e-6);
}

TEST(ConnectionLearning, NothingIsChosenOfNothing) {
  EXPECT_TRUE(ConnectionLearning().choice(4, other_rays).connects.empty());
  EXPECT_FALSE(is_chosen([](int) { return Block{}; }));
}

}  // namespace
}  // namespace kaustik
