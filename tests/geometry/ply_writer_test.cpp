// What is written as PLY is read as it was.

#include "kaustik/geometry/ply_writer.h"

#include <limits>

#include "mesh_file_support.h"

namespace kaustik::test {
namespace {

std::string written_ply(const TriangleMesh& mesh) {
  const std::vector<uint8_t> bytes = ply_file_of(mesh);
  return {bytes.begin(), bytes.end()};
}

TriangleMesh strange_mesh() {
  TriangleMesh mesh;
  mesh.positions = {{0, 1e-40f, -0.0f}, {1, 3.4e38f, 0.1f}, {-1, 0, 2}, {0.3f, 0.7f, 1e-7f}};
  mesh.triangles = {{0, 1, 2}, {3, 2, 1}, {0, 0, 3}};
  return mesh;
}

TEST(PlyWriter, WhatIsReadAgainIsTheSameToTheBit) {
  TriangleMesh mesh = strange_mesh();
  expect_equal_meshes(ply(written_ply(mesh)), mesh, "bare");
  mesh.normals = {{0, 0, 2}, {0, 0, 0}, {0.1f, 0.2f, 0.3f}, {1, 0, 0}};
  expect_equal_meshes(ply(written_ply(mesh)), mesh, "with normals");
  mesh.uvs = {{0, 1}, {-3, 0.1f}, {7, 7}, {0, 0}};
  expect_equal_meshes(ply(written_ply(mesh)), mesh, "with uv");
  mesh.normals.clear();
  expect_equal_meshes(ply(written_ply(mesh)), mesh, "with uv alone");
  std::string flipped = written_ply(mesh);
  flipped[flipped.find("end_header") + 11 + 16] ^= 1;
  EXPECT_NE(ply(flipped).uvs[0].y, mesh.uvs[0].y);
}

/// By the names that they had, too: colours, vectors and numbers, of vertices and of faces.
TEST(PlyWriter, KeepsAttributes) {
  TriangleMesh mesh = strange_mesh();
  const auto add = [&](const std::string& name, int components) {
    const bool of_faces = name.starts_with("face");
    MeshAttribute attribute{name, components};
    for (size_t i = 0; i < size_t(components) * (of_faces ? 3 : 4); ++i)
      attribute.values.push_back(0.1f * float(i + name.size()));
    mesh.attributes.push_back(attribute);
  };
  add("vertex_color", 3);
  add("vertex_paint_color", 3);
  add("vertex_wind", 3);
  add("vertex_heat", 1);
  add("vertex_gray_color", 1);
  add("face_color", 3);
  add("face_age", 1);
  const TriangleMesh read = ply(written_ply(mesh));
  expect_equal_meshes(read, mesh, "with attributes");
  for (size_t i = 0; i < mesh.attributes.size(); ++i) {
    EXPECT_EQ(read.attributes[i].name, mesh.attributes[i].name);
    EXPECT_EQ(read.attributes[i].components, mesh.attributes[i].components);
  }
}

/// A shape of a file, and one of the PLY file that its mesh is written to.
void expect_same_shape(const std::string& type, std::vector<Property> properties,
                       const std::vector<Property>& placement, float tolerance) {
  for (const Property& property : placement) properties.push_back(property);
  Problems problems;
  const TypeInfo* info = nullptr;
  for (const ShapeType& row : shape_types())
    if (row.info.name == type) info = &row.info;
  const MeshFile file = unplaced_mesh(Arguments(*info, properties, {}, problems));
  problems.throw_if_any();
  const TemporaryFile as_ply(written_ply(file.mesh), "as.ply");
  std::vector<Property> of_ply;
  const bool is_placed = std::any_of(properties.begin(), properties.end(), [](const Property& p) {
    return p.name == "max_smooth_angle";
  });
  for (const Property& property : placement)
    if (property.name != "to_world" || !is_placed) of_ply.push_back(property);
  of_ply.push_back({"filename", as_ply.path(), {}});
  const auto before = make_shape(type, properties), after = make_shape("ply", of_ply);
  const TriangleMesh &a = *before->mesh(), &b = *after->mesh();
  expect_equal_bits(a.positions, b.positions, type);
  expect_equal_bits(a.uvs, b.uvs, type);
  expect_equal_bits(a.triangles, b.triangles, type);
  ASSERT_EQ(a.normals.size(), b.normals.size());
  for (size_t i = 0; i < a.normals.size(); ++i)
    EXPECT_LE(length(a.normals[i] - b.normals[i]), tolerance) << i;
}

TEST(PlyWriter, UnplacedMeshesAreTheShape) {
  const TemporaryFile quad(text_obj, "quad.obj");
  const TemporaryFile roof(
      "v 0 0 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\nv 2 0 0\nv 2 1 0\nvn 0.6 0 0.8\n"
      "f 1//1 3//1 4//1 2//1\nf 3 5 6 4\n",
      "some.obj");
  const Transform turned = Transform::rotate({1, 2, 3}, 40) * Transform::scale({1, 1, -2});
  const std::vector<Property> placed = {{"to_world", turned, {}}};
  const std::vector<Property> flipped = {{"to_world", turned, {}}, {"flip_normals", true, {}}};
  const std::vector<Property> of_quad = {{"filename", quad.path(), {}}};
  expect_same_shape("obj", of_quad, placed, 0);
  expect_same_shape("obj", of_quad, flipped, 0);
  expect_same_shape("obj", {{"filename", quad.path(), {}}, {"flip_tex_coords", false, {}}}, {}, 0);
  // Where some normals are missing they are made before the shape is placed, so it is not scaled.
  const std::vector<Property> rotated = {{"to_world", Transform::rotate({1, 2, 3}, 40), {}}};
  expect_same_shape("obj", {{"filename", roof.path(), {}}}, rotated, 1e-6f);
  // Creases are found in the world.
  const std::vector<Property> creased = {{"filename", roof.path(), {}},
                                         {"max_smooth_angle", 80.0, {}}};
  expect_same_shape("obj", creased, flipped, 1e-6f);
  expect_same_shape("obj", creased, {}, 1e-6f);
}

}  // namespace
}  // namespace kaustik::test
