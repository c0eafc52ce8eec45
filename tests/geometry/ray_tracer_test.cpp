#include "kaustik/geometry/ray_tracer.h"

#include <algorithm>
#include <cstring>

#include "geometry_support.h"
#include "kaustik/base/parallel.h"
#include "tests/support/type_rows.h"

namespace kaustik::test {
namespace {

/// A bumpy ball with vertex normals and texture coordinates.
std::shared_ptr<const Shape> bumpy_ball(int level) {
  TriangleMesh mesh = make_shape("sphere")->tessellate(level);
  for (Vec3f& p : mesh.positions) p *= 1 + 0.1f * std::sin(9 * p.x) * std::cos(7 * p.y);
  mesh.normals = smooth_normals(mesh);
  for (const Vec3f& p : mesh.positions) mesh.uvs.emplace_back(p.x, p.y);
  return std::make_shared<MeshShape>(std::move(mesh));
}

Ray random_ray(Random& random, const RayTracer& tracer) {
  const Bounds3f box = tracer.bounds();
  const Vec3f origin = center(box) + random.direction() * bounding_radius(box);
  return {origin, normalize(center(box) + random.in_box(0.5f) * bounding_radius(box) - origin),
          infinity};
}

TEST(RayTracer, ClosestAndAnyHitRespectTheRange) {
  const auto tracer =
      tracer_of({make_shape("rectangle"), make_shape("sphere", {{"center", Vec3d(0, 0, 3), {}}})});
  Hit hit;
  ASSERT_TRUE(tracer->intersect({{0, 0, 10}, {0, 0, -1}, infinity}, hit));
  EXPECT_EQ(hit.shape, 1u);
  EXPECT_FLOAT_EQ(hit.t, 6);
  EXPECT_EQ(hit.instance, no_instance);
  EXPECT_FALSE(tracer->intersect({{0, 0, 10}, {0, 0, -1}, 5.9f}, hit));
  EXPECT_FALSE(tracer->occluded({{0, 0, 10}, {0, 0, -1}, 5.9f}));
  EXPECT_TRUE(tracer->occluded({{0, 0, 10}, {0, 0, -1}, 6.1f}));
  ASSERT_TRUE(tracer->intersect({{0.2f, 0.1f, 1}, {0, 0, -1}, infinity}, hit));
  EXPECT_EQ(hit.shape, 0u);
  // An origin on the surface itself is not in (0, t_max).
  EXPECT_FALSE(tracer->occluded({{0.2f, 0.1f, 0}, {0, 0, -1}, infinity}));
  // Distances count in the direction's length.
  ASSERT_TRUE(tracer->intersect({{0, 0, 10}, {0, 0, -2}, infinity}, hit));
  EXPECT_FLOAT_EQ(hit.t, 3);
  EXPECT_FALSE(tracer->intersect({{0, 0, 10}, {0, 0, 1}, infinity}, hit));
  EXPECT_EQ(tracer->shape_count(), 2u);
  EXPECT_GT(tracer->size_in_bytes(), 0u);
  EXPECT_NE(tracer->embree_scene(), nullptr);
}

TEST(RayTracer, EmptySceneIsNeverHit) {
  const auto tracer = tracer_of({});
  Hit hit;
  EXPECT_FALSE(tracer->intersect({{0, 0, 0}, {0, 0, 1}, infinity}, hit));
  EXPECT_FALSE(tracer->occluded({{0, 0, 0}, {0, 0, 1}, infinity}));
  EXPECT_FALSE(tracer->bounds().isEmpty());  // lamps far away need a size of the scene
}

/// A search for the pieces near a point, which ends after `most`.
std::vector<SurfacePiece> pieces_near(const RayTracer& tracer, const Vec3f& center, float radius,
                                      size_t most = 1000) {
  struct Found {
    std::vector<SurfacePiece> pieces;
    size_t most;
  } found{{}, most};
  const auto take = [](void* context, const SurfacePiece& piece) {
    Found& to = *static_cast<Found*>(context);
    to.pieces.push_back(piece);
    return to.pieces.size() < to.most;
  };
  tracer.pieces_near(center, radius, {take, &found});
  return found.pieces;
}

TEST(RayTracer, PiecesNearAPoint) {
  Geometry geometry;
  geometry.shapes = {make_shape("rectangle"),
                     make_shape("sphere", {{"center", Vec3d(0, 0, 3), {}}})};
  geometry.groups = {{make_shape("rectangle")}};
  geometry.instances = {{0, Transform::translate({0, 0, -9}) * Transform::scale({2, 2, 2})}};
  const RayTracer tracer(std::move(geometry));
  // What lies farther may be among them, where there is little of it.
  const auto boxes = [&](const Vec3f& center, float radius) {
    const auto pieces = pieces_near(tracer, center, radius);
    return std::count_if(pieces.begin(), pieces.end(),
                         [](const SurfacePiece& piece) { return piece.is_box; });
  };
  const auto triangles_at = [&](const Vec3f& center, float radius, float z) {
    const auto pieces = pieces_near(tracer, center, radius);
    return std::count_if(pieces.begin(), pieces.end(), [&](const SurfacePiece& piece) {
      return !piece.is_box && piece.corners[0].z == z && piece.corners[1].z == z &&
             piece.corners[2].z == z;
    });
  };
  EXPECT_EQ(triangles_at({0.1f, -0.2f, 0.1f}, 0.3f, 0), 2);
  EXPECT_EQ(pieces_near(tracer, {0.1f, -0.2f, 0.1f}, 0.3f, 1).size(), 1u);
  EXPECT_EQ(boxes({0, 0, 4.5f}, 0.6f), 1);
  // In the world, twice as large.
  EXPECT_EQ(triangles_at({1.5f, 1.5f, -9}, 0.9f, -9), 2);
}

TEST(RayTracer, MeshPointsInterpolateTheirVertices) {
  const auto shape = bumpy_ball(4);
  const auto tracer = tracer_of({shape});
  const TriangleMesh& mesh = *shape->mesh();
  Random random(41);
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = random_ray(random, *tracer);
    Hit hit;
    if (!tracer->intersect(ray, hit)) continue;
    const SurfacePoint p = tracer->surface_point(ray, hit);
    EXPECT_LT(length(ray.origin + ray.direction * hit.t - p.position), 1e-5f);
    EXPECT_GT(dot(p.ng, normalize(hit.ng)), 0.9999f);
    EXPECT_NEAR(length(p.ns), 1, 1e-5f);
    EXPECT_NEAR(p.uv.x, p.position.x, 1e-5f);  // texture coordinates are x and y here
    EXPECT_NEAR(p.uv.y, p.position.y, 1e-5f);
    // Along ∂p/∂u the texture's u, here x, changes by as much; across it v stays.
    const UvDerivatives d = tracer->uv_derivatives(p);
    if (length(d.dpdu) > 0 && length(d.dpdu) < 100 && length(d.dpdv) < 100) {
      EXPECT_NEAR(d.dpdu.x, 1, 2e-3f);
      EXPECT_NEAR(d.dpdu.y, 0, 2e-3f);
      EXPECT_NEAR(d.dpdv.x, 0, 2e-3f);
      EXPECT_NEAR(d.dpdv.y, 1, 2e-3f);
    }
    const auto& t = mesh.triangles[hit.primitive];
    EXPECT_NEAR(dot(p.ng, mesh.positions[t[1]] - mesh.positions[t[0]]), 0, 1e-5f);
  }
}

TEST(RayTracer, VerticesWithoutRoomBehindThemAreCopied) {
  class Bare : public Shape {
   public:
    Bare() {
      mesh_.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
      mesh_.positions.shrink_to_fit();
      mesh_.triangles = {{0, 1, 2}};
    }
    Bounds3f bounds() const override { return {{0, 0, 0}, {1, 1, 0}}; }
    float area() const override { return 0.5f; }
    const TriangleMesh* mesh() const override { return &mesh_; }
    SurfacePoint surface_point(const Ray&, const Hit&) const override { return {}; }
    ShapeSample sample_area(const Vec2f&) const override { return {}; }
    TriangleMesh tessellate(int) const override { return mesh_; }

   private:
    TriangleMesh mesh_;
  };
  const auto tracer = tracer_of({std::make_shared<Bare>()});
  EXPECT_TRUE(tracer->occluded({{0.2f, 0.2f, 1}, {0, 0, -1}, infinity}));
  EXPECT_FALSE(tracer->occluded({{0.9f, 0.9f, 1}, {0, 0, -1}, infinity}));
}

/// The group of all kinds of shapes that the instances below place.
std::vector<std::shared_ptr<const Shape>> group_shapes(const Transform& to_world) {
  const auto placed = [&](const char* type, const Vec3d& where) {
    return make_shape(type, {{"to_world", to_world * Transform::translate(where), {}}});
  };
  std::vector<std::shared_ptr<const Shape>> shapes = {
      placed("sphere", {0, 0, 0}), placed("cube", {3, 0, 0}), placed("cylinder", {0, 3, 0}),
      placed("disk", {3, 3, 0})};
  TriangleMesh ball = bumpy_ball(3)->tessellate(0);
  for (Vec3f& p : ball.positions) p = to_world.point(p + Vec3f(0, 0, 3));
  for (Vec3f& n : ball.normals) n = normalize(to_world.normal(n));
  shapes.push_back(std::make_shared<MeshShape>(std::move(ball)));
  return shapes;
}

TEST(RayTracer, InstancesAreCopiesInTheirPlace) {
  const Transform first = placement(0.5), second = Transform::translate({-4, 5, 1}) * placement(2);
  const auto group = group_shapes(Transform());
  const auto floor = make_shape("rectangle", {{"to_world", Transform::scale({9, 9, 9}), {}}});
  const RayTracer instanced(Geometry{{floor}, {{floor}, group}, {{1, first}, {1, second}}});
  EXPECT_EQ(instanced.shape_count(), 2 + group.size());
  auto flat = group_shapes(first);
  for (const auto& shape : group_shapes(second)) flat.push_back(shape);
  flat.insert(flat.begin(), floor);
  const RayTracer copied(Geometry{flat, {}, {}});
  Random random(42);
  int hits = 0, differ = 0;
  for (int i = 0; i < 20000 / samples_divisor; ++i) {
    const Ray ray = random_ray(random, copied);
    Hit a, b;
    const bool hit_a = instanced.intersect(ray, a), hit_b = copied.intersect(ray, b);
    if (hit_a != hit_b || (hit_a && std::fabs(a.t - b.t) > 1e-3f)) {
      ++differ;  // at an edge
      continue;
    }
    if (!hit_a) continue;
    EXPECT_EQ(hit_a, instanced.occluded(ray));
    const SurfacePoint p = instanced.surface_point(ray, a), q = copied.surface_point(ray, b);
    EXPECT_LT(length(p.position - q.position), 2e-5f);
    EXPECT_GT(dot(p.ng, q.ng), 0.9999f);
    EXPECT_GT(dot(p.ns, q.ns), 0.999f);
    const UvDerivatives dp = instanced.uv_derivatives(p), dq = copied.uv_derivatives(q);
    EXPECT_LT(length(dp.dpdu - dq.dpdu), 1e-2f * (1 + length(dq.dpdu)));
    EXPECT_LT(length(dp.dpdv - dq.dpdv), 1e-2f * (1 + length(dq.dpdv)));
    EXPECT_NEAR(p.uv.x, q.uv.x, 1e-3f);
    if (a.instance == no_instance) {
      EXPECT_EQ(b.shape, 0u);
    } else {
      ++hits;
      EXPECT_EQ(b.shape, a.shape - 1 + a.instance * group.size());
      EXPECT_EQ(&instanced.shape(a.shape), group[a.shape - 2].get());
    }
  }
  EXPECT_GT(hits, 2000 / samples_divisor);
  EXPECT_LT(differ, 20);
}

TEST(RayTracer, RaysInPacketsMeetWhatSingleRaysMeet) {
  const Transform first = placement(0.5), second = Transform::translate({-4, 5, 1}) * placement(2);
  const auto floor = make_shape("rectangle", {{"to_world", Transform::scale({9, 9, 9}), {}}});
  const auto ball = bumpy_ball(4);
  const RayTracer tracer(
      Geometry{{floor, ball}, {group_shapes(Transform())}, {{0, first}, {0, second}}});
  Random random(44);
  int met = 0, instanced = 0, missed = 0, differ = 0;
  for (size_t round = 0; round < size_t(2000 / samples_divisor); ++round) {
    std::vector<Ray> rays(1 + round % 19);
    for (Ray& ray : rays) {
      ray = random_ray(random, tracer);
      if (random.uniform() < 0.2f) ray.t_max = 5;
    }
    std::vector<Hit> hits(rays.size());
    tracer.intersect(rays, hits);
    for (size_t i = 0; i < rays.size(); ++i) {
      Hit single;
      single.t = infinity;
      tracer.intersect(rays[i], single);
      if ((hits[i].t < infinity) != (single.t < infinity)) {
        ++differ;  // at an edge
        continue;
      }
      if (!(single.t < infinity)) {
        ++missed;
        continue;
      }
      if (hits[i].shape != single.shape || hits[i].instance != single.instance ||
          hits[i].primitive != single.primitive) {
        ++differ;
        continue;
      }
      ++met;
      instanced += single.instance != no_instance;
      const SurfacePoint a = tracer.surface_point(rays[i], hits[i]),
                         b = tracer.surface_point(rays[i], single);
      EXPECT_LT(length(a.position - b.position), 1e-4f);
      EXPECT_GT(dot(a.ng, b.ng), 0.9999f);
    }
  }
  EXPECT_GT(met, 5000 / samples_divisor);
  EXPECT_GT(instanced, 500 / samples_divisor);
  EXPECT_GT(missed, 500 / samples_divisor);
  EXPECT_LT(differ, 20);
}

TEST(RayTracer, SameHitsFromAnyNumberOfThreadsAndBuilds) {
  const auto shape = bumpy_ball(6);
  constexpr size_t rays = 20000;
  const auto trace = [&](int threads) {
    std::vector<Hit> hits(rays);
    with_threads(threads, [&] {
      const auto tracer = tracer_of({shape, make_shape("cylinder")});
      std::vector<Ray> all;
      Random random(43);
      for (size_t i = 0; i < rays; ++i) all.push_back(random_ray(random, *tracer));
      parallel_blocks(rays, 64, [&](size_t begin, size_t end, size_t) {
        for (size_t i = begin; i < end; ++i) tracer->intersect(all[i], hits[i]);
      });
    });
    return hits;
  };
  const auto one = trace(1), two = trace(2), again = trace(2);
  for (size_t i = 0; i < rays; ++i) {
    for (const Hit* other : {&two[i], &again[i]}) {
      ASSERT_EQ(one[i].t, other->t);
      ASSERT_EQ(one[i].u, other->u);
      ASSERT_EQ(one[i].v, other->v);
      ASSERT_EQ(one[i].primitive, other->primitive);
      ASSERT_EQ(one[i].shape, other->shape);
    }
  }
}

TEST(RayTracer, RegistryNamesEveryTypeOnce) { expect_rows_of("shape", shape_types()); }

}  // namespace
}  // namespace kaustik::test
