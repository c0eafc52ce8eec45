// Polygons cut into triangles: exactly what lies within is covered, once.

#include "kaustik/base/polygon_cutter.h"

#include <ctime>
#include <numbers>
#include <numeric>

#include "geometry_support.h"

namespace kaustik::test {
namespace {

using Triangles = PolygonCutter::Triangles;
using Points = std::vector<Vec3f>;

Points in_plane(const std::vector<Vec2f>& flat) {
  Points points;
  for (const Vec2f& p : flat) points.emplace_back(p.x, p.y, 0.0f);
  return points;
}

Triangles cut(const Points& points) {
  std::vector<uint32_t> corners(points.size());
  std::iota(corners.begin(), corners.end(), 0u);
  Triangles triangles;
  EXPECT_TRUE(PolygonCutter(64 * points.size()).cut(points, corners, corners, triangles));
  EXPECT_EQ(triangles.size(), points.size() - 2);
  return triangles;
}

Triangles fan(size_t corners) {
  Triangles triangles;
  for (uint32_t i = 2; i < corners; ++i) triangles.push_back({0, i - 1, i});
  return triangles;
}

double area_of(const Points& p, const PolygonCutter::Triangle& t) {
  return 0.5 * (Vec3d(p[t[1]]) - Vec3d(p[t[0]])).cross(Vec3d(p[t[2]]) - Vec3d(p[t[0]])).length();
}
double area_of(const Points& p, const Triangles& triangles) {
  double sum = 0;
  for (const auto& t : triangles) sum += area_of(p, t);
  return sum;
}
double shoelace(const Points& p) {
  Vec3d sum(0, 0, 0);
  for (size_t i = 0; i < p.size(); ++i) sum += Vec3d(p[i]).cross(Vec3d(p[(i + 1) % p.size()]));
  return 0.5 * sum.length();
}

/// The triangles of a simple polygon add up to its area: none lies outside, none over another.
void expect_exact(const Points& points, const std::string& name, double tolerance = 1e-6) {
  const double area = shoelace(points);
  EXPECT_NEAR(area_of(points, cut(points)), area, tolerance * area) << name;
}

/// `points` from each corner on, in both directions, and in the planes of several orientations.
void expect_exact_however_placed(Points points, const std::string& name) {
  for (size_t turn = 0; turn < points.size(); ++turn) {
    std::rotate(points.begin(), points.begin() + 1, points.end());
    expect_exact(points, name);
    expect_exact({points.rbegin(), points.rend()}, name + " backward");
    for (const double angle : {30.0, 90.0, 180.0, 215.0}) {
      const Transform placed =
          Transform::translate({5.0, -3.0, 2.0}) * Transform::rotate({1.0, 2.0, -0.5}, angle);
      Points moved;
      for (const Vec3f& p : points) moved.push_back(placed.point(p));
      expect_exact(moved, name + " turned", 1e-5);
    }
  }
}

Points star(int tips, float inner, float height) {
  Points points;
  for (int i = 0; i < 2 * tips; ++i) {
    const float phi = pi * float(i) / float(tips), r = i % 2 == 0 ? 1 : inner;
    points.emplace_back(r * std::cos(phi), r * std::sin(phi), i % 2 == 0 ? height : 0);
  }
  return points;
}

Points comb(int teeth) {
  std::vector<Vec2f> flat = {{0, -1}};
  flat.emplace_back(float(teeth), -1.0f);
  for (int i = teeth; i > 0; --i) {
    flat.emplace_back(float(i), 5.0f);
    flat.emplace_back(float(i) - 0.5f, 0.0f);
  }
  flat.emplace_back(0.0f, 5.0f);
  return in_plane(flat);
}

/// A band of width 0.5 that winds inward.
Points spiral(int corners) {
  std::vector<Vec2f> flat;
  const int half = corners / 2;
  const auto at = [&](int i, double inset) {
    const double phi = 2 * std::numbers::pi * i / 100.0;
    const double r = 2.0 + half / 100.0 - i / 100.0 - inset;
    return Vec2f(float(r * std::cos(phi)), float(r * std::sin(phi)));
  };
  for (int i = 0; i < half; ++i) flat.push_back(at(i, 0));
  for (int i = half - 1; i >= 0; --i) flat.push_back(at(i, 0.5));
  return in_plane(flat);
}

TEST(PolygonCutter, SimplePolygonsAreCoveredOnce) {
  expect_exact_however_placed(in_plane({{0.5f, 0.5f}, {0, 0}, {-0.5f, 0.5f}, {0, -0.5f}}), "arrow");
  expect_exact_however_placed(in_plane({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}), "L");
  expect_exact_however_placed(star(5, 0.3f, 0), "star");
  expect_exact_however_placed(star(40, 0.05f, 0), "star of 40");
  expect_exact_however_placed(comb(9), "comb");
  // Corners on straight sides, repeated ones, sides that run back.
  expect_exact_however_placed(
      in_plane({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1.5f, 1}, {1, 1}, {1, 2}, {0, 2}, {0, 1}}),
      "L with straight corners");
  expect_exact_however_placed(
      in_plane({{0, 0}, {2, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 2}, {0, 2}}),
      "L with repeated corners");
  expect_exact(spiral(2000), "spiral", 1e-5);
}

TEST(PolygonCutter, PartsThatTouchAreToldApart) {
  // A square hole reached by a slit.
  expect_exact_however_placed(
      in_plane({{0, 0}, {3, 0}, {3, 3}, {0, 3}, {0, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {1, 1}}),
      "hole");
  // Two lobes that run the same way round, and meet in a point.
  expect_exact_however_placed(in_plane({{0, 0}, {2, -1}, {2, 1}, {0, 0}, {-2, 1}, {-2, -1}}),
                              "lobes");
  // A side that touches a corner; a spike outward and one inward, of no area.
  expect_exact_however_placed(in_plane({{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}),
                              "corner on a side");
  expect_exact_however_placed(in_plane({{0, 0}, {2, 0}, {3, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}}),
                              "spike outward");
  expect_exact_however_placed(
      in_plane({{0, 0}, {2, 0}, {2, 2}, {1, 1.5f}, {1, 1}, {1, 1.5f}, {0, 2}}), "spike inward");
  // Lobes that run opposite ways round: their areas cancel in the polygon's.
  const Points eight = in_plane({{0, 0}, {2, -1}, {2, 1}, {0, 0}, {-2, -1}, {-2, 1}});
  EXPECT_NEAR(area_of(eight, cut(eight)), 4, 1e-6);
  // A quad that goes there and back.
  const Points line = in_plane({{0, 0}, {1, 0}, {1, 1}, {1, 0}});
  EXPECT_EQ(area_of(line, cut(line)), 0);
}

TEST(PolygonCutter, ConvexPolygonsStayFans) {
  Points points;
  for (int i = 0; i < 30; ++i)
    points.emplace_back(std::cos(0.2f * float(i)), std::sin(0.2f * float(i)), 0.0f);
  EXPECT_EQ(cut(points), fan(30));
  EXPECT_EQ(cut(in_plane({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}})), fan(5));
  EXPECT_EQ(cut(in_plane({{0, 0}, {2, 0}, {2, 2}, {0, 2}})), fan(4));
  EXPECT_EQ(cut({{0, 0, 0}, {2, 0, 1}, {2, 2, 0}, {0, 2, 1}}), fan(4));  // a saddle
  EXPECT_EQ(cut(in_plane({{0, 0}, {1, 0}, {0, 1}})), fan(3));
}

/// Seen from above, a star of uneven height is a star.
TEST(PolygonCutter, NeedNotBeCoplanar) {
  for (const float height : {0.1f, 0.5f, -1.0f}) {
    const Points uneven = star(6, 0.4f, height), flat = star(6, 0.4f, 0);
    EXPECT_NEAR(area_of(flat, cut(uneven)), shoelace(flat), 1e-6);
  }
}

/// Star-shaped polygons with uneven rays; a twin with one corner out of order must fail.
TEST(PolygonCutter, RandomPolygons) {
  Random random(11);
  int wrong = 0;
  for (int i = 0; i < 2000 / samples_divisor; ++i) {
    const int n = 5 + int(random.uniform() * 40);
    std::vector<Vec2f> flat;
    for (int j = 0; j < n; ++j) {
      const float phi = 2 * pi * (float(j) + 0.9f * random.uniform()) / float(n);
      const float r = random.magnitude(-2, 0);
      flat.emplace_back(r * std::cos(phi), r * std::sin(phi));
    }
    expect_exact(in_plane(flat), "random", 1e-5);
    std::swap(flat[1], flat[3]);
    const Points crossed = in_plane(flat);
    if (area_of(crossed, cut(crossed)) > shoelace(crossed) * 1.0001) ++wrong;
  }
  EXPECT_GT(wrong, 100 / samples_divisor);
}

/// Where sides cross there is no right answer, but one that comes soon and loses no corner.
TEST(PolygonCutter, CrossingSidesEnd) {
  Random random(5);
  for (const int n : {4, 5, 6, 7, 10, 50, 1000}) {
    for (int i = 0; i < 200 / n + 1; ++i) {
      Points points;
      for (int j = 0; j < n; ++j) points.push_back(random.in_box(1));
      cut(points);
      for (Vec3f& p : points) p.z = 0;
      cut(points);
      for (Vec3f& p : points) p = {std::round(p.x), std::round(p.y), 0};
      cut(points);
    }
  }
  cut(Points(100, Vec3f(1, 2, 3)));
}

TEST(PolygonCutter, LargePolygonsTakeNoSquareOfTheirCorners) {
  for (const Points& points : {star(10000, 0.9f, 0), comb(10000), spiral(20000)}) {
    std::vector<uint32_t> corners(points.size());
    std::iota(corners.begin(), corners.end(), 0u);
    Triangles triangles;
    const std::clock_t begin = std::clock();
    // A file holds at least 16 bytes for each corner.
    EXPECT_TRUE(PolygonCutter(16 * points.size()).cut(points, corners, corners, triangles));
    const double taken = double(std::clock() - begin) / CLOCKS_PER_SEC;
    EXPECT_LT(taken, 1.0 * samples_divisor);  // s of the processor
    EXPECT_NEAR(area_of(points, triangles), shoelace(points), 1e-4 * shoelace(points));
  }
}

TEST(PolygonCutter, StopsWhenItsStepsAreSpent) {
  PolygonCutter cutter(0);
  const Points points = spiral(2000);
  std::vector<uint32_t> corners(points.size());
  std::iota(corners.begin(), corners.end(), 0u);
  bool complete = true;
  for (int i = 0; complete && i < 1000; ++i) {
    Triangles triangles;
    complete = cutter.cut(points, corners, corners, triangles);
  }
  EXPECT_FALSE(complete);
}

}  // namespace
}  // namespace kaustik::test
