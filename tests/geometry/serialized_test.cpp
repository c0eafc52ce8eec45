// Mitsuba's packed meshes, good and hostile.
#include "geometry_support.h"
#include "kaustik/geometry/mesh_reader.h"
#include "tests/support/serialized_file.h"

namespace kaustik::test {
namespace {

PackedMesh triangle(double x) {
  return {.flags = 0x1000, .arrays = {{x, 0, 0, 1, 0, 0, 0, 1, 0}}, .corners = {0, 1, 2}};
}

/// With all that a vertex can have, in double precision.
PackedMesh square() {
  return {.flags = 1 | 2 | 8 | 0x10 | 0x2000,
          .arrays = {{0, 0, 5, 1, 0, 5, 1, 1, 5, 0, 1, 5},
                     {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 2},
                     {0, 0, 1, 0, 1, 1, 0, 1},
                     {1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}},
          .corners = {0, 1, 2, 0, 2, 3}};
}

std::string error_of(const std::string& bytes, uint64_t index) {
  const TemporaryFile file(bytes);
  try {
    read_serialized(file.path(), index);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_FALSE(error.problems()[0].remedy.empty());
    EXPECT_EQ(*error.problems()[0].place.file, file.path());
    return error.problems()[0].message;
  }
  return {};
}

TEST(Serialized, HoldsMeshesOfBothVersions) {
  for (const uint16_t version : {uint16_t(3), uint16_t(4)}) {
    const TemporaryFile file(serialized_file({triangle(-7), square(), triangle(3)}, version));
    const MeshFile whole = read_serialized(file.path(), 1);
    EXPECT_TRUE(whole.has_face_normals);
    EXPECT_EQ(whole.mesh.positions,
              (std::vector<Vec3f>{{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}}));
    EXPECT_EQ(whole.mesh.normals[3], Vec3f(0, 0, 2));
    EXPECT_EQ(whole.mesh.uvs, (std::vector<Vec2f>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
    EXPECT_EQ(whole.mesh.triangles, (TriangleList{{0, 1, 2}, {0, 2, 3}}));
    const MeshFile last = read_serialized(file.path(), 2);
    EXPECT_FALSE(last.has_face_normals);
    EXPECT_EQ(last.mesh.positions[0], Vec3f(3, 0, 0));
    EXPECT_TRUE(last.mesh.normals.empty() && last.mesh.uvs.empty());
    EXPECT_EQ(read_serialized(file.path(), 0).mesh.positions[0], Vec3f(-7, 0, 0));
  }
}

/// Of Mitsuba's version 5, with and without what tells which vertices once were one.
TEST(Serialized, HoldsRecords) {
  for (const bool has_maps : {false, true}) {
    RecordMesh mesh = record_mesh();
    mesh.has_maps = has_maps;
    const TemporaryFile file(
        serialized_file({{.vertices = {1, 2, 3, 0, 0, 0, 0, 0}, .corners = {0, 0, 0}}, mesh}));
    const MeshFile found = read_serialized(file.path(), 1);
    EXPECT_FALSE(found.has_face_normals);
    EXPECT_EQ(found.mesh.positions, (std::vector<Vec3f>{{0, 0, 2}, {1, 0, 2}, {0, 1, 2}}));
    EXPECT_EQ(found.mesh.normals, (std::vector<Vec3f>(3, {0, 0, 1})));
    EXPECT_EQ(found.mesh.uvs, (std::vector<Vec2f>{{0, 0}, {1, 0}, {0, 1}}));
    EXPECT_EQ(found.mesh.triangles, (TriangleList{{0, 1, 2}}));
    EXPECT_TRUE(read_serialized(file.path(), 0).mesh.normals.empty());
  }
}

/// A frame with normal n is packed into the imaginary part of its quaternion over 1 + w: of a turn
/// by φ about an axis into the axis times tan(φ/4).
TEST(Serialized, RecordsHoldNormalsOfFrames) {
  RecordMesh mesh = record_mesh();
  mesh.flags |= 2 | 0x10;
  const double quarter = std::tan(std::numbers::pi / 8);  // of a right angle
  const Vec3f turns[] = {{0, float(quarter), 0}, {float(quarter), 0, 0}, {0, 0, 1}};
  for (size_t i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) mesh.vertices[8 * i + 3 + size_t(axis)] = turns[i][axis];
  const TemporaryFile file(serialized_file({mesh}));
  const MeshFile found = read_serialized(file.path(), 0);
  EXPECT_TRUE(found.has_face_normals);
  const Vec3f normals[] = {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
  for (size_t i = 0; i < 3; ++i) EXPECT_LT(length(found.mesh.normals[i] - normals[i]), 1e-6f) << i;
}

TEST(Serialized, RecordsAreChecked) {
  const auto error_in = [](const RecordMesh& mesh) { return error_of(serialized_file({mesh}), 0); };
  RecordMesh outside = record_mesh(), not_finite = record_mesh(), doubles = record_mesh();
  outside.corners[1] = 3;
  EXPECT_EQ(error_in(outside), "face 0 refers to vertex 3 of 3");
  not_finite.vertices[9] = std::nanf("");
  EXPECT_NE(error_in(not_finite).find("not finite"), std::string::npos);
  doubles.flags = 0x2000;
  EXPECT_NE(error_in(doubles).find("no single floats"), std::string::npos);
  const auto with_raw = [](const std::string& raw) {
    return error_of(serialized_streams({raw}, 5), 0);
  };
  std::string promised = raw_records(record_mesh(), "");
  promised[11] = char(0x7f);
  EXPECT_NE(with_raw(promised).find("would grow"), std::string::npos) << with_raw(promised);
  std::string maps = raw_records(record_mesh(), "");
  maps[24] = 4;
  EXPECT_EQ(with_raw(maps), "mesh 0 has 3 vertices, and 4 positions");
  EXPECT_NE(with_raw(raw_records(record_mesh(), std::string(100000, 'x'))).find("letters"),
            std::string::npos);
}

TEST(Serialized, TellsWhatIsWrong) {
  const std::string good = serialized_file({triangle(0), square()}, 4);
  EXPECT_EQ(error_of(good, 2), "there is no mesh 2");
  EXPECT_EQ(error_of("v 0 0 0\nf 1 2 3\n", 0), "no mesh of Mitsuba's begins at byte 0");
  std::string newer = good;
  newer[2] = 6;
  EXPECT_EQ(error_of(newer, 0), "the mesh has version 6, not 3, 4 or 5");
  PackedMesh outside = triangle(0);
  outside.corners[2] = 3;
  EXPECT_EQ(error_of(serialized_file({outside}, 4), 0), "face 0 refers to vertex 3 of 3");
  EXPECT_NE(error_of(serialized_file({triangle(std::nan(""))}, 3), 0).find("not finite"),
            std::string::npos);
  PackedMesh empty = triangle(0);
  empty.corners.clear();
  EXPECT_EQ(error_of(serialized_file({empty}, 4), 0), "the mesh has no faces");
}

/// A mesh or an error, whatever the bytes are.
TEST(Serialized, OfAnyBytesIsAMeshOrAnError) {
  for (const std::string& good : {serialized_file({square(), triangle(1)}, 4),
                                  serialized_file({record_mesh(), record_mesh()})}) {
    for (size_t length = 0; length < good.size(); ++length)
      EXPECT_FALSE(error_of(good.substr(0, length), 0).empty()) << length;
    for (size_t at = 0; at < good.size(); ++at)
      for (const char bits : {char(0x01), char(0x80), char(0xff)}) {
        std::string flipped = good;
        flipped[at] = char(flipped[at] ^ bits);
        const TemporaryFile file(flipped);
        try {
          const TriangleMesh mesh = read_serialized(file.path(), 0).mesh;
          for (const auto& corners : mesh.triangles)
            for (const uint32_t corner : corners) ASSERT_LT(corner, mesh.positions.size());
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), ErrorKind::input);
        }
      }
  }
}

TEST(Serialized, NamesEnd) {
  PackedMesh mesh = triangle(0);
  mesh.name = std::string(100000, 'x');
  EXPECT_EQ(error_of(serialized_file({mesh}, 4), 0), "the name of mesh 0 has no end");
}

/// A few bytes that promise billions of vertices take no memory.
TEST(Serialized, PromisesAreChecked) {
  std::string raw;
  put_bytes(raw, uint32_t(0x1000));
  put_bytes(raw, uint64_t(4000000000));
  put_bytes(raw, uint64_t(1));
  std::string bytes;
  put_bytes(bytes, uint16_t(0x041c));
  put_bytes(bytes, uint16_t(3));
  bytes += packed(raw);
  put_bytes(bytes, uint32_t(0));
  put_bytes(bytes, uint32_t(1));
  EXPECT_NE(error_of(bytes, 0).find("would grow from"), std::string::npos);
}

}  // namespace
}  // namespace kaustik::test
