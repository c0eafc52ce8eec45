// Rays that leave a surface must not meet it again, at any scale, and must start right beside it.

#include "geometry_support.h"

namespace kaustik::test {
namespace {

constexpr int trials = 20000 / samples_divisor;

/// Unit direction on the given side of the surface, down to 10⁻⁵ above it.
Vec3f leaving_direction(Random& random, const Vec3f& normal) {
  const Frame frame(normal);
  const float z = random.uniform() < 0.5f ? random.magnitude(-5, 0) : random.uniform(0.0f, 1.0f);
  const float phi = random.uniform(0, 2 * pi), r = safe_sqrt(1 - z * z);
  return frame.to_world({r * std::cos(phi), r * std::sin(phi), std::max(z, 1e-5f)});
}

/// The point that a ray from `origin` through `target` finds on the scene.
bool find_point(const RayTracer& tracer, const Vec3f& origin, const Vec3f& target,
                SurfacePoint& point) {
  const Ray ray{origin, target - origin, infinity};
  Hit hit;
  if (!tracer.intersect(ray, hit)) return false;
  point = tracer.surface_point(ray, hit);
  return true;
}

struct Tally {
  int points = 0, self_hits = 0;
  double largest_offset_ulps = 0;
};

/// Leaves `point` to both sides. `magnitude`: of the coordinates that made it.
void leave(const RayTracer& tracer, const SurfacePoint& point, Random& random, float magnitude,
           bool both_sides, Tally& tally) {
  ++tally.points;
  for (const float side : {1.0f, -1.0f}) {
    if (side < 0 && !both_sides) break;
    const Vec3f direction = leaving_direction(random, point.ng * side);
    const Ray ray = spawn_ray(point, direction);
    Hit in_packet;
    tracer.intersect({&ray, 1}, {&in_packet, 1});
    if (tracer.occluded(ray) || in_packet.t < infinity) ++tally.self_hits;
    const Vec3f moved = offset_origin(point, direction) - point.position;
    tally.largest_offset_ulps =
        std::max(tally.largest_offset_ulps, double(length(moved)) / (double(magnitude) * 0x1p-23));
  }
}

/// Points of random triangles of one size, at one distance from the origin, of one slenderness.
Tally leave_triangles(float size, float distance, float slenderness, uint64_t seed) {
  Random random(seed);
  Tally tally;
  for (int i = 0; i < trials / 100; ++i) {
    const Vec3f a = random.direction() * distance;
    const Vec3f edge = random.direction() * size;
    const Vec3f b = a + edge;
    const Vec3f across = normalize(cross(edge, random.direction()));
    const Vec3f c = a + edge * random.uniform() + across * (size * slenderness);
    const float magnitude = std::max({max_abs(a), max_abs(b), max_abs(c)});
    const auto tracer = tracer_of({triangle_shape(a, b, c)});
    for (int j = 0; j < 100; ++j) {
      const Vec2f w = square_to_triangle(random.square());
      const Vec3f target = a * (1 - w.x - w.y) + b * w.x + c * w.y;
      const Vec3f origin = target + random.direction() * (size * random.magnitude(-2, 2));
      SurfacePoint point;
      if (find_point(*tracer, origin, target, point))
        leave(*tracer, point, random, magnitude, true, tally);
    }
  }
  return tally;
}

TEST(RobustOffset, TrianglesOfAnyScaleAndDistance) {
  uint64_t seed = 1;
  for (const float size : {1e-4f, 1.0f, 1e5f})
    for (const float distance : {0.0f, 1.0f, 1000.0f}) {
      const Tally tally = leave_triangles(size, size * distance, 0.5f, seed++);
      EXPECT_GT(tally.points, trials / 4) << size << ' ' << distance;
      EXPECT_EQ(tally.self_hits, 0) << size << ' ' << distance;
      EXPECT_LT(tally.largest_offset_ulps, 50) << size << ' ' << distance;
    }
}

TEST(RobustOffset, SlenderTriangles) {
  uint64_t seed = 100;
  for (const float slenderness : {1e-1f, 1e-2f, 1e-3f})
    for (const float distance : {0.0f, 10.0f}) {
      const Tally tally = leave_triangles(1.0f, distance, slenderness, seed++);
      EXPECT_GT(tally.points, trials / 10);
      EXPECT_EQ(tally.self_hits, 0) << slenderness << ' ' << distance;
    }
}

TEST(RobustOffset, WithoutItRaysDoMeetTheirSurface) {
  // What the tests above would see if the offset were lost.
  Random random(7);
  int self_hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3f a = random.direction(), b = random.direction(), c = random.direction();
    const auto tracer = tracer_of({triangle_shape(a, b, c)});
    SurfacePoint point;
    const Vec3f target = (a + b + c) * (1.0f / 3);
    if (!find_point(*tracer, target + random.direction(), target, point)) continue;
    point.error = 0;
    point.ng = Vec3f(0, 0, 0);
    self_hits += tracer->occluded(spawn_ray(point, random.direction()));
  }
  EXPECT_GT(self_hits, 10);
}

TEST(RobustOffset, AxisAlignedFloorMovesByOneStep) {
  const auto tracer =
      tracer_of({triangle_shape({-1e5f, -1e5f, 0}, {1e5f, -1e5f, 0}, {0, 1e5f, 0})});
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    SurfacePoint point;
    ASSERT_TRUE(find_point(*tracer, random.in_box(10) + Vec3f(0, 0, 20), random.in_box(1), point));
    EXPECT_LT(offset_origin(point, {0, 0, 1}).z, 1e-30f);
    EXPECT_FALSE(tracer->occluded(spawn_ray(point, leaving_direction(random, point.ng))));
  }
}

std::vector<Property> sphere_at(const Vec3f& center, float radius) {
  return {{"center", Vec3d(center), {}}, {"radius", double(radius), {}}};
}

TEST(RobustOffset, SpheresFromOutside) {
  Random random(11);
  for (const float radius : {1e-4f, 1.0f, 1e5f})
    for (const float distance : {0.0f, 1.0f, 1000.0f}) {
      Tally tally;
      for (int i = 0; i < trials / 100; ++i) {
        const Vec3f center = random.direction() * (distance * radius);
        const auto tracer = tracer_of({make_shape("sphere", sphere_at(center, radius))});
        for (int j = 0; j < 100; ++j) {
          SurfacePoint point;
          const Vec3f origin = center + random.direction() * (radius * random.magnitude(0.1f, 3));
          // Toward the silhouette half of the time.
          const Vec3f target =
              center + random.direction() * (radius * (j % 2 ? 0.99f : random.uniform()));
          if (find_point(*tracer, origin, target, point))
            leave(*tracer, point, random, max_abs(point.position), false, tally);
        }
      }
      EXPECT_GT(tally.points, trials / 4);
      EXPECT_EQ(tally.self_hits, 0) << radius << ' ' << distance;
      EXPECT_LT(tally.largest_offset_ulps, 8) << radius << ' ' << distance;
    }
}

TEST(RobustOffset, SpheresFromInsideMeetTheFarSideOnly) {
  Random random(12);
  for (const float radius : {1e-4f, 1.0f, 1e5f}) {
    const Vec3f center = random.direction() * (10 * radius);
    const auto shape = make_shape("sphere", sphere_at(center, radius));
    const auto tracer = tracer_of({shape});
    for (int i = 0; i < trials; ++i) {
      const SurfacePoint point = shape->sample_area(random.square()).point;
      const Vec3f direction = leaving_direction(random, -point.ng);
      const float chord = -2 * radius * dot(direction, point.ng);
      Hit hit;
      // Every ray ends at the far side; the chord is known up to the roundings of the position.
      ASSERT_TRUE(tracer->intersect(spawn_ray(point, direction), hit));
      const float slack = 40 * float_rounding * max_abs(point.position) * radius / chord;
      EXPECT_NEAR(hit.t, chord, 1e-4f * chord + 20 * slack) << radius;
    }
  }
}

TEST(RobustOffset, FlatAnalyticAndProceduralShapes) {
  Random random(13);
  for (const float scale : {1e-4f, 1.0f, 1e5f})
    for (const char* type : {"disk", "cylinder", "sdf", "rectangle", "cube"}) {
      const auto shape = make_shape(type, {{"to_world", placement(double(scale)), {}}});
      const auto tracer = tracer_of({shape});
      Tally tally;
      int early = 0;
      const int rays = std::string(type) == "sdf" ? trials / 20 : trials;
      for (int i = 0; i < rays; ++i) {
        SurfacePoint point;
        const Vec3f middle = center(shape->bounds());
        const float size = bounding_radius(shape->bounds());
        if (!find_point(*tracer, middle + random.direction() * (2 * size),
                        middle + random.in_box(0.5f * size), point))
          continue;
        ++tally.points;
        // Concave and hollow shapes may be hit elsewhere, but not right here.
        const Vec3f direction = normalize(point.ng + random.direction() * 0.9f);
        Hit hit;
        if (tracer->intersect(spawn_ray(point, direction), hit) && hit.t < 1e-4f * size) ++early;
        const float away = max_abs(offset_origin(point, direction) - point.position);
        EXPECT_LT(away, 1e-4f * size + 32 * float_rounding * max_abs(point.position));
      }
      EXPECT_GT(tally.points, rays / 20) << type;
      // Inner edges of the Menger sponge are real neighbours.
      EXPECT_LE(early, std::string(type) == "sdf" ? tally.points / 100 : 0) << type << ' ' << scale;
    }
}

TEST(RobustOffset, UnevenSpheresAndCylinders) {
  Random random(16);
  for (const float scale : {1e-4f, 1.0f, 1e5f})
    for (const double flatness : {0.5, 1e-2, 1e-4})
      for (const char* type : {"sphere", "cylinder"}) {
        const Transform place = placement(double(scale)) * Transform::scale({1.0, flatness, 1.5});
        const auto shape = make_shape(type, {{"to_world", place, {}}});
        const auto tracer = tracer_of({shape});
        Tally tally;
        for (int i = 0; i < trials / 10; ++i) {
          const SurfacePoint target = shape->sample_area(random.square()).point;
          const Vec3f from =
              target.position + random.direction() * (scale * random.uniform(0.1f, 9));
          SurfacePoint point;
          if (!find_point(*tracer, from, target.position, point)) continue;
          // From a cylinder's inside its far side is met.
          const bool is_inside = dot(point.ng, from - point.position) < 0;
          if (is_inside) continue;
          leave(*tracer, point, random, max_abs(point.position), false, tally);
        }
        EXPECT_GT(tally.points, trials / 100) << type << ' ' << flatness;
        EXPECT_EQ(tally.self_hits, 0) << type << ' ' << scale << ' ' << flatness;
        EXPECT_LT(tally.largest_offset_ulps, 8) << type << ' ' << scale << ' ' << flatness;
      }
}

TEST(RobustOffset, ShadowRaysBetweenSurfacesAreFree) {
  Random random(14);
  for (const float scale : {1e-4f, 1.0f, 1e5f})
    for (const float shift : {0.0f, 1000.0f}) {
      const Vec3f far = Vec3f(1, 1, 1) * (shift * scale);
      const Transform place = Transform::translate(Vec3d(far)) * Transform::rotate({1, 1, 0}, 40) *
                              Transform::scale(Vec3d(scale, scale, scale));
      const Transform lamp_place =
          place * Transform::translate({0.2, 0.3, 2.0}) * Transform::rotate({0, 1, 0}, 170);
      const auto floor = make_shape("rectangle", {{"to_world", place, {}}});
      const auto lamp = make_shape("rectangle", {{"to_world", lamp_place, {}}});
      const auto ball =
          make_shape("sphere", {{"to_world", place * Transform::translate({5, 0, 2}), {}}});
      const auto tracer = tracer_of({floor, lamp, ball});
      int blocked = 0;
      for (int i = 0; i < trials; ++i) {
        const SurfacePoint from = floor->sample_area(random.square()).point;
        const SurfacePoint to = lamp->sample_area(random.square()).point;
        blocked += tracer->occluded(spawn_ray_to(from, to));
        const SurfacePoint on_ball = ball->sample_area(random.square()).point;
        if (dot(on_ball.ng, from.position - on_ball.position) > 0)
          blocked += tracer->occluded(spawn_ray_to(from, on_ball));
      }
      EXPECT_EQ(blocked, 0) << scale << ' ' << shift;
    }
}

TEST(RobustOffset, InstancedTriangles) {
  Random random(15);
  for (const float scale : {1e-4f, 1.0f, 1e5f})
    for (int i = 0; i < 20; ++i) {
      const auto shape =
          triangle_shape(random.direction() * 3.0f, random.direction(), random.direction());
      const Transform place = Transform::translate(Vec3d(random.direction() * (scale * 10))) *
                              Transform::rotate(Vec3d(random.direction()), 70) *
                              Transform::scale({scale * 0.5, scale * 1.5, scale * -1.0});
      const RayTracer tracer(Geometry{{}, {{shape}}, {{0, place}}});
      for (int j = 0; j < trials / 100; ++j) {
        const Vec2f w = square_to_triangle(random.square());
        const TriangleMesh& mesh = *shape->mesh();
        const Vec3f target = place.point(mesh.positions[0] * (1 - w.x - w.y) +
                                         mesh.positions[1] * w.x + mesh.positions[2] * w.y);
        SurfacePoint point;
        if (!find_point(tracer, target + random.direction() * scale, target, point)) continue;
        EXPECT_EQ(point.instance, 0u);
        Tally tally;
        leave(tracer, point, random, max_abs(point.position), true, tally);
        EXPECT_EQ(tally.self_hits, 0);
        EXPECT_LT(max_abs(offset_origin(point, point.ng) - point.position), 1e-3f * scale);
      }
    }
}

}  // namespace
}  // namespace kaustik::test
