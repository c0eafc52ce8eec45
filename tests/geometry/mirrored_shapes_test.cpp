// A shape that a transform mirrors is the mirror image of the shape: what was its front stays it.

#include "geometry_support.h"

namespace kaustik::test {
namespace {

struct Case {
  std::string name, type;
  std::vector<Property> properties;
};

const std::string cube_vertices =
    "v -1 -1 -1\nv -1 -1 1\nv -1 1 -1\nv -1 1 1\nv 1 -1 -1\nv 1 -1 1\nv 1 1 -1\nv 1 1 1\n";

/// The faces of a cube; `normal` goes behind each index.
std::string cube_faces(const std::string& normal) {
  const int faces[6][4] = {{1, 2, 4, 3}, {5, 7, 8, 6}, {1, 5, 6, 2},
                           {3, 4, 8, 7}, {1, 3, 7, 5}, {2, 6, 8, 4}};
  std::string text;
  for (const auto& face : faces) {
    text += "f";
    for (const int corner : face)
      text += " " + std::to_string(corner) + (normal.empty() ? "" : "//" + std::to_string(corner));
    text += "\n";
  }
  return text;
}

/// Normals of the cube's corners, times `factor`; zero from the first that has `none`.
std::string cube_normals(int factor, size_t none) {
  std::string text;
  for (size_t i = 0; i < 8; ++i) {
    text += "vn";
    for (const int axis : {0, 1, 2}) {
      const int sign = (i >> (2 - axis) & 1) != 0 ? factor : -factor;
      text += " " + std::to_string(i < none ? sign : 0);
    }
    text += "\n";
  }
  return text;
}

/// Files of cubes, and what can be made of them and without files.
class Cases {
 public:
  std::vector<Case> list() const {
    std::vector<Case> cases = {
        {"cube", "cube", {}},         {"rectangle", "rectangle", {}},
        {"disk", "disk", {}},         {"sphere", "sphere", {}},
        {"cylinder", "cylinder", {}}, {"sdf", "sdf", {{"iterations", int64_t(2), {}}}}};
    for (const TemporaryFile* file : {&flat_, &smooth_, &inward_, &partly_, &ply_})
      for (const bool face_normals : {false, true})
        cases.push_back({file->path(),
                         file == &ply_ ? "ply" : "obj",
                         {{"filename", file->path(), {}}, {"face_normals", face_normals, {}}}});
    const size_t count = cases.size();
    for (size_t i = 0; i < count; ++i) {
      if (cases[i].type == "sdf") continue;
      Case flipped = cases[i];
      flipped.name += " flipped";
      flipped.properties.push_back({"flip_normals", true, {}});
      cases.push_back(flipped);
    }
    return cases;
  }

 private:
  TemporaryFile flat_{cube_vertices + cube_faces(""), "flat.obj"};
  TemporaryFile smooth_{cube_vertices + cube_normals(1, 8) + cube_faces("n"), "smooth.obj"};
  /// Its normals contradict the order of the corners.
  TemporaryFile inward_{cube_vertices + cube_normals(-1, 8) + cube_faces("n"), "inward.obj"};
  /// Some faces have no normals.
  TemporaryFile partly_{cube_vertices + cube_normals(1, 4) + cube_faces("n"), "partly.obj"};
  TemporaryFile ply_{
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n",
      "tetrahedron.ply"};
};

std::shared_ptr<const Shape> shape_of(Case shape_case, const Transform& to_world) {
  shape_case.properties.push_back({"to_world", to_world, {}});
  return make_shape(shape_case.type, shape_case.properties);
}

/// How many of the rays that both meet find other normals on `image` than the mirror image of those
/// on `original`; fails where the rays seldom meet, or not at the same place.
int different_normals(const RayTracer& original, const RayTracer& image, const Transform& mirror,
                      const std::string& name) {
  const Vec3f middle = center(original.bounds());
  const float size = bounding_radius(original.bounds());
  Random random(7);
  int both = 0, apart = 0, different = 0;
  const int rays = 200;
  for (int i = 0; i < rays; ++i) {
    const Vec3f origin = middle + random.direction() * (3 * size);
    const Ray ray{origin, middle + random.in_box(0.4f * size) - origin, infinity};
    const Ray mirrored{mirror.point(ray.origin), mirror.vector(ray.direction), infinity};
    Hit a, b;
    const bool hit_a = original.intersect(ray, a), hit_b = image.intersect(mirrored, b);
    if (hit_a != hit_b || (hit_a && std::fabs(a.t - b.t) > 1e-3f)) ++apart;
    if (!hit_a || !hit_b) continue;
    ++both;
    const SurfacePoint p = original.surface_point(ray, a), q = image.surface_point(mirrored, b);
    if (dot(mirror.vector(p.ng), q.ng) < 0.99f || dot(mirror.vector(p.ns), q.ns) < 0.99f)
      ++different;
  }
  EXPECT_GT(both, rays / 10) << name;
  EXPECT_LE(apart, rays / 50) << name;
  return different;
}

const Transform mirrors[] = {Transform::scale({-1.0, 1.0, 1.0}), Transform::scale({1.0, 1.0, -1.0}),
                             Transform::scale({-1.0, -1.0, -1.0})};

TEST(MirroredShapes, AreMirrorImages) {
  const Cases cases;
  for (const Case& shape_case : cases.list())
    for (const Transform& mirror : mirrors) {
      const auto original = tracer_of({shape_of(shape_case, placement(0.8))});
      const auto image = tracer_of({shape_of(shape_case, mirror * placement(0.8))});
      EXPECT_LE(different_normals(*original, *image, mirror, shape_case.name), 4)
          << shape_case.name;
      // As tessellated, too.
      const auto facets = [&](const Transform& t) {
        return tracer_of({std::make_shared<MeshShape>(shape_of(shape_case, t)->tessellate(1))});
      };
      EXPECT_LE(different_normals(*facets(placement(0.8)), *facets(mirror * placement(0.8)), mirror,
                                  shape_case.name),
                4)
          << shape_case.name;
    }
}

TEST(MirroredShapes, InstancesAreMirrorImages) {
  const Cases cases;
  const auto placed = [](const Case& shape_case, const Transform& inner, const Transform& outer) {
    Geometry geometry;
    geometry.groups = {{shape_of(shape_case, inner)}};
    geometry.instances = {{0, outer}};
    return std::make_unique<RayTracer>(std::move(geometry));
  };
  for (const Case& shape_case : cases.list())
    for (const Transform& mirror : mirrors) {
      const auto original = placed(shape_case, placement(0.8), Transform());
      const auto image = placed(shape_case, placement(0.8), mirror);
      EXPECT_LE(different_normals(*original, *image, mirror, shape_case.name), 4)
          << shape_case.name;
      const auto twice = placed(shape_case, mirror * placement(0.8), mirror);
      EXPECT_LE(different_normals(*original, *twice, Transform(), shape_case.name), 4)
          << shape_case.name;
    }
}

TEST(MirroredShapes, TheComparisonSeesWhatIsInsideOut) {
  const Case cube{"cube", "cube", {}}, inside_out{"cube", "cube", {{"flip_normals", true, {}}}};
  const auto original = tracer_of({shape_of(cube, placement())});
  const auto image = tracer_of({shape_of(inside_out, mirrors[0] * placement())});
  EXPECT_GT(different_normals(*original, *image, mirrors[0], "inside out"), 50);
}

TEST(MirroredShapes, OtherFactorsOfHomogeneousCoordinatesAreRefused) {
  const double rows[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, -1}};
  EXPECT_THROW(shape_of({"cube", "cube", {}}, Transform(rows)), Error);
  EXPECT_THROW(shape_of({"disk", "disk", {}}, Transform(rows)), Error);
}

}  // namespace
}  // namespace kaustik::test
