#include "kaustik/transport/null_boundaries.h"

#include <gtest/gtest.h>

#include "kaustik/base/sampler.h"
#include "kaustik/base/warp.h"
#include "kaustik/transport/visibility.h"
#include "tests/support/scene_text.h"
#include "tests/transport/scene_of.h"

namespace kaustik {
namespace {

using namespace test;

const std::string passed_bsdf = R"(<bsdf type="null"/>)";
const std::string fog =
    R"(<medium type="homogeneous" name="interior"><float name="sigma_t" value="1e-9"/></medium>)";

/// Shadow rays to where boundaries meet, at the origin, whose coordinates have no rounding: nearer
/// to it the next float is nearer still.
TEST(NullBoundaries, RaysEndWhereTheyMeet) {
  const auto scene =
      scene_of(flat("rectangle", "", passed_bsdf + fog) +
               flat("disk", rotate("-0.65, 0.62, -0.31", -104) + rotate("0.83, 0, 0.78", 172),
                    passed_bsdf + fog) +
               flat("disk", rotate("0.3, -0.5, 0.2", 50), passed_bsdf) + point_light("0, 0, 0", 1));
  Sampler sampler = Sampler::at(1, 0, Stream::camera, 0, 0);
  uint64_t rays = 0;
  constexpr int count = 20'000;
  for (int i = 0; i < count; ++i) {
    const Vec3f from = square_to_sphere(sampler.next_2d()) * 0.7f;
    EXPECT_TRUE(is_unobstructed(*scene, {from, -from, 1}, rays)) << from;
    EXPECT_NEAR(transmittance_on_way(*scene, {from, -from, 1}, nullptr, {{}, sampler}, rays)[0], 1,
                1e-6);
  }
  EXPECT_LT(rays, uint64_t(20 * count));
}

/// A stack of more boundaries than anybody has is passed.
TEST(NullBoundaries, ManyInARowAreFollowed) {
  std::string stack;
  for (int i = 0; i < 300; ++i)
    stack += flat("rectangle", translate(fmt::format("0, 0, {}", 0.01 * i)), passed_bsdf + fog);
  const auto scene = scene_of(stack + point_light("0, 0, -1", 1));
  uint64_t rays = 0;
  EXPECT_TRUE(is_unobstructed(*scene, {{0.1f, 0.2f, 4}, {0, 0, -5}, 1}, rays));
  EXPECT_EQ(rays, 301u);
}

}  // namespace
}  // namespace kaustik
