#include "kaustik/base/warp.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/base/statistics.h"

namespace kaustik {
namespace {

#ifdef KAUSTIK_SLOW_BUILD
constexpr int warp_count = 20000;
constexpr double planted_warp_error = 0.065;
#else
constexpr int warp_count = 200000;
constexpr double planted_warp_error = 0.02;
#endif
constexpr double level = 1e-4;
constexpr int cells = 8;

Vec2f point(int i) { return Sampler(hash_mix(17, uint64_t(i)), 0).next_2d(); }

int cell_of(double x, double low, double high) {
  return std::clamp(int((x - low) / (high - low) * cells), 0, cells - 1);
}

/// Chi-square over 8 × 8 cells of two coordinates in which the warp should be uniform, and the same
/// with every other cell expected 2 % off.
void expect_uniform(const std::function<Vec2f(const Vec2f&)>& coordinates) {
  std::vector<double> hits(cells * cells),
      expected(cells * cells, double(warp_count) / (cells * cells));
  for (int i = 0; i < warp_count; ++i) {
    const Vec2f c = coordinates(point(i));
    ASSERT_GE(std::min(c.x, c.y), -1e-6f);
    ASSERT_LE(std::max(c.x, c.y), 1 + 1e-6f);
    hits[size_t(cell_of(c.x, 0, 1) * cells + cell_of(c.y, 0, 1))] += 1;
  }
  EXPECT_GT(chi_square_p_value(hits, expected), level);
  for (size_t i = 0; i < expected.size(); ++i)
    expected[i] *= i % 2 ? 1 + planted_warp_error : 1 - planted_warp_error;
  EXPECT_LT(chi_square_p_value(hits, expected), level);
}

float turn_of(float x, float y) {
  const float turn = std::atan2(y, x) / (2 * pi);
  return turn < 0 ? turn + 1 : turn;
}

TEST(warp, disk_is_uniform_by_area) {
  expect_uniform([](const Vec2f& u) {
    const Vec2f p = square_to_disk(u);
    return Vec2f(p.x * p.x + p.y * p.y, turn_of(p.x, p.y));
  });
}

TEST(warp, disk_to_square_is_the_inverse) {
  for (int i = 0; i < 10000; ++i) {
    const Vec2f u = point(i), back = disk_to_square(square_to_disk(u));
    ASSERT_NEAR(u.x, back.x, 1e-5f);
    ASSERT_NEAR(u.y, back.y, 1e-5f);
  }
  EXPECT_EQ(square_to_disk({0.5f, 0.5f}), Vec2f(0, 0));
}

TEST(warp, cosine_hemisphere_is_uniform_in_projection) {
  expect_uniform([](const Vec2f& u) {
    const Vec3f w = square_to_cosine_hemisphere(u);
    EXPECT_GE(w.z, 0);
    EXPECT_NEAR(length(w), 1, 1e-5f);
    return Vec2f(1 - w.z * w.z, turn_of(w.x, w.y));
  });
  EXPECT_FLOAT_EQ(cosine_hemisphere_pdf(0.5f), 0.5f * inv_pi);
  EXPECT_EQ(cosine_hemisphere_pdf(-0.5f), 0);
}

TEST(warp, sphere_is_uniform_in_height_and_azimuth) {
  expect_uniform([](const Vec2f& u) {
    const Vec3f w = square_to_sphere(u);
    EXPECT_NEAR(length(w), 1, 1e-5f);
    return Vec2f(0.5f * (w.z + 1), turn_of(w.x, w.y));
  });
  EXPECT_FLOAT_EQ(sphere_pdf * 4 * pi, 1);
}

TEST(warp, cone_is_uniform_by_solid_angle) {
  for (const float one_minus_cos : {2.0f, 0.5f, 1e-3f}) {
    expect_uniform([&](const Vec2f& u) {
      const Vec3f w = square_to_cone(u, one_minus_cos);
      // 1 − cosθ without cancellation.
      const float h = (w.x * w.x + w.y * w.y) / (1 + w.z);
      return Vec2f(w.z > 0 ? h / one_minus_cos : (1 - w.z) / one_minus_cos, turn_of(w.x, w.y));
    });
    EXPECT_FLOAT_EQ(cone_pdf(one_minus_cos) * 2 * pi * one_minus_cos, 1);
  }
}

TEST(warp, tiny_cone_keeps_its_size) {
  // Half angle 1e-5: in single precision the cosine itself would be 1.
  const Vec3f w = square_to_cone({one_minus_epsilon, 0.0f}, 0.5e-10f);
  EXPECT_NEAR(w.x, 1e-5f, 1e-9f);
}

TEST(warp, triangle_is_uniform_by_area) {
  expect_uniform([](const Vec2f& u) {
    const Vec2f b = square_to_triangle(u);
    EXPECT_GE(std::min(b.x, b.y), 0);
    EXPECT_LE(b.x + b.y, 1 + 1e-6f);
    // By the area nearer to the first corner, and along the line through the point.
    const float sum = b.x + b.y;
    return Vec2f(sum * sum, sum > 0 ? b.y / sum : 0.5f);
  });
}

TEST(warp, tent_has_its_cumulative_distribution) {
  expect_uniform([](const Vec2f& u) {
    const float x = unit_to_tent(u.x);
    const float below = x < 0 ? 0.5f * (1 + x) * (1 + x) : 1 - 0.5f * (1 - x) * (1 - x);
    return Vec2f(below, u.y);
  });
  EXPECT_EQ(unit_to_tent(0), -1);
  EXPECT_EQ(unit_to_tent(0.5f), 0);
}

}  // namespace
}  // namespace kaustik
