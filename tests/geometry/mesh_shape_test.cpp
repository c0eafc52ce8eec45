// What becomes of the meshes in files.

#include <cmath>
#include <ctime>

#include "mesh_file_support.h"

namespace kaustik::test {
namespace {

/// Both readers cut as PolygonCutter does.
TEST(MeshShape, ConcaveFacesCoverTheirArea) {
  const TemporaryFile as_obj("v 0 -0.5 0\nv 0.5 0.5 0\nv 0 0 0\nv -0.5 0.5 0\nf 2 3 4 1\n",
                             "a.obj");
  const TemporaryFile as_ply(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
      "0 -0.5 0\n0.5 0.5 0\n0 0 0\n-0.5 0.5 0\n4 1 2 3 0\n",
      "a.ply");
  EXPECT_FLOAT_EQ(make_shape("obj", {{"filename", as_obj.path(), {}}})->area(), 0.25f);
  EXPECT_FLOAT_EQ(make_shape("ply", {{"filename", as_ply.path(), {}}})->area(), 0.25f);
}

/// Files of a megabyte that once took time with the square of what they repeat.
TEST(MeshFiles, TakeTimeInProportionToTheirSize) {
  std::string elements = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 60000; ++i) elements += "element e" + std::to_string(i) + " 0\n";
  // One face of all the corners that a byte each can name, over and over.
  std::string corners =
      "ply\nformat binary_little_endian 1.0\nelement vertex 200\nproperty char x\n"
      "property char y\nproperty char z\nelement face 1\n"
      "property list uint uchar vertex_index\nend_header\n";
  Random random(3);
  for (int i = 0; i < 600; ++i) corners += char(random.uniform() * 100);
  put(corners, uint32_t(1000000), false);
  for (int i = 0; i < 1000000; ++i) corners += char(uint8_t(random.uniform() * 200));
  std::string joined = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 ";
  for (int i = 0; i < 300000; ++i) joined += "\\\n";
  const std::clock_t begin = std::clock();
  EXPECT_NE(reading_error([&] { ply(elements); }), "");
  EXPECT_THROW(ply(corners), Error);
  EXPECT_EQ(obj(joined).triangles.size(), 1u);
  const double taken = double(std::clock() - begin) / CLOCKS_PER_SEC;
  EXPECT_LT(taken, 1.5 * samples_divisor);
}

TEST(MeshShape, NormalsFollowMitsuba) {
  // A roof without normals: smooth by default, flat on request.
  const TemporaryFile file(
      "v 0 0 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nv 2 0 0\nv 2 1 0\n"
      "f 1 3 4 2\nf 3 5 6 4\n",
      "roof.obj");
  const auto smooth = make_shape("obj", {{"filename", file.path(), {}}});
  ASSERT_EQ(smooth->mesh()->normals.size(), 6u);
  EXPECT_NEAR(smooth->mesh()->normals[1].z, 1, 1e-6f);  // on the ridge
  const auto flat = make_shape("obj", {{"filename", file.path(), {}}, {"face_normals", true, {}}});
  EXPECT_TRUE(flat->mesh()->normals.empty());
  const auto flipped =
      make_shape("obj", {{"filename", file.path(), {}}, {"flip_normals", true, {}}});
  EXPECT_NEAR(flipped->mesh()->normals[1].z, -1, 1e-6f);
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    EXPECT_GT(smooth->sample_area(random.square()).point.ng.z, 0);
    EXPECT_LT(flipped->sample_area(random.square()).point.ng.z, 0);
    EXPECT_LT(flipped->sample_area(random.square()).point.ns.z, 0);
  }
}

/// A face without normals in a file that has some gets smooth ones, as Mitsuba 3 makes them.
TEST(MeshShape, MissingNormalsAreMade) {
  const TemporaryFile file(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvn 0 0.6 0.8\nf 1//1 2//1 3//1\nf 2 4 3\n", "some.obj");
  const auto shape = make_shape("obj", {{"filename", file.path(), {}}});
  const TriangleMesh& mesh = *shape->mesh();
  ASSERT_EQ(mesh.normals.size(), 6u);
  for (const uint32_t corner : mesh.triangles[0])
    EXPECT_LT(length(mesh.normals[corner] - Vec3f(0, 0.6f, 0.8f)), 1e-6f);
  const Vec3f flat = normalize(Vec3f(-1, -1, 1));
  for (const uint32_t corner : mesh.triangles[1])
    EXPECT_LT(length(mesh.normals[corner] - flat), 1e-6f);
}

/// Mitsuba 0.6's maxSmoothAngle: a roof of two quads at right angles, whose corners stand twice.
TEST(MeshShape, CreasesSplitNormals) {
  const TemporaryFile file(
      "v 0 0 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nv 2 0 0\nv 2 1 0\nv 1 0 1\nv 1 1 1\n"
      "vn 1 0 0\nf 1//1 3//1 4//1 2//1\nf 7 5 6 8\n",
      "roof.obj");
  const auto normals_at = [&](double degrees, const Vec3f& place, const Transform& to_world) {
    const auto shape = make_shape("obj", {{"filename", file.path(), {}},
                                          {"max_smooth_angle", degrees, {}},
                                          {"to_world", to_world, {}}});
    std::vector<Vec3f> normals;
    const TriangleMesh& mesh = *shape->mesh();
    for (size_t i = 0; i < mesh.positions.size(); ++i)
      if (mesh.positions[i] == to_world.point(place)) normals.push_back(mesh.normals[i]);
    return normals;
  };
  const Vec3f ridge(1, 0, 1), left = normalize(Vec3f(-1, 0, 1)), right = normalize(Vec3f(1, 0, 1));
  for (const Vec3f& n : normals_at(91, ridge, {})) EXPECT_LT(length(n - Vec3f(0, 0, 1)), 1e-6f);
  const std::vector<Vec3f> sharp = normals_at(89, ridge, {});
  ASSERT_EQ(sharp.size(), 2u);
  EXPECT_LT(std::min(length(sharp[0] - left), length(sharp[1] - left)), 1e-6f);
  EXPECT_LT(std::min(length(sharp[0] - right), length(sharp[1] - right)), 1e-6f);
  // Within a quad there is no crease, even at 0°.
  EXPECT_EQ(normals_at(0, {0, 0, 0}, {}).size(), 1u);
  // The angle counts in the world.
  EXPECT_EQ(normals_at(89, ridge, Transform::scale({1, 1, 0.5})).size(), 2u);
  for (const Vec3f& n : normals_at(89, ridge, Transform::scale({1, 1, 0.5})))
    EXPECT_LT(length(n - Vec3f(0, 0, 1)), 1e-6f);
}

/// A ball of many faces: the same normals as without a limit, however its vertices are shared.
TEST(MeshShape, WithoutCreasesNormalsAreSmooth) {
  TriangleMesh shared = make_shape("sphere")->tessellate(3);
  shared.normals.clear();
  TriangleMesh apart;
  for (const auto& corners : shared.triangles) {
    for (const uint32_t corner : corners) apart.positions.push_back(shared.positions[corner]);
    const auto n = uint32_t(apart.positions.size());
    apart.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const TriangleMesh split = split_at_creases(apart, 60);
  for (size_t i = 0; i < split.positions.size(); ++i)
    EXPECT_GT(dot(split.normals[i], normalize(split.positions[i])), 0.999f);
  EXPECT_EQ(split_at_creases(shared, 60).positions.size(), shared.positions.size());
  EXPECT_EQ(split_at_creases(shared, 0).positions.size(), 3 * shared.triangles.size());
}

TEST(MeshShape, WindingFollowsVertexNormals) {
  const TemporaryFile file("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\n", "down.obj");
  const auto shape = make_shape("obj", {{"filename", file.path(), {}}});
  EXPECT_LT(shape->sample_area({0.5f, 0.5f}).point.ng.z, 0);
}

TEST(MeshShape, TextureCoordinatesFlip) {
  const TemporaryFile as_obj(text_obj, "quad.obj"), as_ply(text_ply, "quad.ply");
  const auto v_of_second = [](const char* type, const TemporaryFile& file,
                              std::vector<Property> extra) {
    extra.push_back({"filename", file.path(), {}});
    return make_shape(type, extra)->mesh()->uvs[1].y;
  };
  EXPECT_EQ(v_of_second("obj", as_obj, {}), 1);  // Mitsuba's default for OBJ
  EXPECT_EQ(v_of_second("obj", as_obj, {{"flip_tex_coords", false, {}}}), 0);
  EXPECT_EQ(v_of_second("ply", as_ply, {}), 0);
  EXPECT_EQ(v_of_second("ply", as_ply, {{"flip_tex_coords", true, {}}}), 1);
}

TEST(MeshShape, TooFarIsAnError) {
  const TemporaryFile file(text_ply, "far.ply");
  EXPECT_THROW(make_shape("ply", {{"filename", file.path(), {}},
                                  {"to_world", Transform::scale({1e20, 1, 1}), {}}}),
               Error);
}

}  // namespace
}  // namespace kaustik::test
