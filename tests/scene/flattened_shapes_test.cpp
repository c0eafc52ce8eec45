// Shapes that a factor of zero in to_world flattens: what is flat anyway or a mesh stays, all else
// is left out.

#include <fstream>

#include "tests/scene/scene_support.h"
#include "tests/support/temporary_folder.h"

namespace kaustik {
namespace {

using namespace test;

/// Flattened along an axis, turned and moved up by 2.
std::string placed(const std::string& factors) {
  return "<transform name=\"to_world\"><scale value=\"" + factors +
         "\"/><rotate x=\"1\" y=\"1\" angle=\"30\"/><translate z=\"2\"/></transform>";
}

std::string shape(const std::string& type, const std::string& inside) {
  return "\n<shape type=\"" + type + "\">" + inside + "</shape>";
}

/// What a ray straight down at the middle of the shape meets.
SurfacePoint met(const Scene& scene) {
  const Ray ray{{0.1f, 0.05f, 9}, {0, 0, -1}, 100};
  Hit hit;
  EXPECT_TRUE(scene.intersect(ray, hit));
  return scene.tracer().surface_point(ray, hit);
}

void expect_near(const Vec3f& a, const Vec3f& b) { EXPECT_LT(length(a - b), 1e-4f); }

TEST(FlattenedShapes, ThatAreFlatAnyway) {
  for (const std::string type : {"rectangle", "disk"}) {
    SCOPED_TRACE(type);
    const auto flat = scene_of(any_camera + shape(type, placed("2, 3, 0")));
    const auto full = scene_of(any_camera + shape(type, placed("2, 3, 1")));
    EXPECT_TRUE(flat->warnings().empty());
    const SurfacePoint a = met(*flat), b = met(*full);
    expect_near(a.position, b.position);
    expect_near(a.ng, b.ng);
    expect_near(a.ns, b.ns);
    EXPECT_NEAR(flat->tracer().shape(0).area(), full->tracer().shape(0).area(), 1e-4f);
  }
}

TEST(FlattenedShapes, MeshesWhoseNormalsAreSlanted) {
  const TemporaryFolder folder;
  std::ofstream(folder.path("bump.obj"))
      << "v -1 -1 0\nv 1 -1 0\nv 1 1 1\nv -1 1 1\nvn 0.5 0.3 0.8\nvn -0.5 0.3 0.8\n"
         "f 1//1 2//2 3//1\nf 1//1 3//1 4//2\n";
  const std::string file = "<string name=\"filename\" value=\"" + folder.path("bump.obj") + "\"/>";
  const auto scene = scene_of(any_camera + shape("obj", file + placed("1, 1, 0")));
  EXPECT_TRUE(scene->warnings().empty());
  const SurfacePoint flat = met(*scene);
  const SurfacePoint plane = met(*scene_of(any_camera + shape("rectangle", placed("1, 1, 1"))));
  expect_near(flat.position, plane.position);
  expect_near(flat.ng, plane.ng);
  expect_near(flat.ns, plane.ns);
}

TEST(FlattenedShapes, LampsAndCubes) {
  const auto scene =
      scene_of(any_camera + shape("rectangle", placed("1, 1, 0") + "<emitter type=\"area\"/>"));
  ASSERT_EQ(scene->lights().size(), 1u);
  EXPECT_NEAR(scene->tracer().shape(0).area(), 4, 1e-4f);
  expect_near(met(*scene_of(any_camera + shape("cube", placed("1, 1, 0")))).position,
              met(*scene).position);
}

/// With one warning, and an error where they are read strictly.
TEST(FlattenedShapes, OfWhichNothingIsLeft) {
  const auto left_out = [](const std::string& objects, const std::string& type) {
    SCOPED_TRACE(objects);
    Description description = description_of(any_camera + std::string(any_shape) + objects);
    const auto scene = build_scene(description);
    EXPECT_EQ(scene->tracer().shape_count(), 1u);
    EXPECT_EQ(scene->warnings(),
              std::vector<std::string>{"test.xml:3:1: 'to_world' of shape '" + type +
                                       "' leaves nothing of it: it is left out"});
    description.is_strict = true;
    EXPECT_THROW(build_scene(description), Error);
  };
  left_out(shape("sphere", placed("1, 1, 0")), "sphere");
  left_out(shape("cylinder", placed("0, 1, 1")), "cylinder");
  left_out(shape("rectangle", placed("0, 1, 1") + "<emitter type=\"area\"/>"), "rectangle");
  left_out(shape("disk", placed("1, 0, 1")), "disk");
  left_out(shape("cube", placed("0, 0, 0")), "cube");
  left_out(shape("instance", placed("0") + shape("shapegroup", any_shape)), "instance");
  expect_problem(
      "<sensor type=\"perspective\">\n<transform name=\"to_world\"><scale value=\"0\"/>"
      "</transform></sensor>" +
          std::string(any_shape),
      "3:1", "'to_world' flattens things", "no factor of 0");
}

TEST(FlattenedShapes, AreErrorsWhereFilesAreReadStrictly) {
  LoadOptions strict;
  strict.is_strict = true;
  EXPECT_THROW(parse_mitsuba_xml(
                   "<scene version=\"3.0.0\">" + shape("rectangle", placed("1, 1, 0")) + "</scene>",
                   "test.xml", "", strict),
               Error);
}

/// Textures need no factor at all.
TEST(FlattenedShapes, Textures) {
  const auto scene = scene_of(
      any_camera +
      shape("rectangle",
            "<bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\">"
            "<transform name=\"to_uv\"><scale x=\"4\" y=\"4\" z=\"0\"/></transform></texture>"
            "</bsdf>"));
  EXPECT_TRUE(scene->warnings().empty());
}

}  // namespace
}  // namespace kaustik
