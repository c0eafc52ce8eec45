// Kernels over disks that straight edges cut: what they integrate to, by a fine grid.

#include "kaustik/photon/coverage/disk_kernel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kaustik {
namespace {

constexpr float radius = 0.3f;
const Frame frame(normalize(Vec3f(0.2f, -0.7f, 0.5f)));

DiskEdges edges_at(std::initializer_list<std::pair<float, float>> angles_and_distances) {
  DiskEdges edges;
  for (const auto& [angle, distance] : angles_and_distances)
    edges.edges[edges.count++] = {frame.x * -std::cos(angle) + frame.y * -std::sin(angle),
                                  distance};
  return edges;
}

/// Integrals of a kernel times 1, x, y over what the edges leave, x and y over the radius.
struct Integrals {
  double one = 0, x = 0, y = 0;
};
Integrals integrals(const DiskKernel& kernel, const DiskEdges& edges, KernelShape shape) {
  constexpr int n = 1500;
  Integrals sum;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double x = (2 * i + 1.0) / n - 1, y = (2 * j + 1.0) / n - 1;
      const double square = x * x + y * y;
      const Vec3f offset = (frame.x * float(x) + frame.y * float(y)) * radius;
      if (square > 1 || !edges.hold(offset)) continue;
      const double weight = (shape == KernelShape::flat ? 1 : 1 - square) *
                            double(kernel.scale * kernel.factor(offset)) * double(radius * radius) *
                            4 / n / n;
      sum.one += weight;
      sum.x += weight * x;
      sum.y += weight * y;
    }
  return sum;
}

TEST(DiskKernel, FindsLinearLightAsItIsAtTheCenter) {
  const std::vector<DiskEdges> cases = {
      {},
      edges_at({{0, 0.1f}}),
      edges_at({{1, 0}}),
      edges_at({{4, 0.29f}}),
      edges_at({{0.3f, 0.05f}, {2, 0.1f}}),
      edges_at({{1, 0}, {2.5f, 0}}),
      edges_at({{0, 0.1f}, {1.5f, 0.2f}, {3, 0.15f}, {5, 0.02f}}),
  };
  for (const KernelShape shape : {KernelShape::flat, KernelShape::parabolic})
    for (size_t i = 0; i < cases.size(); ++i) {
      const DiskKernel kernel(frame, radius, cases[i], shape);
      const Integrals found = integrals(kernel, cases[i], shape);
      EXPECT_NEAR(found.one, 1, 2e-3) << i;
      EXPECT_NEAR(found.x, 0, 1e-3) << i;
      EXPECT_NEAR(found.y, 0, 1e-3) << i;
    }
}

/// On the edge itself the mean of half a disk is that of a point 16/(15 π) of the radius away,
/// which is what the slope takes back.
TEST(DiskKernel, HalfADisk) {
  const DiskEdges edges = edges_at({{0, 0}});
  const DiskMoments m = disk_moments(frame, radius, edges, KernelShape::parabolic);
  constexpr double pi_ = 3.14159265358979;
  EXPECT_NEAR(m.one, pi_ / 4, 1e-6);
  EXPECT_NEAR(-m.x / m.one, 16 / (15 * pi_), 1e-6);
  EXPECT_NEAR(m.y, 0, 1e-6);
  EXPECT_NEAR(m.xx / m.one, 1.0 / 6, 1e-6);
  const DiskKernel kernel(frame, radius, edges, KernelShape::parabolic);
  const auto factor_at = [&](double share) { return 1 - share * 16 / (15 * pi_) * 6; };
  for (const float share : {0.1f, 0.5f, 1.0f})
    EXPECT_NEAR(kernel.factor(frame.x * (-share * radius)), factor_at(double(share)), 1e-4);
  EXPECT_LT(factor_at(1), 0);
}

/// Edges whose segments are apart have a closed form; where they overlap the disk is cut into
/// sectors. An edge that is there twice overlaps itself.
TEST(DiskKernel, ClosedFormsAreTheSumsOverSectors) {
  const std::vector<std::pair<DiskEdges, DiskEdges>> pairs = {
      {edges_at({{0.4f, 0.1f}}), edges_at({{0.4f, 0.1f}, {0.4f, 0.1f}})},
      {edges_at({{2, 0}}), edges_at({{2, 0}, {2, 0}})},
      {edges_at({{1, 0.29f}}), edges_at({{1, 0.29f}, {1, 0.29f}})},
      {edges_at({{0, 0.2f}, {3, 0.05f}}), edges_at({{0, 0.2f}, {3, 0.05f}, {0, 0.2f}})},
  };
  for (const KernelShape shape : {KernelShape::flat, KernelShape::parabolic})
    for (const auto& [apart, twice] : pairs) {
      const DiskMoments a = disk_moments(frame, radius, apart, shape);
      const DiskMoments b = disk_moments(frame, radius, twice, shape);
      EXPECT_NEAR(a.one, b.one, 1e-6);
      EXPECT_NEAR(a.x, b.x, 1e-6);
      EXPECT_NEAR(a.y, b.y, 1e-6);
      EXPECT_NEAR(a.xx, b.xx, 1e-6);
      EXPECT_NEAR(a.xy, b.xy, 1e-6);
      EXPECT_NEAR(a.yy, b.yy, 1e-6);
    }
}

TEST(DiskKernel, EdgesBeyondTheDiskChangeNothing) {
  const DiskKernel whole(frame, radius, {}, KernelShape::parabolic);
  const DiskKernel far(frame, radius, edges_at({{2, radius}}), KernelShape::parabolic);
  EXPECT_EQ(whole.scale, far.scale);
  EXPECT_EQ(length(far.slope), 0);
  EXPECT_NEAR(whole.scale * 3.14159265f * radius * radius / 2, 1, 1e-5);
}

}  // namespace
}  // namespace kaustik
