#include "kaustik/photon/scene_fingerprint.h"

#include <gtest/gtest.h>

#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using namespace test;

TEST(SceneFingerprint, TellsScenesApartButNotViews) {
  const auto described = [](std::vector<ObjectPointer> objects) {
    return fingerprint_of(*make_scene(objects));
  };
  const auto floor = placed("rectangle", Transform::scale(Vec3d(3, 3, 1)), black());
  const SceneFingerprint one = described({light("point"), floor});
  EXPECT_TRUE(one.matches(described({light("point"), floor})));
  EXPECT_FALSE(one.matches(described({light("spot"), floor})));
  EXPECT_FALSE(
      one.matches(described({light("point"), floor, sphere(Vec3d(0, 0, 1), 0.1, mirror_bsdf())})));
  for (const Vec3d& size : {Vec3d(3, 2, 1), Vec3d(3, 2.999, 1)})
    EXPECT_FALSE(one.matches(
        described({light("point"), placed("rectangle", Transform::scale(size), black())})));
  EXPECT_FALSE(
      one.matches(described({light("point"), placed("rectangle", Transform::scale(Vec3d(3, 3, 1)),
                                                    object("bsdf", "diffuse"))})));
  const auto with_ball = [&](double radius) {
    return described({light("point"), floor, sphere(Vec3d(0, 0, 0), radius, mirror_bsdf())});
  };
  EXPECT_FALSE(with_ball(0.5).matches(with_ball(0.6)));  // the bounds are the floor's
  EXPECT_TRUE(with_ball(0.5).matches(with_ball(0.5)));

  const auto seen_from = [&](double x) {
    const auto root = object("scene", "", {}, {light("point"), floor});
    root->children.push_back({"", object("sensor", "perspective",
                                         {{"to_world", Transform::translate(Vec3d(x, 0, 0))}})});
    return fingerprint_of(*build_scene({root}));
  };
  EXPECT_TRUE(seen_from(1).matches(seen_from(2)));
}

// Programs from different compilers agree but for the last bits, of which nothing else is left
// where coordinates should be zero.
TEST(SceneFingerprint, LastBitsMakeNoDifference) {
  const auto turned = [](double degrees, double size) {
    const auto upright =
        Transform::rotate(Vec3d(1, 0, 0), degrees) * Transform::scale(Vec3d(size, size, 1));
    return fingerprint_of(*make_scene({light("spot"), placed("rectangle", upright, mirror_bsdf()),
                                       sphere(Vec3d(0, 0, 0), 0.3 * size, black())}));
  };
  for (const double degrees : {90.0, 180.0, 33.0}) {
    const SceneFingerprint exact = turned(degrees, 3);
    for (const double last_bits : {-1e-7, 1e-7, 2e-7})
      EXPECT_TRUE(turned(degrees * (1 + last_bits), 3 * (1 - last_bits)).matches(exact)) << degrees;
    EXPECT_FALSE(turned(degrees + 0.5, 3).matches(exact));
    EXPECT_FALSE(turned(degrees, 3.01).matches(exact));
  }
}

// Where there are many numbers, one of them lies next to any bound that could be drawn.
TEST(SceneFingerprint, OfManyShapes) {
  const auto balls = [](double last_bits, double of_one) {
    std::vector<ObjectPointer> objects = {light("point")};
    for (int i = 0; i < 2000; ++i) {
      const double x = i % 50, y = i / 50, radius = 0.1 + 0.3 * ((i * 7919) % 1000) / 1000.0;
      objects.push_back(sphere(Vec3d(x, y, 0) * (1 + last_bits * ((i * 31) % 17 - 8) / 8.0),
                               i == 777 ? radius * of_one : radius, mirror_bsdf()));
    }
    return fingerprint_of(*make_scene(objects));
  };
  const SceneFingerprint exact = balls(0, 1);
  for (const double last_bits : {1e-7, -2e-7})
    EXPECT_TRUE(balls(last_bits, 1).matches(exact)) << last_bits;
  EXPECT_FALSE(balls(0, 2).matches(exact));
}

// Metal seen from behind sends light nowhere, and nothing else may be told of where.
TEST(SceneFingerprint, AbsorbedLightHasNoDirection) {
  const auto metal = object("bsdf", "roughconductor", {{"alpha", 0.2}});
  const auto described = [&] {
    return fingerprint_of(
        *make_scene({light("spot"), placed("rectangle", Transform::scale(Vec3d(3, 3, 1)), metal)}));
  };
  const SceneFingerprint first = described();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(described().sums, first.sums);
}

}  // namespace
}  // namespace kaustik
