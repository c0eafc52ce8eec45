// pbrt's shapes.

#include <cmath>
#include <numbers>

#include "kaustik/loader/pbrt/shape_areas.h"
#include "kaustik/loader/pbrt/shapes.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

Object shape_of_lines(const std::string& lines) {
  return only(parse_scene_of_pbrt("WorldBegin\n" + lines), "shape");
}

bool has_property(const Object& object, const std::string& name) {
  for (const Property& p : object.properties)
    if (p.name == name) return true;
  return false;
}

TEST(PbrtShapes, TrianglesKeepTheirBuffers) {
  const Object mesh = shape_of_lines(
      "Translate 0 0 1 Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" "
      "[0 0 0 1 0 0 1 1 0 0 1 0] \"normal N\" [0 0 1 0 0 1 0 0 1 0 0 1] \"point2 uv\" "
      "[0 0 1 0 1 1 0 1]");
  EXPECT_EQ(mesh.type, "mesh");
  EXPECT_EQ(numbers_in<int>(mesh, "faces"), (std::vector<int>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(numbers_in<float>(mesh, "positions").size(), 12u);
  EXPECT_EQ(numbers_in<float>(mesh, "normals")[2], 1);
  EXPECT_EQ(numbers_in<float>(mesh, "uv")[5], 1);  // as they are
  EXPECT_FALSE(has_property(mesh, "face_normals"));
  EXPECT_TRUE(value<bool>(mesh, "front_by_normals"));
  const Object lone = shape_of_lines("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]");
  EXPECT_EQ(numbers_in<int>(lone, "faces"), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(value<bool>(lone, "face_normals"));  // flat without normals
  const Object old = shape_of_lines(
      "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] \"float st\" [0 0 1 0 0 1]");
  EXPECT_EQ(numbers_in<float>(old, "uv"), (std::vector<float>{0, 0, 1, 0, 0, 1}));
}

TEST(PbrtShapes, WrongMeshesAreErrors) {
  const auto told = [](const std::string& list, const std::string& message) {
    const auto problems =
        problems_of([&] { parse_scene_of_pbrt("WorldBegin\nShape \"trianglemesh\"\n" + list); });
    EXPECT_NE(problems[0].message.find(message), std::string::npos) << problems[0].message;
    EXPECT_FALSE(problems[0].remedy.empty());
    EXPECT_GE(problems[0].place.line, 2);
  };
  told("", "no 'P'");
  told("\"point3 P\" [0 0 0 1]", "three numbers");
  told("\"point3 P\" [0 0 0 1 0 0]", "no 'indices'");
  told("\"point3 P\" [0 0 0 1 0 0] \"integer indices\" [0 1 2]", "index 2 names none of the 2");
  told("\"point3 P\" [0 0 0 1 0 0] \"integer indices\" [0 1 -1]", "index -1");
  told("\"point3 P\" [0 0 0 1 0 0] \"integer indices\" [0 1]", "'indices' has 2 numbers");
  const Description extra = parse_scene_of_pbrt(
      "WorldBegin Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"normal N\" [0 0 1]");
  EXPECT_TRUE(is_ignored(extra, "trianglemesh", "'N' has 3 numbers"));
}

TEST(PbrtShapes, WholeQuadricsAreBodies) {
  const Object sphere = shape_of_lines("Shape \"sphere\" \"float radius\" 3");
  EXPECT_EQ(sphere.type, "sphere");
  EXPECT_EQ(value<double>(sphere, "radius"), 3);
  const Object tube = shape_of_lines("Shape \"cylinder\" \"float zmin\" -2 \"float zmax\" 5");
  EXPECT_EQ(value<Vec3d>(tube, "p0").z, -2);
  EXPECT_EQ(value<Vec3d>(tube, "p1").z, 5);
  const Object disk = shape_of_lines("Shape \"disk\" \"float height\" 2 \"float radius\" 4");
  expect_same(value<Transform>(disk, "to_world"),
              Transform::translate({0, 0, 2}) * Transform::scale({4, 4, 1}));
}

TEST(PbrtShapes, PartsOfQuadricsAreMeshes) {
  // A quarter of the northern hemisphere: an eighth of 4π.
  const Object eighth = shape_of_lines("Shape \"sphere\" \"float zmin\" 0 \"float phimax\" 90");
  EXPECT_EQ(eighth.type, "mesh");
  EXPECT_NEAR(*pbrt::area_of(eighth), std::numbers::pi / 2, 2e-3);
  for (const float z : numbers_in<float>(eighth, "positions")) EXPECT_GE(z, -1e-6f);
  EXPECT_NEAR(*pbrt::area_of(shape_of_lines("Shape \"cylinder\" \"float phimax\" 180")),
              2 * std::numbers::pi, 4e-3);
  EXPECT_NEAR(*pbrt::area_of(shape_of_lines("Shape \"disk\" \"float innerradius\" .5")),
              .75 * std::numbers::pi, 4e-3);
  // Normals point outward, and with them the faces.
  const auto p = numbers_in<float>(eighth, "positions"), n = numbers_in<float>(eighth, "normals");
  for (size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(p[i], n[i], 1e-6);
}

TEST(PbrtShapes, TexturedSpheresHaveUvFromBelow) {
  const Object sphere = shape_of_lines(
      "Texture \"t\" \"spectrum\" \"checkerboard\" Material \"diffuse\" \"texture reflectance\" "
      "\"t\" Shape \"sphere\"");
  expect_same(value<Transform>(sphere, "to_world"), Transform::scale({1, 1, -1}));
}

TEST(PbrtShapes, BilinearPatches) {
  const Object flat = shape_of_lines(
      "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [0 1 2 "
      "3]");
  EXPECT_EQ(numbers_in<int>(flat, "faces"), (std::vector<int>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(numbers_in<float>(flat, "positions"),
            (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(numbers_in<float>(flat, "uv"), (std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}));
  const Object curved =
      shape_of_lines("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]");
  EXPECT_EQ(numbers_in<int>(curved, "faces").size(), 3u * 2 * 64);
  // ∬ √(1 + x² + y²) over the unit square, of z = x y.
  EXPECT_NEAR(*pbrt::area_of(curved), 1.2808, 3e-3);
}

TEST(PbrtShapes, PlyFilesAreFlatWithoutNormals) {
  const TemporaryFolder folder;
  folder.write("flat.ply",
               "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n");
  folder.write("smooth.ply",
               "ply\nformat ascii 1.0\nelement vertex 0\nproperty float nx\nend_header\n");
  const Description scene = parse_scene_of_pbrt(
      "WorldBegin Shape \"plymesh\" \"string filename\" \"flat.ply\" "
      "Shape \"plymesh\" \"string filename\" \"smooth.ply\" "
      "Shape \"plymesh\" \"string filename\" \"gone.ply\" Shape \"banana\"",
      false, folder / "");
  const auto shapes = objects_of(scene, "shape");
  ASSERT_EQ(shapes.size(), 2u);
  EXPECT_TRUE(value<bool>(*shapes[0], "face_normals"));
  EXPECT_TRUE(value<bool>(*shapes[1], "front_by_normals"));
  EXPECT_TRUE(is_missing(scene, "plymesh", "'gone.ply' is not there"));
  EXPECT_TRUE(is_missing(scene, "banana", "no shape 'banana'"));
}

TEST(PbrtShapes, CurvesAreTubes) {
  // A straight one of 4 cm: the sides of a prism about the cylinder.
  const Description scene = parse_scene_of_pbrt(
      "WorldBegin Shape \"curve\" \"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3] \"float width\" .04\n"
      "Shape \"curve\" \"point3 P\" [1 0 0 1 0 1 1 0 2 1 0 3] \"float width\" .04\n"
      "Material \"diffuse\" Shape \"curve\" \"point3 P\" [2 0 0 2 0 1 2 0 2 2 0 3]");
  const auto shapes = objects_of(scene, "shape");
  ASSERT_EQ(shapes.size(), 2u);                   // those alike are one mesh
  constexpr double five_sides = 10 * 0.58778525;  // of the unit circle
  EXPECT_NEAR(*pbrt::area_of(*shapes[0]), 2 * 3 * .02 * five_sides, 1e-4);
  EXPECT_TRUE(is_approximated(scene, "curves", "tubes"));
}

TEST(PbrtShapes, CurvesOfAllBasesEndWhereTheyShould) {
  const auto last = [](const std::string& list) {
    const auto p = numbers_in<float>(shape_of_lines("Shape \"curve\" \"float width\" 1e-6 " + list),
                                     "positions");
    return Vec3f(p[p.size() - 3], p[p.size() - 2], p[p.size() - 1]);
  };
  const auto expect = [&](const std::string& list, float x) {
    EXPECT_NEAR(last(list).x, x, 1e-4) << list;
  };
  expect("\"point3 P\" [0 0 0 1 0 0 2 0 0 9 0 0 3 0 0 4 0 0 8 0 0]", 8);
  expect("\"integer degree\" 2 \"point3 P\" [0 0 0 1 0 0 2 0 0 4 0 0 7 0 0]", 7);
  // Uniform B-splines end at (p1 + 4 p2 + p3) / 6 and (p1 + p2) / 2.
  expect("\"string basis\" \"bspline\" \"point3 P\" [0 0 0 1 0 0 2 0 0 6 0 0 8 0 0]",
         (2 + 24 + 8) / 6.0f);
  expect("\"string basis\" \"bspline\" \"integer degree\" 2 \"point3 P\" [0 0 0 1 0 0 4 0 0]",
         2.5f);
  EXPECT_THROW(shape_of_lines("Shape \"curve\" \"point3 P\" [0 0 0 1 0 0]"), Error);
  const Object ribbon = shape_of_lines(
      "Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3] "
      "\"normal N\" [0 1 0 0 1 0] \"float width\" .5");
  EXPECT_NEAR(*pbrt::area_of(ribbon), 1.5, 1e-5);
  EXPECT_NEAR(numbers_in<float>(ribbon, "normals")[1], 1, 1e-6);
}

TEST(PbrtShapes, SubdivisionKeepsWhatIsFlatAndRoundsWhatIsNot) {
  const std::vector<float> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const pbrt::MeshParts flat = pbrt::subdivided(square, {0, 1, 2, 0, 2, 3}, 2);
  EXPECT_EQ(flat.faces.size(), 3u * 2 * 16);
  for (size_t i = 2; i < flat.positions.size(); i += 3) EXPECT_NEAR(flat.positions[i], 0, 1e-6);
  for (size_t i = 2; i < flat.normals.size(); i += 3) EXPECT_GT(flat.normals[i], 0);
  // An octahedron: its limit is the same on all six sides, and faces outward.
  const std::vector<float> corners = {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
  const std::vector<int32_t> faces = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4,
                                      2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  const pbrt::MeshParts ball = pbrt::subdivided(corners, faces, 3);
  EXPECT_EQ(ball.faces.size(), faces.size() * 64);
  const float top = ball.positions[0];
  for (const auto& [vertex, axis, sign] :
       {std::tuple<size_t, size_t, float>(0, 0, 1), {1, 0, -1}, {2, 1, 1}, {5, 2, -1}})
    EXPECT_NEAR(ball.positions[3 * vertex + axis], sign * top, 1e-5);
  for (size_t v = 0; v < ball.positions.size(); v += 3)
    EXPECT_GT(ball.positions[v] * ball.normals[v] + ball.positions[v + 1] * ball.normals[v + 1] +
                  ball.positions[v + 2] * ball.normals[v + 2],
              0);
  // The limit of the first vertex, valence 4: (own (1 − 4w) + 4 w mean), w = 1 / (4 + 3 / (8 β)).
  const double w = 1 / (4 + 3 / (8 * (3.0 / 32)));
  EXPECT_NEAR(pbrt::subdivided(corners, faces, 0).positions[0], 1 - 4 * w, 1e-6);
  EXPECT_NEAR(top, 1 - 4 * w, 1e-5);
}

TEST(PbrtShapes, SubdivisionHasAnEnd) {
  const Description scene = parse_scene_of_pbrt(
      "WorldBegin Shape \"loopsubdiv\" \"integer levels\" 12 \"point3 P\" [0 0 0 1 0 0 0 1 0] "
      "\"integer indices\" [0 1 2]");
  EXPECT_TRUE(is_approximated(scene, "loopsubdiv", "not 12"));
}

}  // namespace
}  // namespace kaustik::pbrt
