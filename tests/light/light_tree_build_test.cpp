// Cones of emission, and the shape of the tree.

#include "kaustik/light/light_tree_build.h"

#include <gtest/gtest.h>

#include "kaustik/base/warp.h"
#include "tests/light/light_testing.h"

namespace kaustik {
namespace {

using namespace kaustik::testing;

TEST(EmissionCone, MeasuresInClosedForm) {
  const double p = std::numbers::pi;
  EXPECT_NEAR(orientation_measure({{0, 0, 1}, 0, p / 2}), p, 1e-12);  // ∫ cosθ over a hemisphere
  EXPECT_NEAR(orientation_measure({{0, 0, 1}, p, 0}), 4 * p, 1e-12);  // the sphere
  EXPECT_NEAR(orientation_measure({{0, 0, 1}, 0.3, 0}), 2 * p * (1 - std::cos(0.3)), 1e-12);
}

TEST(EmissionCone, UnionHoldsBoth) {
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    EmissionCone parts[2];
    for (EmissionCone& part : parts)
      part = {square_to_sphere(random.next_2d()), 2.0 * random.next(), 1.5 * random.next()};
    const EmissionCone both = united(parts[0], parts[1]);
    EXPECT_NEAR(length(both.axis), 1, 1e-5);
    for (const EmissionCone& part : parts) {
      EXPECT_GE(both.falloff, part.falloff);
      const double rim = std::acos(std::clamp(double(dot(both.axis, part.axis)), -1.0, 1.0));
      EXPECT_GE(both.spread, std::min(rim + part.spread, std::numbers::pi) - 2e-3);
    }
    EXPECT_LE(both.spread, std::numbers::pi);
  }
}

TEST(EmissionCone, OppositeDirectionsFillTheSphere) {
  const EmissionCone both = united({{0, 0, 1}, 0.1, 0}, {{0, 0, -1}, 0.1, 0});
  EXPECT_EQ(both.spread, std::numbers::pi);
}

LightTree::Item item_at(int light, const Vec3f& position) {
  LightTree::Item item{light, {}, 1};
  item.bounds.position.extendBy(position);
  return item;
}

TEST(LightTreeBuild, LeadsToEveryLightHoweverTheyAreSpread) {
  std::vector<LightTree::Item> items;
  // Each light twice as far as the one before: splitting by place alone takes one off at a time.
  for (int i = 0; i < 200; ++i) items.push_back(item_at(i, {std::exp2(float(i % 100)), 0, 0}));
  const LightTreeBuild build(items);
  const auto& nodes = build.nodes();
  EXPECT_EQ(nodes.size(), 2 * items.size() - 1);
  std::vector<int> found(items.size(), 0);
  std::vector<int> parents(nodes.size(), 0);
  for (const auto& node : nodes) {
    ASSERT_LE(node.depth, LightTree::whole_depth);
    if (node.light >= 0) {
      ++found[size_t(node.light)];
      EXPECT_EQ(node.lights, 1);
      continue;
    }
    for (const int child : {node.left, node.left + 1}) {
      ++parents[size_t(child)];
      EXPECT_EQ(nodes[size_t(child)].depth, node.depth + 1);
    }
    EXPECT_EQ(node.lights, nodes[size_t(node.left)].lights + nodes[size_t(node.left) + 1].lights);
  }
  EXPECT_EQ(nodes.front().lights, 200);
  parents.front() = 1;
  EXPECT_EQ(parents, std::vector<int>(nodes.size(), 1));
  EXPECT_EQ(found, std::vector<int>(items.size(), 1));
  EXPECT_NEAR(nodes.front().intensity, 200 / (4 * std::numbers::pi), 1e-9);
}

}  // namespace
}  // namespace kaustik
