// Meshes from buffers: the same as those from files, and what is refused.

#include <bit>

#include "tests/geometry/geometry_support.h"

namespace kaustik::test {
namespace {

/// A wavy sheet of n × n vertices.
struct Sheet {
  std::vector<float> positions, normals, uv;
  std::vector<uint32_t> faces;

  explicit Sheet(uint32_t n) {
    Random random(7);
    for (uint32_t y = 0; y < n; ++y)
      for (uint32_t x = 0; x < n; ++x) {
        const float u = float(x) / float(n), v = float(y) / float(n);
        positions.insert(positions.end(), {u, v, random.uniform(-0.05f, 0.05f)});
        const Vec3f normal = random.direction() + Vec3f(0, 0, 2);
        normals.insert(normals.end(), {normal.x, normal.y, normal.z});
        uv.insert(uv.end(), {u, v});
      }
    for (uint32_t y = 0; y + 1 < n; ++y)
      for (uint32_t x = 0; x + 1 < n; ++x) {
        const uint32_t a = y * n + x, b = a + n;
        faces.insert(faces.end(), {a, a + 1, b, b, a + 1, b + 1});
      }
  }

  template <typename Real, typename Index>
  std::vector<Property> buffers(bool with_normals, bool with_uv) const {
    const auto real = [](const std::vector<float>& v, size_t columns) {
      return Value(
          Array::of<Real>({v.size() / columns, columns}, std::vector<Real>(v.begin(), v.end())));
    };
    std::vector<Property> list = {
        {"positions", real(positions, 3), {}},
        {"faces",
         Value(Array::of<Index>({faces.size() / 3, 3},
                                std::vector<Index>(faces.begin(), faces.end()))),
         {}}};
    if (with_normals) list.push_back({"normals", real(normals, 3), {}});
    if (with_uv) list.push_back({"uv", real(uv, 2), {}});
    return list;
  }

  std::string ply(bool with_normals, bool with_uv) const {
    std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(positions.size() / 3) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
    if (with_normals) text += "property float nx\nproperty float ny\nproperty float nz\n";
    if (with_uv) text += "property float u\nproperty float v\n";
    text += "element face " + std::to_string(faces.size() / 3) +
            "\nproperty list uchar uint vertex_indices\nend_header\n";
    const auto add = [&](const auto* values, size_t count) {
      text.append(reinterpret_cast<const char*>(values), count * sizeof(*values));
    };
    for (size_t i = 0; i < positions.size() / 3; ++i) {
      add(&positions[3 * i], 3);
      if (with_normals) add(&normals[3 * i], 3);
      if (with_uv) add(&uv[2 * i], 2);
    }
    for (size_t i = 0; i < faces.size(); i += 3) {
      text.push_back(3);
      add(&faces[i], 3);
    }
    return text;
  }
};

template <typename Vector>
void expect_same_bits(const Vector& a, const Vector& b) {
  ASSERT_EQ(a.size(), b.size());
  if (a.empty()) return;
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])), 0);
}

void expect_same_mesh(const Shape& a, const Shape& b) {
  const TriangleMesh one = a.tessellate(0), two = b.tessellate(0);
  expect_same_bits(one.positions, two.positions);
  expect_same_bits(one.normals, two.normals);
  expect_same_bits(one.uvs, two.uvs);
  expect_same_bits(one.triangles, two.triangles);
}

TEST(MeshBuffers, AreTheMeshThatAPlyFileIs) {
  const Sheet sheet(20);
  const std::vector<std::vector<Property>> options = {
      {},
      {{"to_world", Value(placement(1.7)), {}}},
      {{"to_world", Value(Transform::scale({-1, 2, 1})), {}}, {"flip_normals", Value(true), {}}},
      {{"face_normals", Value(true), {}}, {"flip_tex_coords", Value(true), {}}}};
  for (const bool normals : {false, true})
    for (const bool uv : {false, true}) {
      const TemporaryFile file(sheet.ply(normals, uv), "twin.ply");
      for (const auto& given : options) {
        const auto with = [&](std::vector<Property> list) {
          list.insert(list.end(), given.begin(), given.end());
          return list;
        };
        const auto twin = make_shape("ply", with({{"filename", Value(file.path()), {}}}));
        expect_same_mesh(*twin,
                         *make_shape("mesh", with(sheet.buffers<float, uint32_t>(normals, uv))));
        expect_same_mesh(*twin,
                         *make_shape("mesh", with(sheet.buffers<double, int64_t>(normals, uv))));
      }
    }
}

TEST(MeshBuffers, AreHitWhereTheFileIsHit) {
  const Sheet sheet(30);
  const TemporaryFile file(sheet.ply(true, true), "hit.ply");
  const auto a = tracer_of({make_shape("ply", {{"filename", Value(file.path()), {}}})});
  const auto b = tracer_of({make_shape("mesh", sheet.buffers<float, uint16_t>(true, true))});
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{{random.uniform(), random.uniform(), 1}, random.direction(), infinity};
    Hit one, two;
    ASSERT_EQ(a->intersect(ray, one), b->intersect(ray, two));
    if (one.t == 0) continue;
    EXPECT_EQ(one.t, two.t);
    EXPECT_EQ(one.primitive, two.primitive);
    EXPECT_EQ(a->surface_point(ray, one).ns, b->surface_point(ray, two).ns);
  }
}

std::string error_of(std::vector<Property> properties) {
  for (Property& property : properties) property.place = place_in(property.name);
  try {
    make_shape("mesh", properties);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_TRUE(error.problems()[0].place.file);
    EXPECT_FALSE(error.problems()[0].remedy.empty());
    return *error.problems()[0].place.file + ": " + error.problems()[0].message;
  }
  return "";
}

template <typename T>
Property buffer(const std::string& name, std::vector<size_t> extents, std::vector<T> values) {
  return {name, Value(Array::of<T>(std::move(extents), std::move(values))), {}};
}

TEST(MeshBuffers, RefuseWhatIsNoMesh) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto corners = buffer<float>("positions", {3, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto face = buffer<int32_t>("faces", {1, 3}, {0, 1, 2});
  EXPECT_EQ(error_of({corners, face}), "");
  EXPECT_EQ(error_of({corners, buffer<int32_t>("faces", {1, 3}, {0, 1, 3})}),
            "faces: 'faces': face 0 refers to vertex 3 of 3");
  EXPECT_EQ(error_of({corners, buffer<int32_t>("faces", {1, 3}, {0, -1, 2})}),
            "faces: 'faces': face 0 refers to vertex -1 of 3");
  // What 32 bits would make a valid index of.
  EXPECT_EQ(error_of({corners, buffer<int64_t>("faces", {1, 3}, {0, 1, 0x100000002})}),
            "faces: 'faces': face 0 refers to vertex 4294967298 of 3");
  EXPECT_EQ(error_of({corners, buffer<int32_t>("faces", {0, 3}, {})}),
            "faces: 'faces': the mesh has no faces");
  EXPECT_EQ(error_of({buffer<float>("positions", {0, 3}, {}), face}),
            "faces: 'faces': face 0 refers to vertex 0 of 0");
  EXPECT_EQ(error_of({buffer<float>("positions", {3, 3}, {0, 0, 0, 1, nan, 0, 0, 1, 0}), face}),
            "positions: 'positions': vertex 1 is not finite (1, nan, 0)");
  EXPECT_EQ(error_of({buffer<double>("positions", {3, 3}, {0, 0, 0, 1, 1e300, 0, 0, 1, 0}), face}),
            "positions: 'positions': vertex 1 is not finite (1, inf, 0)");
  EXPECT_EQ(
      error_of({corners, face, buffer<float>("normals", {3, 3}, {0, 0, 1, 0, 0, 1, nan, 0, 1})}),
      "normals: 'normals': the normal of vertex 2 is not finite");
  EXPECT_EQ(error_of({corners, face, buffer<float>("normals", {1, 3}, {0, 0, 1})}),
            "normals: 'normals': it has 1 rows, and 'positions' has 3");
  EXPECT_EQ(error_of({corners, face, buffer<float>("uv", {3, 2}, {0, 0, 1, 0, 0, nan})}),
            "uv: 'uv': the texture coordinate of vertex 2 is not finite");
  EXPECT_EQ(error_of({corners, face, buffer<float>("uv", {2, 2}, {0, 0, 1, 0})}),
            "uv: 'uv': it has 2 rows, and 'positions' has 3");
  EXPECT_EQ(error_of({corners, buffer<float>("faces", {1, 3}, {0, 1, 2})}),
            "faces: 'faces' holds float32");
  EXPECT_EQ(error_of({corners, buffer<int32_t>("faces", {3}, {0, 1, 2})}),
            "faces: 'faces' has the extents [3]");
  EXPECT_NE(error_of({corners}).find("needs 'faces'"), std::string::npos);
}

}  // namespace
}  // namespace kaustik::test
