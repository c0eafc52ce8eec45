// Mitsuba's packed meshes, good and hostile.
#include <zlib.h>

#include <cstring>

#include "geometry_support.h"
#include "kaustik/geometry/mesh_reader.h"

namespace kaustik::test {
namespace {

template <typename T>
void put(std::string& out, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  out.append(raw, sizeof(T));
}

struct Packed {
  uint32_t flags = 0;
  std::string name = "a mesh";
  std::vector<std::vector<double>> arrays;  ///< positions, and what the flags promise
  std::vector<uint32_t> corners;
};

std::string packed_mesh(const Packed& mesh, uint16_t version) {
  std::string raw;
  put(raw, mesh.flags);
  if (version == 4) raw.append(mesh.name).push_back('\0');
  put(raw, uint64_t(mesh.arrays[0].size() / 3));
  put(raw, uint64_t(mesh.corners.size() / 3));
  for (const auto& array : mesh.arrays)
    for (const double value : array)
      if (mesh.flags & 0x2000)
        put(raw, value);
      else
        put(raw, float(value));
  for (const uint32_t corner : mesh.corners) put(raw, corner);
  uLongf size = compressBound(uLong(raw.size()));
  std::string out(size, '\0');
  compress(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
           uLong(raw.size()));
  out.resize(size);
  std::string whole;
  put(whole, uint16_t(0x041c));
  put(whole, version);
  return whole + out;
}

std::string file_of(const std::vector<Packed>& meshes, uint16_t version) {
  std::string out;
  std::vector<uint64_t> places;
  for (const Packed& mesh : meshes) {
    places.push_back(out.size());
    out += packed_mesh(mesh, version);
  }
  for (const uint64_t place : places)
    if (version == 4)
      put(out, place);
    else
      put(out, uint32_t(place));
  put(out, uint32_t(meshes.size()));
  return out;
}

Packed triangle(double x) {
  return {.flags = 0x1000, .arrays = {{x, 0, 0, 1, 0, 0, 0, 1, 0}}, .corners = {0, 1, 2}};
}

/// With all that a vertex can have, in double precision.
Packed square() {
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
    const TemporaryFile file(file_of({triangle(-7), square(), triangle(3)}, version));
    const MeshFile whole = read_serialized(file.path(), 1);
    EXPECT_TRUE(whole.has_face_normals);
    EXPECT_EQ(whole.mesh.positions,
              (std::vector<Vec3f>{{0, 0, 5}, {1, 0, 5}, {1, 1, 5}, {0, 1, 5}}));
    EXPECT_EQ(whole.mesh.normals[3], Vec3f(0, 0, 2));
    EXPECT_EQ(whole.mesh.uvs, (std::vector<Vec2f>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
    EXPECT_EQ(whole.mesh.triangles, (std::vector<std::array<uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
    const MeshFile last = read_serialized(file.path(), 2);
    EXPECT_FALSE(last.has_face_normals);
    EXPECT_EQ(last.mesh.positions[0], Vec3f(3, 0, 0));
    EXPECT_TRUE(last.mesh.normals.empty() && last.mesh.uvs.empty());
    EXPECT_EQ(read_serialized(file.path(), 0).mesh.positions[0], Vec3f(-7, 0, 0));
  }
}

TEST(Serialized, TellsWhatIsWrong) {
  const std::string good = file_of({triangle(0), square()}, 4);
  EXPECT_EQ(error_of(good, 2), "there is no mesh 2");
  EXPECT_EQ(error_of("v 0 0 0\nf 1 2 3\n", 0), "no mesh of Mitsuba's begins at byte 0");
  std::string newer = good;
  newer[2] = 5;
  EXPECT_EQ(error_of(newer, 0), "the mesh has version 5, not 3 or 4");
  Packed outside = triangle(0);
  outside.corners[2] = 3;
  EXPECT_EQ(error_of(file_of({outside}, 4), 0), "face 0 refers to vertex 3 of 3");
  EXPECT_NE(error_of(file_of({triangle(std::nan(""))}, 3), 0).find("not finite"),
            std::string::npos);
  Packed empty = triangle(0);
  empty.corners.clear();
  EXPECT_EQ(error_of(file_of({empty}, 4), 0), "the mesh has no faces");
}

/// A mesh or an error, whatever the bytes are.
TEST(Serialized, OfAnyBytesIsAMeshOrAnError) {
  const std::string good = file_of({square(), triangle(1)}, 4);
  for (size_t length = 0; length < good.size(); ++length)
    EXPECT_FALSE(error_of(good.substr(0, length), 0).empty()) << length;
  for (size_t at = 0; at < good.size(); ++at)
    for (const char bits : {char(0x01), char(0x80), char(0xff)}) {
      std::string flipped = good;
      flipped[at] ^= bits;
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

/// A few bytes that promise billions of vertices take no memory.
TEST(Serialized, PromisesAreChecked) {
  std::string raw;
  put(raw, uint32_t(0x1000));
  put(raw, uint64_t(4000000000));
  put(raw, uint64_t(1));
  uLongf size = compressBound(uLong(raw.size()));
  std::string stream(size, '\0');
  compress(reinterpret_cast<Bytef*>(stream.data()), &size,
           reinterpret_cast<const Bytef*>(raw.data()), uLong(raw.size()));
  stream.resize(size);
  std::string bytes;
  put(bytes, uint16_t(0x041c));
  put(bytes, uint16_t(3));
  bytes += stream;
  put(bytes, uint32_t(0));
  put(bytes, uint32_t(1));
  EXPECT_NE(error_of(bytes, 0).find("more than zlib packs"), std::string::npos);
}

}  // namespace
}  // namespace kaustik::test
