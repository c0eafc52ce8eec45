// The straight edges that a surface's disks of merging end at: walls, ends, corners, bodies on the
// floor, and what is none.

#include "kaustik/photon/coverage/surface_edges.h"

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

const std::string grey = diffuse("0.5, 0.5, 0.5");
const std::string floor_ = flat("rectangle", scale("5, 5, 1"), grey);

/// Seen from above, around (x, y, 0).
class Seen {
 public:
  explicit Seen(const std::string& inside, float x = 0, float y = 0, float reach = 0.5f)
      : scene_(camera("0, 0, 9", "0, 0, 0", 30, 4, "0, 1, 0") + inside), reach_(reach) {
    vertex_ = vertex_at(x, y);
    edges_ = SurfaceEdges(scene_.scene(), vertex_, reach, rays_);
    around_ = edges_.around(vertex_.position(), reach);
  }
  SurfaceVertex vertex_at(float x, float y) const {
    const Ray ray{{x, y, 3}, {0, 0, -1}, infinity};
    Hit hit;
    EXPECT_TRUE(scene_.scene().intersect(ray, hit));
    SurfaceVertex vertex;
    vertex.meet(scene_.scene(), ray, hit, TransportMode::radiance);
    return vertex;
  }
  const SurfaceEdges& edges() const { return edges_; }
  const DiskEdges& around() const { return around_; }
  /// The widest disk around (x, y, 0) that is clear, to a thousandth of its reach.
  float clear() const {
    float radius = 0;
    while (radius < reach_ && edges_.are_clear(vertex_.position(), radius + 0.001f * reach_))
      radius += 0.001f * reach_;
    return radius;
  }
  bool is_complete() const { return edges_.are_complete(vertex_.position(), reach_); }
  /// That there is an edge there, on the side of (x, y).
  void expect_edge(double x, double y, double distance) const {
    for (size_t i = 0; i < around_.count; ++i)
      if (std::fabs(double(around_.edges[i].inward.x) + x) < 0.02 &&
          std::fabs(double(around_.edges[i].inward.y) + y) < 0.02 &&
          std::fabs(double(around_.edges[i].distance) - distance) < 0.004)
        return;
    std::string found;
    for (size_t i = 0; i < around_.count; ++i)
      found += fmt::format(" ({:.3f}, {:.3f}) at {:.3f}", -around_.edges[i].inward.x,
                           -around_.edges[i].inward.y, around_.edges[i].distance);
    ADD_FAILURE() << "no edge toward " << x << ", " << y << " at " << distance << ", but" << found;
  }

 private:
  TestScene scene_;
  float reach_;
  SurfaceVertex vertex_;
  uint64_t rays_ = 0;
  SurfaceEdges edges_;
  DiskEdges around_;
};

TEST(SurfaceEdges, OfNothingNearby) {
  const Seen seen(floor_);
  EXPECT_EQ(seen.around().count, 0u);
  EXPECT_TRUE(seen.is_complete());
  // Of what lies beyond its reach it knows nothing.
  EXPECT_FALSE(seen.edges().are_complete({0.1f, 0, 0}, 0.5f));
}

TEST(SurfaceEdges, WallsAndCorners) {
  const std::string wall = flat("rectangle", rotate("0, 1, 0", -90) + translate("0.2, 0, 1"), grey);
  const Seen one(floor_ + wall);
  EXPECT_EQ(one.around().count, 1u);
  one.expect_edge(1, 0, 0.2);
  const Seen two(floor_ + wall +
                 flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 0.3, 1"), grey));
  EXPECT_EQ(two.around().count, 2u);
  two.expect_edge(1, 0, 0.2);
  two.expect_edge(0, 1, 0.3);
  EXPECT_TRUE(two.is_complete());
}

TEST(SurfaceEdges, EndsOfTheSurface) {
  const std::string table =
      flat("rectangle", scale("0.6, 0.6, 1") + rotate("0, 0, 1", 30) + translate("0, 0, 1"), grey);
  const Seen seen(floor_ + table, 0.4f * 0.8660254f, 0.4f * 0.5f);
  EXPECT_EQ(seen.around().count, 1u);
  seen.expect_edge(std::cos(pi / 6), std::sin(pi / 6), 0.2);
  // Light below the table is none of its business, and its edges none of the floor's.
  EXPECT_FALSE(seen.edges().hold_at(seen.vertex_at(2, 0)));
  EXPECT_TRUE(seen.edges().hold_at(seen.vertex_at(0, 0)));
}

TEST(SurfaceEdges, BodiesOnTheFloor) {
  const std::string box = flat("cube", scale("0.5, 0.5, 0.2") + translate("0.8, 0, 0.2"), grey);
  const Seen beside(floor_ + box);
  EXPECT_EQ(beside.around().count, 1u);
  beside.expect_edge(1, 0, 0.3);
  // Behind the line the floor goes on, but not within sight.
  EXPECT_FALSE(beside.edges().hold_at(beside.vertex_at(2, 0)));
  const Seen on_top(floor_ + box, 0.5f, 0, 0.7f);
  on_top.expect_edge(-1, 0, 0.2);
  on_top.expect_edge(0, 1, 0.5);
  on_top.expect_edge(0, -1, 0.5);
}

/// Light that passes under a door lies in a line: disks that reach under it would blur that. What
/// hangs higher shades more softly.
TEST(SurfaceEdges, BodiesThatHangLow) {
  const auto door = [](double slit) {
    return flat("cube", scale("0.02, 1, 1") + translate(fmt::format("0.2, 0, {}", 1 + slit)), grey);
  };
  const Seen low(floor_ + door(0.02));
  EXPECT_EQ(low.around().count, 1u);
  low.expect_edge(1, 0, 0.18);
  EXPECT_TRUE(low.is_complete());
  EXPECT_EQ(Seen(floor_ + door(0.2)).around().count, 0u);
  // What lies on the floor has been met below, and what is round ends no light there.
  for (const double radius : {0.05, 0.075, 0.25, 0.5})
    EXPECT_EQ(Seen(floor_ + sphere(fmt::format("0.3, 0, {}", radius), radius, grey)).around().count,
              0u)
        << radius;
}

/// What bends by and by is no edge: disks there are looked at point by point.
TEST(SurfaceEdges, CurvesAreNone) {
  const Seen ball(sphere("0, 0, -2", 2, grey));
  EXPECT_EQ(ball.around().count, 0u);
  EXPECT_FALSE(ball.is_complete());
}

/// Nothing hides points of a clear disk from one another: what stands on the floor or hangs low
/// over it ends it, whether rays meet it or not, but not what lies behind edges, below, or high.
TEST(SurfaceEdges, ClearDisks) {
  const auto clear = [](const std::string& inside) { return Seen(floor_ + inside).clear(); };
  EXPECT_NEAR(clear(""), 0.5, 0.002);
  const std::string wall = flat("rectangle", rotate("0, 1, 0", -90) + translate("0.2, 0, 1"), grey);
  EXPECT_NEAR(clear(wall), 0.5, 0.002);
  // Between the rays that look for edges.
  const auto post = [](double angle, double bottom) {
    return flat("cube",
                scale("0.001, 0.001, 0.5") + translate(fmt::format("0.3, 0, {}", bottom + 0.5)) +
                    rotate("0, 0, 1", angle),
                grey);
  };
  EXPECT_NEAR(clear(post(10, 0)), 0.299, 0.002);
  EXPECT_NEAR(clear(post(10, 0.2)), 0.299, 0.002);
  EXPECT_NEAR(clear(post(10, 0.3)), 0.5, 0.002);
  EXPECT_NEAR(clear(post(10, -1.1)), 0.5, 0.002);
  EXPECT_NEAR(clear(wall + post(10, 0)), 0.5, 0.002);  // behind the wall
  EXPECT_NEAR(clear(wall + post(100, 0)), 0.299, 0.002);
  // Of round bodies the box.
  EXPECT_GT(clear(sphere("0.5, 0, 0.2", 0.2, grey)), 0.15);
  EXPECT_LT(clear(sphere("0.5, 0, 0.2", 0.2, grey)), 0.301);
}

/// The clear disk around a vertex beside the probe: less by the distance, cut by the same edges.
TEST(SurfaceEdges, ClearDisksAround) {
  const Seen seen(floor_ +
                  flat("rectangle", rotate("0, 1, 0", -90) + translate("0.2, 0, 1"), grey));
  const ClearDisk disk = seen.edges().clear_disk({-0.1f, 0, 0});
  EXPECT_NEAR(disk.radius, 0.4, 0.002);
  EXPECT_EQ(disk.normal, Vec3f(0, 0, 1));
  ASSERT_EQ(disk.edges.count, 1u);
  EXPECT_NEAR(disk.edges.edges[0].distance, 0.3, 0.002);
  EXPECT_TRUE(disk.holds({0.25f, 0, 0}));
  EXPECT_FALSE(disk.holds({0.35f, 0, 0})) << "behind the wall";
  EXPECT_FALSE(disk.holds({-0.45f, 0, 0})) << "not looked at";
  EXPECT_FALSE(disk.holds({0.1f, 0, 0.01f})) << "on something else";
  EXPECT_EQ(seen.edges().clear_disk({-0.6f, 0, 0}).radius, 0);
  EXPECT_TRUE(seen.edges().is_whole({-0.1f, 0, 0}, 0.25f));
  EXPECT_FALSE(seen.edges().is_whole({-0.1f, 0, 0}, 0.35f)) << "at the wall";
  EXPECT_FALSE(seen.edges().is_whole({-0.3f, 0, 0}, 0.25f)) << "not looked at";
}

/// A mirror in the floor keeps no light.
TEST(SurfaceEdges, WhereNothingMerges) {
  const Seen seen(flat("rectangle", scale("2, 5, 1") + translate("-1.9, 0, 0"), grey) +
                  flat("rectangle", scale("2, 5, 1") + translate("2.1, 0, 0"), mirror()));
  EXPECT_EQ(seen.around().count, 1u);
  seen.expect_edge(1, 0, 0.1);
}

/// Light on the other side of glass that stands on the floor has come another way, as behind the
/// surface of water along a wall.
TEST(SurfaceEdges, WhatRefracts) {
  const Seen wall(floor_ + flat("rectangle", rotate("0, 1, 0", -90) + translate("0.2, 0, 1"),
                                "<bsdf type=\"dielectric\"/>"));
  EXPECT_EQ(wall.around().count, 1u);
  wall.expect_edge(1, 0, 0.2);
  EXPECT_TRUE(wall.is_complete());
  // Around where a ball touches the floor it is all air.
  const Seen ball(floor_ + sphere("0.45, 0, 0.4", 0.4, glass()));
  EXPECT_EQ(ball.around().count, 0u);
  EXPECT_TRUE(ball.is_complete());
}

}  // namespace
}  // namespace kaustik
