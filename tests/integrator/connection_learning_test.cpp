// Where connections pay, by trials made up of known noise.

#include "kaustik/integrator/connection_learning.h"

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

constexpr Vec2i blocks{40, 30};
constexpr double other_rays = 5;

/// Both passes of a trial in which `block_at(x)` tells the noise of a column.
template <typename BlockAt>
ConnectionLearning::Choice choice_for(const BlockAt& block_at, uint32_t samples = 4) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<std::vector<ConnectionLearning::Trial>> passes(ConnectionLearning::pass_count);
  for (auto& pass : passes)
    for (int i = 0; i < blocks.x * blocks.y; ++i) {
      const Block block = block_at(i % blocks.x);
      ConnectionLearning::Trial trial;
      for (auto& pair : trial)
        for (const auto way : {ConnectionLearning::alone, ConnectionLearning::connected}) {
          const Noise& noise = way == ConnectionLearning::alone ? block.alone : block.connected;
          const double light = 1 + noise.light_paths * normal(random);
          const double a = light + noise.samples * normal(random),
                       b = light + noise.samples * normal(random);
          pair[way] = {(a - b) * (a - b) / 2, (a + b) / 2, noise.rays};
        }
      pass.push_back(trial);
    }
  return ConnectionLearning::choice(passes, blocks, samples, other_rays);
}

TEST(ConnectionLearning, WhereTheyTakeOffMoreThanTheyCost) {
  const auto found = choice_for([](int x) {
    const Noise plain{x < 20 ? 1.0 : 0.2, 0.05, 3};
    return Block{plain, {x < 20 ? 0.3 : 0.2, 0.05, 4}};
  });
  ASSERT_EQ(found.connects.size(), size_t(blocks.x * blocks.y));
  EXPECT_GT(found.gain, 2);
  EXPECT_NEAR(found.share, 0.5, 0.15);
  for (int y = 0; y < blocks.y; ++y) {
    EXPECT_TRUE(found.connects[size_t(y * blocks.x + 8)]);
    EXPECT_FALSE(found.connects[size_t(y * blocks.x + 36)]);
  }
}

/// They cost four rays for each that they trace.
TEST(ConnectionLearning, NotWhereTheyCostMore) {
  EXPECT_TRUE(choice_for([](int) { return Block{{1, 0.05, 3}, {0.9, 0.05, 5}}; }).connects.empty());
  // By chance they look better here and there.
  EXPECT_TRUE(choice_for([](int) { return Block{{1, 0.05, 3}, {1, 0.05, 3.2}}; }).connects.empty());
}

/// What light paths leave as noise, which all samples of a pixel share, they do not take off.
TEST(ConnectionLearning, NotWhereLightPathsAreTheNoise) {
  const auto of = [](double light_paths, double left) {
    return choice_for([=](int) {
      return Block{{0.5, light_paths, 3}, {0.1, left * light_paths, 4}};
    });
  };
  EXPECT_FALSE(of(0.05, 1).connects.empty());
  EXPECT_TRUE(of(1, 1).connects.empty());
  // If they do, they pay.
  EXPECT_FALSE(of(1, 0.5).connects.empty());
}

TEST(ConnectionLearning, NothingIsChosenOfNothing) {
  EXPECT_TRUE(ConnectionLearning().choice(4, other_rays).connects.empty());
  EXPECT_TRUE(choice_for([](int) { return Block{}; }).connects.empty());
}

}  // namespace
}  // namespace kaustik
