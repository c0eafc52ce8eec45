// What gather rays look up: the irradiance of even light on a plane is known.

#include "kaustik/vcm/gathering/scattered_light.h"

#include <gtest/gtest.h>

#include <random>

#include "kaustik/base/statistics.h"

namespace kaustik {
namespace {

const Vec3f up(0, 0, 1);
/// What arrives everywhere on the upper side of the unit square, W/m².
constexpr float scattered_irradiance = 3;

/// A vertex of each path: light that was scattered before, evenly over the unit square; and
/// `focused` more of each, of light that was not. With a wall beside the square that has as much of
/// it, if asked.
LightVertices even_light(uint32_t paths, uint32_t focused = 0, bool with_wall = false) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(0, 1);
  LightVertices light;
  light.path_count = paths;
  std::vector<Vec3f> positions;
  std::vector<LightVertexData> data;
  const auto add = [&](uint32_t path, bool specular, bool on_wall) {
    LightVertexData vertex;
    vertex.side = CoarseNormal(on_wall ? Vec3f(1, 0, 0) : up);
    vertex.direction = PackedDirection(up);
    vertex.flux = Spectrum(scattered_irradiance);
    vertex.specular = specular;
    vertex.before = 2;
    vertex.path = 3 * path;
    const float a = unit(random), b = unit(random);
    positions.push_back(on_wall ? Vec3f(0, a, b) : Vec3f(a, b, 0));
    data.push_back(vertex);
  };
  for (uint32_t path = 0; path < paths; ++path) {
    add(path, false, false);
    for (uint32_t i = 0; i < focused; ++i) add(path, true, false);
    if (with_wall) add(path, false, true);
  }
  light.tree = {std::move(positions), std::move(data)};
  return light;
}

/// Of what is looked up within so far from the border, from so far away.
struct Lookups {
  RunningStatistics irradiance;
  int asked = 0;
};
Lookups look_up(const ScatteredLight& scattered, float from, float to, float distance) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(0, 1);
  Scratch scratch;
  Lookups result;
  while (result.asked < 4000) {
    const Vec3f at(unit(random), unit(random), 0);
    const float border = std::min(std::min(at.x, 1 - at.x), std::min(at.y, 1 - at.y));
    if (border < from || border > to) continue;
    ++result.asked;
    Spectrum irradiance;
    if (scattered.lookup(at, up, distance, scratch, irradiance))
      result.irradiance.add(double(irradiance[0]));
  }
  return result;
}

/// Whatever the disks hold: which places are asked must not depend on how bright they are.
TEST(ScatteredLight, IsThatOfEvenLight) {
  for (const uint32_t focused : {0u, 1u})
    for (const float shrinkage : {1.0f, 0.4f, 0.1f}) {
      const ScatteredLight scattered(even_light(50'000, focused), shrinkage);
      const Lookups inside = look_up(scattered, 0.06f, 1, 10);
      EXPECT_GT(inside.irradiance.count(), 0.4 * inside.asked) << shrinkage;
      // Four times the noise of the vertices that tell it, at least 37 000.
      EXPECT_NEAR(inside.irradiance.mean(), scattered_irradiance, 0.02 * scattered_irradiance)
          << shrinkage << " " << focused;
    }
}

/// Where disks reach beyond the surface there is too little light in them: most are not asked.
TEST(ScatteredLight, IsNotTooDarkAtTheBorder) {
  const ScatteredLight scattered(even_light(60'000), 1);
  const Lookups border = look_up(scattered, 0, 0.003f, 10);
  EXPECT_LT(border.irradiance.count(), 0.5 * border.asked);
  EXPECT_GT(border.irradiance.count(), 50u);
  EXPECT_NEAR(border.irradiance.mean(), scattered_irradiance, 0.2 * scattered_irradiance);
}

/// A wall tells that the floor ends there.
TEST(ScatteredLight, IsNotAskedBesideAWall) {
  const ScatteredLight scattered(even_light(60'000, 0, true), 1);
  Scratch scratch;
  Spectrum irradiance;
  int beside = 0, inside = 0;
  for (int i = 0; i < 200; ++i) {
    const float y = 0.1f + 0.004f * float(i);
    beside += scattered.lookup({0.002f, y, 0}, up, 10, scratch, irradiance) ? 1 : 0;
    inside += scattered.lookup({0.5f, y, 0}, up, 10, scratch, irradiance) ? 1 : 0;
  }
  EXPECT_LT(beside, 10);
  EXPECT_GT(inside, 120);
}

/// So the light that disks blur is asked for less and less.
TEST(ScatteredLight, IsAskedFromFartherOffAsDisksShrink) {
  const LightVertices light = even_light(50'000);
  const auto asked = [&](float shrinkage) {
    return look_up(ScatteredLight(light, shrinkage), 0.06f, 1, 0.1f).irradiance.count();
  };
  EXPECT_GT(asked(1), 1000);
  EXPECT_EQ(asked(0.1f), 0);
}

TEST(ScatteredLight, IsNotKnownFromNearbyFromBehindOrElsewhere) {
  const ScatteredLight scattered(even_light(10'000), 1);
  Scratch scratch;
  Spectrum irradiance;
  const Vec3f middle(0.5f, 0.5f, 0);
  ASSERT_TRUE(scattered.lookup(middle, up, 10, scratch, irradiance));
  EXPECT_FALSE(scattered.lookup(middle, up, 0.01f, scratch, irradiance));
  EXPECT_FALSE(scattered.lookup(middle, -up, 10, scratch, irradiance));
  EXPECT_FALSE(scattered.lookup(middle, normalize(Vec3f(1, 0, 0.2f)), 10, scratch, irradiance));
  EXPECT_FALSE(scattered.lookup({0.5f, 0.5f, 0.1f}, up, 10, scratch, irradiance));
  EXPECT_FALSE(scattered.lookup({2, 2, 0}, up, 10, scratch, irradiance));
}

TEST(ScatteredLight, IsEmptyWithoutLightAndOnceStopped) {
  EXPECT_TRUE(ScatteredLight(LightVertices(), 1).empty());
  EXPECT_TRUE(ScatteredLight(even_light(1), 1).empty());
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(ScatteredLight(even_light(1000), 1, stop.get_token()).empty());
}

}  // namespace
}  // namespace kaustik
