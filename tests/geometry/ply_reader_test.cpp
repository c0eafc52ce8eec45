// PLY files, good and hostile.

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <map>

#include "mesh_file_support.h"

namespace kaustik::test {
namespace {

/// A quad with everything that a vertex can have, and things to be skipped.
std::string binary_ply(bool big_endian) {
  std::string out = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                    "_endian 1.0\ncomment made by hand\nelement camera 1\n"
                    "property double fov\nproperty list uchar short taps\n"
                    "element vertex 4\nproperty float x\nproperty float y\nproperty double z\n"
                    "property uchar red\nproperty float nx\nproperty float ny\nproperty float nz\n"
                    "property float s\nproperty float t\nelement face 1\nproperty int material\n"
                    "property list uint ushort vertex_index\nend_header\n";
  put(out, 45.0, big_endian);
  put(out, uint8_t(2), big_endian);
  put(out, int16_t(-5), big_endian);
  put(out, int16_t(7), big_endian);
  for (const auto& [x, y] : {std::pair(0.f, 0.f), {1.f, 0.f}, {1.f, 1.f}, {0.f, 1.f}}) {
    put(out, x, big_endian);
    put(out, y, big_endian);
    put(out, 2.5, big_endian);
    put(out, uint8_t(200), big_endian);
    for (const float n : {0.f, 0.f, 1.f}) put(out, n, big_endian);
    put(out, x, big_endian);
    put(out, y, big_endian);
  }
  put(out, int32_t(3), big_endian);
  put(out, uint32_t(4), big_endian);
  for (const int i : {0, 1, 2, 3}) put(out, uint16_t(i), big_endian);
  return out;
}

TEST(PlyReader, AllFormats) {
  expect_quad(ply(text_ply));
  expect_quad(ply(binary_ply(false)));
  expect_quad(ply(binary_ply(true)));
  std::string windows = text_ply;
  for (size_t i = 0; (i = windows.find('\n', i)) != windows.npos; i += 2)
    windows.replace(i, 1, "\r\n");
  expect_quad(ply(windows));
}

/// `text_ply` with one piece replaced.
std::string with(const std::string& from, const std::string& to) {
  std::string result = text_ply;
  const size_t at = result.find(from);
  EXPECT_NE(at, result.npos) << from;
  return result.replace(at, from.size(), to);
}

TEST(PlyReader, SaysWhatIsWrongAndWhere) {
  const auto message = [](const std::string& bytes) { return reading_error([&] { ply(bytes); }); };
  const auto expect = [&](const std::string& bytes, const std::string& what) {
    EXPECT_NE(message(bytes).find(what), std::string::npos) << what << "\n got: " << message(bytes);
  };
  expect("", "does not start with 'ply'");
  expect("solid cube", "does not start with 'ply'");
  expect(with("1 0 2.5", "1 nan 2.5"), "vertex 1 is not finite");
  expect(with("1 0 2.5", "1 nan 2.5"), ":16: ");
  expect(with("1 0 2.5", "1 inf 2.5"), "vertex 1 is not finite");
  expect(with("1 0 2.5", "1 1e60 2.5"), "vertex 1 is not finite");
  expect(with("1 0 2.5", "1 zero 2.5"), "'zero' is no number");
  expect(with("4 0 1 2 3", "4 0 1 2 4"), "face 0 refers to vertex 4 of 4");
  expect(with("4 0 1 2 3", "4 0 1 2 -1"), "face 0 refers to vertex -1 of 4");
  expect(with("4 0 1 2 3", "4 0 1 2"), "ends too early");
  expect(with("4 0 1 2 3", "-4 0 1 2 3"), "length -4");
  expect(with("4 0 1 2 3", "2 0 1"), "no faces");
  expect(with("face 1", "face 0"), "no faces");
  expect(with("vertex 4", "vertex 4000000000"), "more than the file can hold");
  expect(with("vertex 4", "vertex 99999999999999999999"), "is no number of elements");
  expect(with("vertex 4", "vertex -4"), "is no number of elements");
  expect(with("float x", "quad x"), "unknown type 'quad'");
  expect(with("float x", "float w"), "no 'x', 'y' and 'z'");
  expect(with("vertex_indices", "triangles"), "no list 'vertex_indices'");
  expect(with("ascii", "utf8"), "unknown format 'utf8'");
  expect(with("end_header", "end_heder"), "unknown line 'end_heder'");
  EXPECT_NE(reading_error([] { read_ply("/nonexistent/mesh.ply"); }), "");
  EXPECT_NE(reading_error([] { read_ply("/tmp"); }), "");
}

TEST(PlyReader, HugeListsAllocateNothing) {
  std::string bytes = binary_ply(false);
  const uint32_t huge = 0xffffffff;
  std::memcpy(bytes.data() + bytes.size() - 12, &huge, 4);
  EXPECT_NE(reading_error([&] { ply(bytes); }).find("ends too early"), std::string::npos);
}

TEST(PlyReader, SurvivesDamage) {
  survive_damage(text_ply, ply, 500);
  survive_damage(binary_ply(false), ply, 500);
  survive_damage(binary_ply(true), ply, 500);
  // With colours of vertices and numbers of faces.
  std::string painted = with("element face 1\n", "element face 1\nproperty short heat_x\n");
  painted.replace(painted.find("4 0 1 2 3"), 0, "7 ");
  for (const auto& [normal, colour] : {std::pair("nx", "r"), {"ny", "g"}, {"nz", "b"}})
    painted.replace(painted.find(normal), 2, colour);
  EXPECT_EQ(ply(painted).attributes.size(), 2u);
  survive_damage(painted, ply, 500);
}

TEST(PlyReader, MarksAndLineEnds) {
  expect_quad(ply("\xef\xbb\xbf" + text_ply));
  std::string old = text_ply;
  std::replace(old.begin(), old.end(), '\n', '\r');
  expect_quad(ply(old));
  EXPECT_NE(reading_error([&] { ply(old.substr(0, old.size() - 3)); }).find(":19: "),
            std::string::npos);
  std::string binary = binary_ply(false);
  std::replace(binary.begin(), binary.begin() + std::ptrdiff_t(binary.find("end_header") + 11),
               '\n', '\r');
  expect_quad(ply(binary));
}

/// A strip of triangles, packed: of many pieces that are read side by side.
std::string packed_strip(uint32_t vertices, const std::string& index_type) {
  std::string out = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                    std::to_string(vertices) +
                    "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
                    "property float ny\nproperty float nz\nproperty double u\nproperty double v\n"
                    "element face " +
                    std::to_string(vertices - 2) + "\nproperty list uchar " + index_type +
                    " vertex_indices\nproperty uchar flag\nend_header\n";
  for (uint32_t i = 0; i < vertices; ++i) {
    for (const float value : {float(i / 2), float(i % 2), 0.5f, 0.f, 0.f, 1.f})
      put(out, value, false);
    for (const double value : {double(i), -double(i)}) put(out, value, false);
  }
  for (uint32_t i = 0; i + 2 < vertices; ++i) {
    put(out, uint8_t(3), false);
    for (uint32_t corner = 0; corner < 3; ++corner)
      if (index_type == "float")
        put(out, float(i + corner), false);
      else
        put(out, i + corner, false);
    put(out, uint8_t(7), false);
  }
  return out;
}

TEST(PlyReader, ReadsLargeMeshesPieceByPiece) {
  const uint32_t count = 100'000;
  for (const char* type : {"int", "float"}) {
    const TriangleMesh mesh = ply(packed_strip(count, type));
    ASSERT_EQ(mesh.positions.size(), count);
    ASSERT_EQ(mesh.triangles.size(), count - 2);
    for (uint32_t i = 0; i < count; ++i) {
      ASSERT_EQ(mesh.positions[i], Vec3f(float(i / 2), float(i % 2), 0.5f));
      ASSERT_EQ(mesh.normals[i], Vec3f(0, 0, 1));
      ASSERT_EQ(mesh.uvs[i], Vec2f(float(i), -float(i)));
    }
    for (uint32_t i = 0; i + 2 < count; ++i)
      ASSERT_EQ(mesh.triangles[i], (std::array<uint32_t, 3>{i, i + 1, i + 2}));
  }
}

TEST(PlyReader, FindsTheFirstFaultOfALargeMesh) {
  const uint32_t count = 100'000;
  const std::string good = packed_strip(count, "int");
  const size_t vertices = good.find("end_header\n") + 11, faces = vertices + 40 * size_t(count);
  const auto damaged = [&](size_t at, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    return bytes;
  };
  const auto message = [](const std::string& bytes) { return reading_error([&] { ply(bytes); }); };
  std::string twice = damaged(vertices + 40 * 70'001 + 4, std::nanf(""));
  std::memcpy(twice.data() + vertices + 40 * 90'000, "\xff\xff\xff\xff", 4);
  EXPECT_NE(message(twice).find("vertex 70001 is not finite"), std::string::npos);
  EXPECT_NE(
      message(damaged(faces + 14 * 60'000 + 1, int32_t(-5))).find("face 60000 refers to vertex -5"),
      std::string::npos);
  EXPECT_NE(
      message(damaged(faces + 14 * 60'000 + 5, count)).find("face 60000 refers to vertex 100000"),
      std::string::npos);
  EXPECT_NE(message(good.substr(0, good.size() - 1)).find("ends too early"), std::string::npos);
  // A polygon among the triangles: all are read one by one.
  std::string quad = good;
  quad.insert(faces + 14 * 50'000 + 13, std::string("\0\0\0\0", 4));
  quad[faces + 14 * 50'000] = 4;
  EXPECT_EQ(ply(quad).triangles.size(), count - 1);
}

/// How a PLY file writes a mesh.
struct PlyForm {
  std::string format, number = "float", length = "uchar", index = "int";
  bool shuffled = false;   ///< numbers of a vertex that do not stand side by side
  bool with_list = false;  ///< one by one: records differ in size
};

/// Vertices with all that they can have, and random triangles.
std::string written(const PlyForm& form, uint32_t vertices, uint32_t faces) {
  std::vector<std::string> names = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
  if (form.shuffled) names = {"v", "nz", "y", "u", "z", "x", "ny", "nx"};
  std::string out =
      "ply\nformat " + form.format + " 1.0\nelement vertex " + std::to_string(vertices) + "\n";
  for (const std::string& name : names) out += "property " + form.number + " " + name + "\n";
  if (form.with_list) out += "property list uchar uchar none\n";
  out += "element face " + std::to_string(faces) + "\nproperty list " + form.length + " " +
         form.index + " vertex_indices\nend_header\n";
  const auto add = [&](const std::string& type, double value) {
    const bool big_endian = form.format == "binary_big_endian";
    if (form.format == "ascii")
      out += fmt::format("{} ", value);
    else if (type == "float")
      put(out, float(value), big_endian);
    else if (type == "double")
      put(out, value, big_endian);
    else if (type == "uchar")
      put(out, uint8_t(value), big_endian);
    else
      put(out, uint32_t(value), big_endian);
  };
  Random random(11);
  for (uint32_t i = 0; i < vertices; ++i) {
    std::map<std::string, float> vertex;
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"})
      vertex[name] = random.uniform(-1, 1) * random.magnitude(-20, 20);
    for (const std::string& name : names) add(form.number, double(vertex[name]));
    if (form.with_list) add("uchar", 0);
  }
  for (uint32_t i = 0; i < faces; ++i) {
    add(form.length, 3);
    for (int corner = 0; corner < 3; ++corner)
      add(form.index, std::floor(double(random.uniform()) * double(vertices)));
  }
  return out;
}

/// What is copied as it stands is what is read number by number.
TEST(PlyReader, AllFormsAreTheSameMesh) {
  const std::string little = "binary_little_endian", big = "binary_big_endian";
  const uint32_t vertices = 20'000, faces = 50'000;
  const TriangleMesh plain = ply(written({.format = little}, vertices, faces));
  ASSERT_EQ(plain.positions.size(), vertices);
  ASSERT_EQ(plain.triangles.size(), faces);
  ASSERT_EQ(plain.normals.size(), vertices);
  ASSERT_EQ(plain.uvs.size(), vertices);
  const PlyForm forms[] = {{.format = "ascii"},
                           {.format = big},
                           {.format = big, .number = "double", .shuffled = true},
                           {.format = little, .shuffled = true},
                           {.format = little, .number = "double", .length = "uint"},
                           {.format = little, .index = "uint", .with_list = true},
                           {.format = little, .index = "double"}};
  for (const PlyForm& form : forms)
    expect_equal_meshes(ply(written(form, vertices, faces)), plain,
                        form.format + " " + form.number + " " + form.index);
  // A single bit tells.
  std::string flipped = written({.format = little}, vertices, faces);
  flipped[flipped.find("end_header") + 11] ^= 1;
  EXPECT_NE(ply(flipped).positions[0], plain.positions[0]);
}

/// Numbers are tested several at once, and the last of a piece apart.
TEST(PlyReader, NoNumberOfAPieceGoesUntested) {
  const uint32_t vertices = 9, faces = 5;
  const std::string good = written({.format = "binary_little_endian"}, vertices, faces);
  const size_t first = good.find("end_header\n") + 11, first_face = first + 32 * vertices;
  const auto message = [&](size_t at, auto value) {
    std::string bytes = good;
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    return reading_error([&] { ply(bytes); });
  };
  for (size_t i = 0; i < 8 * vertices; ++i) {
    for (const float value : {std::nanf(""), -std::nanf(""), infinity, -infinity})
      EXPECT_NE(message(first + 4 * i, value).find(fmt::format("vertex {} is not", i / 8)),
                std::string::npos)
          << i;
    EXPECT_EQ(message(first + 4 * i, -std::numeric_limits<float>::max()), "");
  }
  for (size_t face = 0; face < faces; ++face)
    for (size_t corner = 0; corner < 3; ++corner) {
      const size_t at = first_face + 13 * face + 1 + 4 * corner;
      for (const uint32_t index : {vertices, 0x7fffffffu, 0x80000000u, 0xffffffffu})
        EXPECT_NE(message(at, index).find(fmt::format("face {} refers to vertex", face)),
                  std::string::npos)
            << face << ' ' << corner << ' ' << index;
      EXPECT_EQ(message(at, vertices - 1), "");
    }
}

/// Many attributes of faces times one large polygon would be many times the file.
TEST(PlyReader, AttributesOfFacesAreBounded) {
  const auto file = [](int attributes, int corners) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 2000\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uint int vertex_indices\n";
    for (int i = 0; i < attributes; ++i) text += fmt::format("property uchar a{}_x\n", i);
    text += "end_header\n";
    for (int i = 0; i < 2000; ++i) text += "0 0 0\n";
    text += std::to_string(corners);
    for (int i = 0; i < corners; ++i) text += " 1";
    for (int i = 0; i < attributes; ++i) text += " 7";
    return text;
  };
  const std::string message = reading_error([&] { ply(file(10'000, 2000)); });
  EXPECT_NE(message.find("the attributes of faces up to face 0"), std::string::npos) << message;
  const TriangleMesh few = ply(file(100, 2000));
  EXPECT_EQ(few.triangles.size(), 1998u);
  ASSERT_EQ(few.attributes.size(), 100u);
  EXPECT_EQ(few.attributes[99].values.size(), 1998u);
}

TEST(PlyReader, TellsSmallFaces) {
  const MeshFile file = read_ply(TemporaryFile(with("face 1", "face 2") + "2 0 1\n").path());
  expect_quad(file.mesh);
  ASSERT_EQ(file.remarks.size(), 1u);
  EXPECT_NE(file.remarks[0].find("1 face was left out"), std::string::npos) << file.remarks[0];
}

}  // namespace
}  // namespace kaustik::test
