// Surfaces of grids of distances against their closed forms and against small steps.

#include <functional>

#include "geometry_support.h"
#include "kaustik/geometry/grid_field.h"

namespace kaustik::test {
namespace {

std::vector<float> nodes_of(const std::array<int, 3>& size,
                            const std::function<double(const Vec3d&)>& value) {
  std::vector<float> values;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x)
        values.push_back(
            float(value(Vec3d(x, y, z) / Vec3d(size[0] - 1, size[1] - 1, size[2] - 1))));
  return values;
}

std::shared_ptr<const Shape> grid_shape(const std::array<int, 3>& size,
                                        const std::function<double(const Vec3d&)>& value,
                                        std::vector<Property> more = {}) {
  more.push_back({"grid",
                  Value(Array::of<float>({size_t(size[2]), size_t(size[1]), size_t(size[0])},
                                         nodes_of(size, value))),
                  {}});
  return make_shape("sdfgrid", std::move(more));
}

double distance_to_ball(const Vec3d& p) { return (p - Vec3d(0.5, 0.5, 0.5)).length() - 0.35; }

/// Noise: in each cell the surface may pass several times.
GridField noise_field(const std::array<int, 3>& size, uint64_t seed) {
  Random random(seed);
  std::vector<float> values;
  for (int i = 0; i < size[0] * size[1] * size[2]; ++i) values.push_back(random.uniform(-1, 1));
  return {size, std::move(values)};
}

struct Line {
  Vec3d from, direction;
};
Line line_through(Random& random, const Vec3d& extent) {
  const auto in_box = [&](double margin) {
    return Vec3d(double(random.uniform(float(-margin), float(extent.x + margin))),
                 double(random.uniform(float(-margin), float(extent.y + margin))),
                 double(random.uniform(float(-margin), float(extent.z + margin))));
  };
  Line line;
  line.from = in_box(3);
  line.direction = in_box(0) - line.from;
  // Along an axis, and through nodes and edges, now and then.
  if (random.uniform() < 0.2f) line.direction[int(random.uniform() * 3)] = 0;
  if (random.uniform() < 0.2f)
    for (int i = 0; i < 3; ++i) line.from[i] = std::round(line.from[i]);
  return line;
}

TEST(GridField, FirstCrossingIsThatOfSmallSteps) {
  Random random(51);
  int met = 0;
  for (const std::array<int, 3>& size : {std::array{2, 2, 2}, {3, 5, 4}, {20, 9, 17}, {2, 30, 3}}) {
    const GridField field = noise_field(size, uint64_t(size[0]));
    const Vec3d extent = field.extent();
    for (int i = 0; i < 1000 / samples_divisor; ++i) {
      const auto line = line_through(random, extent);
      const Vec3d from = line.from, direction = line.direction;
      const auto inside = [&](double t) {
        const Vec3d p = from + direction * t;
        for (int axis = 0; axis < 3; ++axis)
          if (p[axis] < -1e-9 || p[axis] > extent[axis] + 1e-9) return false;
        return true;
      };
      const auto found = field.crossing(from, direction, 10);
      // By steps much smaller than a cell, from the first one in the grid on.
      const double step = 2e-3 / direction.length();
      double t = 0, end = found ? *found - 1e-6 : 10;
      while (t < end && !inside(t)) t += step;
      if (t >= end) continue;
      const bool is_negative = field.value(from + direction * t) < 0;
      double deepest = 0;  // what the steps find beyond the surface before it was found
      for (; t < end && inside(t); t += step) {
        const double value = field.value(from + direction * t);
        if ((value < 0) != is_negative) deepest = std::max(deepest, std::fabs(value));
      }
      EXPECT_LT(deepest, 1e-9) << i << " of " << size[0];
      if (!found) continue;
      ++met;
      EXPECT_LT(std::fabs(field.value(from + direction * *found)), 1e-9);
    }
  }
  EXPECT_GT(met, 1000 / samples_divisor);
}

/// Both lie between borders of the cell, at which the value has the same sign: along its diagonal
/// it is 1 − 5 s (1 − s).
TEST(GridField, TwoCrossingsWithinACellAreFound) {
  const GridField field({2, 2, 2}, {1, -1.5f, -1.5f, 1, 1, -1.5f, -1.5f, 1});
  const auto first = field.crossing({0, 0, 0.5}, {1, 1, 0}, 1);
  ASSERT_TRUE(first);
  EXPECT_NEAR(*first, 0.5 - std::sqrt(0.05), 1e-9);
  const auto second = field.crossing({0.5, 0.5, 0.5}, {1, 1, 0}, 1);
  ASSERT_TRUE(second);
  EXPECT_NEAR(*second, std::sqrt(0.05), 1e-9);
  EXPECT_FALSE(field.crossing({0, 0, 0.5}, {1, 1, 0}, 0.2));
}

TEST(GridField, BoxesHoldTheSurface) {
  const GridField field({33, 33, 33}, nodes_of({33, 33, 33}, distance_to_ball));
  Random random(52);
  for (const int budget : {1, 8, 100, 1000}) {
    const std::vector<Imath::Box3d> boxes = field.surface_boxes(budget);
    EXPECT_LE(boxes.size(), size_t(budget));
    for (int i = 0; i < 500; ++i) {
      const Vec3d from(16, 16, 16), direction(random.direction());
      const auto t = field.crossing(from, direction, 100);
      ASSERT_TRUE(t);
      EXPECT_TRUE(std::any_of(boxes.begin(), boxes.end(), [&](const Imath::Box3d& box) {
        return box.intersects(from + direction * *t);
      }));
    }
  }
}

/// A distance that is linear is met exactly, with the plane's normal.
TEST(SdfGrid, PlanesAreExact) {
  const Vec3d normal = Vec3d(1, 2, -0.5).normalized();
  for (const char* normals : {"smooth", "analytic"}) {
    const Transform place = placement(2) * Transform::scale({1.0, 0.5, -3.0});
    const auto shape = grid_shape(
        {5, 9, 3}, [&](const Vec3d& p) { return (p - Vec3d(0.5, 0.5, 0.5)).dot(normal); },
        {{"normals", std::string(normals), {}}, {"to_world", place, {}}});
    const auto tracer = tracer_of({shape});
    Random random(53);
    for (int i = 0; i < 1000; ++i) {
      // Toward a point of the plane within the cube.
      Vec3f on_plane;
      do {
        on_plane = Vec3f(0.5f, 0.5f, 0.5f) + random.in_box(0.5f);
        on_plane -= Vec3f(normal) * dot(on_plane - Vec3f(0.5f, 0.5f, 0.5f), Vec3f(normal));
      } while (max_abs(on_plane - Vec3f(0.5f, 0.5f, 0.5f)) > 0.45f);
      const Vec3f target = place.point(on_plane);
      const Vec3f origin = target + random.direction() * 8.0f;
      Hit hit;
      const Ray ray{origin, normalize(target - origin), infinity};
      const Vec3f expected = normalize(place.normal(Vec3f(normal)));
      if (abs_dot(ray.direction, expected) < 0.05f) continue;
      ASSERT_TRUE(tracer->intersect(ray, hit));
      const SurfacePoint p = tracer->surface_point(ray, hit);
      EXPECT_LT(length(p.position - target), 1e-4f);
      EXPECT_LT(length(p.ng - expected), 1e-4f);
      EXPECT_LT(length(p.ns - expected), 1e-4f);
    }
  }
}

TEST(SdfGrid, BallsAreNearlyRound) {
  for (const bool smooth : {true, false}) {
    const auto shape = grid_shape({48, 48, 48}, distance_to_ball,
                                  {{"normals", std::string(smooth ? "smooth" : "analytic"), {}}});
    EXPECT_FALSE(shape->can_sample());
    EXPECT_NEAR(shape->area(), 4 * pi * sqr(0.35f), 0.02f);
    const auto tracer = tracer_of({shape});
    Random random(54);
    double bend = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3f outward = random.direction(), middle(0.5f, 0.5f, 0.5f);
      Hit hit;
      const Ray ray{middle + outward * 3.0f, -outward, infinity};
      ASSERT_TRUE(tracer->intersect(ray, hit));
      const SurfacePoint p = tracer->surface_point(ray, hit);
      EXPECT_NEAR(length(p.position - middle), 0.35f, 1e-3f);
      EXPECT_GT(dot(p.ng, outward), 0.99f);
      bend += double(length(p.ns - outward));
      // From inside it is met as well, wherever one looks.
      const Ray inside{middle + random.in_box(0.1f), random.direction(), infinity};
      ASSERT_TRUE(tracer->intersect(inside, hit));
      EXPECT_GT(dot(tracer->surface_point(inside, hit).ng, inside.direction), 0);
    }
    // Blended normals are nearer to those of the ball than those of cells.
    if (smooth)
      EXPECT_LT(bend / 2000, 0.004);
    else
      EXPECT_GT(bend / 2000, 0.004);
  }
}

TEST(SdfGrid, RaysThatLeaveDoNotMeetItAgain) {
  Random random(55);
  for (const double scale : {1e-4, 1.0, 1e5}) {
    const auto shape =
        grid_shape({24, 24, 24}, distance_to_ball, {{"to_world", placement(scale), {}}});
    const auto tracer = tracer_of({shape});
    const Vec3f middle = center(shape->bounds());
    const float size = bounding_radius(shape->bounds());
    int again = 0, points = 0;
    for (int i = 0; i < 6000 / samples_divisor; ++i) {
      const Vec3f origin = middle + random.direction() * (3 * size);
      const Ray ray{origin, middle + random.in_box(0.3f * size) - origin, infinity};
      Hit hit;
      if (!tracer->intersect(ray, hit)) continue;
      ++points;
      const SurfacePoint p = tracer->surface_point(ray, hit);
      EXPECT_LT(max_abs(offset_origin(p, p.ng) - p.position),
                1e-4f * size + 32 * float_rounding * max_abs(p.position));
      const Vec3f direction = normalize(p.ng + random.direction() * 0.95f);
      // Between cells the surface is a little concave: farther on it may be met.
      Hit other;
      again += tracer->intersect(spawn_ray(p, direction), other) && other.t < 1e-4f * size;
    }
    EXPECT_GT(points, 600 / samples_divisor);
    EXPECT_EQ(again, 0) << scale;
  }
}

TEST(SdfGrid, TellsWhatIsWrong) {
  const auto message = [](const std::array<int, 3>& size,
                          const std::function<double(const Vec3d&)>& value) -> std::string {
    try {
      grid_shape(size, value);
    } catch (const Error& error) {
      EXPECT_FALSE(error.problems()[0].remedy.empty());
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message({1, 4, 4}, [](const Vec3d&) { return 1.0; }).find("flat"), std::string::npos);
  EXPECT_NE(message({4, 4, 4}, [](const Vec3d&) { return 1.0; }).find("no surface"),
            std::string::npos);
  EXPECT_NE(message({4, 4, 4}, [](const Vec3d&) { return std::nan(""); }), "");
  EXPECT_THROW(make_shape("sdfgrid"), Error);
  EXPECT_THROW(
      make_shape("sdfgrid",
                 {{"grid", Value(Array::of<float>({2, 2, 2, 3}, std::vector<float>(24, -1))), {}}}),
      Error);
}

}  // namespace
}  // namespace kaustik::test
