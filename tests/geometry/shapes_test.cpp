// Each shape against its tessellation and its closed forms.

#include <filesystem>
#include <fstream>

#include "geometry_support.h"
#include "kaustik/geometry/sdf_field.h"

namespace kaustik::test {
namespace {

struct ShapeCase {
  const char* name;
  const char* type;
  std::vector<Property> properties;
};

std::vector<ShapeCase> shape_cases() {
  const Transform odd = placement(1.7);
  const Transform mirrored = placement(0.6) * Transform::scale({1, 1, -1});
  const Transform uneven = placement() * Transform::scale({2.0, 0.5, 1.0});
  const double rows[4][4] = {{1, 0.4, -0.3, 0}, {0, 0.8, 0.6, 0}, {0.2, 0, 1.3, 0}, {0, 0, 0, 1}};
  const Transform sheared = placement(0.8) * Transform(rows);
  const Transform taller = placement() * Transform::scale({0.7, 0.7, 2.5});
  return {
      {"rectangle", "rectangle", {{"to_world", uneven, {}}}},
      {"cube", "cube", {{"to_world", uneven, {}}}},
      {"cube mirrored", "cube", {{"to_world", mirrored, {}}}},
      {"disk", "disk", {{"to_world", odd, {}}}},
      {"ellipse", "disk", {{"to_world", uneven, {}}}},
      {"sphere",
       "sphere",
       {{"center", Vec3d(1, 2, 3), {}}, {"radius", 0.7, {}}, {"to_world", odd, {}}}},
      {"sphere mirrored", "sphere", {{"to_world", mirrored, {}}}},
      {"ellipsoid",
       "sphere",
       {{"center", Vec3d(1, 2, 3), {}}, {"radius", 0.7, {}}, {"to_world", uneven, {}}}},
      {"ellipsoid sheared", "sphere", {{"to_world", sheared, {}}}},
      {"ellipsoid mirrored",
       "sphere",
       {{"to_world", sheared * Transform::scale({-1.0, 2, 1}), {}}}},
      {"ellipsoid flipped", "sphere", {{"to_world", sheared, {}}, {"flip_normals", true, {}}}},
      {"disk sheared", "disk", {{"to_world", sheared, {}}}},
      {"sphere flipped", "sphere", {{"flip_normals", true, {}}}},
      {"cylinder",
       "cylinder",
       {{"p0", Vec3d(1, 0, 0), {}},
        {"p1", Vec3d(1, 2, 1), {}},
        {"radius", 0.5, {}},
        {"to_world", odd, {}}}},
      {"cylinder mirrored", "cylinder", {{"to_world", mirrored, {}}}},
      {"cylinder taller", "cylinder", {{"to_world", taller, {}}, {"radius", 0.6, {}}}},
      {"cylinder uneven", "cylinder", {{"to_world", uneven, {}}, {"radius", 0.6, {}}}},
      {"cylinder sheared",
       "cylinder",
       {{"p1", Vec3d(1, 2, 1), {}}, {"radius", 0.5, {}}, {"to_world", sheared, {}}}},
      {"cylinder sheared and mirrored",
       "cylinder",
       {{"to_world", sheared * Transform::scale({1.0, -1, 2}), {}}}},
      {"cylinder sheared and flipped",
       "cylinder",
       {{"to_world", sheared, {}}, {"flip_normals", true, {}}}},
      {"cylinder flipped", "cylinder", {{"flip_normals", true, {}}}},
      {"thin cylinder", "cylinder", {{"p1", Vec3d(3, 2, 1), {}}, {"radius", 0.001, {}}}},
  };
}

double mesh_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles)
    area += 0.5 * double(length(cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                      mesh.positions[t[2]] - mesh.positions[t[0]])));
  return area;
}

class EveryShape : public testing::TestWithParam<size_t> {
 protected:
  ShapeCase test_case() const { return shape_cases()[GetParam()]; }
  std::shared_ptr<const Shape> shape() const {
    return make_shape(test_case().type, test_case().properties);
  }
};

TEST_P(EveryShape, AgreesWithItsTessellation) {
  const auto exact = shape();
  const auto tracer = tracer_of({exact});
  const auto facets = tracer_of({std::make_shared<MeshShape>(exact->tessellate(6))});
  const Bounds3f box = exact->bounds();
  const float size = bounding_radius(box);
  Random random(GetParam());
  int both = 0, differ = 0;
  const int rays = 20000 / samples_divisor;
  for (int i = 0; i < rays; ++i) {
    const ShapeSample target = exact->sample_area(random.square());
    const Vec3f origin = center(box) + random.direction() * (3 * size);
    const Ray ray{origin, target.point.position - origin + random.in_box(0.05f * size), infinity};
    Hit a, b;
    const bool hit_a = tracer->intersect(ray, a), hit_b = facets->intersect(ray, b);
    EXPECT_EQ(hit_a, tracer->occluded(ray));
    if (hit_a != hit_b) {
      ++differ;
      continue;
    }
    if (!hit_a) continue;
    const SurfacePoint p = tracer->surface_point(ray, a), q = facets->surface_point(ray, b);
    if (length(p.position - q.position) > 0.02f * size) {
      ++differ;
      continue;
    }
    ++both;
    EXPECT_GT(dot(p.ng, q.ng), 0.99f) << test_case().name;
    EXPECT_NEAR(length(p.ng), 1, 1e-5f);
    EXPECT_GT(dot(p.ng, a.ng), 0);
    EXPECT_GE(dot(p.ng, p.ns), 0);
    const UvDerivatives d = tracer->uv_derivatives(p);
    EXPECT_NEAR(dot(d.dpdu, p.ng), 0, 1e-4f * length(d.dpdu));
    EXPECT_NEAR(dot(d.dpdv, p.ng), 0, 1e-4f * length(d.dpdv));
    EXPECT_LT(length(p.position - (ray.origin + ray.direction * a.t)), 1e-5f * (size + 10));
  }
  const bool thin = test_case().name == std::string("thin cylinder");
  EXPECT_GT(both, thin ? 0 : rays / 4);
  EXPECT_LT(differ, rays / 100);
}

TEST_P(EveryShape, AreaIsThatOfItsTessellation) {
  const auto exact = shape();
  EXPECT_NEAR(double(exact->area()), mesh_area(exact->tessellate(7)), 1e-3 * double(exact->area()))
      << test_case().name;
  EXPECT_LE(mesh_area(exact->tessellate(0)), double(exact->area()) * (1 + 1e-5));
}

TEST_P(EveryShape, BoxesHoldTheSurface) {
  const auto exact = shape();
  for (const int budget : {1, 2, 7, 64, 500}) {
    const auto boxes = exact->bounding_boxes(budget);
    EXPECT_LE(boxes.size(), size_t(budget) + size_t(budget) / 4) << test_case().name;
    ASSERT_FALSE(boxes.empty());
    Random random(GetParam() + 50);
    for (int i = 0; i < 5000 / samples_divisor; ++i) {
      const Vec3f p = exact->sample_area(random.square()).point.position;
      EXPECT_TRUE(exact->bounds().intersects(p));
      bool inside = false;
      for (const Bounds3f& box : boxes) inside |= box.intersects(p);
      ASSERT_TRUE(inside) << test_case().name << " budget " << budget;
    }
  }
}

TEST_P(EveryShape, BoxesGetTight) {
  const auto boxes = shape()->bounding_boxes(400);
  double area = 0;
  for (const Bounds3f& box : boxes) area += double(surface_area(box));
  // A box around a flat patch of random orientation has a few times its area.
  EXPECT_LT(area, 16.0 * double(shape()->area())) << test_case().name;
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::Range(size_t(0), shape_cases().size()),
                         [](const auto& tested) {
                           std::string name = shape_cases()[tested.param].name;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST(Shapes, ClosedFormAreas) {
  EXPECT_FLOAT_EQ(make_shape("rectangle")->area(), 4);
  EXPECT_FLOAT_EQ(make_shape("cube")->area(), 24);
  EXPECT_FLOAT_EQ(make_shape("disk")->area(), pi);
  EXPECT_FLOAT_EQ(make_shape("sphere", {{"radius", 2.0, {}}})->area(), 16 * pi);
  EXPECT_FLOAT_EQ(make_shape("cylinder", {{"p1", Vec3d(0, 0, 3), {}}})->area(), 6 * pi);
}

SurfacePoint seen_along(const Shape& shape, const Vec3f& origin, const Vec3f& direction) {
  const std::shared_ptr<const Shape> borrowed(&shape, [](const Shape*) {});
  const auto tracer = tracer_of({borrowed});
  Hit hit;
  const Ray ray{origin, direction, infinity};
  EXPECT_TRUE(tracer->intersect(ray, hit));
  return tracer->surface_point(ray, hit);
}

TEST(Shapes, MitsubaConventions) {
  const SurfacePoint r = seen_along(*make_shape("rectangle"), {0.5f, -0.5f, 1}, {0, 0, -1});
  EXPECT_EQ(r.ng, Vec3f(0, 0, 1));
  EXPECT_NEAR(r.uv.x, 0.75f, 1e-6f);
  EXPECT_NEAR(r.uv.y, 0.25f, 1e-6f);
  EXPECT_NEAR(make_shape("rectangle")->uv_derivatives(r).dpdu.x, 2, 1e-6f);
  const SurfacePoint flipped =
      seen_along(*make_shape("rectangle", {{"flip_normals", true, {}}}), {0, 0, 1}, {0, 0, -1});
  EXPECT_EQ(flipped.ng, Vec3f(0, 0, -1));
  // Mirroring leaves +z the front.
  const SurfacePoint mirrored =
      seen_along(*make_shape("rectangle", {{"to_world", Transform::scale({-1, 1, 1}), {}}}),
                 {0, 0, 1}, {0, 0, -1});
  EXPECT_EQ(mirrored.ng, Vec3f(0, 0, 1));

  const SurfacePoint s = seen_along(*make_shape("sphere"), {0, 5, 0}, {0, -1, 0});
  EXPECT_NEAR(s.uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(s.uv.y, 0.5f, 1e-6f);
  EXPECT_NEAR(make_shape("sphere")->uv_derivatives(s).dpdu.x, -2 * pi, 1e-4f);

  const SurfacePoint d = seen_along(*make_shape("disk"), {0, 0.5f, 1}, {0, 0, -1});
  EXPECT_NEAR(d.uv.x, 0.5f, 1e-6f);
  EXPECT_NEAR(d.uv.y, 0.25f, 1e-6f);
  EXPECT_EQ(d.ng, Vec3f(0, 0, 1));

  const SurfacePoint c = seen_along(*make_shape("cylinder"), {0, 5, 0.25f}, {0, -1, 0});
  EXPECT_NEAR(c.uv.x, 0.25f, 1e-6f);
  EXPECT_NEAR(c.uv.y, 0.25f, 1e-6f);
  EXPECT_NEAR(c.ng.y, 1, 1e-6f);

  const SurfacePoint k = seen_along(*make_shape("cube"), {-3, 0.2f, 0.3f}, {1, 0, 0});
  EXPECT_EQ(k.ng, Vec3f(-1, 0, 0));
}

TEST(Shapes, InsideOfSphereAndCylinderIsHit) {
  for (const char* type : {"sphere", "cylinder"}) {
    const SurfacePoint p = seen_along(*make_shape(type), {0, 0, 0.5f}, {1, 0, 0});
    EXPECT_GT(p.ng.x, 0.8f) << type;  // outward, seen from inside
    EXPECT_GT(p.position.x, 0.8f) << type;
  }
}

/// Of spheroids and of an ellipse.
TEST(Shapes, AreasUnderUnevenScalesAreClosedForms) {
  const auto area = [](const char* type, const Vec3d& scale) {
    return double(
        make_shape(type, {{"to_world", placement() * Transform::scale(scale), {}}})->area());
  };
  const double pi_d = std::numbers::pi;
  for (const double c : {1.3, 5.0, 1000.0}) {
    const double e = std::sqrt(1 - 1 / (c * c));
    const double prolate = 2 * pi_d * (1 + c / e * std::asin(e));
    const double oblate = 2 * pi_d * (1 + std::atanh(e) / (c * c * e));
    EXPECT_NEAR(area("sphere", {1, 1, c}) / prolate, 1, 1e-6);
    EXPECT_NEAR(area("sphere", {1, c, 1}) / prolate, 1, 1e-6);
    EXPECT_NEAR(area("sphere", {1, 1, 1 / c}) / oblate, 1, 1e-6);
  }
  EXPECT_NEAR(area("cylinder", {2, 2, 3}), 12 * pi_d, 1e-5);
  // The circumference of an ellipse with half axes 1 and 2, by its series in
  // ((2 − 1) / (2 + 1))² = 1/9 (Ivory 1796).
  double series = 1, factor = 1;
  for (int n = 1; n < 20; ++n) {
    factor *= n == 1 ? 0.5 : (2.0 * n - 3) / (2 * n);
    series += factor * factor * std::pow(1.0 / 9, n);
  }
  EXPECT_NEAR(area("cylinder", {1, 2, 3}), 3 * 3 * pi_d * series, 1e-5);
  EXPECT_NEAR(area("disk", {1, 2, 3}), 2 * pi_d, 1e-5);
}

/// What is stretched is met where the stretched ray of the sphere meets it, with its texture
/// coordinates.
TEST(Shapes, UnevenScalesKeepTextureCoordinates) {
  const Transform stretch = Transform::scale({2.0, 0.25, 3.0});
  for (const char* type : {"sphere", "cylinder"}) {
    const auto original = tracer_of({make_shape(type)});
    const auto stretched = tracer_of({make_shape(type, {{"to_world", stretch, {}}})});
    Random random(5);
    int met = 0;
    for (int i = 0; i < 1000; ++i) {
      const Ray ray{random.direction() * 3.0f, {0, 0, 0}, infinity};
      Ray before = ray;
      before.direction = random.in_box(0.7f) - ray.origin;
      const Ray after{stretch.point(before.origin), stretch.vector(before.direction), infinity};
      Hit a, b;
      const bool is_met = original->intersect(before, a);
      if (is_met != stretched->intersect(after, b)) continue;  // at its outline
      if (!is_met) continue;
      ++met;
      const SurfacePoint p = original->surface_point(before, a);
      const SurfacePoint q = stretched->surface_point(after, b);
      EXPECT_NEAR(a.t, b.t, 1e-4f);
      EXPECT_LT(length(stretch.point(p.position) - q.position), 1e-4f) << type;
      EXPECT_GT(dot(normalize(stretch.normal(p.ng)), q.ng), 0.99999f) << type;
      EXPECT_NEAR(p.uv.x, q.uv.x, 1e-4f) << type;
      EXPECT_NEAR(p.uv.y, q.uv.y, 1e-4f) << type;
    }
    EXPECT_GT(met, 300) << type;
  }
}

TEST(Shapes, FlattenedToNothingIsAnError) {
  for (const char* type : {"sphere", "cylinder"}) {
    const Transform flat = Transform::scale({1, 1e-20, 1});
    try {
      make_shape(type, {{"to_world", flat, place_in("scene.xml", 7, 3)}});
      ADD_FAILURE() << type;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      EXPECT_EQ(error.problems()[0].place.line, 7);
    }
  }
  EXPECT_THROW(make_shape("cylinder", {{"p1", Vec3d(0, 0, 0), {}}}), Error);
  EXPECT_THROW(make_shape("sphere", {{"radius", -1.0, {}}}), Error);
}

// The procedural shape ------------------------------------------------------------------------

std::vector<Property> field(const char* name) {
  return {{"field", std::string(name), {}},
          {"iterations", int64_t(name == std::string("menger") ? 2 : 4), {}},
          {"to_world", placement(1.5), {}}};
}

TEST(SignedDistanceField, MengerFacesAndTunnels) {
  const auto tracer = tracer_of({make_shape("sdf", {{"iterations", int64_t(1), {}}})});
  Hit hit;
  // A corner cell is met at the face of the cube, the middle lets everything through.
  EXPECT_TRUE(tracer->intersect({{0.8f, 0.8f, 5}, {0, 0, -1}, infinity}, hit));
  EXPECT_NEAR(hit.t, 4, 1e-4f);
  EXPECT_NEAR(hit.ng.z, 1, 1e-4f);
  EXPECT_FALSE(tracer->intersect({{0.1f, 0.2f, 5}, {0, 0, -1}, infinity}, hit));
  // Down the tunnel to its wall at x = 1/3.
  EXPECT_TRUE(tracer->intersect({{0, 0, 0.7f}, {1, 0, 0}, infinity}, hit));
  EXPECT_NEAR(hit.t, 1.0f / 3, 1e-4f);
}

TEST(SignedDistanceField, AreaComesFromTheTessellation) {
  // The sponge of level 1: 72 squares of a third of the edge.
  const auto sponge = make_shape("sdf", {{"iterations", int64_t(1), {}}, {"size", 3.0, {}}});
  EXPECT_NEAR(sponge->area(), 72, 4);
}

TEST(SignedDistanceField, RefractedRaysLeaveTheInside) {
  const auto tracer = tracer_of({make_shape("sdf", {{"iterations", int64_t(1), {}}})});
  Hit hit;
  ASSERT_TRUE(tracer->intersect({{0.8f, 0.8f, 0.8f}, {0, 0, 1}, infinity}, hit));
  EXPECT_NEAR(hit.t, 0.2f, 1e-4f);
}

/// A ray that ends before the surface meets nothing, from inside and from outside, at any size.
TEST(SignedDistanceField, RaysEndBeforeTheSurface) {
  Random random(8);
  for (int i = 0; i < 2000; ++i) {
    const double size = std::pow(10, 4 * random.uniform() - 2);
    const auto sponge = make_shape("sdf", {{"iterations", int64_t(1), {}}, {"size", size, {}}});
    const auto half = float(0.5 * size);
    const float x = i % 2 == 0 ? 0.8f : 1.2f, way = 0.2f * half;
    const Ray ray{Vec3f(x, 0.8f, 0.8f) * half, {i % 2 == 0 ? 1.0f : -1.0f, 0, 0}, infinity};
    const auto meets = [&](float share) {
      Ray part = ray;
      part.t_max = share * way;
      return sponge->intersect(part).has_value();
    };
    EXPECT_FALSE(meets(0.9985f)) << size << ' ' << x;
    EXPECT_TRUE(meets(1.0015f)) << size << ' ' << x;
  }
}

/// From inside a ray passes nothing that is as wide as a step.
TEST(SignedDistanceField, RaysFromInsideStayInside) {
  for (const SdfField& field : {SdfField{SdfKind::menger, 8}, SdfField{SdfKind::mandelbulb, 4}}) {
    const bool is_menger = field.kind == SdfKind::menger;
    const auto shape = make_shape("sdf", {{"field", is_menger ? "menger" : "mandelbulb", {}},
                                          {"iterations", int64_t(field.iterations), {}}});
    const double step = is_menger ? 1e-4 : 1e-3;
    Random random(9);
    int rays = 0;
    while (rays < 100) {
      const auto coordinate = [&] { return 2 * random.uniform() - 1; };
      const Vec3d from(coordinate(), coordinate(), coordinate());
      const Vec3d way = Vec3d(coordinate(), coordinate(), coordinate()).normalized();
      if (field.value(from) > -1e-4) continue;
      ++rays;
      const auto hit = shape->intersect({Vec3f(from), Vec3f(way), infinity});
      ASSERT_TRUE(hit);
      const double t_hit = double(hit->t);
      EXPECT_GT(field.value(from + way * (t_hit + 2e-5)), -1e-5);
      double passed = 0;  // of what is not inside
      for (double t = 0; t < t_hit - 2e-5; t += 0.05 * step) {
        passed = field.value(from + way * t) > 1e-6 ? passed + 0.05 * step : 0;
        EXPECT_LT(passed, 1.2 * step);
      }
    }
  }
}

TEST(SignedDistanceField, HitsLieInItsBoxesAndNearItsTessellation) {
  for (const char* name : {"menger", "mandelbulb"}) {
    const auto shape = make_shape("sdf", field(name));
    const auto tracer = tracer_of({shape});
    const auto facets = tracer_of({std::make_shared<MeshShape>(shape->tessellate(2))});
    const auto boxes = shape->bounding_boxes(1000);
    EXPECT_LE(boxes.size(), 1000u);
    EXPECT_GT(boxes.size(), 50u);
    EXPECT_GT(shape->area(), 0);
    EXPECT_FALSE(shape->can_sample());
    const Vec3f middle = center(shape->bounds());
    const float size = bounding_radius(shape->bounds());
    Random random(5);
    int hits = 0, close = 0;
    for (int i = 0; i < 4000 / samples_divisor; ++i) {
      const Vec3f origin = middle + random.direction() * (2 * size);
      const Ray ray{origin, middle + random.in_box(0.5f * size) - origin, infinity};
      Hit hit, facet;
      if (!tracer->intersect(ray, hit)) continue;
      ++hits;
      const Vec3f p = tracer->surface_point(ray, hit).position;
      bool inside = false;
      for (const Bounds3f& box : boxes) inside |= box.intersects(p);
      EXPECT_TRUE(inside) << name;
      if (facets->intersect(ray, facet))
        close += length(ray.direction) * std::fabs(facet.t - hit.t) < 0.05f * size;
    }
    EXPECT_GT(hits, 500 / samples_divisor) << name;
    EXPECT_GT(close, hits * 3 / 4) << name;
  }
}

/// They are found by a part of the triangles, and hold all of them.
TEST(MeshBoxes, OfManyTrianglesAreTight) {
  constexpr int side = 200;
  TriangleMesh mesh;
  for (int y = 0; y <= side; ++y)
    for (int x = 0; x <= side; ++x) mesh.positions.emplace_back(float(x), float(y), 0.0f);
  // In an order that says nothing of the place.
  for (int i = 0; i < side * side; ++i) {
    const int cell = int(uint32_t(i) * 7919u % uint32_t(side * side));
    const auto a = uint32_t(cell / side * (side + 1) + cell % side), b = a + 1, c = a + side + 1;
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({b, c + 1, c});
  }
  const std::vector<Bounds3f> boxes = triangle_boxes(mesh, 64);
  EXPECT_LE(boxes.size(), 64u);
  EXPECT_GE(boxes.size(), 50u);
  double area = 0;
  for (const Bounds3f& box : boxes)
    area += double(box.max.x - box.min.x) * double(box.max.y - box.min.y);
  EXPECT_LT(area, 1.2 * side * side);  // neighbours share a row of cells
  for (const Vec3f& p : mesh.positions)
    EXPECT_TRUE(std::any_of(boxes.begin(), boxes.end(),
                            [&](const Bounds3f& box) { return box.intersects(p); }));
}

}  // namespace
}  // namespace kaustik::test
