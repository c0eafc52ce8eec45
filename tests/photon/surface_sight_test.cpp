#include "kaustik/photon/coverage/surface_sight.h"

#include <gtest/gtest.h>

#include "tests/photon/emission_scenes.h"

namespace kaustik {
namespace {

using namespace test;

/// A floor at z = 0 with `bodies` on it.
class Floor {
 public:
  explicit Floor(std::vector<ObjectPointer> bodies) {
    bodies.push_back(placed("rectangle", Transform::scale(Vec3d(10, 10, 1)), black()));
    bodies.push_back(light("point"));
    scene_ = make_scene(bodies);
  }
  bool sees(const Vec3f& from, const Vec3f& to, const Vec3f& normal = {0, 0, 1},
            const Vec3f& other_normal = {0, 0, 1}) {
    const SurfaceSight there(*scene_, from, SurfaceSight::no_shape, rays_);
    const SurfaceSight back(*scene_, to, SurfaceSight::no_shape, rays_);
    const bool result = there.sees(normal, to, other_normal);
    EXPECT_EQ(back.sees(other_normal, from, normal), result);
    return result;
  }

 private:
  std::shared_ptr<const Scene> scene_;
  uint64_t rays_ = 0;
};

ObjectPointer box(const Vec3d& center, const Vec3d& half, const ObjectPointer& bsdf = black()) {
  return placed("cube", Transform::translate(center) * Transform::scale(half), bsdf);
}

TEST(SurfaceSight, WallsHide) {
  Floor open({}), walled({box(Vec3d(0, 0, 1), Vec3d(0.005, 2, 1))});
  for (const float distance : {0.02f, 0.3f, 2.0f}) {
    EXPECT_TRUE(open.sees({-distance, 0, 0}, {distance, 0.1f, 0})) << distance;
    EXPECT_FALSE(walled.sees({-distance, 0, 0}, {distance, 0.1f, 0})) << distance;
    EXPECT_TRUE(walled.sees({-distance, 0, 0}, {-2 * distance, 0.1f, 0})) << distance;
    EXPECT_TRUE(walled.sees({-distance, 3, 0}, {distance, 3, 0})) << distance;  // past its end
  }
}

/// A board close above the floor hides what lies on it, not what lies below.
TEST(SurfaceSight, LowBoards) {
  Floor floor({box(Vec3d(0, 0, 0.04), Vec3d(0.5, 2, 0.01))});
  EXPECT_TRUE(floor.sees({-0.4f, 0, 0}, {0.4f, 0, 0}));
  EXPECT_TRUE(floor.sees({-0.7f, 0, 0}, {0.4f, 0, 0}));
  EXPECT_FALSE(floor.sees({0.1f, 0, 0}, {0.1f, 0, 0.05f}));
}

/// A ball is in its own way, and not for what lies near.
TEST(SurfaceSight, RoundBodies) {
  Floor floor({sphere(Vec3d(0, 0, 5), 1, black())});
  const auto at = [](float angle) { return Vec3f(std::sin(angle), 0, std::cos(angle)); };
  const Vec3f center(0, 0, 5);
  for (const float angle : {0.01f, 0.1f, 0.5f})
    EXPECT_TRUE(floor.sees(center + at(0), center + at(angle), at(0), at(angle))) << angle;
  EXPECT_FALSE(floor.sees(center + at(0), center + at(3), at(0), at(3)));
}

/// Where it is known to be clear nobody looks; beyond that, and on the other side, somebody does.
TEST(SurfaceSight, LooksOnlyWhereItIsNotKnown) {
  const auto scene = make_scene({box(Vec3d(0.5, 0, 0), Vec3d(0.005, 2, 2)), light("point")});
  ClearDisk clear;
  clear.normal = {0, 0, 1};
  clear.radius = 0.4f;
  clear.flatness = 0.01f;
  clear.edges.count = 1;
  clear.edges.edges[0] = {{0, 1, 0}, 0.2f};
  const auto rays_to = [&](const Vec3f& other, float side) {
    uint64_t rays = 0;
    const SurfaceSight sight(*scene, {0, 0, 0}, SurfaceSight::no_shape, rays, clear);
    EXPECT_TRUE(sight.sees({0, 0, side}, other, {0, 0, side}));
    return rays;
  };
  EXPECT_EQ(rays_to({0.3f, 0.2f, 0.005f}, 1), 0u);
  EXPECT_EQ(rays_to({0.3f, -0.1f, 0}, 1), 0u);
  EXPECT_GT(rays_to({0.3f, -0.3f, 0}, 1), 0u) << "beyond the edge";
  EXPECT_GT(rays_to({-0.45f, 0, 0}, 1), 0u) << "beyond the radius";
  EXPECT_GT(rays_to({0.3f, 0, 0.02f}, 1), 0u) << "out of the plane";
  EXPECT_GT(rays_to({0.3f, 0, 0}, -1), 0u) << "below";
}

TEST(SurfaceSight, WhatLightPassesThroughHidesNothing) {
  const auto glass = object("bsdf", "dielectric");
  Floor panes({box(Vec3d(0, 0, 1), Vec3d(0.005, 2, 1), glass),
               box(Vec3d(0.1, 0, 1), Vec3d(0.005, 2, 1), glass)});
  EXPECT_TRUE(panes.sees({-0.2f, 0, 0}, {0.3f, 0.1f, 0}));
  Floor both(
      {box(Vec3d(0, 0, 1), Vec3d(0.005, 2, 1), glass), box(Vec3d(0.1, 0, 1), Vec3d(0.005, 2, 1))});
  EXPECT_FALSE(both.sees({-0.2f, 0, 0}, {0.3f, 0.1f, 0}));
}

}  // namespace
}  // namespace kaustik
