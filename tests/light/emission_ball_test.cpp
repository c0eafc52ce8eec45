// Many balls at once against one by one, and one against the light that it bounds.

#include "kaustik/light/emission_ball.h"

#include <gtest/gtest.h>

#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

EmissionBall random_ball(Random& random) {
  EmissionBall ball;
  ball.center = random.next_3d() * 4.0f;
  ball.radius = random.next() < 0.2f ? 0.0f : random.next();
  ball.axis = normalize(random.next_3d() - Vec3f(0.5f));
  const float spread = pi * random.next(), falloff = 0.5f * pi * random.next();
  ball.cos_spread = std::cos(spread);
  ball.sin_spread = std::sin(spread);
  ball.cos_falloff = std::cos(falloff);
  if (random.next() < 0.3f) ball.ramp = 1 / std::sin(falloff);
  ball.intensity = std::exp(6 * random.next() - 3);
  return ball;
}

TEST(EmissionBalls, tell_of_each_what_it_tells_alone) {
  Random random(1);
  size_t positive = 0;
  for (size_t count = 1; count <= 17; ++count) {
    std::vector<EmissionBall> each;
    for (size_t i = 0; i < count; ++i) each.push_back(random_ball(random));
    EmissionBalls balls;
    (void)balls.add({each.data(), count / 2});
    const EmissionBalls::Block block = balls.add(each);
    ASSERT_EQ(block.count, count);
    EXPECT_EQ(balls.intensities(block)[count - 1], each.back().intensity);
    for (int query = 0; query < 50; ++query) {
      // Now and then at a centre, and without a normal, as in a medium.
      const Vec3f at =
          query % 5 == 0 ? each[size_t(query) % count].center : random.next_3d() * 4.0f;
      const Vec3f normal = query % 3 == 0 ? Vec3f(0.0f) : normalize(random.next_3d() - Vec3f(0.5f));
      std::vector<float> together(EmissionBalls::padded(count), -1.0f);
      balls.irradiance(block, at, normal, together.data());
      for (size_t i = count; i < together.size(); ++i) EXPECT_EQ(together[i], 0);
      for (size_t i = 0; i < count; ++i) {
        const float alone = each[i].irradiance(at, normal);
        positive += alone > 0;
        EXPECT_NEAR(together[i], alone, 1e-5f * alone) << count << " " << query << " " << i;
      }
    }
  }
  EXPECT_GT(positive, 1000u);
}

// A Lambertian sphere, which shines in all directions: no point gets more than the bound, and far
// away that is near to what arrives.
TEST(EmissionBall, is_no_less_than_what_arrives) {
  EmissionBall ball;
  ball.radius = 0.5f;
  ball.intensity = 3;
  for (const float distance : {0.6f, 1.0f, 4.0f, 50.0f}) {
    const double arrives = 3.0 / sqr(double(distance));
    const double bound = ball.irradiance({distance, 0, 0}, {-1, 0, 0});
    EXPECT_GE(bound, arrives * (1 - 1e-5)) << distance;
    if (distance > 10) {
      EXPECT_NEAR(bound, arrives, 0.03 * arrives);
    }
  }
  // Behind the surface there is nothing.
  EXPECT_EQ(ball.irradiance({4, 0, 0}, {1, 0, 0}), 0);
}

}  // namespace
}  // namespace kaustik
