// What light paths learn of where to go on from surfaces.

#include "kaustik/vcm/lessons/scatter_learning.h"

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"

namespace kaustik {
namespace {

constexpr float floor_size = 10;

/// On a floor.
LightScattering event(const Vec3f& position, const Vec3f& next, int path = 0) {
  LightScattering result;
  result.path = uint32_t(path);
  result.position = position;
  result.normal = {0, 0, 1};
  result.next = next;
  const Vec3f direction = normalize(next - position);
  result.pdf = result.pdf_unguided = cosine_hemisphere_pdf(direction.z);
  return result;
}

/// Events that went on by the cosine and came to a dome, or through a window at the floor's end, by
/// which they are worth more.
ScatterLearning learning(int count, double use_of_window) {
  ScatterLearning result;
  for (int i = 0; i < count; ++i) {
    Sampler sampler = Sampler::at(3, 0, Stream::training, 0, uint32_t(i));
    const Vec2f u = sampler.next_2d(), v = sampler.next_2d();
    const Vec3f position(floor_size * u.x, floor_size * u.y, 0);
    if (i % 4 == 0)
      result.add(event(position, {12, 4 + v.x, 1 + v.y}, i), use_of_window, 1);
    else
      result.add(event(position, position + square_to_cosine_hemisphere(v) * 20.0f, i), 1, 1);
  }
  return result;
}

TEST(ScatterLearning, GoesWhereItIsWorthwhile) {
  const auto guide = learning(4000, 3).learned();
  ASSERT_TRUE(guide);
  // From places between those that were learned from.
  for (const float x : {1.23f, 4.56f, 8.91f}) {
    const Vec3f position(x, 2.5f, 0);
    const ScatterGuide::Place place = guide->place(position, 4);
    const Vec3f to_window = normalize(Vec3f(12, 4.5f, 1.5f) - position);
    const float plain = cosine_hemisphere_pdf(to_window.z);
    EXPECT_GT(place.pdf(plain, to_window), 3 * plain) << x;
    // Whatever was not seen keeps most of its chance.
    const Vec3f away = normalize(Vec3f(-1, 0, 0.2f));
    EXPECT_GE(place.pdf(1, away), 0.69f) << x;
  }
}

TEST(ScatterLearning, KnowsWhereThereIsNothingToLearn) {
  EXPECT_FALSE(learning(4000, 0.01).learned());
  EXPECT_FALSE(ScatterLearning().learned());
  // Too few, whatever they say.
  EXPECT_FALSE(learning(40, 100).learned());
}

/// Events in one point, to one point, or without use: nothing to divide.
TEST(ScatterLearning, OddEvents) {
  ScatterLearning same;
  for (int i = 0; i < 1000; ++i) same.add(event({1, 2, 0}, {3, 2, 4}, i), 1, 1);
  same.add(event({1, 2, 0}, {3, 2, 4}), 0, 1);
  same.add(event({1, 2, 0}, {3, 2, 4}), double(infinity), 1);
  EXPECT_EQ(same.size(), 1000u);
  const auto guide = same.learned();
  ASSERT_TRUE(guide);
  const ScatterGuide::Place place = guide->place({1, 2, 0}, 4);
  const Vec3f direction = normalize(Vec3f(2, 0, 4));
  EXPECT_TRUE(std::isfinite(place.pdf(1, direction)));
  EXPECT_GE(place.pdf(1, direction), 1);
  const Vec3f sample = place.sample(0, {0.3f, 0.6f});
  EXPECT_NEAR(dot(sample, direction), 1, 1e-4);
}

}  // namespace
}  // namespace kaustik
