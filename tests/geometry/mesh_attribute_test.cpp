// Colours and numbers of meshes: from files and buffers to points of triangles.

#include "kaustik/geometry/mesh_attribute.h"

#include <algorithm>
#include <cstring>

#include "geometry_support.h"
#include "kaustik/base/srgb.h"
#include "kaustik/geometry/attribute_groups.h"
#include "kaustik/geometry/mesh_reader.h"
#include "tests/support/serialized_file.h"

namespace kaustik::test {
namespace {

/// "name: members" of each group.
std::vector<std::string> groups_of(const std::vector<std::string>& properties) {
  std::vector<std::string> texts;
  for (const AttributeGroup& group : attribute_groups(properties)) {
    texts.push_back(group.name + ":");
    for (const size_t i : group.members) texts.back() += " " + properties[i];
  }
  return texts;
}

TEST(AttributeGroups, FollowMitsubasRules) {
  using Texts = std::vector<std::string>;
  EXPECT_EQ(groups_of({"x", "y", "z", "red", "green", "blue", "alpha"}),
            (Texts{"color: red green blue"}));
  EXPECT_EQ(groups_of({"b", "x", "g", "r"}), (Texts{"color: r g b"}));
  EXPECT_EQ(
      groups_of({"x", "heat_x", "glow_r", "glow_g", "glow_b", "wind_x", "wind_y", "wind_z"}),
      (Texts{"heat: heat_x", "glow_color: glow_r glow_g glow_b", "wind: wind_x wind_y wind_z"}));
  EXPECT_EQ(groups_of({"a_0", "a_1", "a_2", "b_1", "b_2", "b_3", "c_1"}),
            (Texts{"a: a_0 a_1 a_2", "b: b_1 b_2 b_3", "c: c_1"}));
  // Opacity is left out; four numbers are none.
  EXPECT_EQ(groups_of({"p_r", "p_g", "p_b", "p_a", "q_x", "q_y", "q_z", "q_w"}),
            (Texts{"p_color: p_r p_g p_b"}));
  // Two are neither a number nor a colour; what does not stand side by side does not belong
  // together, and a name is taken once.
  EXPECT_EQ(groups_of({"uv_x", "uv_y", "n_x", "x", "n_y", "n_z", "n_x"}), (Texts{"n: n_x"}));
  EXPECT_TRUE(groups_of({"quality", "", "_x", "v_", "flags_q", "x_yz", "r", "g"}).empty());
  EXPECT_TRUE(groups_of({}).empty());
}

std::vector<float> values_of(const TriangleMesh& mesh, const std::string& name) {
  const MeshAttribute* found = find_attribute(mesh, name);
  if (!found) {
    ADD_FAILURE() << "no " << name;
    return {};
  }
  return found->values;
}

const std::string coloured_ply =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\nproperty float y\nproperty float z\n"
    "property float heat_x\nelement face 2\nproperty float paint_r\n"
    "property list uchar int vertex_indices\nproperty float paint_g\nproperty float paint_b\n"
    "end_header\n"
    "0 255 0 51 0 0 1\n1 0 255 0 0 0 2\n1 0 0 255 1 0 -3\n0 51 51 51 1 0 nan\n"
    "0.5 4 0 1 2 3 0.25 0.125\n1 3 0 1 2 0 0\n";

TEST(MeshAttribute, OfPlyFiles) {
  const TemporaryFile file(coloured_ply, "colours.ply");
  const MeshFile read = read_ply(file.path());
  ASSERT_EQ(read.mesh.attributes.size(), 3u);
  const float dark = linear_from_srgb(0.2f);
  EXPECT_EQ(values_of(read.mesh, "vertex_color"),
            (std::vector<float>{1, 0, dark, 0, 1, 0, 0, 0, 1, dark, dark, dark}));
  EXPECT_EQ(values_of(read.mesh, "vertex_heat"), (std::vector<float>{1, 2, -3, 0}));
  // The list tears it apart; both triangles of the quad have what it has.
  EXPECT_EQ(values_of(read.mesh, "face_paint_color"), (std::vector<float>{0.5f, 0.5f, 1}));
  ASSERT_EQ(read.remarks.size(), 1u);
  EXPECT_NE(read.remarks[0].find("1 value of 'vertex_heat' is not finite"), std::string::npos)
      << read.remarks[0];
  // Side by side it is a colour.
  std::string faces = coloured_ply;
  faces.replace(faces.find("property float paint_r\n"), 23, "");
  faces.replace(faces.find("property float paint_g"), 22,
                "property float paint_r\nproperty float paint_g");
  faces.replace(faces.find("0.5 4 0 1 2 3 0.25"), 18, "4 0 1 2 3 0.5 0.25");
  faces.replace(faces.find("1 3 0 1 2 0 0"), 13, "3 0 1 2 1 0 0");
  const TemporaryFile other(faces, "faces.ply");
  EXPECT_EQ(values_of(read_ply(other.path()).mesh, "face_paint_color"),
            (std::vector<float>{0.5f, 0.25f, 0.125f, 0.5f, 0.25f, 0.125f, 1, 0, 0}));
}

/// Triangles, or a quad and a triangle, with colours of vertices as integers and of faces as
/// floats.
std::string binary_colours(bool big_endian, bool has_quad) {
  std::string out = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                    "_endian 1.0\nelement vertex 4\nproperty ushort red\nproperty float x\n"
                    "property float y\nproperty uchar green\nproperty float z\n"
                    "property uchar blue\nproperty double heat_x\nelement face 2\n"
                    "property float glow_1\nproperty list uchar int vertex_indices\n"
                    "end_header\n";
  const auto put = [&](auto value) {
    char raw[sizeof(value)];
    std::memcpy(raw, &value, sizeof(value));
    if (big_endian) std::reverse(std::begin(raw), std::end(raw));
    out.append(raw, sizeof(value));
  };
  for (int i = 0; i < 4; ++i) {
    put(uint16_t(i == 0 ? 65535 : 0));
    put(float(i == 1 || i == 2));
    put(float(i >= 2));
    put(uint8_t(51 * i));
    put(0.0f);
    put(uint8_t(255));
    put(double(i) - 1);
  }
  const std::vector<std::vector<int32_t>> faces = {
      has_quad ? std::vector<int32_t>{0, 1, 2, 3} : std::vector<int32_t>{0, 1, 2}, {0, 2, 3}};
  for (const auto& corners : faces) {
    put(corners[1] == 1 ? 0.5f : 2.0f);
    put(uint8_t(corners.size()));
    for (const int32_t corner : corners) put(corner);
  }
  return out;
}

/// Those of records of one size, which are read side by side, and of others.
TEST(MeshAttribute, OfBinaryPlyFiles) {
  std::vector<float> colours;
  for (int i = 0; i < 4; ++i)
    colours.insert(colours.end(), {i == 0 ? 1.0f : 0.0f, attribute_value(51 * i, 255), 1.0f});
  for (const bool big_endian : {false, true})
    for (const bool has_quad : {false, true}) {
      const TemporaryFile file(binary_colours(big_endian, has_quad), "colours.ply");
      const TriangleMesh mesh = read_ply(file.path()).mesh;
      ASSERT_EQ(mesh.attributes.size(), 3u);
      EXPECT_EQ(values_of(mesh, "vertex_color"), colours);
      EXPECT_EQ(values_of(mesh, "vertex_heat"), (std::vector<float>{-1, 0, 1, 2}));
      EXPECT_EQ(values_of(mesh, "face_glow"),
                has_quad ? (std::vector<float>{0.5f, 0.5f, 2}) : (std::vector<float>{0.5f, 2}));
    }
}

/// Where normals have creases vertices become several.
TEST(MeshAttribute, GoWithVerticesThatAreSplit) {
  const TemporaryFile file(
      "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 0 0 1\nf 1 2 3\nf 1 3 4\n", "roof.obj");
  TriangleMesh whole = read_obj(file.path()).mesh;
  whole.attributes.push_back({"face_value", 1, {4, 5}});
  const TriangleMesh split = split_at_creases(whole, 10);
  ASSERT_EQ(split.positions.size(), 6u);
  EXPECT_EQ(values_of(split, "face_value"), (std::vector<float>{4, 5}));
  const std::vector<float> before = values_of(whole, "vertex_color"),
                           after = values_of(split, "vertex_color");
  ASSERT_EQ(after.size(), 18u);
  for (size_t face = 0; face < 2; ++face)
    for (size_t i = 0; i < 3; ++i)
      for (size_t c = 0; c < 3; ++c)
        EXPECT_EQ(after[3 * split.triangles[face][i] + c],
                  before[3 * whole.triangles[face][i] + c]);
}

TEST(MeshAttribute, OfIntegersIsEncoded) {
  EXPECT_EQ(attribute_value(0.25, 0), 0.25f);
  EXPECT_EQ(attribute_value(-7, 0), -7);
  for (const double largest : {127.0, 255.0, 65535.0, 4294967295.0}) {
    EXPECT_EQ(attribute_value(0, largest), 0);
    EXPECT_FLOAT_EQ(attribute_value(largest, largest), 1);
    EXPECT_NEAR(attribute_value(std::floor(largest / 2), largest), linear_from_srgb(0.5f), 4e-3f);
  }
  for (int i = 0; i < 256; ++i)
    EXPECT_EQ(attribute_value(i, 255), linear_from_srgb(float(i / 255.0)));
}

TEST(MeshAttribute, OfObjFiles) {
  const TemporaryFile file(
      "v 0 0 0\nv 1 0 0 1 0.5 0\nv 1 1 0 0.25 0.25 0.25 # grey\nv 0 1 0 1\n"
      "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n",
      "colours.obj");
  const TriangleMesh mesh = read_obj(file.path()).mesh;
  ASSERT_EQ(mesh.positions.size(), 5u);  // the first one has two texture coordinates
  const float half = linear_from_srgb(0.5f), quarter = linear_from_srgb(0.25f);
  EXPECT_EQ(values_of(mesh, "vertex_color"),
            (std::vector<float>{1, 1, 1, 1, half, 0, quarter, quarter, quarter, 1, 1, 1, 1, 1, 1}));
  const TemporaryFile plain("v 0 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "plain.obj");
  EXPECT_TRUE(read_obj(plain.path()).mesh.attributes.empty());
  const TemporaryFile bad("v 0 0 0\nv 1 0 0 1 one 1\nv 0 1 0\nf 1 2 3\n", "bad.obj");
  EXPECT_THROW(read_obj(bad.path()), Error);
}

TEST(MeshAttribute, OfSerializedFiles) {
  const PackedMesh mesh{.flags = 8 | 0x1000,
                        .arrays = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0.5, 0, 0, 0, 2, 0, 0, 0, 1}},
                        .corners = {0, 1, 2}};
  PackedMesh in_doubles = mesh;
  in_doubles.flags = 8 | 0x2000;
  const TemporaryFile file(serialized_file({mesh, in_doubles}, 4), "colours.serialized");
  for (const uint64_t index : {0, 1})
    EXPECT_EQ(values_of(read_serialized(file.path(), index).mesh, "vertex_color"),
              (std::vector<float>{0.5f, 0, 0, 0, 2, 0, 0, 0, 1}));
}

template <typename T>
Property attribute_buffer(const std::string& name, std::vector<size_t> extents,
                          std::vector<T> values) {
  return {name, Value(Array::of<T>(std::move(extents), std::move(values))), place_in(name)};
}

TEST(MeshAttribute, OfBuffers) {
  const auto corners = attribute_buffer<float>("positions", {3, 3}, {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto face = attribute_buffer<int32_t>("faces", {1, 3}, {0, 1, 2});
  const auto made = [&](const Property& attribute) {
    return make_shape("mesh", {corners, face, attribute});
  };
  EXPECT_TRUE(make_shape("mesh", {corners, face})->mesh()->attributes.empty());
  EXPECT_EQ(
      values_of(*made(attribute_buffer<double>("vertex_color", {3, 3}, {1, 2, 3, 4, 5, 6, 7, 8, 9}))
                     ->mesh(),
                "vertex_color"),
      (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(values_of(*made(attribute_buffer<uint8_t>("face_color", {1, 3}, {0, 255, 51}))->mesh(),
                      "face_color"),
            (std::vector<float>{0, 1, linear_from_srgb(0.2f)}));
  EXPECT_EQ(values_of(*made(attribute_buffer<float>("vertex_value", {3}, {1, -2, 3}))->mesh(),
                      "vertex_value"),
            (std::vector<float>{1, -2, 3}));
  EXPECT_EQ(values_of(*made(attribute_buffer<float>("face_value", {1}, {4}))->mesh(), "face_value"),
            (std::vector<float>{4}));
  const auto message = [&](const Property& attribute) -> std::string {
    try {
      made(attribute);
    } catch (const Error& error) {
      EXPECT_EQ(*error.problems()[0].place.file, attribute.name);
      EXPECT_FALSE(error.problems()[0].remedy.empty());
      return error.problems()[0].message;
    }
    return "";
  };
  EXPECT_EQ(message(attribute_buffer<float>("vertex_value", {2}, {1, 2})),
            "'vertex_value': it has 2 rows, and 'positions' has 3");
  EXPECT_EQ(message(attribute_buffer<float>("face_color", {3, 3}, {1, 2, 3, 1, 2, 3, 1, 2, 3})),
            "'face_color': it has 3 rows, and 'faces' has 1");
  EXPECT_EQ(message(attribute_buffer<float>("vertex_value", {3}, {1, 2, std::nanf("")})),
            "'vertex_value': row 2 is not finite");
  EXPECT_EQ(message(attribute_buffer<float>("vertex_color", {9}, {1, 2, 3, 1, 2, 3, 1, 2, 3})),
            "'vertex_color' has the extents [9]");
}

/// A few triangles of any size and place, with colours at their corners and numbers on their faces.
TriangleMesh coloured_mesh(Random& random) {
  TriangleMesh mesh;
  for (int i = 0; i < 12; ++i) mesh.positions.push_back(random.in_box(5));
  for (uint32_t i = 0; i + 2 < 12; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  MeshAttribute colours{"vertex_color", 3}, numbers{"face_number", 1};
  for (int i = 0; i < 36; ++i) colours.values.push_back(random.uniform());
  for (int i = 0; i < 10; ++i) numbers.values.push_back(random.uniform());
  mesh.attributes = {colours, numbers};
  return mesh;
}

Vec3f colour_of(const TriangleMesh& mesh, uint32_t vertex) {
  const std::vector<float>& values = mesh.attributes[0].values;
  return {values[3 * vertex], values[3 * vertex + 1], values[3 * vertex + 2]};
}

TEST(MeshAttribute, IsLinearOverTriangles) {
  Random random(5);
  for (int i = 0; i < 2000 / samples_divisor; ++i) {
    const TriangleMesh mesh = coloured_mesh(random);
    const auto triangle = uint32_t(random.uniform() * 10);
    const auto& corner = mesh.triangles[triangle];
    // Of needles rounding moves points far.
    if (length(cross(mesh.positions[corner[1]] - mesh.positions[corner[0]],
                     mesh.positions[corner[2]] - mesh.positions[corner[0]])) < 2)
      continue;
    const Vec2f b = square_to_triangle(random.square());
    const Vec3f at = mesh.positions[corner[0]] * (1 - b.x - b.y) + mesh.positions[corner[1]] * b.x +
                     mesh.positions[corner[2]] * b.y;
    const Vec3f expected = colour_of(mesh, corner[0]) * (1 - b.x - b.y) +
                           colour_of(mesh, corner[1]) * b.x + colour_of(mesh, corner[2]) * b.y;
    EXPECT_LT(max_abs(attribute_at(mesh, mesh.attributes[0], triangle, at) - expected), 2e-4f);
    EXPECT_EQ(attribute_at(mesh, mesh.attributes[1], triangle, at),
              Vec3f(mesh.attributes[1].values[triangle]));
    // The slope is what it rises by from corner to corner.
    const Vec3f weights = random.in_box(1);
    const Vec3f slope = attribute_gradient(mesh, mesh.attributes[0], triangle, weights);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t one = corner[k], two = corner[(k + 1) % 3];
      const float rise = dot(colour_of(mesh, two) - colour_of(mesh, one), weights);
      EXPECT_NEAR(dot(slope, mesh.positions[two] - mesh.positions[one]), rise, 2e-3f);
    }
    EXPECT_EQ(attribute_gradient(mesh, mesh.attributes[1], triangle, weights), Vec3f(0));
  }
}

TEST(MeshAttribute, TellsItsMeanAndMaximum) {
  Random random(6);
  const TriangleMesh mesh = coloured_mesh(random);
  const MeshShape shape(mesh);
  for (const MeshAttribute& attribute : mesh.attributes) {
    Vec3d sum(0);
    constexpr int n = 200000 / samples_divisor;
    for (int i = 0; i < n; ++i) {
      const ShapeSample sample = shape.sample_area(random.square());
      const Vec3f value =
          attribute_at(mesh, attribute, sample.point.primitive, sample.point.position);
      EXPECT_LE(max_abs(value), attribute_maximum(attribute) * 1.00001f);
      sum += Vec3d(value);
    }
    // Of values between 0 and 1.
    const Vec3f mean = attribute_mean(mesh, attribute), found(sum / double(n));
    EXPECT_LT(max_abs(mean - found), 4 * 0.5f / std::sqrt(float(n)));
  }
  EXPECT_EQ(attribute_maximum({"vertex_color", 3}), 0);
}

/// Whatever the place and however thin the triangle.
TEST(MeshAttribute, StaysBetweenItsValues) {
  Random random(7);
  TriangleMesh mesh = coloured_mesh(random);
  mesh.positions[1] = mesh.positions[0];                               // no area
  mesh.positions[5] = mesh.positions[4] + Vec3f(1e-20f, 0, 0);         // less than floats tell
  mesh.positions[8] = (mesh.positions[6] + mesh.positions[7]) * 0.5f;  // on a line
  for (uint32_t triangle = 0; triangle < 10; ++triangle)
    for (const float far : {0.0f, 1.0f, 1e20f, 3e38f, infinity, std::nanf("")}) {
      const Vec3f value =
          attribute_at(mesh, mesh.attributes[0], triangle, random.direction() * far);
      for (int c = 0; c < 3; ++c) {
        EXPECT_GE(value[c], 0);
        EXPECT_LE(value[c], 1);
      }
      EXPECT_TRUE(is_finite(attribute_gradient(mesh, mesh.attributes[0], triangle, {1, 1, 1})));
    }
}

/// Turning triangles round by normals and mirrors leaves every vertex its colour.
TEST(MeshAttribute, SurvivesPlacement) {
  const TemporaryFile file("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n", "turned.obj");
  for (const bool flip : {false, true})
    for (const double mirror : {-1.0, 1.0}) {
      const auto shape =
          make_shape("obj", {{"filename", file.path(), {}},
                             {"flip_normals", Value(flip), {}},
                             {"to_world", Value(Transform::scale({mirror, 2, 1})), {}}});
      const TriangleMesh& mesh = *shape->mesh();
      const auto at = [&](float x, float y) {
        return attribute_at(mesh, mesh.attributes[0], 0, {float(mirror) * x, 2 * y, 0});
      };
      EXPECT_LT(max_abs(at(0, 0) - Vec3f(1, 0, 0)), 1e-6f);
      EXPECT_LT(max_abs(at(1, 0) - Vec3f(0, 1, 0)), 1e-6f);
      EXPECT_LT(max_abs(at(0.25f, 0.5f) - Vec3f(0.25f, 0.25f, 0.5f)), 1e-6f);
    }
}

TEST(MeshAttribute, IsNamedWhereItIsMissing) {
  const auto message = [](const Shape& shape) {
    try {
      attribute_named(shape, "the vase", "vertex_colour", place_in("scene.xml", 3, 7));
    } catch (const Error& error) {
      EXPECT_EQ(error.problems()[0].place.line, 3);
      return error.problems()[0].message + "; " + error.problems()[0].remedy;
    }
    return std::string();
  };
  Random random(8);
  EXPECT_EQ(message(MeshShape(coloured_mesh(random))),
            "the mesh of the vase has no attribute 'vertex_colour'; did you mean 'vertex_color'? "
            "Valid: vertex_color, face_number");
  EXPECT_EQ(message(*make_shape("cube")),
            "the mesh of the vase has no attribute 'vertex_colour'; it has none at all: save it "
            "with colours, or give it another texture");
  EXPECT_NE(message(*make_shape("sphere")).find("is no mesh"), std::string::npos);
}

}  // namespace
}  // namespace kaustik::test
