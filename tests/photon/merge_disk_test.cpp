// How much of a disk of merging is covered: disks that a straight line, a corner, a gap cut, beside
// other surfaces and below them, against their known shares.

#include "kaustik/photon/coverage/merge_disk.h"

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

constexpr float radius = 0.5f;
constexpr int samples = slow_build ? 2'000 : 20'000;

std::string rectangle(const std::string& transform,
                      const std::string& bsdf = diffuse("0.5, 0.5, 0.5")) {
  return flat("rectangle", transform, bsdf);
}
std::string turned(const std::string& transform) { return rotate("1, 0, 0", 180) + transform; }

/// The share, by the weights of the kernel, of a disk around the origin that a straight line at
/// this distance cuts off on the far side: ∫ over x > d of 2/π (1 − x² − y²).
double share_beyond(double distance) {
  const double d = distance / double(radius);
  constexpr int n = 20'000;
  double sum = 0;
  for (int i = 0; i < n; ++i) {
    const double x = d + (1 - d) * (i + 0.5) / n;
    sum += 4.0 / 3 * std::pow(1 - x * x, 1.5) * (1 - d) / n;
  }
  return 2 / std::numbers::pi * sum;
}

/// What lies around the origin, which is seen from above.
class Disk {
 public:
  explicit Disk(const std::string& inside, double from = 5)
      : scene_(camera("0, 0, 9", "0, 0, 0", 30, 4, "0, 1, 0") + inside) {
    const Ray ray{{0, 0, float(from)}, {0, 0, -1}, infinity};
    Hit hit;
    EXPECT_TRUE(scene_.scene().intersect(ray, hit));
    vertex_.meet(scene_.scene(), ray, hit, TransportMode::radiance);
    EXPECT_NEAR(vertex_.position().z, 0, 1e-6);
  }

  /// Share of points, by the kernel, that hold; and the mean estimate of one over it.
  void expect_share(const std::string& what, double expected) const {
    uint64_t rays = 0;
    const DiskCoverage coverage(scene_.scene(), MergeDisk(vertex_, radius), rays);
    int held = 0;
    RunningStatistics inverse;
    for (int i = 0; i < samples; ++i) {
      Sampler sampler = Sampler::at(1, 0, Stream::disk_cover, 0, uint32_t(i));
      const Vec2f u = sampler.next_2d();
      if (coverage.holds(radius, radius * std::sqrt(1 - std::sqrt(1 - u.x)), 2 * pi * u.y)) ++held;
      inverse.add(
          double(coverage.inverse_share(radius, DiskEdges(), sampler.fork(Fork::merge_cover))));
    }
    std::printf("  %-40s %.4f of %.4f, one over it %.4f ± %.4f\n", what.c_str(),
                double(held) / samples, expected, inverse.mean(), inverse.standard_error());
    EXPECT_NEAR(double(held) / samples, expected, slow_build ? 0.03 : 0.005) << what;
    EXPECT_NEAR(inverse.mean() * expected, 1, 0.005 + 4 * inverse.standard_error() * expected)
        << what;
    EXPECT_GE(rays, uint64_t(held));
  }
  /// MergeDisk::share of a point whose surface is turned by that angle, in degrees.
  float share(double angle, const Vec3f& offset = {0.1f, 0.2f, 0}) const {
    const double radians = angle * std::numbers::pi / 180;
    return MergeDisk(vertex_, radius)
        .share(offset, CoarseNormal(Vec3f(float(std::sin(radians)), 0, float(std::cos(radians)))));
  }
  bool reaches(const Vec3f& offset) const {
    uint64_t rays = 0;
    return DiskCoverage(scene_.scene(), MergeDisk(vertex_, radius), rays).reaches(radius, offset);
  }
  float clear_radius(float widest = radius) const {
    uint64_t rays = 0;
    return DiskCoverage(scene_.scene(), MergeDisk(vertex_, widest), rays).clear_radius();
  }

 private:
  TestScene scene_;
  SurfaceVertex vertex_;
};

const std::string half = scale("2, 2, 1") + translate("-1.9, 0, 0");  // up to x = 0.1
const std::string other_half = scale("2, 2, 1") + translate("2.1, 0, 0");

TEST(MergeDisk, StraightEdgeCornerAndGap) {
  const double beyond = share_beyond(0.1);
  Disk(rectangle(scale("2, 2, 1"))).expect_share("whole", 1);
  Disk(rectangle(half)).expect_share("straight edge", 1 - beyond);
  Disk(rectangle(turned(half))).expect_share("straight edge, seen from the back", 1 - beyond);
  Disk(rectangle(scale("1, 1, 1") + translate("-0.999999, -0.999999, 0")))
      .expect_share("corner", 0.25);
  Disk(rectangle(half) + rectangle(scale("2, 2, 1") + translate("2.3, 0, 0")))
      .expect_share("gap", 1 - beyond + share_beyond(0.3));
  Disk(rectangle(half) + rectangle(other_half + translate("0, 0, -0.2")))
      .expect_share("step down by more than counts", 1 - beyond);
}

/// A light vertex counts by what its surface covers of the disk.
TEST(MergeDisk, SurfacesCountByWhatTheyCover) {
  const Disk disk(rectangle(scale("2, 2, 1")));
  for (const double angle : {0, 30, 45, 59, 121, 150, 180})
    EXPECT_NEAR(disk.share(angle), std::fabs(std::cos(angle * std::numbers::pi / 180)), 0.005)
        << angle;
  for (const double angle : {61, 90, 119}) EXPECT_EQ(disk.share(angle), 0) << angle;
  EXPECT_EQ(disk.share(0), 1);
  EXPECT_EQ(disk.share(0, {0, 0, 0.29f * radius}), 1);
  EXPECT_EQ(disk.share(0, {0, 0, -0.31f * radius}), 0);
}

/// Light vertices count by the side on which they arrive, however the surface is wound …
TEST(MergeDisk, NeighboursOfAnyOrientation) {
  for (const std::string& own : {half, turned(half)}) {
    Disk(rectangle(own) + rectangle(other_half)).expect_share("neighbour", 1);
    Disk(rectangle(own) + rectangle(turned(other_half))).expect_share("turned neighbour", 1);
  }
}

/// … but for those that light passes through, whose front may face another medium.
TEST(MergeDisk, NeighboursThatLightPasses) {
  const std::string sheet = R"(<bsdf type="thinphong"/>)";
  const double beyond = share_beyond(0.1);
  Disk(rectangle(half, sheet) + rectangle(other_half, sheet)).expect_share("sheet", 1);
  Disk(rectangle(half, sheet) + rectangle(turned(other_half), sheet))
      .expect_share("turned sheet", 1 - beyond);
}

/// Nothing merges on a mirror, and what lies below glass is as good as bare.
TEST(MergeDisk, NeighboursWithoutLight) {
  const double beyond = share_beyond(0.1);
  Disk(rectangle(half) + rectangle(other_half, mirror())).expect_share("mirror", 1 - beyond);
  Disk(rectangle(scale("2, 2, 1")) +
       rectangle(scale("2, 2, 1") + translate("2.1, 0, 0.05"), glass()))
      .expect_share("below glass", 1);
}

/// A wall ends the disk, and so does a solid that stands on the floor: what lies beyond is not
/// reached.
TEST(MergeDisk, WallsAndSolids) {
  const double beyond = share_beyond(0.1);
  const std::string floor = rectangle(scale("2, 2, 1"));
  Disk(floor + rectangle(rotate("0, 1, 0", -90) + translate("0.1, 0, 0.5")))
      .expect_share("wall", 1 - beyond);
  for (const char* height : {"-0.05", "0", "0.01"})
    Disk(floor + fmt::format(R"(<shape type="cube"><transform name="to_world">
        <translate value="1.1, 0, {}"/></transform>{}</shape>)",
                             1 + std::stod(height), diffuse("0.5, 0.5, 0.5")))
        .expect_share(fmt::format("solid at {}", height), 1 - beyond);
  Disk(floor + fmt::format(R"(<shape type="cube"><transform name="to_world">
      <scale value="0.05, 2, 1"/><translate value="0.15, 0, 0"/></transform>{}</shape>)",
                           diffuse("0.5, 0.5, 0.5")))
      .expect_share("rib", 1 - beyond);
}

/// Light vertices count where they are reached: not beyond a wall, in what stands on the floor, or
/// below what hangs low.
TEST(MergeDisk, ReachesWhatIsNotHidden) {
  const std::string floor = rectangle(scale("2, 2, 1"));
  const Disk wall(floor + rectangle(rotate("0, 1, 0", -90) + translate("0.1, 0, 0.5")));
  EXPECT_TRUE(wall.reaches({0.099f, 0.2f, 0}));
  EXPECT_FALSE(wall.reaches({0.101f, 0.2f, 0}));
  EXPECT_TRUE(wall.reaches({-0.3f, 0, 0.05f}));
  const Disk shelf(floor + rectangle(scale("0.1, 2, 1") + translate("0.2, 0, 0.05")));
  EXPECT_FALSE(shelf.reaches({0.2f, 0, 0}));
  EXPECT_TRUE(shelf.reaches({0.2f, 0, 0.05f}));
  EXPECT_TRUE(shelf.reaches({0.31f, 0, 0}));
  // A bowl and a ball do not stand in their own way.
  EXPECT_TRUE(Disk(sphere("0, 0, 1", 1, diffuse("0.5, 0.5, 0.5"), true), 0.5)
                  .reaches({0.3f, 0, 1 - std::sqrt(1 - 0.09f)}));
  EXPECT_TRUE(Disk(sphere("0, 0, -1", 1, diffuse("0.5, 0.5, 0.5")))
                  .reaches({0.3f, 0, std::sqrt(1 - 0.09f) - 1}));
  // What light passes through hides nothing.
  EXPECT_TRUE(Disk(floor + rectangle(rotate("0, 1, 0", -90) + translate("0.1, 0, 0.5"), glass()))
                  .reaches({0.2f, 0, 0}));
}

/// The disk lies in a gap below a solid: what is above the solid's lower face is its inside.
TEST(MergeDisk, BelowSomethingSolid) {
  const double beyond = share_beyond(0.1);
  const std::string lid = fmt::format(R"(<shape type="cube"><transform name="to_world">
      <translate value="0, 0, 1.05"/></transform>{}</shape>)",
                                      diffuse("0.5, 0.5, 0.5"));
  Disk(rectangle(scale("2, 2, 1")) + lid, 0.04).expect_share("below a solid", 1);
  Disk(rectangle(half) + lid, 0.04).expect_share("straight edge below a solid", 1 - beyond);
  Disk(rectangle(half) + rectangle(scale("2, 2, 1") + translate("0, 0, 0.05")), 0.04)
      .expect_share("straight edge below a sheet", 1 - beyond);
}

/// Twice the height of what hangs over the vertex, if that is less than its radius …
TEST(MergeDisk, WhatHangsLowEndsTheDisk) {
  const std::string floor = rectangle(scale("2, 2, 1"));
  const auto below = [&](const std::string& height, const std::string& bsdf) {
    return Disk(floor + rectangle(scale("1, 1, 1") + translate("0, 0, " + height), bsdf), 0.001);
  };
  const std::string grey = diffuse("0.5, 0.5, 0.5");
  for (const double height : {0.002, 0.05, 0.2, 0.24})
    EXPECT_NEAR(below(std::to_string(height), grey).clear_radius(), 2 * height, 1e-5) << height;
  EXPECT_NEAR(below("0.05", mirror()).clear_radius(), 0.1, 1e-5);
  // … by the widest disk there is to be.
  EXPECT_EQ(below("0.26", grey).clear_radius(), infinity);
  EXPECT_EQ(below("0.05", grey).clear_radius(0.09f), infinity);
  EXPECT_NEAR(below("0.05", grey).clear_radius(0.11f), 0.1, 1e-5);
  // What light passes through does not shade, nor does what hangs beside the vertex.
  EXPECT_EQ(below("0.05", glass()).clear_radius(), infinity);
  EXPECT_EQ(Disk(floor + rectangle(scale("1, 1, 1") + translate("1.01, 0, 0.05"))).clear_radius(),
            infinity);
  EXPECT_EQ(Disk(floor).clear_radius(), infinity);
}

}  // namespace
}  // namespace kaustik
