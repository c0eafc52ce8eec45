#include "kaustik/base/transform.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace kaustik {
namespace {

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance = 1e-5f) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(transform, moves_points_but_not_vectors) {
  const Transform t = Transform::translate({1, 2, 3});
  expect_near(t.point({1, 1, 1}), {2, 3, 4});
  expect_near(t.vector({1, 1, 1}), {1, 1, 1});
  expect_near(t.normal({0, 1, 0}), {0, 1, 0});
}

TEST(transform, rotates_right_handed) {
  expect_near(Transform::rotate({0, 0, 2}, 90).vector({1, 0, 0}), {0, 1, 0});
  expect_near(Transform::rotate({1, 0, 0}, 90).vector({0, 1, 0}), {0, 0, 1});
  expect_near(Transform::rotate({1, 1, 1}, 120).vector({1, 0, 0}), {0, 1, 0});
}

TEST(transform, product_applies_the_right_one_first) {
  const Transform t = Transform::translate({1, 0, 0}) * Transform::scale({2, 2, 2});
  expect_near(t.point({1, 1, 1}), {3, 2, 2});
}

TEST(transform, normals_stay_perpendicular) {
  const Transform t = Transform::rotate({1, 2, 3}, 40) * Transform::scale({1, 5, 0.2}) *
                      Transform::rotate({3, -1, 0}, 70);
  const Vec3f n(0.2f, 0.5f, -0.7f), v(0.5f, -0.2f, 0);
  ASSERT_NEAR(dot(n, v), 0, 1e-7f);
  EXPECT_NEAR(dot(normalize(t.normal(n)), normalize(t.vector(v))), 0, 1e-6f);
}

TEST(transform, inverse_undoes) {
  const Transform t = Transform::translate({1, 2, 3}) * Transform::rotate({1, 2, 3}, 40) *
                      Transform::scale({1, -5, 0.2});
  expect_near((t.inverse() * t).point({4, 5, 6}), {4, 5, 6}, 1e-4f);
  expect_near(t.inverse().point(t.point({4, 5, 6})), {4, 5, 6}, 1e-4f);
  EXPECT_NEAR(t.determinant3(), -1, 1e-12);
}

TEST(transform, look_at_is_the_camera_of_mitsuba) {
  const Transform t = Transform::look_at({0, 0, -5}, {0, 0, 0}, {0, 1, 0});
  expect_near(t.point({0, 0, 0}), {0, 0, -5});
  expect_near(t.vector({0, 0, 1}), {0, 0, 1});
  expect_near(t.vector({1, 0, 0}), {1, 0, 0});
  const Transform side = Transform::look_at({3, 1, 2}, {4, 1, 2}, {0, 2, 0});
  expect_near(side.vector({0, 0, 1}), {1, 0, 0});
  expect_near(side.vector({1, 0, 0}), {0, 0, -1});
  expect_near(side.vector({0, 1, 0}), {0, 1, 0});
  EXPECT_GT(side.determinant3(), 0);
}

TEST(transform, bounds_hold_all_corners) {
  const Bounds3f box({-1, -1, -1}, {1, 1, 1});
  const Bounds3f turned = Transform::rotate({0, 0, 1}, 45).bounds(box);
  EXPECT_NEAR(turned.max.x, std::sqrt(2.0f), 1e-5f);
  EXPECT_NEAR(turned.min.y, -std::sqrt(2.0f), 1e-5f);
  EXPECT_NEAR(turned.max.z, 1, 1e-6f);
  EXPECT_TRUE(Transform::scale({2, 2, 2}).bounds(Bounds3f()).isEmpty());
}

TEST(transform, divides_by_the_homogeneous_coordinate) {
  const double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 1, 1}};
  expect_near(Transform(m).point({2, 4, 1}), {1, 2, 0.5f});
}

TEST(transform, copies_have_the_bits_of_their_inverse) {
  const Transform made = Transform::look_at({1, 2, 3}, {4, 4, 4}, {0, 0, 1}) *
                         Transform::rotate({1, 2, 3}, 40) * Transform::scale({3, 0.1, 1e-5});
  double rows[4][4], inverse[4][4];
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      rows[i][j] = made.at(i, j);
      inverse[i][j] = made.inverse().at(i, j);
    }
  EXPECT_TRUE(Transform(rows, inverse) == made);
  EXPECT_FALSE(Transform(rows) == made);  // an inverse of its own: other bits
  inverse[2][1] += 1;
  EXPECT_THROW(Transform(rows, inverse), std::invalid_argument);
  inverse[2][1] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Transform(rows, inverse), std::invalid_argument);
}

TEST(transform, refuses_what_has_no_inverse) {
  EXPECT_THROW(Transform::scale({1, 0, 1}), std::invalid_argument);
  EXPECT_THROW(Transform::rotate({0, 0, 0}, 10), std::invalid_argument);
  EXPECT_THROW(Transform::look_at({1, 1, 1}, {1, 1, 1}, {0, 1, 0}), std::invalid_argument);
  EXPECT_THROW(Transform::look_at({0, 0, 0}, {0, 3, 0}, {0, 1, 0}), std::invalid_argument);
  double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
  m[1][2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Transform{m}, std::invalid_argument);
}

TEST(frame, is_right_handed_for_every_normal) {
  for (const Vec3f& raw : {Vec3f(0, 0, 1), Vec3f(0, 0, -1), Vec3f(1, 0, 0), Vec3f(0.3f, -2, -1e-4f),
                           Vec3f(-1, 2, -3), Vec3f(1e-5f, -1e-5f, -1)}) {
    const Vec3f n = normalize(raw);
    const Frame frame(n);
    expect_near(cross(frame.x, frame.y), n);
    EXPECT_NEAR(length(frame.x), 1, 1e-5f);
    EXPECT_NEAR(dot(frame.x, frame.y), 0, 1e-5f);
    const Vec3f v(0.3f, 0.4f, -0.5f);
    expect_near(frame.to_world(frame.to_local(v)), v);
    expect_near(frame.to_local(n), {0, 0, 1});
  }
}

TEST(vectors, reflect_about_a_normal) {
  expect_near(reflect(Vec3f(1, 2, 3), {0, 0, 1}), {-1, -2, 3});
}

// A factor of zero along some axis: points fall into a plane, and normals stand on it.
TEST(transform, flattens) {
  const Transform turn = Transform::rotate({1, 2, 3}, 40);
  for (const Vec3d& factors : {Vec3d(2, 3, 0), Vec3d(-2, 0, 3), Vec3d(0, 0.01, 300)}) {
    const Transform flat = Transform::collapsing(
        {{factors.x, 0, 0, 0}, {0, factors.y, 0, 0}, {0, 0, factors.z, 5}, {0, 0, 0, 1}});
    EXPECT_EQ(flat.dimensions(), 2);
    EXPECT_EQ(flat.determinant3(), 0);
    const Vec3f p(1, 2, 3);
    expect_near(flat.point(p),
                Vec3f(p.x * float(factors.x), p.y * float(factors.y), p.z * float(factors.z) + 5));
    const Transform turned = Transform::translate({1, 1, 1}) * turn * flat * turn;
    EXPECT_EQ(turned.dimensions(), 2);
    const Vec3f s = turned.vector({1, 0, 0}), t = turned.vector({0, 1, 0}),
                u = turned.vector({0, 0, 1});
    const Vec3f n = normalize(turned.normal({0.5f, 0.7f, 0.3f}));
    for (const Vec3f& along : {s, t, u}) EXPECT_NEAR(dot(n, along), 0, 1e-4f * length(along));
  }
}

// The plane is seen from the side from which the flat thing was.
TEST(transform, flattened_frames_stay_right_handed) {
  for (const double x : {1.0, -1.0}) {
    const Transform flat =
        Transform::collapsing({{x, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 1}});
    const Vec3f side = flat.vector({1, 0, 0}) % flat.vector({0, 1, 0});
    expect_near(normalize(flat.normal({0, 0, 1})), side);
  }
}

TEST(transform, dimensions_that_are_left) {
  const auto of = [](double x, double y, double z) {
    return Transform::collapsing({{x, 0, 0, 0}, {0, y, 0, 0}, {0, 0, z, 0}, {0, 0, 0, 1}});
  };
  EXPECT_EQ(of(0, 0, 0).dimensions(), 0);
  EXPECT_EQ(of(1, 0, 0).dimensions(), 1);
  EXPECT_EQ(of(1e-9, 2, 1e-12).dimensions(), 3);
  EXPECT_EQ(of(1e-9, 2, 1e-12), Transform::scale({1e-9, 2, 1e-12}));
  EXPECT_EQ((of(1, 1, 0) * Transform::rotate({1, 0, 0}, 90) * of(1, 1, 0)).dimensions(), 1);
  EXPECT_EQ((of(1, 1, 0) * of(1, 1, 0)).dimensions(), 2);
  EXPECT_THROW(Transform::collapsing({{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 1, 0}}),
               std::invalid_argument);
  EXPECT_THROW(Transform::scale({1, 1, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace kaustik
