// Solid bodies that overlap: which parts of their surfaces are there, and what is around them.

#include "tests/geometry/geometry_support.h"

namespace kaustik {
namespace {

using namespace test;

std::shared_ptr<const Shape> cube_of(const Vec3d& half, const Vec3d& center) {
  return make_shape("cube",
                    {{"to_world", Transform::translate(center) * Transform::scale(half), {}}});
}
std::shared_ptr<const Shape> ball_of(double radius, const Vec3d& center) {
  return make_shape("sphere", {{"radius", radius, {}}, {"center", center, {}}});
}

/// What is known of the place of a body by its formula.
struct Known {
  std::shared_ptr<const Shape> shape;
  std::function<bool(const Vec3f&)> contains;
};

Known cube(float half, const Vec3f& center) {
  return {cube_of(Vec3d(half), Vec3d(center)),
          [=](const Vec3f& p) { return max_abs(p - center) < half; }};
}
Known ball(float radius, const Vec3f& center) {
  return {ball_of(radius, Vec3d(center)),
          [=](const Vec3f& p) { return length(p - center) < radius; }};
}

/// The part that a point of body `of` belongs to, by the formulas; −1: in the open.
int expected_part(const std::vector<Known>& known, const std::vector<uint32_t>& order,
                  const RayTracer& tracer, uint32_t of, const Vec3f& position) {
  bool wins = false;
  for (const uint32_t other : order) {
    if (other == of) {
      wins = true;
      continue;
    }
    if (!known[other].contains(position)) continue;
    for (size_t i = 0; i < tracer.body_parts().size(); ++i) {
      const BodyPart& part = tracer.body_parts()[i];
      if (part.shape == of && (wins ? !part.is_hidden && part.around == other : part.is_hidden))
        return int(i);
    }
    ADD_FAILURE() << "no such part";
  }
  return -1;
}

void expect_parts(const std::vector<Known>& known, const std::vector<uint32_t>& order) {
  Geometry geometry;
  for (const Known& body : known) geometry.shapes.push_back(body.shape);
  geometry.bodies = order;
  const RayTracer tracer(geometry);
  Random random(1);
  int hidden = 0, within = 0, open = 0;
  for (int i = 0; i < 20000 / samples_divisor; ++i) {
    Ray ray{random.in_box(3), random.direction(), infinity};
    Hit hit;
    for (int layer = 0; layer < 8 && tracer.intersect(ray, hit); ++layer) {
      const SurfacePoint point = tracer.surface_point(ray, hit);
      const int part = int(point.shape) - int(tracer.shape_count());
      ASSERT_EQ(std::max(part, -1), expected_part(known, order, tracer, hit.shape, point.position))
          << "shape " << hit.shape << " at " << point.position;
      if (part < 0)
        ++open;
      else
        ++(tracer.body_parts()[size_t(part)].is_hidden ? hidden : within);
      EXPECT_EQ(&tracer.shape(point.shape), known[hit.shape].shape.get());
      ray = spawn_ray(point, ray.direction);
      hit = {};
    }
  }
  EXPECT_GT(hidden, 100 / samples_divisor);
  EXPECT_GT(within, 100 / samples_divisor);
  EXPECT_GT(open, 100 / samples_divisor);
}

TEST(SolidBodies, AreCutWhereTheyOverlap) {
  expect_parts({cube(1, {0, 0, 0}), ball(1, {1, 0.2f, 0})}, {0, 1});
  expect_parts({cube(1, {0, 0, 0}), ball(1, {1, 0.2f, 0})}, {1, 0});
}

TEST(SolidBodies, MayNestAndOverlapByThrees) {
  const std::vector<Known> three = {ball(1.5f, {0, 0, 0}), cube(0.8f, {0.1f, 0, 0}),
                                    ball(0.9f, {0.7f, 0, 0.4f})};
  expect_parts(three, {1, 2, 0});
  expect_parts(three, {0, 1, 2});
  expect_parts(three, {2, 0, 1});
}

TEST(SolidBodies, ThatDoNotMeetAreLeftAlone) {
  Geometry geometry;
  geometry.shapes = {cube_of(Vec3d(1, 1, 1), Vec3d(0, 0, 0)), ball_of(1, Vec3d(5, 0, 0))};
  geometry.bodies = {0, 1};
  EXPECT_TRUE(RayTracer(geometry).body_parts().empty());
}

}  // namespace
}  // namespace kaustik
