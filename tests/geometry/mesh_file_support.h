#pragma once
// Mesh files for tests of their readers, good and hostile.

#include <cmath>
#include <cstring>
#include <string>

#include "geometry_support.h"
#include "kaustik/geometry/mesh_reader.h"

namespace kaustik::test {

inline TriangleMesh ply(const std::string& bytes) {
  return read_ply(TemporaryFile(bytes).path()).mesh;
}
inline TriangleMesh obj(const std::string& bytes) {
  return read_obj(TemporaryFile(bytes).path()).mesh;
}

/// The message of the Error(input) that `read` throws; "" if it throws none.
template <typename Read>
std::string reading_error(const Read& read) {
  try {
    read();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_FALSE(error.problems()[0].remedy.empty());
    EXPECT_TRUE(error.problems()[0].place.file != nullptr || error.problems().size() == 1);
    return error.what();
  }
  return {};
}

template <typename T>
void put(std::string& out, T value, bool big_endian) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(std::begin(raw), std::end(raw));
  out.append(raw, sizeof(T));
}

template <typename Vector>
void expect_equal_bits(const Vector& a, const Vector& b, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  if (a.empty()) return;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0) << what;
}

inline void expect_equal_meshes(const TriangleMesh& a, const TriangleMesh& b,
                                const std::string& what) {
  expect_equal_bits(a.positions, b.positions, what);
  expect_equal_bits(a.normals, b.normals, what);
  expect_equal_bits(a.uvs, b.uvs, what);
  expect_equal_bits(a.triangles, b.triangles, what);
  ASSERT_EQ(a.attributes.size(), b.attributes.size()) << what;
  for (size_t i = 0; i < a.attributes.size(); ++i)
    expect_equal_bits(a.attributes[i].values, b.attributes[i].values, what);
}

inline const std::string text_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property float u\nproperty float v\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 2.5 0 0 1 0 0\n1 0 2.5 0 0 1 1 0\n1 1 +2.5 0 0 1 1 1\n0 1 2.5e0 0 0 1 0 1\n4 0 1 2 3\n";

inline void expect_quad(const TriangleMesh& mesh) {
  ASSERT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.normals.size(), 4u);
  ASSERT_EQ(mesh.uvs.size(), 4u);
  EXPECT_EQ(mesh.positions[2], Vec3f(1, 1, 2.5f));
  EXPECT_EQ(mesh.normals[3], Vec3f(0, 0, 1));
  EXPECT_EQ(mesh.uvs[1], Vec2f(1, 0));
  const TriangleList fan = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(mesh.triangles, fan);
}

inline void expect_sound(const TriangleMesh& mesh) {
  EXPECT_FALSE(mesh.triangles.empty());
  for (const auto& t : mesh.triangles)
    for (const uint32_t i : t) ASSERT_LT(i, mesh.positions.size());
  for (const Vec3f& p : mesh.positions) ASSERT_TRUE(is_finite(p));
  EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.positions.size());
  EXPECT_TRUE(mesh.uvs.empty() || mesh.uvs.size() == mesh.positions.size());
  for (const MeshAttribute& attribute : mesh.attributes) {
    const size_t count = attribute.is_of_faces() ? mesh.triangles.size() : mesh.positions.size();
    EXPECT_EQ(attribute.values.size(), count * size_t(attribute.components));
    for (const float value : attribute.values) ASSERT_TRUE(std::isfinite(value));
  }
}

/// Reads damaged copies of `bytes`: cut at every offset and with bytes changed. Each gives a sound
/// mesh or an Error(input); at least `least_errors` of them the latter.
template <typename Read>
void survive_damage(const std::string& bytes, const Read& read, int least_errors) {
  int errors = 0;
  const auto attempt = [&](const std::string& damaged) {
    try {
      const TriangleMesh mesh = read(damaged);
      expect_sound(mesh);
      // What reads must also trace.
      MeshOptions options;
      const auto shape = std::make_shared<MeshShape>(prepare_mesh(mesh, options, place_in("mesh")));
      EXPECT_TRUE(std::isfinite(shape->area()));
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
      ++errors;
    }
  };
  for (size_t length = 0; length < bytes.size(); ++length) attempt(bytes.substr(0, length));
  Random random(31);
  for (int i = 0; i < 3000 / samples_divisor; ++i) {
    std::string damaged = bytes;
    const int changes = 1 + int(random.uniform() * 4);
    for (int j = 0; j < changes; ++j)
      damaged[size_t(random.uniform() * float(bytes.size()))] =
          char(uint8_t(random.uniform() * 256));
    attempt(damaged);
  }
  EXPECT_GT(errors, least_errors);
}

inline const std::string text_obj =
    "# a quad\nmtllib none.mtl\no quad\nv 0 0 2.5\nv 1 0 2.5\nv 1 1 2.5\nv 0 1 2.5 1.0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1 0\nvn 0 0 1\nusemtl x\ns off\nf 1/1/1 2/2/1 3/3/1 4/4/1\n";

}  // namespace kaustik::test
